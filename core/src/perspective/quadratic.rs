//! Parabolas through three exact points.

use super::by_size::{BySize, Planes};
use super::homogeneous::short::ShortPlanes;
use super::homogeneous::words::{WordLine, WordPlanes};
use super::{Homogeneous, Run, RunSink, SpanSink, Strategy};
use crate::setup::TriangleSetup;
use crate::span::{Area, Span};
use crate::uv::{Curve, Uv};

/// Second-order differences through three exact points on every piece of `N` pixels, 16 or 32:
/// the curved spans of NV1 and of polynomial mappers (Demirer and Grimsdale, "Approximation
/// techniques for high performance texture mapping", *Computers & Graphics* 20(4), 1996).
///
/// Pieces follow one another from a span's first pixel, and are divided at both ends and in the middle; what is left
/// at the end is a piece of half the length, or of half that, and so on. Along a scanline u is a hyperbola over the
/// linear q = 1/w; with dq the change of q in a piece of n, the parabola is off at step t by exactly
///
/// `|du| (dq / n)^2 |t (t - n/2) (t - n)| / (n q(n/2) q(t))`,
///
/// which is at most `|du| (sqrt 3 / 18) (r - 1)^2 / (r + 1)`, r being the ratio of the
/// depths of its ends: at r = 1.5 a twenty-fifth of the error of a chord over the same piece. To
/// this add 5/4 (what a parabola makes of the errors of its points) of the errors that [`Every`](super::Every) has
/// at the ends of pieces half as long, and `N/2 + n/2 + n^2/8` units of 2^-24 repeats: differences are rounded to
/// one, and what that takes from pixels on the edges of texels is added to all.
///
/// Small triangles are divided at every pixel, like those of [`PerPixel`](super::PerPixel), and so are triangles
/// with depths that differ by more than 64, and with coordinates of more than 64 repeats: a parabola may swing
/// beyond 128 where no coordinate does.
///
/// **Cost.** Two divisions a piece and one a scanline, as many as chords over half the length take, and two
/// additions more a pixel. Pieces of 16 are a match for chords over 4 pixels on a processor with a divider, with a
/// third of their error, and take less on one without.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Quadratic<const N: u32 = 16>;

/// Through coordinates at the first pixel of a piece of `2^log2`, 2 or more, in its middle and at the next
/// piece's first.
#[inline]
fn curve(points: [Uv; 3], log2: u32) -> Curve {
    let half = log2.wrapping_sub(1);
    let middle = 1i32.wrapping_shl(half);
    let steps_between = middle.wrapping_mul(middle.wrapping_sub(1)) >> 1;
    // Less than 64 repeats from one end to the other, of which either half may have all: no more than one and a
    // half times that, below.
    let parabola = |bits: fn(Uv) -> i32| {
        let [a, b, c] = points.map(bits);
        let (ab, bc) = (b.wrapping_sub(a), c.wrapping_sub(b));
        let change = rounded(bc.wrapping_sub(ab), half.wrapping_mul(2));
        let step = rounded(ab.wrapping_sub(change.wrapping_mul(steps_between)), half);
        (step, change)
    };
    let (u, v) = (parabola(|uv| uv.u.to_bits()), parabola(|uv| uv.v.to_bits()));
    let [uv, ..] = points;
    Curve {
        uv,
        step: Uv::from_bits(u.0, v.0),
        change: Uv::from_bits(u.1, v.1),
    }
}

/// Divided by a power of two, and rounded to nearest.
#[inline]
const fn rounded(value: i32, log2: u32) -> i32 {
    let half = 1i32.wrapping_shl(log2) >> 1;
    value.wrapping_add(half).wrapping_shr(log2)
}

impl<const N: u32> Quadratic<N> {
    const SUPPORTED: () = assert!(N == 16 || N == 32);
    const LOG2: u32 = N.trailing_zeros();
}

/// The lengths, as powers of two, of the pieces behind the last whole one, of which there are `steps` to a span's last
/// pixel.
#[inline]
fn shorter_pieces(steps: u32) -> impl Iterator<Item = u32> {
    let mut left = steps;
    core::iter::from_fn(move || {
        let log2 = left.checked_ilog2()?;
        left = left.wrapping_sub(1u32.wrapping_shl(log2));
        Some(log2)
    })
}

impl<const N: u32> Strategy for Quadratic<N> {
    type Planes = Planes;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<Planes> {
        const { Self::SUPPORTED };
        // Steps are off by half a unit: what a piece loses so is added first.
        Planes::new(triangle, ShortPlanes::LOG2_PIXELS, N.cast_signed() / 2)
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
        let pixels = span.left.abs_diff(span.right);
        match planes {
            Planes::Words(planes) if !planes.begin_far() => {
                let steps = pixels.wrapping_sub(1);
                let whole = steps >> Self::LOG2 << 1;
                let shorter = shorter_pieces(steps & (N - 1));
                let divisions = shorter.map(|log2| if log2 == 0 { 1 } else { 2 });
                divisions.sum::<u32>().wrapping_add(whole).wrapping_add(1)
            }
            Planes::Short(_) | Planes::Words(_) | Planes::Whole(_) => pixels,
        }
    }
}

impl<const N: u32> BySize for Quadratic<N> {
    #[inline]
    fn short_runs(&self, planes: &ShortPlanes, span: Span, to: impl RunSink) {
        self.short_points(planes, span, to);
    }

    #[inline]
    fn word_runs(&self, planes: &WordPlanes, span: Span, mut to: impl RunSink) {
        let line = planes.line(span);
        if planes.begin_far() {
            every_pixel(planes, &line, span, &mut to);
            return;
        }
        // The last piece ends at the last pixel's centre.
        let steps = span.left.abs_diff(span.right).wrapping_sub(1);
        let mut at = line.first;
        let mut uv = planes.divide(at);
        if steps >= N {
            let half = line.leap(N / 2);
            let next = || {
                let middle = at.after(half);
                at = middle.after(half);
                let points = [uv, planes.divide(middle), planes.divide(at)];
                [.., uv] = points;
                curve(points, Self::LOG2)
            };
            let count = (steps >> Self::LOG2) as usize;
            if const { N == 16 } {
                to.curves::<16>(0, count, next);
            } else {
                to.curves::<32>(0, count, next);
            }
        }
        rest(planes, &line, steps & !(N - 1), steps, uv, &mut to);
    }

    #[inline]
    fn whole_runs(&self, planes: &Homogeneous, span: Span, to: impl RunSink) {
        self.whole_points(planes, span, to);
    }
}

/// What is left of a span from a pixel of those coordinates on, to the last.
#[inline(never)]
fn rest(
    planes: &WordPlanes,
    line: &WordLine,
    offset: u32,
    last: u32,
    uv: Uv,
    to: &mut impl RunSink,
) {
    let (mut offset, mut uv) = (offset, uv);
    for log2 in shorter_pieces(last.wrapping_sub(offset)) {
        let start = uv;
        let at = |pixels: u32| planes.divide(line.at(offset.wrapping_add(pixels)));
        let pixels = 1u32.wrapping_shl(log2);
        uv = at(pixels);
        if log2 == 0 {
            to.run(Run {
                offset: offset as usize,
                len: 1,
                uv: start,
                step: Uv::default(),
            });
        } else {
            let curve = curve([start, at(pixels >> 1), uv], log2);
            to.curve(offset as usize, pixels as usize, curve);
        }
        offset = offset.wrapping_add(pixels);
    }
    to.run(Run {
        offset: last as usize,
        len: 1,
        uv,
        step: Uv::default(),
    });
}

/// Every pixel by itself, where a parabola might swing beyond 128 repeats.
#[cold]
#[inline(never)]
fn every_pixel(planes: &WordPlanes, line: &WordLine, span: Span, to: &mut impl RunSink) {
    to.points::<_, 1>(
        0,
        span.left.abs_diff(span.right) as usize,
        0,
        |&offset| planes.divide(line.at(offset)),
        |offset| *offset = offset.wrapping_add(1),
    );
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::vec::Vec;

    use super::*;

    /// Against the parabola through the same points, in integers: differences are rounded to a unit.
    #[test]
    fn differences_are_those_of_the_parabola() {
        let mut state = 1u32;
        let mut next = move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state ^ state >> 15).cast_signed()
        };
        const MOST: i32 = 64 << (Uv::FRACTION_BITS - 1);
        for round in 0..100_000u32 {
            let log2 = 1 + round % 5;
            let (n, m) = (1i64 << log2, (1i64 << log2) >> 1);
            let shift = round / 5 % 28;
            // From one end to the other without turning around: up to 64 repeats, which one half may have all.
            let mut three = || {
                let a = next() >> 2;
                let far = (next() >> shift).clamp(-MOST, MOST);
                let part = i64::from(next().unsigned_abs()) * [0, 1, 2][next() as usize % 3];
                let b = ((i64::from(far) * part.min(1 << 31)) >> 31) as i32;
                [a, a + b, a + far]
            };
            let (u, v) = (three(), three());
            let points = [0, 1, 2].map(|i| Uv::from_bits(u[i], v[i]));
            let along: Vec<Uv> = curve(points, log2).take(n as usize).collect();
            for (t, uv) in (0..).zip(along) {
                for ([a, b, c], found) in [(u, uv.u.to_bits()), (v, uv.v.to_bits())] {
                    let [a, b, c] = [a, b, c].map(i64::from);
                    // a + t (b - a) / m + t (t - m) (a - 2 b + c) / (2 m^2), in 1 / (2 m^2) of a unit.
                    let exact = 2 * m * m * a + 2 * m * t * (b - a) + t * (t - m) * (a - 2 * b + c);
                    let off = (2 * m * m * i64::from(found) - exact).abs();
                    // t / 2 + t |t - m| / 4.
                    let most = m * m * t + m * m * t * (t - m).abs() / 2;
                    assert!(off <= most, "{round}, step {t} of {n}: {off} > {most}");
                }
            }
        }
    }

    /// What is left of a span is as many pixels as the pieces have.
    #[test]
    fn shorter_pieces_are_all_that_is_left() {
        for steps in 0..32 {
            let lengths: Vec<u32> = shorter_pieces(steps).map(|log2| 1 << log2).collect();
            assert_eq!(lengths.iter().sum::<u32>(), steps);
            assert!(lengths.is_sorted_by(|a, b| a > b), "{lengths:?}");
        }
    }
}
