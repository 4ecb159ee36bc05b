//! How lambda is found: once for a triangle, or for pixels of its spans.

use core::fmt::Debug;

use super::{Footprint, SmallFootprint};
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
        Self(match SmallFootprint::new(triangle, log2_size) {
            Some(small) => small.lambda_of_mean(triangle, rule),
            None => Footprint::new(triangle, log2_size).lambda_of_mean(triangle, rule),
        })
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
