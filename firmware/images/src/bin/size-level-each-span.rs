//! As size-nearest, with the nearest level of a pyramid, chosen for each span.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::{draw, level_each_span};
use multum::perspective::Every;

#[entry]
fn main() -> ! {
    draw(Every::<16>, level_each_span())
}
