//! As size-nearest, with the nearest level of a pyramid.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{PYRAMID, draw};
use multum::filter::NearestTexel;
use multum::lod::{EachPiece, Lod, LongestAxis, NearestLevel};
use multum::mipmap::Mipmapped;
use multum::texture::Repeat;

#[entry]
fn main() -> ! {
    let (filter, lod) = (NearestTexel, Lod::new(NearestLevel, LongestAxis, EachPiece));
    draw(Mipmapped::<_, _, _, _, Repeat>::new(
        &PYRAMID, filter, filter, lod,
    ))
}
