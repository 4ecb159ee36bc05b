//! Colours as plain channels, so that a test can say what a mean or a filter of them is.

use std::fmt::Debug;

use multum::colour::{Colour, Rgba5551, Rgba8888};
use multum::embedded_graphics::pixelcolor::{Gray8, GrayColor, Rgb565, Rgb888, RgbColor};
use rand::Rng as _;

use crate::random::Rng;

/// A colour whose channels can be told and set.
pub trait Split: Colour + PartialEq + Debug {
    /// Bits of each channel; 0 for those that it does not have.
    const BITS: [u32; 4];

    /// Its channels.
    fn split(self) -> [u32; 4];

    /// From channels within their bits.
    fn join(channels: [u32; 4]) -> Self;

    /// Any colour.
    fn random(random: &mut Rng) -> Self {
        Self::join(Self::BITS.map(|bits| random.random_range(0..1u32 << bits)))
    }
}

impl Split for Gray8 {
    const BITS: [u32; 4] = [8, 0, 0, 0];

    fn split(self) -> [u32; 4] {
        [self.luma().into(), 0, 0, 0]
    }

    fn join([luma, ..]: [u32; 4]) -> Self {
        Self::new(luma as u8)
    }
}

impl Split for Rgb565 {
    const BITS: [u32; 4] = [5, 6, 5, 0];

    fn split(self) -> [u32; 4] {
        [self.r().into(), self.g().into(), self.b().into(), 0]
    }

    fn join([r, g, b, _]: [u32; 4]) -> Self {
        Self::new(r as u8, g as u8, b as u8)
    }
}

impl Split for Rgb888 {
    const BITS: [u32; 4] = [8, 8, 8, 0];

    fn split(self) -> [u32; 4] {
        [self.r().into(), self.g().into(), self.b().into(), 0]
    }

    fn join([r, g, b, _]: [u32; 4]) -> Self {
        Self::new(r as u8, g as u8, b as u8)
    }
}

impl Split for Rgba5551 {
    const BITS: [u32; 4] = [5, 5, 5, 1];

    fn split(self) -> [u32; 4] {
        let bits = u32::from(self.0);
        [bits / 2048, bits / 64 % 32, bits / 2 % 32, bits % 2]
    }

    fn join([r, g, b, a]: [u32; 4]) -> Self {
        Self((r * 2048 + g * 64 + b * 2 + a) as u16)
    }
}

impl Split for Rgba8888 {
    const BITS: [u32; 4] = [8; 4];

    fn split(self) -> [u32; 4] {
        self.0.map(u32::from)
    }

    fn join(channels: [u32; 4]) -> Self {
        Self(channels.map(|c| c as u8))
    }
}
