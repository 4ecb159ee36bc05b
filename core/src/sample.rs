//! Samplers: from a texture coordinate to a texel's colour.

use core::marker::PhantomData;

use crate::packed;
use crate::texture::{Repeat, Texture, Wrap};
use crate::uv::Uv;

/// What a run of pixels is filled with.
pub trait Sampler {
    /// The colour it gives.
    type Texel;

    /// The colour at a coordinate; any coordinate has one.
    fn sample(&self, uv: Uv) -> Self::Texel;

    /// Fills a run: the colours at `uv`, `uv + step` and so on, the same as [`Self::sample`] gives.
    #[inline]
    fn fill<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        Self::Texel: Into<P>,
    {
        let mut uv = uv;
        for pixel in pixels {
            *pixel = self.sample(uv).into();
            uv = uv + step;
        }
    }
}

/// The texel that the coordinate lies in; `U` and `V` say what lies beyond the edges.
#[derive(Clone, Copy, Debug)]
pub struct Nearest<'a, C, U = Repeat, V = U> {
    texture: Texture<'a, C>,
    wrap: PhantomData<(U, V)>,
}

impl<'a, C, U: Wrap, V: Wrap> Nearest<'a, C, U, V> {
    /// Samples `texture`.
    #[must_use]
    pub const fn new(texture: Texture<'a, C>) -> Self {
        Self {
            texture,
            wrap: PhantomData,
        }
    }
}

impl<C: Copy + Default, U: Wrap, V: Wrap> Sampler for Nearest<'_, C, U, V> {
    type Texel = C;

    #[inline]
    fn sample(&self, uv: Uv) -> C {
        let (log2_width, log2_height) = self.texture.log2_size();
        // At most 12 bits each: the shifts stay at 12 .. 24.
        let column = U::wrap(
            uv.u.to_bits() >> ((Uv::FRACTION_BITS - log2_width) & 31),
            log2_width,
        );
        let row = V::wrap(
            uv.v.to_bits() >> ((Uv::FRACTION_BITS - log2_height) & 31),
            log2_height,
        );
        let index = (row << (log2_width & 31)) | column;
        // Wrapping keeps the index inside; the default is never used.
        self.texture
            .texels()
            .get(index as usize)
            .copied()
            .unwrap_or_default()
    }

    #[inline]
    fn fill<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        C: Into<P>,
    {
        // A run of a few pixels, as in small triangles, is not worth packing.
        if const { U::REPEATS && V::REPEATS } && pixels.len() > packed::SHORT {
            packed::fill(&self.texture, uv, step, pixels);
        } else {
            let mut uv = uv;
            for pixel in pixels {
                *pixel = self.sample(uv).into();
                uv = uv + step;
            }
        }
    }
}
