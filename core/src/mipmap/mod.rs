//! Mip mapping: a level, or two, for each piece of a span, and filters within and between levels.

mod anisotropic;

pub use anisotropic::{Anisotropic, AnisotropicRow, AnisotropicTriangle};

use core::marker::PhantomData;
use core::ops::Range;

use crate::arith::FEW_REGISTERS;
use crate::colour::{Colour, Wide};
use crate::filter::ImageFilter;
use crate::lod::footprint::Lambdas;
use crate::lod::{Chosen, EachPiece, Lod, Rule, Selection};
use crate::perspective::Run;
use crate::pyramid::Pyramid;
use crate::setup::TriangleSetup;
use crate::shade::{Shader, ShaderRow};
use crate::simd::EIGHTS;
use crate::span::Span;
use crate::texture::{BLENDED, Repeat, Texels, Wrap};
use crate::uv::Uv;
use crate::visibility::{Visibility, by_stretches, first_stretch};

/// Pixels that are mixed from two levels at a time: those of a piece.
const TWO_LEVELS: usize = EachPiece::COLUMNS as usize;
const _: () = assert!(TWO_LEVELS <= BLENDED, "filters mix as many");

/// Texel filtering with level selection, as OpenGL has it (4.6, sections 8.14 and 8.15).
///
/// `Min` filters within a level where a pixel spans texels, `Mag` where it does not (lambda not
/// above 0). With the level choice of the [`Lod`] `L` this gives all of OpenGL's modes:
///
/// | OpenGL | `Min` | choice |
/// |---|---|---|
/// | `NEAREST`, `LINEAR` | [`NearestTexel`], [`LinearTexels`] | [`FinestLevel`] |
/// | `NEAREST_MIPMAP_NEAREST`, `LINEAR_MIPMAP_NEAREST` | the same | [`NearestLevel`] |
/// | `NEAREST_MIPMAP_LINEAR`, `LINEAR_MIPMAP_LINEAR` (trilinear) | the same | [`LinearLevels`] |
///
/// Where a channel's values span c, the filter within a level is off by at most `c 2^-9`, the mix
/// of two levels by `c 2^-12` for its weight and `c 2^-12` for lambda, in small triangles up to `c 2^-8.7`, before
/// the result is rounded to the channel's bits. [`LinearTexels5`] is off by up to `c / 32 + 1`, and the mix of its two
/// levels by `c / 64` and one half more.
///
/// [`NearestTexel`]: crate::filter::NearestTexel
/// [`LinearTexels`]: crate::filter::LinearTexels
/// [`LinearTexels5`]: crate::filter::LinearTexels5
/// [`FinestLevel`]: crate::lod::FinestLevel
/// [`NearestLevel`]: crate::lod::NearestLevel
/// [`LinearLevels`]: crate::lod::LinearLevels
#[derive(Clone, Copy, Debug)]
pub struct Mipmapped<'a, T, Min, Mag = Min, L = Lod, U = Repeat, V = U> {
    pyramid: &'a Pyramid<T>,
    min: Min,
    mag: Mag,
    lod: L,
    wrap: PhantomData<(U, V)>,
}

impl<'a, T, Min, Mag, L, U, V> Mipmapped<'a, T, Min, Mag, L, U, V> {
    /// Samples `pyramid`.
    #[must_use]
    pub const fn new(pyramid: &'a Pyramid<T>, min: Min, mag: Mag, lod: L) -> Self {
        Self {
            pyramid,
            min,
            mag,
            lod,
            wrap: PhantomData,
        }
    }
}

impl<T, Min, Mag, L, U, V> Mipmapped<'_, T, Min, Mag, L, U, V>
where
    T: Texels<Colour: Colour>,
    Min: ImageFilter,
    Mag: ImageFilter,
    L: Selection,
    U: Wrap,
    V: Wrap,
{
    /// Of the finest level.
    #[inline]
    fn log2_size(&self) -> (u32, u32) {
        self.level(0).log2_size()
    }

    #[inline]
    fn choose(&self, lambda: i32) -> Chosen {
        self.lod.choose(lambda, self.pyramid.last())
    }

    #[inline]
    fn level(&self, number: u32) -> &T {
        self.pyramid.level(number)
    }

    /// The mix of two levels, with fractions.
    #[inline]
    fn between(&self, finer: u32, weight: u32, uv: Uv) -> Min::Wide<T::Colour> {
        let fine = self.min.wide::<_, U, V>(self.level(finer), uv);
        let coarser = self.level(finer.wrapping_add(1));
        fine.lerp(self.min.wide::<_, U, V>(coarser, uv), weight)
    }

    #[inline]
    fn colour(&self, chosen: Chosen, uv: Uv) -> T::Colour {
        match chosen {
            Chosen::Magnified(level) => self.mag.texel::<_, U, V>(self.level(level), uv),
            Chosen::One(level) => self.min.texel::<_, U, V>(self.level(level), uv),
            Chosen::Two { finer, weight } if const { L::BLENDS } => {
                Min::narrow(self.between(finer, weight, uv))
            }
            Chosen::Two { .. } => T::Colour::default(),
        }
    }

    /// Fills at most [`TWO_LEVELS`] pixels with the mix of two levels: the finer one's colours
    /// are kept meanwhile, so that each loop has one texture to walk on.
    #[inline]
    fn blend<P>(&self, finer: u32, weight: u32, uv: Uv, step: Uv, pixels: &mut [P])
    where
        T::Colour: Into<P>,
    {
        if let [pixel] = pixels {
            *pixel = Min::narrow(self.between(finer, weight, uv)).into();
            return;
        }
        if const { EIGHTS } {
            let levels = [self.level(finer), self.level(finer.wrapping_add(1))];
            let min = &self.min;
            if min.blend::<_, U, V, _>(levels, weight, uv, step, pixels) {
                return;
            }
        }
        let mut fine = [Min::Wide::<T::Colour>::default(); TWO_LEVELS];
        let fine = fine.get_mut(..pixels.len()).unwrap_or_default();
        let level = self.level(finer);
        let keep = |to: &mut _, colour| *to = colour;
        self.min
            .wides::<_, U, V, _>(level, uv, step, fine.iter_mut(), keep);
        let level = self.level(finer.wrapping_add(1));
        let both = pixels.iter_mut().zip(&*fine);
        let mix = |(pixel, fine): (&mut P, &Min::Wide<T::Colour>), coarse| {
            *pixel = Min::narrow::<T::Colour>(fine.lerp(coarse, weight)).into();
        };
        self.min.wides::<_, U, V, _>(level, uv, step, both, mix);
    }

    /// [`Self::fill`] for a run of known length; `false`, and nothing is written, between two levels.
    #[inline]
    fn piece<P, const N: usize>(
        &self,
        chosen: Chosen,
        uv: Uv,
        step: Uv,
        pixels: &mut [P; N],
    ) -> bool
    where
        T::Colour: Into<P>,
    {
        match chosen {
            Chosen::Magnified(level) => {
                self.mag
                    .piece::<_, U, V, _, N>(self.level(level), uv, step, pixels);
            }
            Chosen::One(level) => {
                self.min
                    .piece::<_, U, V, _, N>(self.level(level), uv, step, pixels);
            }
            Chosen::Two { .. } => return false,
        }
        true
    }

    /// Fills pixels that share their levels; those of a part of a run are no more than 64.
    #[inline]
    fn fill<P, const IS_PART: bool>(&self, chosen: Chosen, uv: Uv, step: Uv, pixels: &mut [P])
    where
        T::Colour: Into<P>,
    {
        match chosen {
            Chosen::Magnified(level) => {
                fill::<_, _, U, V, _, IS_PART>(self.mag, self.level(level), uv, step, pixels);
            }
            Chosen::One(level) => {
                fill::<_, _, U, V, _, IS_PART>(self.min, self.level(level), uv, step, pixels);
            }
            Chosen::Two { finer, weight } if const { L::BLENDS } => {
                let mut uv = uv;
                for pixels in pixels.chunks_mut(TWO_LEVELS) {
                    self.blend(finer, weight, uv, step, pixels);
                    uv = uv.after(step, TWO_LEVELS);
                }
            }
            Chosen::Two { .. } => {}
        }
    }
}

/// From one level; see [`Mipmapped::fill`].
#[inline]
fn fill<F, T, U, V, P, const IS_PART: bool>(
    filter: F,
    level: &T,
    uv: Uv,
    step: Uv,
    pixels: &mut [P],
) where
    F: ImageFilter,
    T: Texels<Colour: Colour + Into<P>>,
    U: Wrap,
    V: Wrap,
{
    if const { IS_PART } {
        filter.fill_part::<_, U, V, _>(level, uv, step, pixels);
    } else {
        filter.fill::<_, U, V, _>(level, uv, step, pixels);
    }
}

impl<T, Min, Mag, L, U, V> Shader for Mipmapped<'_, T, Min, Mag, L, U, V>
where
    T: Texels<Colour: Colour>,
    Min: ImageFilter,
    Mag: ImageFilter,
    L: Selection,
    U: Wrap,
    V: Wrap,
{
    type Texel = T::Colour;
    type Triangle = L::Lambdas;
    type Row<'r>
        = MipmappedRow<'r, Self, L::Lambdas, L::Rule>
    where
        Self: 'r;

    #[inline]
    fn triangle(&self, triangle: &TriangleSetup<'_>) -> L::Lambdas {
        self.lod.lambdas(triangle, self.log2_size())
    }

    #[inline]
    fn row<'r>(&'r self, lambdas: &'r L::Lambdas, span: Span) -> Self::Row<'r> {
        MipmappedRow {
            shader: self,
            lambdas: lambdas.row(span, self.lod.rule()),
            span,
            known: 0..0,
            chosen: Chosen::Magnified(0),
        }
    }
}

/// The row of [`Mipmapped`]: remembers the levels of the piece that was asked for last.
#[derive(Clone, Debug)]
pub struct MipmappedRow<'r, M, P: Lambdas + 'r, R: Rule> {
    shader: &'r M,
    lambdas: P::Row<'r, R>,
    span: Span,
    /// The pixels that have `chosen`.
    known: Range<usize>,
    chosen: Chosen,
}

impl<T, Min, Mag, L, U, V>
    MipmappedRow<'_, Mipmapped<'_, T, Min, Mag, L, U, V>, L::Lambdas, L::Rule>
where
    T: Texels<Colour: Colour>,
    Min: ImageFilter,
    Mag: ImageFilter,
    L: Selection,
    U: Wrap,
    V: Wrap,
{
    /// The levels of a pixel.
    #[inline]
    fn chosen(&mut self, offset: usize) -> Chosen {
        if !self.known.contains(&offset) {
            if const { FEW_REGISTERS && L::TAKES_PIXELS } {
                self.choose_apart(offset);
            } else {
                self.choose(offset);
            }
        }
        self.chosen
    }

    /// [`Self::choose`] beside a loop that needs all registers.
    #[inline(never)]
    fn choose_apart(&mut self, offset: usize) {
        self.choose(offset);
    }

    /// Fills the stretches of a run that are seen, of which the first is known.
    #[inline(never)]
    fn fill_stretches<P>(
        &mut self,
        first: Range<usize>,
        run: Run,
        pixels: &mut [P],
        seen: &mut impl Visibility,
    ) where
        T::Colour: Into<P>,
    {
        by_stretches(first, pixels, seen, |first, pixels| {
            self.fill_part(run.part(first, pixels.len()), pixels);
        });
    }

    /// [`ShaderRow::fill`] for no more than 64 pixels.
    #[inline(never)]
    fn fill_part<P>(&mut self, run: Run, pixels: &mut [P])
    where
        T::Colour: Into<P>,
    {
        self.fill_levels::<P, true>(run, pixels);
    }

    /// A run, or a part of one, level by level.
    #[inline]
    fn fill_levels<P, const IS_PART: bool>(&mut self, run: Run, pixels: &mut [P])
    where
        T::Colour: Into<P>,
    {
        let (mut rest, mut uv, mut offset) = (pixels, run.uv, run.offset);
        while !rest.is_empty() {
            let chosen = self.chosen(offset);
            // At least one pixel, so that it ends.
            let length = self.known.end.saturating_sub(offset).clamp(1, rest.len());
            let Some((now, after)) = rest.split_at_mut_checked(length) else {
                return;
            };
            self.shader.fill::<P, IS_PART>(chosen, uv, run.step, now);
            uv = uv.after(run.step, length);
            offset = offset.wrapping_add(length);
            rest = after;
        }
    }

    /// Those of the piece that a pixel is in.
    #[inline]
    fn choose(&mut self, offset: usize) {
        let piece = self.shader.lod.piece(self.span, offset);
        let lambda = L::Lambdas::lambda(&self.lambdas, piece.at.unwrap_or(0));
        self.known = piece.start..piece.end;
        self.chosen = self.shader.choose(lambda);
    }
}

impl<T, Min, Mag, L, U, V> ShaderRow
    for MipmappedRow<'_, Mipmapped<'_, T, Min, Mag, L, U, V>, L::Lambdas, L::Rule>
where
    T: Texels<Colour: Colour>,
    Min: ImageFilter,
    Mag: ImageFilter,
    L: Selection,
    U: Wrap,
    V: Wrap,
{
    type Texel = T::Colour;

    #[inline]
    fn texel(&mut self, offset: usize, uv: Uv) -> T::Colour {
        let chosen = self.chosen(offset);
        self.shader.colour(chosen, uv)
    }

    #[inline]
    fn fill<P>(&mut self, run: Run, pixels: &mut [P])
    where
        T::Colour: Into<P>,
    {
        self.fill_levels::<P, false>(run, pixels);
    }

    #[inline]
    fn piece<P, const N: usize>(&mut self, offset: usize, uv: Uv, step: Uv, pixels: &mut [P; N])
    where
        T::Colour: Into<P>,
    {
        let run = Run::piece::<N>(offset, uv, step);
        if const { L::EACH_PIXEL } {
            self.fill(run, pixels);
            return;
        }
        let chosen = self.chosen(offset);
        if self.known.end.wrapping_sub(offset) < N || !self.shader.piece(chosen, uv, step, pixels) {
            self.fill_part(run, pixels);
        }
    }

    /// Stretch by stretch, with no level chosen, or recorded as wanted, for a piece of which nothing is seen.
    #[inline(never)]
    fn fill_seen<P>(&mut self, run: Run, pixels: &mut [P], seen: &mut impl Visibility)
    where
        T::Colour: Into<P>,
    {
        self.fill_stretches(0..0, run, pixels, seen);
    }

    #[inline]
    fn piece_seen<P, const N: usize>(
        &mut self,
        offset: usize,
        uv: Uv,
        step: Uv,
        pixels: &mut [P; N],
        seen: &mut impl Visibility,
    ) where
        T::Colour: Into<P>,
    {
        let Some(first) = first_stretch::<N>(seen) else {
            self.piece(offset, uv, step, pixels);
            return;
        };
        let run = Run::piece::<N>(offset, uv, step);
        self.fill_stretches(first, run, pixels, seen);
    }
}
