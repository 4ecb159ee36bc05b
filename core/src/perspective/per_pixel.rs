//! The exact strategy.

use super::by_size::{BySize, Planes};
use super::homogeneous::octave::Octave;
use super::homogeneous::short::ShortPlanes;
use super::homogeneous::words::WordPlanes;
use super::{Homogeneous, RunSink, SpanSink, Strategy};
use crate::setup::TriangleSetup;
use crate::simd::{COUNT, EIGHTS};
use crate::span::{Area, Span};

/// One perspective division a pixel, as graphics hardware does it.
///
/// The error is that of the arithmetic alone (see the error budget in the crate's
/// documentation), below 1/64 texel for any sensible triangle. Choose it to compare with, or for
/// triangles in which depth changes a lot between neighbouring pixels.
///
/// **Cost.** One reciprocal of 31 bits a pixel (a division of 32 bits and two multiplications; a table where
/// there is none, and on x86-64, where pixels go by eights) and a multiplication a coordinate. What floating point does for each number, to count
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
            let (mut octave, mut count) = planes.octave(&line, done, len.wrapping_sub(done));
            // What is left of them goes one by one.
            if const { EIGHTS } {
                let by_eights = count & !(COUNT as u32 - 1);
                if by_eights != 0 && to.eights(done as usize, by_eights as usize, octave) {
                    octave.skip(by_eights);
                    done = done.wrapping_add(by_eights);
                    count = count.wrapping_sub(by_eights);
                    if count == 0 {
                        continue;
                    }
                }
            }
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
