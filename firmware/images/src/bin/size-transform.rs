//! As size-clip, with a mesh that is seen by a camera.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{camera, draw_mesh, nearest};

#[entry]
fn main() -> ! {
    draw_mesh(camera, nearest())
}
