//! As size-nearest, with bilinear filtering of 5 bits.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{FINEST, draw};
use multum::filter::LinearTexels5;
use multum::perspective::Every;
use multum::sample::Bilinear;
use multum::texture::Repeat;

#[entry]
fn main() -> ! {
    let bilinear = Bilinear::<_, Repeat, Repeat, LinearTexels5>::new(FINEST);
    draw(Every::<16>, bilinear)
}
