//! How the pixels of a triangle are asked for lambda: not at all, one of a span, or many.

use core::fmt::Debug;

use super::{Footprint, FootprintLine, FootprintRow, FootprintWords};
use crate::lod::Rule;
use crate::setup::TriangleSetup;
use crate::span::Span;

/// What finds the lambda of pixels, once prepared for a triangle.
pub trait Lambdas: Copy + Debug {
    /// Prepared for a span.
    type Row<'t, R: Rule>: Clone
    where
        Self: 't;

    /// Prepares a span.
    fn row<'t, R: Rule>(
        &'t self,
        footprint: &'t Footprint,
        span: Span,
        rule: R,
    ) -> Self::Row<'t, R>;

    /// Lambda at the pixel `offset` pixels from its start, with
    /// [`FRACTION_BITS`](crate::lod::log2::FRACTION_BITS) fraction bits.
    fn lambda<R: Rule>(row: &Self::Row<'_, R>, offset: usize) -> i32;
}

/// No pixel is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct NoPixel;

impl Lambdas for NoPixel {
    type Row<'t, R: Rule> = ();

    #[inline]
    fn row<'t, R: Rule>(&'t self, _: &'t Footprint, _: Span, _: R) {}

    #[inline]
    fn lambda<R: Rule>((): &(), _: usize) -> i32 {
        0
    }
}

/// One or two of each span: with all bits, and nothing is prepared for the triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FewPixels;

impl Lambdas for FewPixels {
    type Row<'t, R: Rule> = FootprintRow<'t, R>;

    #[inline]
    fn row<'t, R: Rule>(
        &'t self,
        footprint: &'t Footprint,
        span: Span,
        rule: R,
    ) -> FootprintRow<'t, R> {
        footprint.row(span, rule)
    }

    #[inline]
    fn lambda<R: Rule>(row: &FootprintRow<'_, R>, offset: usize) -> i32 {
        row.lambda(offset as u32)
    }
}

/// Many, in single words.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ManyPixels(FootprintWords);

impl ManyPixels {
    /// Prepares a triangle.
    #[inline]
    #[must_use]
    pub fn new(footprint: &Footprint, triangle: &TriangleSetup<'_>) -> Self {
        Self(footprint.words(triangle))
    }
}

impl Lambdas for ManyPixels {
    type Row<'t, R: Rule> = FootprintLine<R>;

    #[inline]
    fn row<'t, R: Rule>(
        &'t self,
        footprint: &'t Footprint,
        span: Span,
        rule: R,
    ) -> FootprintLine<R> {
        footprint.line(&self.0, span, rule)
    }

    #[inline]
    fn lambda<R: Rule>(line: &FootprintLine<R>, offset: usize) -> i32 {
        line.lambda(offset as u32)
    }
}
