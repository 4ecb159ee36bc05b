//! As size-affine, exact in perspective.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{draw, nearest};
use multum::perspective::PerPixel;

#[entry]
fn main() -> ! {
    draw(PerPixel, nearest())
}
