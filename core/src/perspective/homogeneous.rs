//! The planes that every perspective-correct strategy shares: 1/w, u/w and v/w, linear on the
//! screen (Heckbert and Moreton, "Interpolation for polygon texture mapping and shading", 1991).

pub(super) mod octave;
pub(super) mod parts;
pub(super) mod short;
pub(super) mod words;

use fixed::types::I8F24;

use words::WordPlanes;

use crate::arith::{leading_zeros_long, multiply_high, product, reciprocal, shared_inverses};
use crate::setup::{Plane, RatioPlanes, TriangleSetup};
use crate::uv::Uv;

/// 1/w, u/w and v/w of a triangle, each in the triangle's own units.
///
/// The largest 1/w of the three corners uses 31 bits. u and v are counted from those of the first
/// corner, in a unit that is a power of two of repeats, so that u/w and v/w stay below half of 1/w,
/// one of them uses nearly as many bits, and the three can be shifted together. From there on the planes
/// are exact: they are not divided by the area, which only ratios don't need.
#[derive(Clone, Copy, Debug)]
pub struct Homogeneous {
    planes: Weights<Plane>,
    /// See [`counted_from`].
    first: Uv,
    /// From the ratio with 30 fraction bits down to 8.24, and two more.
    down: u32,
}

/// What coordinates are counted from: u and v of the first corner, 16.16, so many units of 2^-24, and a
/// unit more, since what is added to them is rounded down, and a coordinate on a texel's edge is not to come
/// out before it.
#[inline]
fn counted_from(first: [i32; 2], units: i32) -> Uv {
    let [u, v] = first.map(|c| c.wrapping_shl(8).wrapping_add(units.wrapping_add(1)));
    Uv::from_bits(u, v)
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
        Self::biased(triangle, 0, |planes, _| planes)
    }

    /// With so many units of 2^-24 added to all coordinates, as a part of something; and their words, if these
    /// will do.
    // Wrapped where they are made: they are large, and would be moved there.
    #[inline]
    pub(super) fn biased<T>(
        triangle: &TriangleSetup<'_>,
        units: i32,
        wrap: impl FnOnce(Self, Option<WordPlanes>) -> T,
    ) -> Option<T> {
        let (a, [[ub, uc], [vb, vc]]) = triangle.coordinates();
        // A ratio of exactly -1/2 is none: rounded down it would be beyond its range.
        let all = ub.unsigned_abs() | uc.unsigned_abs() | vb.unsigned_abs() | vc.unsigned_abs();
        // 27 at most, so that words may be shifted down as far: 2^-11 repeats.
        let zeros = (all | 31).leading_zeros();
        if zeros < 11 {
            // 32 repeats and more.
            let spans = |b: i32, c: i32| b.abs_diff(c) >= 1 << 23;
            if zeros < 9 || spans(ub, uc) || spans(vb, vc) {
                return None;
            }
        }
        let q = shared_inverses(triangle.vertices().each_ref().map(|v| v.w()));
        let [p, q, r] = q.map(u32::cast_signed);
        let times = |c: i32, q: i32| (product(c << (zeros.wrapping_sub(1) & 31), q) >> 32) as i32;
        let RatioPlanes {
            planes: [q_plane, u, v],
            is_full,
            are_steep,
        } = triangle.ratio_planes([
            [p, q, r],
            [0, times(ub, q), times(uc, r)],
            [0, times(vb, q), times(vc, r)],
        ]);
        let planes = Self {
            planes: Weights { q: q_plane, u, v },
            first: counted_from(a, units),
            down: zeros.wrapping_sub(9),
        };
        let words =
            (is_full && !are_steep && zeros >= 11).then(|| WordPlanes::new(&planes, [p, q, r]));
        Some(wrap(planes, words.flatten()))
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
        point.after(&self.leap(pixels))
    }

    /// Coordinates are quotients of u/w and 1/w times a power of two of repeats: its logarithm.
    #[inline]
    pub(super) fn log2_repeats(&self) -> i32 {
        32i32
            .wrapping_sub(Uv::FRACTION_BITS.cast_signed())
            .wrapping_sub_unsigned(self.down)
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
    /// one reciprocal serves both coordinates. The result is rounded up: down, and a unit added.
    #[inline]
    #[must_use]
    pub fn divide(&self, Point(Weights { q, u, v }): Point) -> Uv {
        // Positive inside the triangle, and below 2^62. The top bit that stays clear beside the
        // sign lets a coordinate exceed 1/w, by rounding, far away.
        let q = q.max(1);
        let shift = leading_zeros_long(q.cast_unsigned()).wrapping_sub(2) & 63;
        // 2^61 .. 2^62 when shifted, hence 2^31 .. 2^32.
        let inverse = reciprocal((q << shift >> 30) as u32).cast_signed();
        let coordinate = |value: i64, first: I8F24| {
            let value = (value << shift >> 30) as i32;
            self.coordinate(multiply_high(value, inverse), first)
        };
        Uv::from_bits(coordinate(u, self.first.u), coordinate(v, self.first.v))
    }

    /// The same, for where it is called seldom: code that is in the image once.
    #[inline(never)]
    pub(super) fn divide_far(&self, point: Point) -> Uv {
        self.divide(point)
    }

    /// From a ratio with 30 fraction bits, below 1/2.
    #[inline]
    fn coordinate(&self, ratio: i32, first: I8F24) -> i32 {
        first
            .to_bits()
            .wrapping_add((ratio << 2) >> (self.down & 31))
    }
}
