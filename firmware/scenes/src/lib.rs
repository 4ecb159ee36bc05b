//! The scenes of the verification, and the code that draws them.
//!
//! Chips and the PC build this crate alike, from the same baked tables: an image draws with it in
//! bands, the program `expected` draws with it whole frames, and the hashes must be the same.
#![no_std]
#![forbid(unsafe_code)]

pub mod baked;
pub mod draw;
pub mod plan;
pub mod scene;
