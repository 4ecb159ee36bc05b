//! Filters within one level of a texture: which texels a coordinate takes, and their weights.

mod linear;

pub use linear::{FourTexels, LinearTexels, LinearTexels5};

use crate::colour::{Colour, Wide};
use crate::texture::{Texels, Wrap, fill_seen, nearest};
use crate::uv::Uv;
use crate::visibility::{Candidate as _, Visibility};

/// A filter within one level.
pub trait ImageFilter: Copy {
    /// What it gives to be mixed with others.
    type Wide<C: Colour>: Wide;

    /// Rounds to the nearest colour.
    fn narrow<C: Colour>(wide: Self::Wide<C>) -> C;

    /// The colour at a coordinate.
    fn texel<T, U, V>(&self, texture: &T, uv: Uv) -> T::Colour
    where
        T: Texels<Colour: Colour>,
        U: Wrap,
        V: Wrap;

    /// The same, to be mixed with others.
    fn wide<T, U, V>(&self, texture: &T, uv: Uv) -> Self::Wide<T::Colour>
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

    /// [`Self::fill`] for a run of known length.
    #[inline]
    fn piece<T, U, V, P, const N: usize>(&self, texture: &T, uv: Uv, step: Uv, pixels: &mut [P; N])
    where
        T: Texels<Colour: Colour + Into<P>>,
        U: Wrap,
        V: Wrap,
    {
        self.fill::<T, U, V, P>(texture, uv, step, pixels);
    }

    /// Writes those pixels of a run from number `first` on that are seen; `uv` is that of number
    /// `first`, of those before it nothing is asked.
    #[inline]
    fn fill_seen<T, U, V, P>(
        &self,
        texture: &T,
        uv: Uv,
        step: Uv,
        (first, pixels): (usize, &mut [P]),
        seen: &mut impl Visibility,
    ) where
        T: Texels<Colour: Colour + Into<P>>,
        U: Wrap,
        V: Wrap,
    {
        let mut uv = uv;
        for pixel in seen.among(first, pixels.get_mut(first..).unwrap_or_default()) {
            pixel.write(|pixel| {
                *pixel = self.texel::<T, U, V>(texture, uv).into();
                true
            });
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
        mut each: impl FnMut(I::Item, Self::Wide<T::Colour>),
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
    type Wide<C: Colour> = C::Wide;

    #[inline]
    fn narrow<C: Colour>(wide: C::Wide) -> C {
        C::narrow(wide)
    }

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
    fn wide<T, U, V>(&self, texture: &T, uv: Uv) -> Self::Wide<T::Colour>
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

    #[inline]
    fn fill_seen<T, U, V, P>(
        &self,
        texture: &T,
        uv: Uv,
        step: Uv,
        (first, pixels): (usize, &mut [P]),
        seen: &mut impl Visibility,
    ) where
        T: Texels<Colour: Colour + Into<P>>,
        U: Wrap,
        V: Wrap,
    {
        let pixels = (first, pixels.get_mut(first..).unwrap_or_default());
        if const { U::REPEATS && V::REPEATS } {
            texture.fill_seen_repeating(uv, step, pixels, seen);
        } else {
            fill_seen::<T, U, V, _>(texture, uv, step, pixels, seen);
        }
    }
}
