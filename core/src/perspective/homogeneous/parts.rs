//! Parts of the perspective division, for strategies that use one reciprocal for many pixels.

use fixed::types::I8F24;

use super::{Homogeneous, Point, Weights};
use crate::arith::{leading_zeros_long, reciprocal};
use crate::setup::Plane;
use crate::uv::Uv;

/// A reciprocal of 1/w at some point, with the scale that it belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::perspective) struct Scale {
    /// How far the planes' values are shifted up, so that 1/w is in `2^61 .. 2^62`.
    pub(in crate::perspective) shift: u32,
    /// `2^62 / q`, where q is the upper half of the shifted 1/w, in `2^31 .. 2^32`.
    pub(in crate::perspective) inverse: u32,
}

impl Point {
    /// 1/w in the triangle's units, at least 1.
    #[inline]
    pub(in crate::perspective) fn q(&self) -> i64 {
        self.0.q.max(1)
    }
}

/// How far up 1/w is shifted to use all its bits; see [`Homogeneous::divide`].
#[inline]
pub(in crate::perspective) fn shift(q: i64) -> u32 {
    leading_zeros_long(q.cast_unsigned()).wrapping_sub(2) & 63
}

/// 1/w with 32 bits, shifted up by `shift`.
#[inline]
pub(in crate::perspective) fn head(q: i64, shift: u32) -> u32 {
    (q.wrapping_shl(shift) >> 30) as u32
}

/// Whether two values of 1/w differ by more than one part in `2^bits` of the smaller.
#[inline]
pub(in crate::perspective) fn differ(p: i64, q: i64, bits: u32) -> bool {
    p.abs_diff(q) > p.min(q).cast_unsigned() >> bits
}

impl Homogeneous {
    /// How much 1/w changes over that many rows of one column.
    #[inline]
    pub(in crate::perspective) fn change_down(&self, rows: u32) -> u64 {
        let step = self.planes.q.step_y().unsigned_abs();
        step.saturating_mul(u64::from(rows))
    }

    /// The perspective division's reciprocal.
    #[inline]
    pub(in crate::perspective) fn scale(&self, point: Point) -> Scale {
        let q = point.q();
        let shift = shift(q);
        Scale {
            shift,
            inverse: reciprocal(head(q, shift)),
        }
    }

    /// u and v at a point, with a reciprocal that is (nearly) that of the point's 1/w. Kept to
    /// the triangle's range.
    #[inline]
    pub(in crate::perspective) fn scaled(&self, point: Point, scale: Scale) -> Uv {
        // See `divide`. A reciprocal that is too large must not leave the range.
        const MOST: i64 = (1 << 29) - 1;
        let coordinate = |value: i64, first: I8F24| {
            let value = i64::from((value.wrapping_shl(scale.shift) >> 30) as i32);
            let ratio = value.wrapping_mul(i64::from(scale.inverse)) >> 32;
            self.coordinate(ratio.clamp(-MOST, MOST) as i32, first)
        };
        Uv::from_bits(
            coordinate(point.0.u, self.first.u),
            coordinate(point.0.v, self.first.v),
        )
    }

    /// How u and v change at a point from one pixel to the next on its right: the tangent of the
    /// hyperbola. Takes no reciprocal beyond the point's own.
    ///
    /// The change is right to 2^-27 of what 1/w, u/w or v/w gains a pixel, as a part of 1/w, in
    /// ranges of the triangle, plus 2^-25 repeats. It saturates at one range a pixel.
    #[inline]
    pub(in crate::perspective) fn slope(&self, point: Point, scale: Scale) -> Uv {
        let Weights { q, u, v } = &self.planes;
        let steps = [q, u, v].map(Plane::step_x);
        // The unit of the coordinate a pixel, with 62 bits, less what rounding adds.
        const MOST: i64 = (1 << 62) - (1 << 31);
        let most = steps.iter().fold(1, |most, s| s.unsigned_abs().max(most));
        // The largest step gets 30 bits and a sign.
        let up = most.leading_zeros().wrapping_sub(2) & 63;
        let [q_step, u_step, v_step] = steps.map(|s| s.wrapping_shl(up) >> 32);
        let inverse = i64::from(scale.inverse);
        let slope = |value: i64, step: i64| {
            let value = i64::from((value.wrapping_shl(scale.shift) >> 32) as i32);
            // The coordinate itself, in its unit, with 28 bits.
            let coordinate = value.wrapping_mul(inverse) >> 32;
            // u' = (U' - u Q') / Q, as in `divide`: 2^60 is 1 where the steps are shifted as far
            // as the values.
            let slope = step
                .wrapping_sub(coordinate.wrapping_mul(q_step) >> 28)
                .wrapping_mul(inverse);
            let left = scale.shift.cast_signed() + 2 - up.cast_signed();
            let slope = if left <= 0 {
                slope >> left.unsigned_abs().min(63)
            } else if slope.unsigned_abs().leading_zeros() > left.unsigned_abs() + 1 {
                slope.wrapping_shl(left.unsigned_abs())
            } else {
                slope.signum().saturating_mul(MOST)
            };
            // From 62 fraction bits.
            let shift = self.down.wrapping_add(30) & 63;
            let half = (1i64 << shift) >> 1;
            (slope.clamp(-MOST, MOST).wrapping_add(half) >> shift) as i32
        };
        Uv::from_bits(slope(point.0.u, u_step), slope(point.0.v, v_step))
    }
}
