//! As size-nearest, without the levels of its pyramid.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{PICTURE, draw};
use multum::perspective::Every;
use multum::sample::Nearest;
use multum::texture::Repeat;

#[entry]
fn main() -> ! {
    draw(Every::<16>, Nearest::<_, Repeat>::new(PICTURE))
}
