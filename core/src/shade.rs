//! Shaders: what fills the pixels of a triangle. A shader may know its triangle and its place on
//! the screen, as level selection must; a [`Sampler`] knows neither and is the simplest of them.

use crate::arith::keep_rolled;
use crate::perspective::Run;
use crate::sample::Sampler;
use crate::setup::TriangleSetup;
use crate::simd::COUNT;
use crate::span::Span;
use crate::uv::{Curve, Eight, Uv};
use crate::visibility::{Candidate as _, Visibility};

/// Colours for the pixels of triangles.
pub trait Shader {
    /// The colour it gives.
    type Texel;

    /// What it needs of a triangle.
    type Triangle;

    /// What it needs of a span.
    type Row<'r>: ShaderRow<Texel = Self::Texel>
    where
        Self: 'r;

    /// Once a triangle.
    fn triangle(&self, triangle: &TriangleSetup<'_>) -> Self::Triangle;

    /// Once a span.
    fn row<'r>(&'r self, triangle: &'r Self::Triangle, span: Span) -> Self::Row<'r>;
}

/// Colours for the pixels of one span, asked for from left to right.
pub trait ShaderRow {
    /// The colour it gives.
    type Texel;

    /// The colour of the pixel `offset` pixels from the start of the span, with these coordinates.
    fn texel(&mut self, offset: usize, uv: Uv) -> Self::Texel;

    /// Gives one pixel its colour; `false` if it is left as it was, because nothing is to be seen
    /// there.
    #[inline]
    fn write<P>(&mut self, offset: usize, uv: Uv, pixel: &mut P) -> bool
    where
        Self::Texel: Into<P>,
    {
        *pixel = self.texel(offset, uv).into();
        true
    }

    /// Writes the pixels of a run, the same as [`Self::write`] one by one. `pixels` has the run's
    /// length.
    #[inline]
    fn fill<P>(&mut self, run: Run, pixels: &mut [P])
    where
        Self::Texel: Into<P>,
    {
        let (mut offset, mut uv) = (run.offset, run.uv);
        for pixel in pixels {
            self.write(offset, uv, pixel);
            uv = uv + run.step;
            offset = offset.wrapping_add(1);
        }
    }

    /// Writes those pixels of a run that are seen, and asks for no others' colours.
    #[inline]
    fn fill_seen<P>(&mut self, run: Run, pixels: &mut [P], seen: &mut impl Visibility)
    where
        Self::Texel: Into<P>,
    {
        one_by_one(self, run, pixels, seen);
    }

    /// [`Self::fill_seen`] for a run of known length.
    #[inline]
    fn piece_seen<P, const N: usize>(
        &mut self,
        offset: usize,
        uv: Uv,
        step: Uv,
        pixels: &mut [P; N],
        seen: &mut impl Visibility,
    ) where
        Self::Texel: Into<P>,
    {
        let run = Run::piece::<N>(offset, uv, step);
        self.fill_seen(run, pixels, seen);
    }

    /// [`Self::fill`] for a run of known length.
    #[inline]
    fn piece<P, const N: usize>(&mut self, offset: usize, uv: Uv, step: Uv, pixels: &mut [P; N])
    where
        Self::Texel: Into<P>,
    {
        let run = Run::piece::<N>(offset, uv, step);
        self.fill(run, pixels);
    }

    /// Whether it is faster to write eight pixels at a time where each has coordinates of its own.
    #[inline]
    fn takes_eights(&self) -> bool {
        false
    }

    /// Writes eight pixels, the same as [`Self::write`] one by one.
    #[inline]
    fn eight<P>(&mut self, offset: usize, at: Eight, pixels: &mut [P; COUNT])
    where
        Self::Texel: Into<P>,
    {
        for ((offset, uv), pixel) in (offset..).zip(at.array()).zip(pixels) {
            self.write(offset, uv, pixel);
        }
    }

    /// Writes pixels of which the coordinates are on a parabola, the first at `offset`.
    #[inline]
    fn curve<P>(&mut self, offset: usize, curve: Curve, pixels: &mut [P])
    where
        Self::Texel: Into<P>,
    {
        for ((offset, uv), pixel) in (offset..).zip(curve).zip(pixels) {
            self.write(offset, uv, pixel);
        }
    }

    /// Writes those of them that are seen.
    #[inline]
    fn curve_seen<P>(
        &mut self,
        offset: usize,
        curve: Curve,
        pixels: &mut [P],
        seen: &mut impl Visibility,
    ) where
        Self::Texel: Into<P>,
    {
        for ((offset, uv), pixel) in (offset..).zip(curve).zip(seen.among(pixels)) {
            pixel.write(|pixel| self.write(offset, uv, pixel));
            keep_rolled();
        }
    }
}

/// Writes those pixels of a run that are seen.
#[inline]
fn one_by_one<R: ShaderRow<Texel: Into<P>> + ?Sized, P>(
    row: &mut R,
    run: Run,
    pixels: &mut [P],
    seen: &mut impl Visibility,
) {
    let (mut offset, mut uv) = (run.offset, run.uv);
    for pixel in seen.among(pixels) {
        pixel.write(|pixel| row.write(offset, uv, pixel));
        uv = uv + run.step;
        offset = offset.wrapping_add(1);
        keep_rolled();
    }
}

impl<S: Sampler> Shader for S {
    type Texel = S::Texel;
    type Triangle = ();
    type Row<'r>
        = SamplerRow<'r, S>
    where
        S: 'r;

    #[inline]
    fn triangle(&self, _: &TriangleSetup<'_>) {}

    #[inline]
    fn row<'r>(&'r self, (): &'r (), _: Span) -> SamplerRow<'r, S> {
        SamplerRow(self)
    }
}

/// The row of a [`Sampler`]: all are alike.
#[derive(Clone, Copy, Debug)]
pub struct SamplerRow<'r, S>(&'r S);

impl<S: Sampler> ShaderRow for SamplerRow<'_, S> {
    type Texel = S::Texel;

    #[inline]
    fn texel(&mut self, _: usize, uv: Uv) -> S::Texel {
        self.0.sample(uv)
    }

    #[inline]
    fn fill<P>(&mut self, run: Run, pixels: &mut [P])
    where
        S::Texel: Into<P>,
    {
        self.0.fill(run.uv, run.step, pixels);
    }

    #[inline]
    fn piece<P, const N: usize>(&mut self, _: usize, uv: Uv, step: Uv, pixels: &mut [P; N])
    where
        S::Texel: Into<P>,
    {
        self.0.piece(uv, step, pixels);
    }

    #[inline]
    fn takes_eights(&self) -> bool {
        self.0.takes_eights()
    }

    #[inline(always)]
    fn eight<P>(&mut self, _: usize, at: Eight, pixels: &mut [P; COUNT])
    where
        S::Texel: Into<P>,
    {
        self.0.eight(at, pixels);
    }

    #[inline]
    fn fill_seen<P>(&mut self, run: Run, pixels: &mut [P], seen: &mut impl Visibility)
    where
        S::Texel: Into<P>,
    {
        self.0.fill_seen(run.uv, run.step, pixels, seen);
    }

    #[inline]
    fn curve<P>(&mut self, _: usize, curve: Curve, pixels: &mut [P])
    where
        S::Texel: Into<P>,
    {
        self.0.curve(curve, pixels);
    }

    #[inline]
    fn curve_seen<P>(
        &mut self,
        _: usize,
        curve: Curve,
        pixels: &mut [P],
        seen: &mut impl Visibility,
    ) where
        S::Texel: Into<P>,
    {
        self.0.curve_seen(curve, pixels, seen);
    }

    #[inline]
    fn piece_seen<P, const N: usize>(
        &mut self,
        _: usize,
        uv: Uv,
        step: Uv,
        pixels: &mut [P; N],
        seen: &mut impl Visibility,
    ) where
        S::Texel: Into<P>,
    {
        self.0.piece_seen(uv, step, pixels, seen);
    }
}
