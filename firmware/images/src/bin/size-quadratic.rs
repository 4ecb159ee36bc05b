//! As size-affine, by parabolas of 16 columns.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{draw, nearest};
use multum::perspective::Quadratic;

#[entry]
fn main() -> ! {
    draw(Quadratic::<16>, nearest())
}
