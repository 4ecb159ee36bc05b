//! No perspective: u and v as linear functions of the screen.

use super::{Range, Run, RunSink, Strategy};
use crate::setup::{Plane, TriangleSetup};
use crate::span::Span;
use crate::uv::Uv;

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

/// A plane in the coordinate's range, in words: products of 32 bits do at each span.
#[derive(Clone, Copy, Debug)]
struct Coordinate {
    /// At the first corner's pixel, and the changes to the right and down: 1.31, counted from the
    /// range's middle, modulo 2^32.
    whole: [i32; 3],
    /// 16 bits behind those.
    part: [i32; 3],
    /// The middle in 8.24.
    middle: i32,
    /// From 1.31 down to 8.24.
    shift: u32,
}

impl Coordinate {
    #[inline]
    fn new(plane: &Plane, range: Range) -> Self {
        let values = [plane.at_pixel(), plane.step_x(), plane.step_y()];
        let [first, right, down] = values.map(|v| (v >> Plane::FRACTION_BITS) as i32);
        let (middle, from_middle) = range.middle();
        Self {
            whole: [first.wrapping_add(from_middle), right, down],
            part: values.map(|v| ((v >> (Plane::FRACTION_BITS - 16)) as i32) & 0xffff),
            middle,
            shift: range.shift & 31,
        }
    }

    /// So many pixels from the first corner's, at most 2^12 each way.
    #[inline]
    fn at(&self, [x, y]: [i32; 2]) -> i32 {
        let sum = |[first, right, down]: [i32; 3]| {
            first
                .wrapping_add(right.wrapping_mul(x))
                .wrapping_add(down.wrapping_mul(y))
        };
        let value = sum(self.whole).wrapping_add(sum(self.part) >> 16);
        self.middle.wrapping_add(value >> self.shift)
    }
}

impl Strategy for Affine {
    type Planes = AffinePlanes;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<AffinePlanes> {
        let vertices = triangle.vertices();
        let inverse = triangle.inverse_area();
        let plane = |axis: fn(&crate::project::ScreenVertex) -> i32| {
            let (range, excess) = Range::new(vertices.each_ref().map(axis))?;
            // excess < 2^bits, and 8 + shift = 31 - bits: the whole word is used.
            let values = excess.map(|e| (e << ((range.shift + 8) & 31)).cast_signed());
            Some((triangle.plane_over(values, inverse), range))
        };
        let (u, u_range) = plane(|v| v.uv()[0].to_bits())?;
        let (v, v_range) = plane(|v| v.uv()[1].to_bits())?;
        Some(AffinePlanes {
            pixel: u.pixel(),
            u: Coordinate::new(&u, u_range),
            v: Coordinate::new(&v, v_range),
            step: Uv::from_bits(
                u_range.expand_step(u.step_x()),
                v_range.expand_step(v.step_x()),
            ),
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
