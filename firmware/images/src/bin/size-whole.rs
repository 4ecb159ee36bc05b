//! As size-transform-levels, with a depth test: what most programs need.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{camera, draw_mesh_tested, level_each_span};

#[entry]
fn main() -> ! {
    draw_mesh_tested(camera, level_each_span())
}
