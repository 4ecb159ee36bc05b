//! As size-transform, with the nearest level of a pyramid for each span.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{camera, draw_mesh, level_each_span};

#[entry]
fn main() -> ! {
    draw_mesh(camera, level_each_span())
}
