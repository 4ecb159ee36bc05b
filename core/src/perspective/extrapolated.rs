//! Reciprocals predicted from those of the last pixels.

use super::by_size::{BySize, Planes};
use super::homogeneous::octave::Octave;
use super::homogeneous::short::ShortPlanes;
use super::homogeneous::words::WordPlanes;
use super::{Homogeneous, RunSink, SpanSink, Strategy};
use crate::arith::{multiply_high, product_unsigned, reciprocal_of_30_bits};
use crate::setup::TriangleSetup;
use crate::span::{Area, Span};
use crate::uv::Uv;

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
/// - q crosses a power of two, so that the scale changes, or 128 pixels are done,
///
/// the pixel gets a real division, and prediction goes on from there. Pixels of small triangles and of those with
/// depths that differ by more than 64 all get one. With R the power of two of
/// repeats that the triangle's u (or v) fits in, the error is therefore at most
/// `R (2^-22 + 2^-29)` repeats in addition to that of [`PerPixel`](super::PerPixel).
///
/// **Cost.** One division a scanline, one for every lost lock, and two 32-bit multiplications a
/// pixel beside those of the coordinates. To watch the lock and to correct take more than the division on all cores
/// that were measured, also on one without a divider, for which `PerPixel` looks up its reciprocals: it is here to
/// compare.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Extrapolated;

/// The reciprocals of the last pixel and of the one before it.
#[derive(Clone, Copy, Debug)]
struct Lock {
    last: u32,
    before: u32,
}

/// `|e|` may be up to one part in 2 to this power.
const LOCK_BITS: u32 = 11;

impl Lock {
    #[inline]
    fn divide(q: u32) -> Self {
        let last = reciprocal_of_30_bits(q);
        Self { last, before: last }
    }

    /// For the next pixel, and whether it took a division.
    #[inline]
    fn next(self, q: u32) -> (Self, bool) {
        let Self { last, before } = self;
        // Both have 31 bits, the result may have more.
        let guess = last.wrapping_mul(2).wrapping_sub(before);
        // 2^60 (1 - e), of which -e is left, with 60 fraction bits.
        let over = product_unsigned(guess, q).wrapping_sub(1 << 60);
        // e has 21 bits of the upper word's where it is no more than that.
        const WITHIN: u64 = 1 << (60 - LOCK_BITS);
        if over.wrapping_add(WITHIN) < 2 * WITHIN {
            let e = (over >> 18) as i32;
            let correction = multiply_high((guess >> 1).cast_signed(), e) >> 9;
            // 2^60 over the least q has 32 bits.
            let corrected = guess
                .wrapping_sub(correction.cast_unsigned())
                .min(i32::MAX.cast_unsigned());
            let next = Self {
                last: corrected,
                before: last,
            };
            return (next, false);
        }
        let next = Self {
            before: last,
            ..Self::divide(q)
        };
        (next, true)
    }
}

/// Points of one scale, and the reciprocal at the one that is next.
#[derive(Clone, Copy, Debug)]
struct Predicted {
    octave: Octave,
    lock: Lock,
    /// Points, with this one.
    left: u32,
}

impl Predicted {
    /// So many points, of which the first is divided.
    #[inline]
    fn new((octave, left): (Octave, u32)) -> Self {
        let lock = Lock::divide(octave.q());
        Self { octave, lock, left }
    }

    #[inline]
    fn here(&self) -> Uv {
        self.octave.here_by(self.lock.last)
    }

    /// On to the next point, if there is one. Whether it took a division.
    #[inline]
    fn next(&mut self) -> bool {
        self.left = self.left.wrapping_sub(1);
        if self.left == 0 {
            return false;
        }
        self.octave.next();
        let divided;
        (self.lock, divided) = self.lock.next(self.octave.q());
        divided
    }
}

impl Strategy for Extrapolated {
    type Planes = Planes;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<Planes> {
        Planes::new(triangle, ShortPlanes::LOG2_PIXELS, 0)
    }

    #[inline]
    fn runs(&self, planes: &Planes, span: Span, to: impl RunSink) {
        self.runs_by_size(planes, span, to);
    }

    #[inline]
    fn all_runs(
        &self,
        planes: &Planes,
        triangle: &TriangleSetup<'_>,
        area: Area,
        to: impl SpanSink,
    ) {
        self.all_runs_by_size(planes, triangle, area, to);
    }

    fn divisions(&self, planes: &Planes, span: Span) -> u32 {
        let len = span.left.abs_diff(span.right);
        let Planes::Words(planes) = planes else {
            return len;
        };
        let line = planes.line(span);
        let (mut done, mut divisions) = (0, 0u32);
        while done < len {
            let points = planes.octave(&line, done, len.wrapping_sub(done));
            let mut predicted = Predicted::new(points);
            divisions = divisions.wrapping_add(1);
            for _ in 0..points.1 {
                divisions = divisions.wrapping_add(predicted.next().into());
            }
            done = done.wrapping_add(points.1);
        }
        divisions
    }
}

impl BySize for Extrapolated {
    #[inline]
    fn short_runs(&self, planes: &ShortPlanes, span: Span, to: impl RunSink) {
        self.short_points(planes, span, to);
    }

    #[inline]
    fn word_runs(&self, planes: &WordPlanes, span: Span, mut to: impl RunSink) {
        let len = span.right.abs_diff(span.left);
        let line = planes.line(span);
        let mut done = 0;
        while done < len {
            let points = planes.octave(&line, done, len.wrapping_sub(done));
            to.points::<_, 1>(
                done as usize,
                points.1 as usize,
                Predicted::new(points),
                Predicted::here,
                |point| _ = point.next(),
            );
            done = done.wrapping_add(points.1);
        }
    }

    #[inline]
    fn whole_runs(&self, planes: &Homogeneous, span: Span, to: impl RunSink) {
        self.whole_points(planes, span, to);
    }
}
