//! Affine mapping for the triangles in which it cannot be told from the correct one.

use fixed::types::I16F16;

use super::affine::AffinePlanes;
use super::{Affine, RunSink, SpanSink, Strategy};
use crate::arith::product_unsigned;
use crate::setup::TriangleSetup;
use crate::span::{Area, Span};

/// [`Affine`] for triangles in which its error stays within a bound, in footprints, and another
/// strategy for the rest: small triangles, and surfaces that face the camera.
///
/// Affine mapping is off by at most `C (sqrt r - 1) / (sqrt r + 1) <= C (r - 1) / 4`, where C is what a
/// coordinate spans over the triangle and r the ratio of its depths. From one corner to another a
/// coordinate changes by no more than `(width + height) f`, f being the most that it changes from a
/// pixel to the next on the right or below, anywhere in the triangle. So where
///
/// `(width + height) (r - 1) <= 4 bound`
///
/// the error is at most `bound f`: that part of the triangle's largest footprint, along each axis of the
/// texture. It is added to the rounding of [`Affine`].
///
/// Choose it for meshes, where triangles are a few pixels wide: what perspective takes to set up is
/// most of what they cost. Where none of a scene's triangles passes the test, it has cost two products
/// for each; an image that does not choose it has no code of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AffineWithin<P> {
    strategy: P,
    /// In 2^-10 footprints: a quarter of the bound's unit of 2^-8, which subpixels have.
    bound: u32,
}

impl AffineWithin<()> {
    /// A quarter of a footprint: below what nearest sampling shows.
    pub const DEFAULT_BOUND: I16F16 = I16F16::lit("0.25");
}

impl<P> AffineWithin<P> {
    /// With a bound in footprints, of which 10 fraction bits count, rounded down; a negative one counts as
    /// 0, with which triangles of constant depth are mapped affinely and no others.
    #[must_use]
    pub const fn new(strategy: P, bound: I16F16) -> Self {
        let bits = bound.to_bits();
        let bound = if bits < 0 {
            0
        } else {
            bits.cast_unsigned() >> 6
        };
        Self { strategy, bound }
    }

    /// Whether affine mapping keeps the bound.
    #[inline]
    fn holds(&self, triangle: &TriangleSetup<'_>) -> bool {
        let [nearest, farthest] = triangle.depths();
        // (width + height) 2^8 (r - 1) <= bound 2^10: exact in 64 bits.
        product_unsigned(triangle.extent(), farthest.wrapping_sub(nearest))
            <= product_unsigned(self.bound, nearest)
    }
}

/// What [`AffineWithin`] has ready for the spans of a triangle.
#[derive(Clone, Copy, Debug)]
pub enum AffineWithinPlanes<P> {
    /// Within the bound.
    Affine(AffinePlanes),
    /// Beyond it.
    Other(P),
}

impl<P: Strategy> Strategy for AffineWithin<P> {
    type Planes = AffineWithinPlanes<P::Planes>;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<Self::Planes> {
        if self.holds(triangle) {
            Affine.planes(triangle).map(AffineWithinPlanes::Affine)
        } else {
            self.strategy
                .planes(triangle)
                .map(AffineWithinPlanes::Other)
        }
    }

    #[inline]
    fn runs(&self, planes: &Self::Planes, span: Span, to: impl RunSink) {
        match planes {
            AffineWithinPlanes::Affine(planes) => Affine.runs(planes, span, to),
            AffineWithinPlanes::Other(planes) => self.strategy.runs(planes, span, to),
        }
    }

    #[inline]
    fn all_runs(
        &self,
        planes: &Self::Planes,
        triangle: &TriangleSetup<'_>,
        area: Area,
        to: impl SpanSink,
    ) {
        match planes {
            AffineWithinPlanes::Affine(planes) => Affine.all_runs(planes, triangle, area, to),
            AffineWithinPlanes::Other(planes) => {
                self.strategy.all_runs(planes, triangle, area, to);
            }
        }
    }

    fn divisions(&self, planes: &Self::Planes, span: Span) -> u32 {
        match planes {
            AffineWithinPlanes::Affine(planes) => Affine.divisions(planes, span),
            AffineWithinPlanes::Other(planes) => self.strategy.divisions(planes, span),
        }
    }
}
