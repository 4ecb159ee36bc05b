//! As size-affine, with triangles divided within a bound.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{FINEST, draw, nearest};
use multum::perspective::Subdivided;

#[entry]
fn main() -> ! {
    let strategy = Subdivided::new(Subdivided::DEFAULT_BOUND, FINEST.log2_size());
    draw(strategy, nearest())
}
