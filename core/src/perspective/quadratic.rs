//! Parabolas through three exact points.

use super::{Homogeneous, Run, RunSink, Strategy};
use crate::arith::RECIPROCALS;
use crate::setup::TriangleSetup;
use crate::span::Span;
use crate::uv::Uv;

/// Second-order differences through three exact points on every piece of `N` pixels, 16 or 32:
/// the curved spans of NV1 and of polynomial mappers (Demirer and Grimsdale, "Approximation
/// techniques for high performance texture mapping", *Computers & Graphics* 20(4), 1996).
///
/// Pieces end where those of [`Every`](super::Every) end, and are divided at both ends and at
/// their middle step m (of n, rounded down). Along a scanline u is a hyperbola over the linear
/// q = 1/w; with dq the change of q in the piece, the parabola is off at step t by exactly
///
/// `|du| (dq / n)^2 |t (t - m) (t - n)| / (n q(m) q(t))`,
///
/// which for even n is at most `|du| (sqrt 3 / 18) (r - 1)^2 / (r + 1)`, r being the ratio of the
/// depths of its ends: at r = 1.5 a twenty-fifth of the error of a chord over the same piece. To
/// this add 1.7 times the error of [`PerPixel`](super::PerPixel) (what the parabola makes of the
/// errors of its points) and 2^-24 repeats plus `|du| 2^-24` for rounding.
///
/// **Cost.** Two divisions a piece and one a scanline, as many as a chord every `N / 2` pixels;
/// two 64-bit additions a pixel and coordinate. Divisions of 64 bits and the parabola's setup take more
/// than a piece of [`PerPixel`](super::PerPixel) on all cores that were measured: it is here to compare.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Quadratic<const N: u32 = 16>;

/// Bits added behind those of a coordinate, so that no difference of full pieces is rounded.
const EXTRA_BITS: u32 = 16;

/// One coordinate along a piece: its value, and its first and second difference.
#[derive(Clone, Copy, Debug)]
struct Parabola {
    value: i64,
    first: i64,
    second: i64,
}

impl Parabola {
    /// Through values at steps 0, `middle` and `steps`; `middle` is at least 1 and below `steps`,
    /// or both are 1 and the parabola is a line.
    #[inline]
    fn new([a, b, c]: [i32; 3], middle: u32, steps: u32) -> Self {
        // Distances of 32 bits with 16 more, times 32 bits over 32: in two parts.
        let over = |distance: i64, n: u32| match RECIPROCALS.get(n as usize) {
            Some(&r) if n > 1 => {
                let (high, low) = (distance >> 32, distance & 0xffff_ffff);
                let low = low.wrapping_mul(i64::from(r)) >> 32;
                high.wrapping_mul(i64::from(r)).wrapping_add(low)
            }
            _ => distance,
        };
        let distance = |from: i32, to: i32| i64::from(to.wrapping_sub(from)) << EXTRA_BITS;
        // Newton's divided differences.
        let start = over(distance(a, b), middle);
        let curve = if steps > middle {
            let end = over(distance(b, c), steps.wrapping_sub(middle));
            over(end.wrapping_sub(start), steps)
        } else {
            0
        };
        // a + start t + curve t (t - middle)
        Self {
            value: (i64::from(a) << EXTRA_BITS).wrapping_add(1 << (EXTRA_BITS - 1)),
            first: start.wrapping_add(curve.wrapping_mul(1 - i64::from(middle))),
            second: curve.wrapping_mul(2),
        }
    }

    #[inline]
    fn step(&mut self) {
        self.value = self.value.wrapping_add(self.first);
        self.first = self.first.wrapping_add(self.second);
    }

    /// In 8.24. A parabola may swing beyond 128 repeats where no coordinate of the triangle does;
    /// there it stops, which is nearer to the truth.
    #[inline]
    fn bits(self) -> i32 {
        let bits = self.value >> EXTRA_BITS;
        bits.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32
    }
}

impl<const N: u32> Quadratic<N> {
    const SUPPORTED: () = assert!(N == 16 || N == 32);

    /// Steps of the piece from a pixel, of as many as remain: to the next multiple of N.
    #[inline]
    fn piece(column: i32, rest: u32) -> u32 {
        N.wrapping_sub(column.cast_unsigned() & (N - 1)).min(rest)
    }
}

impl<const N: u32> Strategy for Quadratic<N> {
    type Planes = Homogeneous;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<Homogeneous> {
        const { Self::SUPPORTED };
        Homogeneous::new(triangle)
    }

    #[inline]
    fn runs(&self, planes: &Homogeneous, span: Span, mut to: impl RunSink) {
        let mut rest = span.left.abs_diff(span.right).wrapping_sub(1);
        let mut column = span.left;
        let mut point = planes.at(column, span.y);
        let mut uv = planes.divide(point);
        let mut offset = 0u32;
        while rest > 0 {
            let steps = Self::piece(column, rest);
            let middle = (steps >> 1).max(1);
            let between = planes.divide(planes.step(point, middle));
            point = planes.step(point, steps);
            let end = if steps > 1 {
                planes.divide(point)
            } else {
                between
            };
            let bits = |c: fn(Uv) -> i32| [c(uv), c(between), c(end)];
            let u = Parabola::new(bits(|uv| uv.u.to_bits()), middle, steps);
            let v = Parabola::new(bits(|uv| uv.v.to_bits()), middle, steps);
            to.points::<_, 1>(
                offset as usize,
                steps as usize,
                [u, v],
                |[u, v]| Uv::from_bits(u.bits(), v.bits()),
                |both| both.iter_mut().for_each(Parabola::step),
            );
            offset = offset.wrapping_add(steps);
            uv = end;
            column = column.wrapping_add_unsigned(steps);
            rest = rest.wrapping_sub(steps);
        }
        to.run(Run {
            offset: offset as usize,
            len: 1,
            uv,
            step: Uv::default(),
        });
    }

    fn divisions(&self, _: &Homogeneous, span: Span) -> u32 {
        let mut rest = span.left.abs_diff(span.right).wrapping_sub(1);
        let mut column = span.left;
        let mut divisions = 1u32;
        while rest > 0 {
            let steps = Self::piece(column, rest);
            divisions = divisions.wrapping_add(steps.min(2));
            column = column.wrapping_add_unsigned(steps);
            rest = rest.wrapping_sub(steps);
        }
        divisions
    }
}
