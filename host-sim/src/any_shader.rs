//! One shader type for all filters, wrap modes and numbers of samples that are chosen at run time.
//! Pixels are asked for one by one, not in runs: a device fills runs, and gets the same.

use multum::colour::Colour;
use multum::lod::Lod;
use multum::mipmap::{Anisotropic, Mipmapped};
use multum::pyramid::Pyramid;
use multum::setup::TriangleSetup;
use multum::shade::{Shader, ShaderRow};
use multum::span::Span;
use multum::texture::Texels;
use multum::uv::Uv;

use crate::any::{AnyChoice, AnyImage, AnyRate, AnyRule};
use crate::choice::with_wrap;
use crate::filtering::Filtering;
use crate::reference::Beyond;

/// What a shader keeps of a triangle.
pub struct OfTriangle<'s, C>(Box<dyn Spans<C> + 's>);

/// From a triangle to what is kept of it.
type Prepare<'s, C> = dyn Fn(&TriangleSetup<'_>) -> OfTriangle<'s, C> + 's;

/// A shader behind a pointer.
pub struct AnyShader<'s, C>(Box<Prepare<'s, C>>);

impl<'s, C: Colour> AnyShader<'s, C> {
    /// Behind a pointer.
    pub fn new<S: Shader<Texel = C, Triangle: 's> + Copy + 's>(shader: S) -> Self {
        Self(Box::new(move |triangle| {
            OfTriangle(Box::new(Prepared {
                shader,
                triangle: shader.triangle(triangle),
            }))
        }))
    }

    /// The filters that were chosen, over a pyramid; `wrap` says what lies beyond its edges.
    pub fn filtering<T: Texels<Colour = C>>(
        filtering: &Filtering,
        pyramid: &'s Pyramid<T>,
        wrap: Beyond,
    ) -> Self {
        with_wrap!(wrap, W => {
            let choice = AnyChoice(filtering.min.choice);
            let lod = Lod::new(choice, AnyRule(filtering.rule), AnyRate(filtering.per))
                .with_bias(filtering.bias);
            let (min, mag) = (AnyImage(filtering.min.image), AnyImage(filtering.mag));
            let mipmapped = Mipmapped::<_, _, _, _, W>::new(pyramid, min, mag, lod);
            match filtering.min.taps {
                2 => Self::new(Anisotropic::<2, _>::new(mipmapped)),
                4 => Self::new(Anisotropic::<4, _>::new(mipmapped)),
                8 => Self::new(Anisotropic::<8, _>::new(mipmapped)),
                _ => Self::new(mipmapped),
            }
        })
    }
}

/// A triangle's spans.
trait Spans<C> {
    fn row<'r>(&'r self, span: Span) -> Box<dyn Pixels<C> + 'r>;
}

/// A span's pixels.
trait Pixels<C> {
    /// The colour of a pixel, if it has one.
    fn colour(&mut self, offset: usize, uv: Uv) -> Option<C>;
}

struct Prepared<S: Shader> {
    shader: S,
    triangle: S::Triangle,
}

impl<C: Colour, S: Shader<Texel = C>> Spans<C> for Prepared<S> {
    fn row<'r>(&'r self, span: Span) -> Box<dyn Pixels<C> + 'r> {
        Box::new(Row(self.shader.row(&self.triangle, span)))
    }
}

struct Row<R>(R);

impl<C: Colour, R: ShaderRow<Texel = C>> Pixels<C> for Row<R> {
    fn colour(&mut self, offset: usize, uv: Uv) -> Option<C> {
        let mut colour = C::default();
        self.0.write(offset, uv, &mut colour).then_some(colour)
    }
}

impl<'s, C: Colour + 's> Shader for AnyShader<'s, C> {
    type Texel = C;
    type Triangle = OfTriangle<'s, C>;
    type Row<'r>
        = AnyRow<'r, C>
    where
        Self: 'r;

    fn triangle(&self, triangle: &TriangleSetup<'_>) -> OfTriangle<'s, C> {
        (self.0)(triangle)
    }

    fn row<'r>(&'r self, triangle: &'r OfTriangle<'s, C>, span: Span) -> AnyRow<'r, C> {
        AnyRow(triangle.0.row(span))
    }
}

/// The row of [`AnyShader`].
pub struct AnyRow<'r, C>(Box<dyn Pixels<C> + 'r>);

impl<C: Colour> ShaderRow for AnyRow<'_, C> {
    type Texel = C;

    fn texel(&mut self, offset: usize, uv: Uv) -> C {
        self.0.colour(offset, uv).unwrap_or_default()
    }

    fn write<P>(&mut self, offset: usize, uv: Uv, pixel: &mut P) -> bool
    where
        C: Into<P>,
    {
        match self.0.colour(offset, uv) {
            Some(colour) => {
                *pixel = colour.into();
                true
            }
            None => false,
        }
    }
}
