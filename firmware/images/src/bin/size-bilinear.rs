//! As size-nearest, with bilinear filtering.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{FINEST, draw};
use multum::perspective::Every;
use multum::sample::Bilinear;
use multum::texture::Repeat;

#[entry]
fn main() -> ! {
    draw(Every::<16>, Bilinear::<_, Repeat>::new(FINEST))
}
