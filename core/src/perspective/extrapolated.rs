//! Reciprocals predicted from those of the last pixels.

use super::homogeneous::parts::{Scale, head, shift};
use super::{Homogeneous, RunSink, Strategy};
use crate::arith::reciprocal;
use crate::setup::TriangleSetup;
use crate::span::Span;

/// No division in the span: w of a pixel is predicted from the last two and corrected by one
/// Newton step.
///
/// With q = 1/w, p the prediction `2 w(x-1) - w(x-2)` and `e = 1 - p q` its relative error, the
/// Newton step `p (1 + e)` (Hennessy and Patterson, *Computer Architecture*, appendix J.6) leaves
/// a relative error of `e^2`. The prediction is off by the second difference of a hyperbola,
/// `2 d^2 / ((1 - d) (1 - 2 d))`, d being the relative change of q a pixel. e is known before the
/// step is made, so the lock is watched and not assumed: where
///
/// - `|e| > 2^-11` (q changes by more than about one part in 64 a pixel, or has just begun to
///   change), or
/// - q crosses a power of two, so that the scale changes,
///
/// the pixel gets a real division, and prediction goes on from there. With R the power of two of
/// repeats that the triangle's u (or v) fits in, the error is therefore at most
/// `R (2^-22 + 2^-29)` repeats in addition to that of [`PerPixel`](super::PerPixel).
///
/// **Cost.** One division a scanline, one for every lost lock, and five 32-bit multiplications a
/// pixel. To watch the lock and to keep scales takes more than the division on all cores that were measured,
/// also on one without a divider, for which `PerPixel` looks up its reciprocals: it is here to compare.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Extrapolated;

/// The last reciprocals.
#[derive(Clone, Copy, Debug)]
struct Lock {
    last: Scale,
    before: u32,
}

/// `|e|` may be up to one part in 2 to this power.
const LOCK_BITS: u32 = 11;

impl Lock {
    #[inline]
    fn divide(q: i64) -> Self {
        let shift = shift(q);
        let inverse = reciprocal(head(q, shift));
        Self {
            last: Scale { shift, inverse },
            before: inverse,
        }
    }

    /// The reciprocal for the next pixel, and whether it took a division.
    #[inline]
    fn next(self, q: i64) -> (Self, bool) {
        let Scale {
            shift: old,
            inverse,
        } = self.last;
        if shift(q) == old {
            // Reciprocals have 31 bits.
            let guess = i64::from(inverse)
                .wrapping_mul(2)
                .wrapping_sub(i64::from(self.before))
                .clamp(0, i64::from(i32::MAX));
            // 2^62 (1 - e), so the rest is e with 62 fraction bits.
            let product = guess.wrapping_mul(i64::from(head(q, old)));
            let rest = (1i64 << 62).wrapping_sub(product);
            if rest.unsigned_abs() >> (62 - LOCK_BITS) == 0 {
                // e has 20 bits of 31 here.
                let correction = guess.wrapping_mul(rest >> 31) >> 31;
                let inverse = guess.wrapping_add(correction).min(i64::from(i32::MAX)) as u32;
                let lock = Self {
                    last: Scale {
                        shift: old,
                        inverse,
                    },
                    before: self.last.inverse,
                };
                return (lock, false);
            }
        }
        let mut lock = Self::divide(q);
        if lock.last.shift == old {
            lock.before = inverse;
        }
        (lock, true)
    }
}

impl Strategy for Extrapolated {
    type Planes = Homogeneous;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<Homogeneous> {
        Homogeneous::new(triangle)
    }

    #[inline]
    fn runs(&self, planes: &Homogeneous, span: Span, mut to: impl RunSink) {
        let len = span.left.abs_diff(span.right);
        let point = planes.at(span.left, span.y);
        let lock = Lock::divide(point.q());
        let leap = planes.leap(1);
        to.points::<_, 1>(
            0,
            len as usize,
            (point, lock, len),
            |(point, lock, _)| planes.scaled(*point, lock.last),
            |(point, lock, rest)| {
                *rest = rest.wrapping_sub(1);
                // Nothing behind the last.
                if *rest > 0 {
                    *point = point.after(&leap);
                    (*lock, _) = lock.next(point.q());
                }
            },
        );
    }

    fn divisions(&self, planes: &Homogeneous, span: Span) -> u32 {
        let mut point = planes.at(span.left, span.y);
        let mut lock = Lock::divide(point.q());
        let mut divisions = 1u32;
        for _ in 1..span.left.abs_diff(span.right) {
            point = planes.step(point, 1);
            let divided;
            (lock, divided) = lock.next(point.q());
            divisions = divisions.wrapping_add(u32::from(divided));
        }
        divisions
    }
}
