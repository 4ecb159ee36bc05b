//! How lambda is found: once for a triangle, or for one pixel of a span, or for many.

use core::fmt::Debug;

use super::{Footprint, FootprintLine, FootprintRow, FootprintWords};
use crate::lod::Rule;
use crate::setup::TriangleSetup;
use crate::span::Span;

/// What finds lambda, once prepared for a triangle: it holds as much of the footprint as it needs.
pub trait Lambdas: Copy + Debug {
    /// Prepared for a span.
    type Row<'t, R: Rule>: Clone
    where
        Self: 't;

    /// Prepares a span.
    fn row<R: Rule>(&self, span: Span, rule: R) -> Self::Row<'_, R>;

    /// Lambda at the pixel `offset` pixels from its start, with
    /// [`FRACTION_BITS`](crate::lod::log2::FRACTION_BITS) fraction bits.
    fn lambda<R: Rule>(row: &Self::Row<'_, R>, offset: usize) -> i32;
}

/// Once, at the mean of the corners: all pixels have that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AtMean(i32);

impl AtMean {
    /// Of a triangle, as [`Footprint::new`].
    #[inline]
    #[must_use]
    pub fn new<R: Rule>(triangle: &TriangleSetup<'_>, log2_size: (u32, u32), rule: R) -> Self {
        let footprint = Footprint::in_registers(triangle, log2_size);
        Self(footprint.lambda_of_mean(triangle, rule))
    }
}

impl Lambdas for AtMean {
    type Row<'t, R: Rule> = Self;

    #[inline]
    fn row<R: Rule>(&self, _: Span, _: R) -> Self {
        *self
    }

    #[inline]
    fn lambda<R: Rule>(&Self(lambda): &Self, _: usize) -> i32 {
        lambda
    }
}

/// One or two pixels of each span: with all bits, and nothing is prepared for the triangle.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FewPixels(Footprint);

impl FewPixels {
    /// Of a triangle, as [`Footprint::new`].
    #[inline]
    #[must_use]
    pub fn new(triangle: &TriangleSetup<'_>, log2_size: (u32, u32)) -> Self {
        Self(Footprint::new(triangle, log2_size))
    }
}

impl Lambdas for FewPixels {
    type Row<'t, R: Rule> = FootprintRow<'t, R>;

    #[inline]
    fn row<R: Rule>(&self, span: Span, rule: R) -> FootprintRow<'_, R> {
        self.0.row(span, rule)
    }

    #[inline]
    fn lambda<R: Rule>(row: &FootprintRow<'_, R>, offset: usize) -> i32 {
        row.lambda(offset as u32)
    }
}

/// Many pixels, in single words.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ManyPixels {
    footprint: Footprint,
    words: FootprintWords,
}

impl ManyPixels {
    /// Of a triangle, as [`Footprint::new`].
    #[inline]
    #[must_use]
    pub fn new(triangle: &TriangleSetup<'_>, log2_size: (u32, u32)) -> Self {
        let footprint = Footprint::in_registers(triangle, log2_size);
        Self {
            words: footprint.words(triangle),
            footprint,
        }
    }
}

impl Lambdas for ManyPixels {
    type Row<'t, R: Rule> = FootprintLine<R>;

    #[inline]
    fn row<R: Rule>(&self, span: Span, rule: R) -> FootprintLine<R> {
        self.footprint.line(&self.words, span, rule)
    }

    #[inline]
    fn lambda<R: Rule>(line: &FootprintLine<R>, offset: usize) -> i32 {
        line.lambda(offset as u32)
    }
}
