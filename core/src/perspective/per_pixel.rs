//! The exact strategy.

use super::by_size::{BySize, Planes};
use super::homogeneous::octave::Octave;
use super::homogeneous::short::ShortPlanes;
use super::homogeneous::words::WordPlanes;
use super::{Homogeneous, RunSink, SpanSink, Strategy};
use crate::setup::TriangleSetup;
use crate::span::{Area, Span};

/// One perspective division a pixel, as graphics hardware does it.
///
/// The error is that of the arithmetic alone (see the error budget in the crate's
/// documentation), below 1/64 texel for any sensible triangle. Choose it to compare with, or for
/// triangles in which depth changes a lot between neighbouring pixels.
///
/// **Cost.** One reciprocal of 31 bits a pixel (a division of 32 bits and two multiplications; a table where
/// there is none) and a multiplication a coordinate. What floating point does for each number, to count
/// its leading zeros and to shift, is done once for up to 128 pixels: 1/w is linear along a scanline and
/// seldom reaches another power of two. Small triangles of nearly one depth need none of it: a reciprocal of
/// 16 bits does, and planes from products of 32 bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PerPixel;

impl Strategy for PerPixel {
    type Planes = Planes;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<Planes> {
        Planes::new(triangle, ShortPlanes::LOG2_PIXELS, 0)
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

impl BySize for PerPixel {
    #[inline]
    fn short_runs(&self, planes: &ShortPlanes, span: Span, to: impl RunSink) {
        self.short_points(planes, span, to);
    }

    #[inline]
    fn word_runs(&self, planes: &WordPlanes, span: Span, mut to: impl RunSink) {
        let len = span.right.abs_diff(span.left);
        let line = planes.line(span);
        let mut done = 0;
        while done < len {
            let (octave, count) = planes.octave(&line, done, len.wrapping_sub(done));
            to.points::<_, 2>(
                done as usize,
                count as usize,
                octave,
                Octave::here,
                Octave::next,
            );
            done = done.wrapping_add(count);
        }
    }

    #[inline]
    fn whole_runs(&self, planes: &Homogeneous, span: Span, to: impl RunSink) {
        self.whole_points(planes, span, to);
    }
}
