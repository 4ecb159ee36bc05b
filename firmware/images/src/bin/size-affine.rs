//! One triangle, affine, nearest texel: the least that draws.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{draw, nearest};
use multum::perspective::Affine;

#[entry]
fn main() -> ! {
    draw(Affine, nearest())
}
