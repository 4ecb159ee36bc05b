//! As size-nearest, with a depth test.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{draw_tested, nearest};

#[entry]
fn main() -> ! {
    draw_tested(nearest())
}
