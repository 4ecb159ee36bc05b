//! Several samples along the long axis of a footprint.

use crate::colour::{Colour, Wide};
use crate::filter::ImageFilter;
use crate::lod::footprint::{Footprint, FootprintRow, LongAxis};
use crate::lod::log2::FRACTION_BITS;
use crate::lod::{Chosen, Euclidean, Selection};
use crate::setup::TriangleSetup;
use crate::shade::{Shader, ShaderRow};
use crate::span::Span;
use crate::texture::{Texels, Wrap};
use crate::uv::Uv;

use super::Mipmapped;

/// Anisotropic filtering: up to `N` (2, 4 or 8) samples along the long axis of the footprint, of
/// a level that fits its short axis; each as `M`, a [`Mipmapped`], would take it.
///
/// The footprint's axes are the steps to the next pixel on the right and to the one below, by their
/// Euclidean lengths whatever the rule of `M`. The number of samples is the least power of two that
/// is not below the ratio of the two, at most `N`; they lie in the middles of as many equal parts
/// of the long axis, and lambda is that of one part (after the OpenGL extension
/// `EXT_texture_filter_anisotropic`, which leaves the places to the implementation).
#[derive(Clone, Copy, Debug)]
pub struct Anisotropic<const N: u32, M>(M);

impl<const N: u32, M> Anisotropic<N, M> {
    const SUPPORTED: () = assert!(N == 2 || N == 4 || N == 8);

    /// Takes samples of `mipmapped`.
    #[must_use]
    pub const fn new(mipmapped: M) -> Self {
        const { Self::SUPPORTED };
        Self(mipmapped)
    }
}

/// Where the samples of a pixel lie, and what they read.
#[derive(Clone, Copy, Debug)]
struct Samples {
    chosen: Chosen,
    /// Base-2 logarithm of their number.
    log2: u32,
    /// From one to the next.
    step: Uv,
}

impl<const N: u32, T, Min, Mag, L, U, V> Anisotropic<N, Mipmapped<'_, T, Min, Mag, L, U, V>>
where
    T: Texels<Colour: Colour>,
    Min: ImageFilter,
    Mag: ImageFilter,
    L: Selection,
    U: Wrap,
    V: Wrap,
{
    #[inline]
    fn samples(&self, axis: LongAxis) -> Samples {
        // The ceiling: `excess` is not negative.
        let octaves = axis.excess.wrapping_add((1 << FRACTION_BITS) - 1) >> FRACTION_BITS;
        let log2 = octaves.cast_unsigned().min(N.trailing_zeros());
        let lambda = axis
            .lambda
            .wrapping_sub((log2 << FRACTION_BITS).cast_signed());
        Samples {
            chosen: self.0.choose(lambda),
            log2,
            step: Uv::from_bits(
                axis.step.u.to_bits() >> (log2 & 31),
                axis.step.v.to_bits() >> (log2 & 31),
            ),
        }
    }

    #[inline]
    fn colour(&self, samples: Samples, uv: Uv) -> T::Colour {
        if samples.log2 == 0 {
            return self.0.colour(samples.chosen, uv);
        }
        let count = 1u32 << (samples.log2 & 31);
        // (n - 1) / 2 steps back: the samples lie evenly around the pixel's centre.
        let back = |bits: i32| bits.wrapping_mul(count.wrapping_sub(1).cast_signed()) >> 1;
        let (u, v) = (samples.step.u.to_bits(), samples.step.v.to_bits());
        let from = uv + Uv::from_bits(back(u).wrapping_neg(), back(v).wrapping_neg());
        match samples.chosen {
            Chosen::Magnified(level) => mean::<Mag, _>(samples, from, |at| {
                self.0.mag.wide::<_, U, V>(self.0.level(level), at)
            }),
            Chosen::One(level) => mean::<Min, _>(samples, from, |at| {
                self.0.min.wide::<_, U, V>(self.0.level(level), at)
            }),
            Chosen::Two { finer, weight } if const { L::BLENDS } => {
                mean::<Min, _>(samples, from, |at| self.0.between(finer, weight, at))
            }
            Chosen::Two { .. } => T::Colour::default(),
        }
    }
}

/// The mean of what `filtered` gives at all samples, the first of them at `from`.
#[inline]
fn mean<F: ImageFilter, C: Colour>(
    samples: Samples,
    from: Uv,
    filtered: impl Fn(Uv) -> F::Wide<C>,
) -> C {
    let mut at = from;
    let mut sum = F::Wide::<C>::default();
    for _ in 0..1u32 << (samples.log2 & 31) {
        sum = sum.plus(filtered(at));
        at = at + samples.step;
    }
    F::narrow(sum.half(samples.log2))
}

/// What anisotropic filtering needs of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct AnisotropicTriangle {
    footprint: Footprint,
    axis: LongAxis,
}

impl<const N: u32, T, Min, Mag, L, U, V> Shader
    for Anisotropic<N, Mipmapped<'_, T, Min, Mag, L, U, V>>
where
    T: Texels<Colour: Colour>,
    Min: ImageFilter,
    Mag: ImageFilter,
    L: Selection,
    U: Wrap,
    V: Wrap,
{
    type Texel = T::Colour;
    type Triangle = AnisotropicTriangle;
    type Row<'r>
        = AnisotropicRow<'r, Self>
    where
        Self: 'r;

    #[inline]
    fn triangle(&self, triangle: &TriangleSetup<'_>) -> AnisotropicTriangle {
        let mut of_triangle = AnisotropicTriangle {
            footprint: Footprint::new(triangle, self.0.log2_size()),
            axis: LongAxis::default(),
        };
        if const { L::TAKES_TRIANGLE } {
            of_triangle.axis = of_triangle.footprint.long_axis_of_mean(triangle, Euclidean);
        }
        of_triangle
    }

    #[inline]
    fn row<'r>(&'r self, triangle: &'r AnisotropicTriangle, span: Span) -> Self::Row<'r> {
        AnisotropicRow {
            shader: self,
            footprint: if const { L::TAKES_PIXELS } {
                Some(triangle.footprint.row(span, Euclidean))
            } else {
                None
            },
            of_triangle: triangle.axis,
            span,
            known: 0..0,
            samples: Samples {
                chosen: Chosen::Magnified(0),
                log2: 0,
                step: Uv::default(),
            },
        }
    }
}

/// The row of [`Anisotropic`]: remembers the samples of the piece that was asked for last.
#[derive(Clone, Debug)]
pub struct AnisotropicRow<'r, A> {
    shader: &'r A,
    footprint: Option<FootprintRow<'r, Euclidean>>,
    of_triangle: LongAxis,
    span: Span,
    /// The pixels that have `samples`.
    known: core::ops::Range<usize>,
    samples: Samples,
}

impl<const N: u32, T, Min, Mag, L, U, V> ShaderRow
    for AnisotropicRow<'_, Anisotropic<N, Mipmapped<'_, T, Min, Mag, L, U, V>>>
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
        if !self.known.contains(&offset) {
            let piece = self.shader.0.lod.piece(self.span, offset);
            let axis = match (&self.footprint, piece.at) {
                (Some(footprint), Some(at)) => footprint.long_axis(at as u32),
                _ => self.of_triangle,
            };
            self.known = piece.start..piece.end;
            self.samples = self.shader.samples(axis);
        }
        self.shader.colour(self.samples, uv)
    }
}
