//! No perspective: u and v as linear functions of the screen.

use super::{Run, RunSink, Strategy};
use crate::arith::product_with_short;
use crate::setup::TriangleSetup;
use crate::span::Span;
use crate::uv::Uv;
use crate::viewport::SUBPIXEL_BITS;

/// Affine mapping, as on the PlayStation: one run a span and no division after setup.
///
/// Exact where 1/w is constant over the triangle. Elsewhere the error on a line between two
/// points of the triangle's outline with depths of ratio `r >= 1` is at most
/// `|du| (sqrt r - 1) / (sqrt r + 1)`, the farthest that a hyperbola bends away from its chord, in
/// addition to 2^-25 repeats per pixel of the span for the step's rounding. Choose it for sprites, distant or small triangles, and subdivided meshes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Affine;

/// The planes of u and v themselves.
#[derive(Clone, Copy, Debug)]
pub struct AffinePlanes {
    /// The first corner's.
    pixel: [i32; 2],
    u: Coordinate,
    v: Coordinate,
    /// From one pixel to the next.
    step: Uv,
}

/// A plane of one coordinate, in words: products of 32 bits do at each span.
#[derive(Clone, Copy, Debug)]
struct Coordinate {
    /// At the first corner's pixel, and the changes to the right and down: 8.24.
    whole: [i32; 3],
    /// 16 bits behind those.
    part: [i32; 3],
}

impl Coordinate {
    /// From the first corner's value, in 16.16, how many subpixels its pixel's centre is beyond it,
    /// and the gradient.
    #[inline]
    fn new(first: i32, [right, down]: [i32; 2], [x, y]: [i64; 2]) -> Self {
        let beyond = product_with_short(x, right).wrapping_add(product_with_short(y, down));
        // In 8.40, and half a unit of 8.24: what is left of the sum is cut off.
        let first = (i64::from(first) << 24)
            .wrapping_add(1 << 15)
            .wrapping_add(beyond >> SUBPIXEL_BITS);
        Self {
            whole: [first, x, y].map(|value| (value >> 16) as i32),
            part: [first, x, y].map(|value| i32::from(value as u16)),
        }
    }

    /// From one pixel to the next, rounded to nearest.
    #[inline]
    fn step(&self) -> i32 {
        let ([_, whole, _], [_, part, _]) = (self.whole, self.part);
        whole.wrapping_add((part >> 15) & 1)
    }

    /// So many pixels from the first corner's, at most 2^12 each way.
    #[inline]
    fn at(&self, [x, y]: [i32; 2]) -> i32 {
        let sum = |[first, right, down]: [i32; 3]| {
            first
                .wrapping_add(right.wrapping_mul(x))
                .wrapping_add(down.wrapping_mul(y))
        };
        sum(self.whole).wrapping_add(sum(self.part) >> 16)
    }
}

impl Strategy for Affine {
    type Planes = AffinePlanes;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<AffinePlanes> {
        let (first, beyond) = triangle.coordinates();
        if !beyond.into_iter().all(spans_below_128) {
            return None;
        }
        let (pixel, to_centre) = triangle.first_pixel();
        let [du, dv] = triangle.gradients(beyond);
        let (u, v) = (
            Coordinate::new(first[0], to_centre, du),
            Coordinate::new(first[1], to_centre, dv),
        );
        Some(AffinePlanes {
            pixel,
            u,
            v,
            step: Uv::from_bits(u.step(), v.step()),
        })
    }

    #[inline]
    fn runs(&self, planes: &AffinePlanes, span: Span, mut to: impl RunSink) {
        let [x, y] = planes.pixel;
        let from_pixel = [span.left.wrapping_sub(x), span.y.wrapping_sub(y)];
        to.run(Run {
            offset: 0,
            len: span.right.abs_diff(span.left) as usize,
            uv: Uv::from_bits(planes.u.at(from_pixel), planes.v.at(from_pixel)),
            step: planes.step,
        });
    }

    fn divisions(&self, _: &AffinePlanes, _: Span) -> u32 {
        0
    }
}

/// Whether coordinates that exceed the first corner's by so much, in 16.16, span less than 128
/// repeats.
#[inline]
fn spans_below_128([b, c]: [i32; 2]) -> bool {
    let all = b.unsigned_abs() | c.unsigned_abs();
    all < 1 << 22 || (all < 1 << 23 && b.abs_diff(c) < 1 << 23)
}
