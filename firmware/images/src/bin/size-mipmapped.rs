//! As size-level-each-span, with a level for each 16 columns.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{PYRAMID, draw};
use multum::filter::NearestTexel;
use multum::lod::{EachPiece, Lod, LongestAxis, NearestLevel};
use multum::mipmap::Mipmapped;
use multum::perspective::Every;
use multum::texture::Repeat;

#[entry]
fn main() -> ! {
    let (filter, lod) = (NearestTexel, Lod::new(NearestLevel, LongestAxis, EachPiece));
    let shader = Mipmapped::<_, _, _, _, Repeat>::new(PYRAMID, filter, filter, lod);
    draw(Every::<16>, shader)
}
