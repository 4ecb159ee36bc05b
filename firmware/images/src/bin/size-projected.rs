//! As size-transform, with vertices that are projected once a frame.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{camera, draw_mesh_projected, nearest};

#[entry]
fn main() -> ! {
    draw_mesh_projected(camera, nearest())
}
