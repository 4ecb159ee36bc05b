//! Filters within one level of a texture: which texels a coordinate takes, and their weights.

use crate::colour::{Colour, Weights};

use crate::texture::{PIECE, Texels, Wrap, around, nearest};
use crate::uv::Uv;

/// A filter within one level.
pub trait ImageFilter: Copy {
    /// The colour at a coordinate.
    fn texel<T, U, V>(&self, texture: &T, uv: Uv) -> T::Colour
    where
        T: Texels<Colour: Colour>,
        U: Wrap,
        V: Wrap;

    /// The same with its fractions, to be mixed with others.
    fn wide<T, U, V>(&self, texture: &T, uv: Uv) -> <T::Colour as Colour>::Wide
    where
        T: Texels<Colour: Colour>,
        U: Wrap,
        V: Wrap;

    /// Fills a run: what [`Self::texel`] gives at `uv`, `uv + step` and so on.
    #[inline]
    fn fill<T, U, V, P>(&self, texture: &T, uv: Uv, step: Uv, pixels: &mut [P])
    where
        T: Texels<Colour: Colour + Into<P>>,
        U: Wrap,
        V: Wrap,
    {
        let mut uv = uv;
        for pixel in pixels {
            *pixel = self.texel::<T, U, V>(texture, uv).into();
            uv = uv + step;
        }
    }

    /// Hands over what [`Self::wide`] gives at `uv`, `uv + step` and so on, each with one of
    /// `items`, of which there are few.
    #[inline]
    fn wides<T, U, V, I>(
        &self,
        texture: &T,
        uv: Uv,
        step: Uv,
        items: I,
        mut each: impl FnMut(I::Item, <T::Colour as Colour>::Wide),
    ) where
        T: Texels<Colour: Colour>,
        U: Wrap,
        V: Wrap,
        I: ExactSizeIterator,
    {
        let mut uv = uv;
        for item in items {
            each(item, self.wide::<T, U, V>(texture, uv));
            uv = uv + step;
        }
    }
}

/// The texel that the coordinate lies in: OpenGL's `NEAREST`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct NearestTexel;

impl ImageFilter for NearestTexel {
    #[inline]
    fn texel<T, U, V>(&self, texture: &T, uv: Uv) -> T::Colour
    where
        T: Texels<Colour: Colour>,
        U: Wrap,
        V: Wrap,
    {
        nearest::<T, U, V>(texture, uv)
    }

    #[inline]
    fn wide<T, U, V>(&self, texture: &T, uv: Uv) -> <T::Colour as Colour>::Wide
    where
        T: Texels<Colour: Colour>,
        U: Wrap,
        V: Wrap,
    {
        nearest::<T, U, V>(texture, uv).widen()
    }

    #[inline]
    fn fill<T, U, V, P>(&self, texture: &T, uv: Uv, step: Uv, pixels: &mut [P])
    where
        T: Texels<Colour: Colour + Into<P>>,
        U: Wrap,
        V: Wrap,
    {
        if const { U::REPEATS && V::REPEATS } {
            texture.fill_repeating(uv, step, pixels);
        } else {
            let mut uv = uv;
            for pixel in pixels {
                *pixel = nearest::<T, U, V>(texture, uv).into();
                uv = uv + step;
            }
        }
    }
}

/// The four texels around the coordinate by their nearness: OpenGL's `LINEAR`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LinearTexels;

impl ImageFilter for LinearTexels {
    #[inline]
    fn texel<T, U, V>(&self, texture: &T, uv: Uv) -> T::Colour
    where
        T: Texels<Colour: Colour>,
        U: Wrap,
        V: Wrap,
    {
        let (texels, weights) = around::<T, U, V>(texture, uv);
        T::Colour::mixed(texels, weights)
    }

    #[inline]
    fn wide<T, U, V>(&self, texture: &T, uv: Uv) -> <T::Colour as Colour>::Wide
    where
        T: Texels<Colour: Colour>,
        U: Wrap,
        V: Wrap,
    {
        let (texels, weights) = around::<T, U, V>(texture, uv);
        T::Colour::mix(texels, weights)
    }

    #[inline]
    fn fill<T, U, V, P>(&self, texture: &T, uv: Uv, step: Uv, pixels: &mut [P])
    where
        T: Texels<Colour: Colour + Into<P>>,
        U: Wrap,
        V: Wrap,
    {
        let mut uv = uv;
        for pixels in pixels.chunks_mut(PIECE) {
            let next = uv.after(step, PIECE);
            fours::<T, U, V, _>(
                texture,
                uv,
                step,
                pixels.iter_mut(),
                |pixel, texels, weights| {
                    *pixel = T::Colour::mixed(texels, weights).into();
                },
            );
            uv = next;
        }
    }

    #[inline]
    fn wides<T, U, V, I>(
        &self,
        texture: &T,
        uv: Uv,
        step: Uv,
        items: I,
        mut each: impl FnMut(I::Item, <T::Colour as Colour>::Wide),
    ) where
        T: Texels<Colour: Colour>,
        U: Wrap,
        V: Wrap,
        I: ExactSizeIterator,
    {
        fours::<T, U, V, _>(texture, uv, step, items, |item, texels, weights| {
            each(item, T::Colour::mix(texels, weights));
        });
    }
}

/// The four texels around `uv`, `uv + step` and so on, each with one of `items`.
#[inline]
fn fours<T: Texels, U: Wrap, V: Wrap, I: ExactSizeIterator>(
    texture: &T,
    uv: Uv,
    step: Uv,
    items: I,
    mut each: impl FnMut(I::Item, [T::Colour; 4], Weights),
) {
    if const { U::REPEATS && V::REPEATS } {
        texture.fours_repeating(uv, step, items, each);
    } else {
        let mut uv = uv;
        for item in items {
            let (texels, weights) = around::<T, U, V>(texture, uv);
            each(item, texels, weights);
            uv = uv + step;
        }
    }
}
