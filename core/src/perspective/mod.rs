//! Perspective: from the planes of a triangle to texture coordinates along a span.
//!
//! A strategy decides where coordinates are computed exactly and where they are interpolated. It
//! hands over *runs*: pieces of a span along which u and v change by a constant step. What a run
//! is filled with, and where it is written, is not its business.

mod adaptive;
mod affine;
mod affine_within;
mod by_size;
mod chord;
mod constant_z;
mod constant_z_columns;
#[cfg(test)]
mod count_divisions;
mod every;
mod extrapolated;
mod homogeneous;
mod per_pixel;
mod quadratic;
mod subdivided;

pub use adaptive::Adaptive;
pub use affine::Affine;
pub use affine_within::AffineWithin;
pub use constant_z::ConstantZ;
pub use constant_z_columns::ConstantZColumns;
pub use every::Every;
pub use extrapolated::Extrapolated;
pub use homogeneous::Homogeneous;
pub use per_pixel::PerPixel;
pub use quadratic::Quadratic;
pub use subdivided::Subdivided;

use crate::setup::TriangleSetup;
use crate::span::{Area, Span, for_each_span};
use crate::uv::{Curve, Eight, Uv};

/// A piece of a span along which u and v are linear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Run {
    /// First pixel, counted from the start of the span.
    pub offset: usize,
    /// Number of pixels, at least 1.
    pub len: usize,
    /// Coordinates at the first pixel's centre.
    pub uv: Uv,
    /// From one pixel to the next.
    pub step: Uv,
}

impl Run {
    /// One of known length.
    #[inline]
    pub(crate) const fn piece<const N: usize>(offset: usize, uv: Uv, step: Uv) -> Self {
        Self {
            offset,
            len: N,
            uv,
            step,
        }
    }

    /// So many of its pixels, from number `first` on.
    #[inline]
    pub(crate) fn part(self, first: usize, len: usize) -> Self {
        Self {
            offset: self.offset.wrapping_add(first),
            len,
            uv: self.uv.after(self.step, first),
            step: self.step,
        }
    }
}

/// Takes the pixels of a span, from left to right. A closure over runs is one.
pub trait RunSink {
    /// A piece along which u and v are linear.
    fn run(&mut self, run: Run);

    /// A piece that is often long.
    #[inline]
    fn long_run(&mut self, run: Run) {
        self.run(run);
    }

    /// [`Self::run`] for a run that is all of a span, and short.
    #[inline]
    fn short_run(&mut self, run: Run) {
        self.run(run);
    }

    /// So many pieces of one length, the first at `offset`, which is known where the strategy is
    /// compiled; `next` gives coordinates at a piece's first pixel and their step.
    #[inline]
    fn pieces<const N: usize>(
        &mut self,
        offset: usize,
        count: usize,
        mut next: impl FnMut() -> (Uv, Uv),
    ) {
        for piece in 0..count {
            let (uv, step) = next();
            let offset = offset.wrapping_add(piece.wrapping_mul(N));
            self.run(Run::piece::<N>(offset, uv, step));
        }
    }

    /// So many pixels from `offset` on, along which u and v are parabolas.
    #[inline]
    fn curve(&mut self, offset: usize, len: usize, curve: Curve) {
        for (pixel, uv) in (0..len).zip(curve) {
            self.run(Run {
                offset: offset.wrapping_add(pixel),
                len: 1,
                uv,
                step: Uv::default(),
            });
        }
    }

    /// So many pieces of one length, the first at `offset`, along which u and v are parabolas.
    #[inline]
    fn curves<const N: usize>(
        &mut self,
        offset: usize,
        count: usize,
        mut next: impl FnMut() -> Curve,
    ) {
        for piece in 0..count {
            let offset = offset.wrapping_add(piece.wrapping_mul(N));
            self.curve(offset, N, next());
        }
    }

    /// So many pixels from `offset` on, a multiple of eight, with their coordinates eight at a time. `false`, and nothing is
    /// written, if they would be taken one by one.
    #[inline]
    fn eights(
        &mut self,
        _offset: usize,
        _len: usize,
        _eights: impl IntoIterator<Item = Eight>,
    ) -> bool {
        false
    }

    /// So many pixels from `offset` on: `here` gives coordinates, and `next` goes on to the next pixel. A
    /// loop over them should take `N` at a time: as many as the registers of a small processor hold.
    // Two functions: where a pixel is hidden nobody asks for its coordinates, and a state that was stepped
    // before would have to be kept twice.
    #[inline]
    fn points<T, const N: usize>(
        &mut self,
        offset: usize,
        count: usize,
        mut state: T,
        here: impl Fn(&T) -> Uv,
        mut next: impl FnMut(&mut T),
    ) {
        for pixel in 0..count {
            self.run(Run {
                offset: offset.wrapping_add(pixel),
                len: 1,
                uv: here(&state),
                step: Uv::default(),
            });
            next(&mut state);
        }
    }
}

impl<F: FnMut(Run)> RunSink for F {
    #[inline]
    fn run(&mut self, run: Run) {
        self(run);
    }
}

/// Takes the pixels of a triangle, span by span.
pub trait SpanSink {
    /// What takes those of a span.
    type Runs<'s>: RunSink
    where
        Self: 's;

    /// Once a span. `None` to leave it out.
    fn span(&mut self, span: Span) -> Option<Self::Runs<'_>>;
}

/// How u and v are found along a span.
///
/// All strategies cover the same pixels and feed the same samplers; they differ in divisions and
/// in error.
pub trait Strategy {
    /// What a triangle needs to have ready for its spans.
    type Planes;

    /// Once a triangle. `None` if it spans
    /// [`MAX_UV_SPAN`](crate::geometry::MAX_UV_SPAN) repeats or more.
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<Self::Planes>;

    /// The runs of one span, from left to right: together they cover it exactly. The planes are
    /// evaluated from the span's absolute position.
    fn runs(&self, planes: &Self::Planes, span: Span, to: impl RunSink);

    /// The runs of a triangle's spans inside `area`, from top to bottom.
    ///
    /// As provided, [`Self::runs`] of each. A strategy with more than one kind of planes tells them apart
    /// here, once a triangle.
    #[inline]
    fn all_runs(
        &self,
        planes: &Self::Planes,
        triangle: &TriangleSetup<'_>,
        area: Area,
        mut to: impl SpanSink,
    ) {
        for_each_span(triangle, area, |span| {
            if let Some(to) = to.span(span) {
                self.runs(planes, span, to);
            }
        });
    }

    /// How many perspective divisions [`Self::runs`] makes for a span: for measurements; drawing
    /// does not call it.
    ///
    /// As provided: one at the start of every run, and one at the end of the last run unless that
    /// is a single pixel. Right for all strategies that lay chords between exact coordinates.
    fn divisions(&self, planes: &Self::Planes, span: Span) -> u32 {
        exact_ends(|to| self.runs(planes, span, to))
    }
}

/// How many ends of chords there are: see [`Strategy::divisions`].
fn exact_ends(runs: impl FnOnce(&mut dyn FnMut(Run))) -> u32 {
    let (mut count, mut last) = (0u32, 0);
    runs(&mut |run: Run| {
        count = count.wrapping_add(1);
        last = run.len;
    });
    count.wrapping_add(u32::from(last > 1))
}
