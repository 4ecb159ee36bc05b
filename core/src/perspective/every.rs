//! Exact coordinates every N pixels, linear in between.

use super::by_size::{BySize, Planes, one_piece};
use super::homogeneous::short::ShortPlanes;
use super::homogeneous::words::WordPlanes;
use super::{Homogeneous, Run, RunSink, SpanSink, Strategy};
use crate::arith::{RECIPROCALS, product};
use crate::setup::TriangleSetup;
use crate::span::{Area, Span};
use crate::uv::Uv;

/// A perspective division every `N` pixels, as in Quake (Abrash, *Graphics Programming Black
/// Book*, chapter 70); `N` is 4, 8, 16, 32 or 64.
///
/// The divisions happen at screen columns that are multiples of `N`, so that neighbouring
/// triangles of one plane agree between them, and at the first and the last pixel of the span, so
/// that nothing is ever evaluated outside the triangle, where 1/w may reach zero. On a piece
/// whose ends differ by `du` and have depths of ratio `r >= 1` the error is at most
/// `|du| (sqrt r - 1) / (sqrt r + 1)`, the farthest that a hyperbola bends away from its chord,
/// in addition to that of [`PerPixel`](super::PerPixel), `N/2` units of 2^-24 repeats and one more for
/// each pixel of the piece, for the step's rounding, and half a unit of the words of 1/w and u/w for
/// every piece before. At one texel a pixel, 16 pixels keep 0.25 texel up to r = 1.065.
///
/// Triangles that are no more than `N` pixels wide and high, and 16, of nearly one depth and less than an
/// eighth of a repeat, are divided at both ends of their spans only: few of these reach over a multiple of
/// `N`. Products of 32 bits do for them; their error is that which [`PerPixel`](super::PerPixel) gives for small
/// triangles, half as much again, and 2^-19 repeats.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Every<const N: u32 = 16>;

impl<const N: u32> Every<N> {
    const SUPPORTED: () = assert!(N.is_power_of_two() && N >= 4 && N <= 64);
    const LOG2: u32 = N.trailing_zeros();
}

impl<const N: u32> Strategy for Every<N> {
    type Planes = Planes;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<Planes> {
        const { Self::SUPPORTED };
        // Steps are rounded down: half of what a piece so loses is added first. Spans of a small triangle
        // are no longer than a piece.
        Planes::new(triangle, Self::LOG2, N.cast_signed() / 2)
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
}

impl<const N: u32> Every<N> {
    /// From a span's first column to the next multiple of `N`.
    #[inline]
    const fn first_piece(span: Span) -> u32 {
        N.wrapping_sub(span.left.cast_unsigned() & (N - 1))
    }
}

impl<const N: u32> BySize for Every<N> {
    #[inline]
    fn short_runs(&self, planes: &ShortPlanes, span: Span, to: impl RunSink) {
        one_piece(planes, span, to);
    }

    #[inline]
    fn word_runs(&self, planes: &WordPlanes, span: Span, mut to: impl RunSink) {
        let len = span.right.abs_diff(span.left);
        let piece = Self::first_piece(span);
        let line = planes.line(span);
        let mut at = line.first;
        let mut uv = planes.divide(at);
        let mut offset = 0;
        if piece < N && piece < len {
            at = line.at(piece);
            let end = planes.divide(at);
            to.run(Run {
                offset: 0,
                len: piece as usize,
                uv,
                step: short_step(uv, end, piece),
            });
            offset = piece;
            uv = end;
        }
        let rest = len.wrapping_sub(offset);
        // The last piece ends at the last pixel's centre, and is short for that: 1 to N pixels.
        let count = rest.wrapping_sub(1) >> Self::LOG2;
        if count > 0 {
            let leap = line.leap(N);
            let next = || {
                at = at.after(leap);
                let (start, end) = (uv, planes.divide(at));
                uv = end;
                (
                    start,
                    difference(start, end, |distance| distance >> Self::LOG2),
                )
            };
            let (offset, count) = (offset as usize, count as usize);
            match N {
                4 => to.pieces::<4>(offset, count, next),
                8 => to.pieces::<8>(offset, count, next),
                16 => to.pieces::<16>(offset, count, next),
                32 => to.pieces::<32>(offset, count, next),
                _ => to.pieces::<64>(offset, count, next),
            }
        }
        let done = offset.wrapping_add(count << Self::LOG2);
        let pixels = len.wrapping_sub(done);
        let steps = pixels.wrapping_sub(1);
        let end = if steps > 0 {
            planes.divide(line.at(len.wrapping_sub(1)))
        } else {
            uv
        };
        to.run(Run {
            offset: done as usize,
            len: pixels as usize,
            uv,
            step: short_step(uv, end, steps),
        });
    }

    #[inline]
    fn whole_runs(&self, planes: &Homogeneous, span: Span, to: impl RunSink) {
        far::<N>(planes, span, to);
    }
}

/// The step that leads from one coordinate to another in up to 63 pixels.
#[inline]
pub(super) fn short_step(from: Uv, to: Uv, steps: u32) -> Uv {
    let reciprocal = RECIPROCALS[steps as usize & (RECIPROCALS.len() - 1)];
    difference(from, to, |distance| {
        if steps <= 1 {
            distance
        } else {
            (product(distance, reciprocal) >> 32) as i32
        }
    })
}

/// From one coordinate to another, in parts.
#[inline]
pub(super) fn difference(from: Uv, to: Uv, part: impl Fn(i32) -> i32) -> Uv {
    // Coordinates are within 127 repeats and spans below 128: no overflow.
    let each = |from: i32, to: i32| part(to.wrapping_sub(from));
    Uv::from_bits(
        each(from.u.to_bits(), to.u.to_bits()),
        each(from.v.to_bits(), to.v.to_bits()),
    )
}

/// With all bits of the planes.
#[cold]
#[inline(never)]
fn far<const N: u32>(planes: &Homogeneous, span: Span, mut to: impl RunSink) {
    let len = span.left.abs_diff(span.right);
    let mut point = planes.at(span.left, span.y);
    let mut uv = planes.divide_far(point);
    let (mut rest, mut pixels) = (len, Every::<N>::first_piece(span));
    while rest > 0 {
        // The last piece ends at the last pixel's centre.
        let steps = pixels.min(rest.wrapping_sub(1));
        point = planes.step(point, steps);
        let end = if steps > 0 {
            planes.divide_far(point)
        } else {
            uv
        };
        // The table of lengths ends before a whole piece of the longest.
        let step = if steps == N {
            difference(uv, end, |distance| distance >> Every::<N>::LOG2)
        } else {
            short_step(uv, end, steps)
        };
        to.run(Run {
            offset: len.wrapping_sub(rest) as usize,
            len: pixels.min(rest) as usize,
            uv,
            step,
        });
        uv = end;
        rest = rest.saturating_sub(pixels);
        pixels = N;
    }
}
