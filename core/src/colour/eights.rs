//! The colours of eight pixels at a time.

use core::array::from_fn;

use super::{Colour, Fractions, LANE_BITS, Lanes as _, WEIGHT_BITS, Weights, Wide as _};
use crate::simd::{COUNT, U16x8};

/// Colours of eight pixels, as they are while they are mixed.
pub trait EightMixed<C>: Copy + Default {
    /// The means of four texels each, given by numbers, in the order of [`Weights`], and by weights along u and v.
    fn new(numbers: [U16x8; 4], texel: impl Fn(u16) -> C, between: [U16x8; 2]) -> Self;

    /// See [`Wide::lerp`](super::Wide::lerp).
    #[must_use]
    fn lerp(self, other: Self, weight: u32) -> Self;

    /// Rounded.
    fn colours(self) -> [C; COUNT];
}

/// A way to mix colours for eight pixels at a time.
pub trait MixesEights {
    /// Bits of the weights of four texels.
    const BITS: u32;

    /// What it mixes.
    type Mixed<C: Colour>: EightMixed<C>;
}

/// [`Colour::Lanes`]: rounded along v, and then along u.
#[derive(Clone, Copy, Debug)]
pub struct ByLanes;

impl MixesEights for ByLanes {
    const BITS: u32 = LANE_BITS;

    type Mixed<C: Colour> = C::EightLanes;
}

/// [`Colour::Wide`]: rounded once, at the end.
#[derive(Clone, Copy, Debug)]
pub struct ByWeights;

impl MixesEights for ByWeights {
    const BITS: u32 = WEIGHT_BITS;

    type Mixed<C: Colour> = C::EightWide;
}

/// What `mixed` makes of the texels of each pixel.
#[inline]
fn each<C, T>(
    numbers: [U16x8; 4],
    texel: impl Fn(u16) -> C,
    between: [U16x8; 2],
    mixed: impl Fn([C; 4], Fractions) -> T,
) -> [T; COUNT] {
    let (numbers, [u, v]) = (numbers.map(U16x8::array), between.map(U16x8::array));
    from_fn(|pixel| {
        let [u, v] = [u, v].map(|weights| weights[pixel].into());
        let texels = numbers.map(|numbers| texel(numbers[pixel]));
        mixed(texels, Fractions { u, v })
    })
}

/// [`Colour::Lanes`] of each pixel by itself.
#[derive(Clone, Copy, Debug, Default)]
pub struct EachLanes<C: Colour>([C::Lanes; COUNT]);

impl<C: Colour> EightMixed<C> for EachLanes<C> {
    #[inline]
    fn new(numbers: [U16x8; 4], texel: impl Fn(u16) -> C, between: [U16x8; 2]) -> Self {
        Self(each(
            numbers,
            texel,
            between,
            |texels, Fractions { u, v }| {
                let [a, b, c, d] = texels.map(C::spread);
                a.mix(c, v).mix(b.mix(d, v), u)
            },
        ))
    }

    #[inline]
    fn lerp(self, other: Self, weight: u32) -> Self {
        Self(from_fn(|pixel| self.0[pixel].lerp(other.0[pixel], weight)))
    }

    #[inline]
    fn colours(self) -> [C; COUNT] {
        self.0.map(C::gather)
    }
}

/// [`Colour::Wide`] of each pixel by itself.
#[derive(Clone, Copy, Debug, Default)]
pub struct EachWide<C: Colour>([C::Wide; COUNT]);

impl<C: Colour> EightMixed<C> for EachWide<C> {
    #[inline]
    fn new(numbers: [U16x8; 4], texel: impl Fn(u16) -> C, between: [U16x8; 2]) -> Self {
        Self(each(numbers, texel, between, |texels, between| {
            C::mix(texels, Weights::new(between))
        }))
    }

    #[inline]
    fn lerp(self, other: Self, weight: u32) -> Self {
        Self(from_fn(|pixel| self.0[pixel].lerp(other.0[pixel], weight)))
    }

    #[inline]
    fn colours(self) -> [C; COUNT] {
        self.0.map(C::narrow)
    }
}
