//! A band of pixels and the corners of a triangle, which is not drawn.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::prepare;

#[entry]
fn main() -> ! {
    prepare()
}
