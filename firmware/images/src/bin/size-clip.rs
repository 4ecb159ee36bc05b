//! As size-nearest, with a triangle in clip space that the near plane cuts.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{draw_clipped, nearest};

#[entry]
fn main() -> ! {
    draw_clipped(nearest())
}
