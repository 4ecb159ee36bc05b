//! The least image: one triangle, nearest texel.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{FINEST, draw};
use multum::sample::Nearest;
use multum::texture::Repeat;

#[entry]
fn main() -> ! {
    draw(Nearest::<_, Repeat>::new(FINEST))
}
