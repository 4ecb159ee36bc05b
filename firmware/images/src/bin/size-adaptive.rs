//! As size-affine, in perspective within a bound.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{FINEST, draw, nearest};
use multum::perspective::Adaptive;

#[entry]
fn main() -> ! {
    let strategy = Adaptive::new(Adaptive::DEFAULT_BOUND, FINEST.log2_size());
    draw(strategy, nearest())
}
