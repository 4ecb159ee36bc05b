//! As size-affine, by lines of equal depth.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{draw, nearest};
use multum::perspective::ConstantZ;

#[entry]
fn main() -> ! {
    draw(ConstantZ, nearest())
}
