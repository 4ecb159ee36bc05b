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
    planes: [Plane; 2],
    ranges: [Range; 2],
    /// From one pixel to the next.
    step: Uv,
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
            planes: [u, v],
            ranges: [u_range, v_range],
            step: Uv::from_bits(
                u_range.expand_step(u.step_x()),
                v_range.expand_step(v.step_x()),
            ),
        })
    }

    #[inline]
    fn runs(&self, planes: &AffinePlanes, span: Span, mut to: impl RunSink) {
        let [u, v] = &planes.planes;
        let [u_range, v_range] = planes.ranges;
        let at = |plane: &Plane| (plane.at(span.left, span.y) >> Plane::FRACTION_BITS) as i32;
        to.run(Run {
            offset: 0,
            len: span.right.abs_diff(span.left) as usize,
            uv: Uv::from_bits(u_range.expand(at(u)), v_range.expand(at(v))),
            step: planes.step,
        });
    }
    fn divisions(&self, _: &AffinePlanes, _: Span) -> u32 {
        0
    }
}
