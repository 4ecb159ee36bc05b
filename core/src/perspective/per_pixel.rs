//! The exact strategy.

use super::{Homogeneous, Run, Strategy};
use crate::setup::TriangleSetup;
use crate::span::Span;
use crate::uv::Uv;

/// One perspective division a pixel, as graphics hardware does it.
///
/// The error is that of the arithmetic alone (see the error budget in the crate's
/// documentation), below 1/64 texel for any sensible triangle. The dearest strategy; choose it to compare
/// with, or for triangles in which depth changes a lot between neighbouring pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PerPixel;

impl Strategy for PerPixel {
    type Planes = Homogeneous;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<Homogeneous> {
        Homogeneous::new(triangle)
    }

    #[inline]
    fn runs(&self, planes: &Homogeneous, span: Span, mut emit: impl FnMut(Run)) {
        let mut point = planes.at(span.left, span.y);
        let leap = planes.leap(1);
        for offset in 0..span.right.abs_diff(span.left) as usize {
            emit(Run {
                offset,
                len: 1,
                uv: planes.divide(point),
                step: Uv::default(),
            });
            point = point.after(&leap);
        }
    }
}
