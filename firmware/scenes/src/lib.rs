//! The scenes of the verification in flash, and the code that draws them on a chip in bands.
//!
//! `host-sim hash` draws the same scenes as whole frames and by its own way through the stages; the
//! hashes must be the same.
#![no_std]
#![forbid(unsafe_code)]

pub mod baked;
pub mod benchmark;
pub mod draw;
pub mod plan;
pub mod scene;
