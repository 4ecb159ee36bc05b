//! Exact coordinates every N pixels, linear in between.

use super::{Homogeneous, Run, Strategy};
use crate::arith::RECIPROCALS;
use crate::setup::TriangleSetup;
use crate::span::Span;
use crate::uv::Uv;

/// A perspective division every `N` pixels, as in Quake (Abrash, *Graphics Programming Black
/// Book*, chapter 70); `N` is 4, 8, 16, 32 or 64.
///
/// The divisions happen at screen columns that are multiples of `N`, so that neighbouring
/// triangles of one plane agree between them, and at the first and the last pixel of the span, so
/// that nothing is ever evaluated outside the triangle, where 1/w may reach zero. On a piece
/// whose ends differ by `du` and have depths of ratio `r >= 1` the error is at most
/// `|du| (sqrt r - 1) / (sqrt r + 1)`, the farthest that a hyperbola bends away from its chord,
/// in addition to that of [`PerPixel`](super::PerPixel) and 2^-24 repeats a pixel for the step's
/// rounding. At one texel a
/// pixel, 16 pixels keep 0.25 texel up to r = 1.065.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Every<const N: u32 = 16>;

impl<const N: u32> Every<N> {
    const SUPPORTED: () = assert!(N.is_power_of_two() && N >= 4 && N <= 64);
    const LOG2: u32 = N.trailing_zeros();
}

impl<const N: u32> Strategy for Every<N> {
    type Planes = Homogeneous;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<Homogeneous> {
        const { Self::SUPPORTED };
        Homogeneous::new(triangle)
    }

    #[inline]
    fn runs(&self, planes: &Homogeneous, span: Span, mut emit: impl FnMut(Run)) {
        let len = span.right.abs_diff(span.left);
        let mut rest = len;
        let mut point = planes.at(span.left, span.y);
        let mut uv = planes.divide(point);
        let leap = planes.leap(N);
        // To the next multiple of N: the first piece may be shorter.
        let mut piece = N.wrapping_sub(span.left.cast_unsigned() & (N - 1));
        while rest > 0 {
            // One place for all pieces: what follows is in the image once.
            let (pixels, steps);
            if rest > piece {
                (pixels, steps) = (piece, piece);
                point = if piece == N {
                    point.after(&leap)
                } else {
                    planes.step(point, piece)
                };
            } else {
                // The last piece ends at the last pixel's centre.
                (pixels, steps) = (rest, rest.wrapping_sub(1));
                point = planes.step(point, steps);
            }
            let end = if steps > 0 { planes.divide(point) } else { uv };
            emit(Run {
                offset: len.wrapping_sub(rest) as usize,
                len: pixels as usize,
                uv,
                step: step::<N>(uv, end, steps),
            });
            uv = end;
            rest = rest.wrapping_sub(pixels);
            piece = N;
        }
    }
}

/// The step that leads from one coordinate to another in `steps <= N` pixels, rounded to nearest.
#[inline]
fn step<const N: u32>(from: Uv, to: Uv, steps: u32) -> Uv {
    let each = |from: i32, to: i32| {
        let distance = to.wrapping_sub(from);
        if steps == N {
            // Coordinates are within 127 repeats and spans below 128: no overflow.
            distance.wrapping_add((N / 2).cast_signed()) >> Every::<N>::LOG2
        } else if steps <= 1 {
            distance
        } else {
            let reciprocal = RECIPROCALS.get(steps as usize).map_or(0, |&r| i64::from(r));
            ((i64::from(distance) * reciprocal).wrapping_add(1 << 31) >> 32) as i32
        }
    };
    Uv::from_bits(
        each(from.u.to_bits(), to.u.to_bits()),
        each(from.v.to_bits(), to.v.to_bits()),
    )
}
