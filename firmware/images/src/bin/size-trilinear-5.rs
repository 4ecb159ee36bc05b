//! As size-mipmapped, with trilinear filtering of 5 bits.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{PYRAMID, draw};
use multum::filter::LinearTexels5;
use multum::lod::{EachPiece, LinearLevels, Lod, LongestAxis};
use multum::mipmap::Mipmapped;
use multum::perspective::Every;
use multum::texture::Repeat;

#[entry]
fn main() -> ! {
    let (filter, lod) = (
        LinearTexels5,
        Lod::new(LinearLevels, LongestAxis, EachPiece),
    );
    let shader = Mipmapped::<_, _, _, _, Repeat>::new(PYRAMID, filter, filter, lod);
    draw(Every::<16>, shader)
}
