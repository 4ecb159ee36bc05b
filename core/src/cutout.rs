//! Texels that are not to be seen: a colour key, or alpha. The pixel behind stays, and so does its
//! depth.

use crate::colour::Opacity;
use crate::setup::TriangleSetup;
use crate::shade::{Shader, ShaderRow};
use crate::span::Span;
use crate::uv::Uv;

/// Leaves pixels out by the colour that they would get.
pub trait Cutout<C>: Copy {
    /// Whether a pixel of this colour is drawn.
    fn shows(&self, colour: &C) -> bool;
}

/// Leaves out the pixels that would get exactly this colour: for textures without alpha.
///
/// A filter that mixes texels makes other colours at the edges of what is left out; such filters
/// go with textures that have alpha, and [`AlphaTest`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ColourKey<C>(pub C);

impl<C: Copy + PartialEq> Cutout<C> for ColourKey<C> {
    #[inline]
    fn shows(&self, colour: &C) -> bool {
        *colour != self.0
    }
}

/// Leaves out the pixels whose alpha is below one half.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AlphaTest;

impl<C: Opacity> Cutout<C> for AlphaTest {
    #[inline]
    fn shows(&self, colour: &C) -> bool {
        colour.is_opaque()
    }
}

/// A shader of which some pixels are left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CutOut<S, K> {
    /// Gives the colours.
    pub shader: S,
    /// Tells which of them are drawn.
    pub cutout: K,
}

impl<S: Shader, K: Cutout<S::Texel>> Shader for CutOut<S, K> {
    type Texel = S::Texel;
    type Triangle = S::Triangle;
    type Row<'r>
        = CutOutRow<S::Row<'r>, K>
    where
        Self: 'r;

    #[inline]
    fn triangle(&self, triangle: &TriangleSetup<'_>) -> S::Triangle {
        self.shader.triangle(triangle)
    }

    #[inline]
    fn row<'r>(&'r self, triangle: &'r S::Triangle, span: Span) -> Self::Row<'r> {
        CutOutRow {
            row: self.shader.row(triangle, span),
            cutout: self.cutout,
        }
    }
}

/// The row of [`CutOut`].
#[derive(Clone, Copy, Debug)]
pub struct CutOutRow<R, K> {
    row: R,
    cutout: K,
}

impl<R: ShaderRow, K: Cutout<R::Texel>> ShaderRow for CutOutRow<R, K> {
    type Texel = R::Texel;

    #[inline]
    fn texel(&mut self, offset: usize, uv: Uv) -> R::Texel {
        self.row.texel(offset, uv)
    }

    #[inline]
    fn write<P>(&mut self, offset: usize, uv: Uv, pixel: &mut P) -> bool
    where
        R::Texel: Into<P>,
    {
        let texel = self.row.texel(offset, uv);
        let shown = self.cutout.shows(&texel);
        if shown {
            *pixel = texel.into();
        }
        shown
    }
}
