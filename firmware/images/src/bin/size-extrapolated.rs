//! As size-affine, extrapolated along a row.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{draw, nearest};
use multum::perspective::Extrapolated;

#[entry]
fn main() -> ! {
    draw(Extrapolated, nearest())
}
