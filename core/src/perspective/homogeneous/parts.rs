//! Parts of the perspective division, for strategies that use one reciprocal for many pixels.

use super::{Homogeneous, Point};
use crate::arith::reciprocal;
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
    q.leading_zeros().wrapping_sub(2) & 63
}

/// 1/w with 32 bits, shifted up by `shift`.
#[inline]
pub(in crate::perspective) fn head(q: i64, shift: u32) -> u32 {
    (q.wrapping_shl(shift) >> 30) as u32
}

impl Homogeneous {
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
        // See `divide`: the quotient has 28 bits. What a reciprocal that is too large adds would
        // wrap around at the upper end of the range.
        const MOST: i64 = (1 << 28) - (1 << 5);
        let [u_range, v_range] = self.ranges;
        let quotient = |value: i64, range: super::Range| {
            let value = i64::from((value.wrapping_shl(scale.shift) >> 32) as i32);
            let upper = (value.wrapping_mul(i64::from(scale.inverse)) >> 32).clamp(0, MOST);
            range.expand((upper as i32).wrapping_shl(3) | 4)
        };
        Uv::from_bits(quotient(point.0.u, u_range), quotient(point.0.v, v_range))
    }

    /// u and v at a point, and how they change there from one pixel to the next on its right:
    /// the tangent of the hyperbola. One reciprocal serves all four.
    ///
    /// The change is right to 2^-28 of what 1/w, u/w or v/w gains a pixel, as a part of 1/w, in
    /// ranges of the triangle, plus 2^-25 repeats.
    #[inline]
    pub(in crate::perspective) fn tangent(&self, point: Point) -> (Uv, Uv) {
        let scale = self.scale(point);
        let [u_range, v_range] = self.ranges;
        let steps = [
            self.planes.q.step_x(),
            self.planes.u.step_x(),
            self.planes.v.step_x(),
        ];
        let most = steps.iter().fold(1, |most, s| s.unsigned_abs().max(most));
        // The largest step gets 30 bits and a sign.
        let up = most.leading_zeros().wrapping_sub(2) & 63;
        let [q_step, u_step, v_step] = steps.map(|s| s.wrapping_shl(up) >> 32);
        let slope = |value: i64, step: i64, range: super::Range| {
            let value = i64::from((value.wrapping_shl(scale.shift) >> 32) as i32);
            let inverse = i64::from(scale.inverse);
            // The coordinate itself, 0 .. 1 with 28 bits.
            let coordinate = value.wrapping_mul(inverse) >> 32;
            // u' = (U' - u Q') / Q: 31 bits against Q's 32, as in `divide`, and shifted
            // further than Q.
            let step = step.wrapping_sub(coordinate.wrapping_mul(q_step) >> 28);
            let slope = step.wrapping_mul(inverse);
            // 2^60 is 1 where both shifts are equal; `expand_step` takes 62 fraction bits.
            let slope = match up.checked_sub(scale.shift) {
                Some(down) => slope >> down.min(63) << 2,
                None => slope
                    .wrapping_shl(2)
                    .wrapping_shl(scale.shift.wrapping_sub(up)),
            };
            range.expand_step(slope)
        };
        let at = self.scaled(point, scale);
        let step = Uv::from_bits(
            slope(point.0.u, u_step, u_range),
            slope(point.0.v, v_step, v_range),
        );
        (at, step)
    }
}
