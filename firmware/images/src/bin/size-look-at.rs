//! As size-transform, with a camera from angles and directions.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{camera_from_angles, draw_mesh, nearest};

#[entry]
fn main() -> ! {
    draw_mesh(camera_from_angles, nearest())
}
