//! The planes that every perspective-correct strategy shares: 1/w, u/w and v/w, linear on the
//! screen (Heckbert and Moreton, "Interpolation for polygon texture mapping and shading", 1991).

pub(super) mod parts;

use super::Range;
use crate::arith::{multiply_high, reciprocal, shared_inverses};
use crate::project::ScreenVertex;
use crate::setup::{Plane, TriangleSetup};
use crate::uv::Uv;

/// 1/w, u/w and v/w of a triangle, each in the triangle's own units.
///
/// With a shared exponent the largest 1/w of the three corners uses 31 bits. u and v are first
/// mapped to 0..1 over the triangle, so that u/w and v/w never exceed 1/w and the three can be
/// shifted together; constant u or v gives a plane of zeros.
#[derive(Clone, Copy, Debug)]
pub struct Homogeneous {
    planes: Weights<Plane>,
    ranges: [Range; 2],
}

/// 1/w, u/w, v/w.
#[derive(Clone, Copy, Debug)]
struct Weights<T> {
    q: T,
    u: T,
    v: T,
}

/// The three planes' values at one pixel; steps exactly to others.
#[derive(Clone, Copy, Debug)]
pub struct Point(Weights<i64>);

impl Point {
    /// Farther to the right by a leap.
    #[inline]
    #[must_use]
    pub(super) fn after(self, leap: &Self) -> Self {
        Self(Weights {
            q: self.0.q.wrapping_add(leap.0.q),
            u: self.0.u.wrapping_add(leap.0.u),
            v: self.0.v.wrapping_add(leap.0.v),
        })
    }
}

impl Homogeneous {
    /// `None` if u or v spans 128 repeats or more.
    #[inline]
    #[must_use]
    pub fn new(triangle: &TriangleSetup<'_>) -> Option<Self> {
        let vertices = triangle.vertices();
        let coordinates =
            |axis: fn(&ScreenVertex) -> i32| Range::new(vertices.each_ref().map(axis));
        let (u_range, u) = coordinates(|v| v.uv()[0].to_bits())?;
        let (v_range, v) = coordinates(|v| v.uv()[1].to_bits())?;

        let q = shared_inverses(vertices.each_ref().map(|v| v.w()));
        let weighted = |excess: [u32; 3], range: Range| {
            // excess < 2^bits with bits <= 23: the products keep to 54 bits.
            let bits = 23u32.wrapping_sub(range.shift) & 31;
            let [a, b, c] = excess;
            let [p, q, r] = q;
            let product =
                |e: u32, q: u32| ((u64::from(e) * u64::from(q) + (1 << bits >> 1)) >> bits) as i32;
            triangle.plane([product(a, p), product(b, q), product(c, r)])
        };
        Some(Self {
            planes: Weights {
                q: triangle.plane(q.map(u32::cast_signed)),
                u: weighted(u, u_range),
                v: weighted(v, v_range),
            },
            ranges: [u_range, v_range],
        })
    }

    /// The planes at the centre of a pixel.
    #[inline]
    #[must_use]
    pub fn at(&self, x: i32, y: i32) -> Point {
        Point(Weights {
            q: self.planes.q.at(x, y),
            u: self.planes.u.at(x, y),
            v: self.planes.v.at(x, y),
        })
    }

    /// `pixels` to the right of `point`; the same bits as [`Self::at`] there.
    #[inline]
    #[must_use]
    pub fn step(&self, point: Point, pixels: u32) -> Point {
        let to = |value: i64, plane: &Plane| {
            value.wrapping_add(plane.step_x().wrapping_mul(i64::from(pixels)))
        };
        Point(Weights {
            q: to(point.0.q, &self.planes.q),
            u: to(point.0.u, &self.planes.u),
            v: to(point.0.v, &self.planes.v),
        })
    }

    /// How the planes change over `pixels`.
    #[inline]
    pub(super) fn leap(&self, pixels: u32) -> Point {
        let over = |plane: &Plane| plane.step_x().wrapping_mul(i64::from(pixels));
        Point(Weights {
            q: over(&self.planes.q),
            u: over(&self.planes.u),
            v: over(&self.planes.v),
        })
    }

    /// u and v at a point of the triangle: the perspective division.
    ///
    /// The three values are shifted up together until 1/w has all its bits, whatever the depth;
    /// one reciprocal serves both coordinates. With R the power of two of repeats that the
    /// triangle's range of u (or v) fits in, the division adds at most `2^-27 R + 2^-25` repeats:
    /// 2^-29 each for the value's bits, the reciprocal and the product's bits, 2^-31 for the
    /// divisor's, and the rounding to 8.24.
    #[inline]
    #[must_use]
    pub fn divide(&self, point: Point) -> Uv {
        let Point(Weights { q, u, v }) = point;
        // Positive inside the triangle, and below 2^62. The top bit that stays clear beside the
        // sign lets a coordinate exceed 1/w, by rounding, far away.
        let head = (q >> 32) as i32;
        if head <= 0 {
            return self.divide_far(point);
        }
        // 0 ..= 29: the shifts of single words below are all in range.
        let shift = head.leading_zeros().wrapping_sub(2) & 31;
        // 2^61 .. 2^62 when shifted, hence 2^31 .. 2^32.
        let q = (head.cast_unsigned() << ((shift + 2) & 31))
            | (q as u32 >> (30u32.wrapping_sub(shift) & 31));
        let upper = |value: i64| {
            let low = value as u32 >> 1 >> (31 - shift);
            (((value >> 32) as u32) << shift | low).cast_signed()
        };
        self.quotients([upper(u), upper(v)], q)
    }

    /// [`Self::divide`] where 1/w is so small that its upper word is empty: beyond 2^30 times the
    /// nearest depth. It takes no part in speed.
    #[cold]
    #[inline(never)]
    fn divide_far(&self, Point(Weights { q, u, v }): Point) -> Uv {
        let q = q.max(1);
        let shift = q.leading_zeros().wrapping_sub(2) & 63;
        let upper = |value: i64| (value.wrapping_shl(shift) >> 32) as i32;
        self.quotients([upper(u), upper(v)], (q.wrapping_shl(shift) >> 30) as u32)
    }

    /// The quotients of two values of 30 bits and a normalised divisor of 32.
    #[inline]
    fn quotients(&self, [u, v]: [i32; 2], q: u32) -> Uv {
        // Below 2^31.
        let inverse = reciprocal(q).cast_signed();
        let [u_range, v_range] = self.ranges;
        let quotient = |value: i32, range: Range| {
            // 30 bits of value against 32 of q: the quotient is 4 value / q, which is
            // value * inverse 2^-60, of which the upper word has 28 bits. The OR puts the result
            // into the middle of what the lost bits leave open.
            range.expand(multiply_high(value, inverse).wrapping_shl(3) | 4)
        };
        Uv::from_bits(quotient(u, u_range), quotient(v, v_range))
    }
}
