//! The zero of all sizes: starts, sums up the frame and ends.
#![no_std]
#![no_main]

use images::machine::entry;
use images::size::run;

#[entry]
fn main() -> ! {
    run(|_| Ok(()))
}
