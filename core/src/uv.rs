//! Texture coordinates as the perspective stage hands them to a sampler. A leaf.

use core::array::from_fn;
use core::ops::Add;

use fixed::types::I8F24;

use crate::simd::{COUNT, U32x8};

/// A texture coordinate, or a step between two, in repeats of the texture, as 8.24.
///
/// Not wrapped: the whole part tells the repeat, so that every wrap mode takes the same
/// coordinates and a difference of two has a sign. Meshes stay within
/// [`MAX_UV`](crate::geometry::MAX_UV) = 127 repeats; sums wrap around at 128.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Uv {
    /// To the right.
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    pub u: I8F24,
    /// Down.
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    pub v: I8F24,
}

impl Uv {
    /// Fraction bits of both coordinates.
    pub const FRACTION_BITS: u32 = 24;

    /// From the raw bits of two 8.24 numbers.
    #[inline]
    #[must_use]
    pub const fn from_bits(u: i32, v: i32) -> Self {
        Self {
            u: I8F24::from_bits(u),
            v: I8F24::from_bits(v),
        }
    }
}

impl Uv {
    /// After so many steps; wraps around at 128 repeats.
    #[inline]
    pub(crate) fn after(self, step: Self, steps: usize) -> Self {
        let far = |c: I8F24| c.to_bits().wrapping_mul(steps as i32);
        self + Self::from_bits(far(step.u), far(step.v))
    }
}

/// A coordinate that goes along a parabola from pixel to pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Curve {
    /// At the pixel's centre.
    pub uv: Uv,
    /// To the next pixel.
    pub step: Uv,
    /// From that step to the one behind it.
    pub change: Uv,
}

impl Curve {
    /// So many pixels farther, below 2^16.
    #[inline]
    pub(crate) fn after(self, pixels: usize) -> Self {
        // The sum of so many steps, each a change more than the one before.
        let changes = pixels.wrapping_mul(pixels.wrapping_sub(1)) >> 1;
        Self {
            uv: self.uv.after(self.step, pixels).after(self.change, changes),
            step: self.step.after(self.change, pixels),
            change: self.change,
        }
    }
}

/// Coordinates at this pixel, the next and so on, without end.
impl Iterator for Curve {
    type Item = Uv;

    #[inline]
    fn next(&mut self) -> Option<Uv> {
        let here = self.uv;
        self.uv = here + self.step;
        self.step = self.step + self.change;
        Some(here)
    }
}

/// The coordinates of eight pixels, one behind the other.
#[derive(Clone, Copy, Debug)]
pub struct Eight {
    /// As the bits of [`Uv`]'s.
    pub(crate) u: U32x8,
    pub(crate) v: U32x8,
}

impl Eight {
    /// One by one.
    #[inline(always)]
    pub(crate) fn array(self) -> [Uv; COUNT] {
        let [u, v] = [self.u, self.v].map(|all| all.array().map(u32::cast_signed));
        from_fn(|pixel| Uv::from_bits(u[pixel], v[pixel]))
    }
}

impl Add for Uv {
    type Output = Self;

    /// Steps on; wraps around at 128 repeats.
    #[inline]
    fn add(self, step: Self) -> Self {
        Self {
            u: self.u.wrapping_add(step.u),
            v: self.v.wrapping_add(step.v),
        }
    }
}
