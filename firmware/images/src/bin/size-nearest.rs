//! Perspective every 16 columns, nearest texel. Others differ from this in a feature.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{draw, nearest};
use multum::perspective::Every;

#[entry]
fn main() -> ! {
    draw(Every::<16>, nearest())
}
