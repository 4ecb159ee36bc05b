//! Projection: clip vertices become points on the subpixel grid of the screen. From here on a
//! position is an integer, and everything that follows is exact in it.

use fixed::types::{I16F16, I24F8};

use crate::arith::{Inverse, leading_zeros_from, multiply_high, product};
use crate::clip::ClipVertex;
use crate::geometry::MAX_UV;
use crate::viewport::{GUARD, SUBPIXEL_BITS, SUBPIXELS, Viewport};

/// A vertex on the screen, snapped to 1/256 pixel.
///
/// Invariants: x and y within plus and minus [`GUARD_BAND`](crate::viewport::GUARD_BAND) pixels,
/// w positive, u and v within plus and minus [`MAX_UV`] repeats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ScreenVertex {
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    x: I24F8,
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    y: I24F8,
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    w: I16F16,
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    uv: [I16F16; 2],
}

impl ScreenVertex {
    /// A vertex given after projection: x to the right and y down from the top-left corner of the
    /// top-left pixel, in pixels; clip w; u and v in repeats. `None` if it breaks an invariant.
    #[must_use]
    pub fn new(x: I24F8, y: I24F8, w: I16F16, uv: [I16F16; 2]) -> Option<Self> {
        let on_screen = |c: I24F8| c.to_bits().unsigned_abs() <= GUARD.unsigned_abs();
        let [u, v] = uv.map(|c| c.to_bits().unsigned_abs() <= MAX_UV.unsigned_abs() << 16);
        (on_screen(x) && on_screen(y) && w > 0 && u && v).then_some(Self { x, y, w, uv })
    }

    /// Projects a clip vertex that lies inside a [`ClipVolume`](crate::clip::ClipVolume).
    ///
    /// Rounds to the nearest subpixel, halves up. What the rounding of a cut left outside the
    /// guard band is moved onto its rim. `None` if w is not positive or a texture coordinate out
    /// of range.
    #[inline]
    #[must_use]
    pub fn project(vertex: &ClipVertex, viewport: Viewport) -> Option<Self> {
        let y_down = vertex.y.checked_neg()?;
        let w = vertex.w.to_bits();
        if w <= 0 {
            return None;
        }
        let inverse = Inverse::new(w.cast_unsigned());
        let snapped = |position: I16F16, size: u32| snapped(position.to_bits(), w, inverse, size);
        let x = snapped(vertex.x, viewport.width());
        let y = snapped(y_down, viewport.height());
        Self::new(x, y, vertex.w, [vertex.u, vertex.v])
    }

    /// A clip vertex whose place is known, by [`Self::project`].
    #[inline]
    pub(crate) const fn of_projected(x: I24F8, y: I24F8, vertex: &ClipVertex) -> Self {
        Self {
            x,
            y,
            w: vertex.w,
            uv: [vertex.u, vertex.v],
        }
    }

    /// To the right, in pixels.
    #[must_use]
    pub const fn x(&self) -> I24F8 {
        self.x
    }

    /// Down, in pixels.
    #[must_use]
    pub const fn y(&self) -> I24F8 {
        self.y
    }

    /// Clip w, in units.
    #[must_use]
    pub const fn w(&self) -> I16F16 {
        self.w
    }

    /// Column of the texture, in repeats.
    #[inline]
    pub(crate) const fn u(&self) -> I16F16 {
        let [u, _] = &self.uv;
        *u
    }

    /// Row of the texture, in repeats.
    #[inline]
    pub(crate) const fn v(&self) -> I16F16 {
        let [_, v] = &self.uv;
        *v
    }

    /// u and v, in repeats.
    #[must_use]
    pub const fn uv(&self) -> [I16F16; 2] {
        self.uv
    }
}

/// By how much a frame's size is shifted up: 2^10 has no bits to spare then.
const SIZE_UP: u32 = 21;

/// `(position / w + 1) size / 2`, to the nearest subpixel and within the guard band, for `w > 0`.
///
/// An estimate from the inverse of w tells all but a few cases; those that lie too near to the middle
/// between two subpixels are found exactly.
#[inline(never)]
fn snapped(position: i32, w: i32, inverse: Inverse, size: u32) -> I24F8 {
    // Both factors with all the bits that they have room for.
    let magnitude = (position ^ (position >> 31)).cast_unsigned();
    let up = magnitude.leading_zeros();
    let position_up = position << (up.wrapping_sub(1) & 31);
    let size_up = leading_zeros_from(0, size << SIZE_UP);
    let factor = (size << SIZE_UP << (size_up & 31) >> 1).cast_signed();
    // |ratio| = 2^28 .. 2^30, up to 2 too small for the inverse's error and rounded down; so
    // |estimate| = 2^26 .. 2^29, unless it is 0, is less than 2.5 below and 1 above its value.
    let ratio = multiply_high(position_up, inverse.mantissa.cast_signed());
    let estimate = multiply_high(ratio, factor);
    // It is the quotient times 2^bits.
    let bits = (up.wrapping_add(size_up).wrapping_add(SIZE_UP))
        .wrapping_sub(inverse.exponent)
        .wrapping_sub(SUBPIXEL_BITS + 3)
        .cast_signed();
    let half = (size << (SUBPIXEL_BITS - 1)).cast_signed();
    let quotient = if bits < 7 {
        // Beyond 2^19, and so beyond the guard band.
        if position < 0 { -2 * GUARD } else { 2 * GUARD }
    } else {
        // Of a quotient below a quarter nothing is left.
        let one = 1u32 << bits.min(31);
        let rounded = estimate.wrapping_add_unsigned(one >> 1);
        let quotient = rounded >> bits.min(31);
        let behind = rounded.cast_unsigned() & (one - 1);
        if behind < 1 || behind > one - 3 {
            nearest(position, w, half, quotient)
        } else {
            quotient
        }
    };
    I24F8::from_bits(half.wrapping_add(quotient).clamp(-GUARD, GUARD))
}

/// `position half / w` to the nearest integer, halves up, from one that is off by at most 1.
#[cold]
#[inline(never)]
fn nearest(position: i32, w: i32, half: i32, quotient: i32) -> i32 {
    // floor((2 n + w) / 2 w) is n / w to nearest; all of this has less than 52 bits.
    let excess = 2 * (product(position, half) - product(w, quotient)) + i64::from(w);
    if excess < 0 {
        quotient - 1
    } else if excess >= 2 * i64::from(w) {
        quotient + 1
    } else {
        quotient
    }
}

/// The first pixel, column or row, whose centre is at `c` or beyond.
///
/// ```text
///        pixel 0         pixel 1
///   |-------+-------|-------+-------|     centres at 128, 384, ... subpixels
///   0      128     256     384     512
///           ^ c = 128 -> 0   ^ c = 129 .. 384 -> 1
/// ```
#[inline]
pub(crate) const fn first_centre(c: i32) -> i32 {
    // ceil((c - 128) / 256)
    (c + (SUBPIXELS / 2 - 1)) >> SUBPIXEL_BITS
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By one division of 128 bits.
    fn check(position: i32, w: i32, size: u32) {
        let found = snapped(position, w, Inverse::new(w.cast_unsigned()), size).to_bits();
        let [position, w, size] = [position, w, size.cast_signed()].map(i128::from);
        let exact = (position * size * 256 + w * size * 256 + w).div_euclid(2 * w);
        let exact = exact.clamp(-i128::from(GUARD), i128::from(GUARD));
        assert_eq!(i128::from(found), exact, "{position} / {w}, {size} pixels");
    }

    #[test]
    fn snaps_to_the_nearest_subpixel() {
        let mut state = 1u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state ^ state >> 15
        };
        for case in 0..2_000_000 {
            // All sizes, and depths and positions of all lengths; most are on the screen.
            let size = 1 + next() % [4, 64, 1024][case % 3];
            let w = ((next() >> 1 >> (next() % 31)).cast_signed()).max(1);
            let position = match case % 4 {
                0 => next().cast_signed() >> (next() % 32),
                1 => w.saturating_mul((next() % 9).cast_signed() - 4),
                _ => ((i64::from(w) * i64::from(next().cast_signed())) >> 31) as i32,
            };
            check(position, w, size);
            // The middle between two subpixels, and what lies beside it.
            let subpixel = i64::from(next() % (size << 9)) - i64::from(size << 8);
            let middle = (2 * subpixel + 1) * i64::from(w) / i64::from(size << 8);
            for beside in -1..=1 {
                let middle = (middle + beside).clamp(i64::from(-i32::MAX), i64::from(i32::MAX));
                check(middle as i32, w, size);
            }
        }
        let ends = [-i32::MAX, -65537, -1, 0, 1, 65535, i32::MAX];
        for position in ends {
            for w in [1, 2, 3, 65535, 65536, i32::MAX - 1, i32::MAX] {
                for size in [1, 2, 3, 320, 1023, 1024] {
                    check(position, w, size);
                }
            }
        }
    }
}
