//! As size-nearest, affine within a bound.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{draw, nearest};
use multum::perspective::{AffineWithin, Every};

#[entry]
fn main() -> ! {
    let strategy = AffineWithin::new(Every::<16>, AffineWithin::DEFAULT_BOUND);
    draw(strategy, nearest())
}
