//! Filters within one level of a texture: which texels a coordinate takes, and their weights.

mod linear;

pub use linear::{FourTexels, LinearTexels, LinearTexels5};

use core::ops::Range;

use crate::colour::{Colour, Wide};
use crate::texture::{Texels, Wrap, nearest};
use crate::uv::Uv;
use crate::visibility::{Visibility, by_stretches, first_stretch};

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

    /// [`Self::fill`] for no more than 64 pixels.
    #[inline]
    fn fill_part<T, U, V, P>(&self, texture: &T, uv: Uv, step: Uv, pixels: &mut [P])
    where
        T: Texels<Colour: Colour + Into<P>>,
        U: Wrap,
        V: Wrap,
    {
        self.fill::<T, U, V, P>(texture, uv, step, pixels);
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

    /// Writes those pixels of a run that are seen.
    #[inline]
    fn fill_seen<T, U, V, P>(
        &self,
        texture: &T,
        uv: Uv,
        step: Uv,
        pixels: &mut [P],
        seen: &mut impl Visibility,
    ) where
        T: Texels<Colour: Colour + Into<P>>,
        U: Wrap,
        V: Wrap,
    {
        fill_stretches::<Self, T, U, V, P>(*self, texture, (uv, step), 0..0, pixels, seen);
    }

    /// The same for a run of known length.
    #[inline]
    fn piece_seen<T, U, V, P, const N: usize>(
        &self,
        texture: &T,
        uv: Uv,
        step: Uv,
        pixels: &mut [P; N],
        seen: &mut impl Visibility,
    ) where
        T: Texels<Colour: Colour + Into<P>>,
        U: Wrap,
        V: Wrap,
    {
        piece_stretches::<Self, T, U, V, P, N>(*self, texture, (uv, step), pixels, seen);
    }

    /// Mixes what two levels give at `uv`, `uv + step` and so on, by a weight of
    /// [`BLEND_BITS`](crate::colour::BLEND_BITS); `false`, and nothing is written, if that is no better than one by one, as
    /// of more than 16 pixels.
    #[inline]
    fn blend<T, U, V, P>(
        &self,
        _levels: [&T; 2],
        _weight: u32,
        _uv: Uv,
        _step: Uv,
        _pixels: &mut [P],
    ) -> bool
    where
        T: Texels<Colour: Colour + Into<P>>,
        U: Wrap,
        V: Wrap,
    {
        false
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

/// Fills the stretches of a run that are seen, of which the first is known.
#[inline]
fn fill_stretches<F: ImageFilter, T: Texels<Colour: Colour + Into<P>>, U: Wrap, V: Wrap, P>(
    filter: F,
    texture: &T,
    (uv, step): (Uv, Uv),
    first: Range<usize>,
    pixels: &mut [P],
    seen: &mut impl Visibility,
) {
    by_stretches(first, pixels, seen, |first, pixels| {
        filter.fill_part::<T, U, V, P>(texture, uv.after(step, first), step, pixels);
    });
}

/// The same for a run of known length, which is often seen as a whole.
#[inline]
fn piece_stretches<F, T, U, V, P, const N: usize>(
    filter: F,
    texture: &T,
    (uv, step): (Uv, Uv),
    pixels: &mut [P; N],
    seen: &mut impl Visibility,
) where
    F: ImageFilter,
    T: Texels<Colour: Colour + Into<P>>,
    U: Wrap,
    V: Wrap,
{
    match first_stretch::<N>(seen) {
        None => filter.piece::<T, U, V, P, N>(texture, uv, step, pixels),
        Some(first) => {
            fill_stretches::<F, T, U, V, P>(filter, texture, (uv, step), first, pixels, seen);
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
    fn fill_part<T, U, V, P>(&self, texture: &T, uv: Uv, step: Uv, pixels: &mut [P])
    where
        T: Texels<Colour: Colour + Into<P>>,
        U: Wrap,
        V: Wrap,
    {
        if const { U::REPEATS && V::REPEATS } {
            texture.fill_part_repeating(uv, step, pixels);
        } else {
            self.fill::<T, U, V, P>(texture, uv, step, pixels);
        }
    }

    #[inline]
    fn piece<T, U, V, P, const N: usize>(&self, texture: &T, uv: Uv, step: Uv, pixels: &mut [P; N])
    where
        T: Texels<Colour: Colour + Into<P>>,
        U: Wrap,
        V: Wrap,
    {
        if const { U::REPEATS && V::REPEATS } {
            texture.piece_repeating(uv, step, pixels);
        } else {
            self.fill::<T, U, V, P>(texture, uv, step, pixels);
        }
    }
}

#[cfg(test)]
mod tests {
    use embedded_graphics::pixelcolor::Rgb565;
    use embedded_graphics::pixelcolor::raw::RawU16;

    use super::*;
    use crate::texture::{Repeat, Texture};
    use crate::visibility::tests::{Seen, patterns};

    fn check<F: ImageFilter>(filter: F) {
        const N: usize = 16;
        let texels: [Rgb565; 64 * 32] =
            core::array::from_fn(|i| RawU16::new((i * 40_503) as u16).into());
        let texture = Texture::new(&texels, 64, 32).expect("powers of two");
        for (round, pattern) in patterns::<N>().enumerate() {
            let bits = (round as i32).wrapping_mul(0x0123_4567);
            let (uv, step) = (
                Uv::from_bits(bits >> 2, bits.wrapping_mul(9)),
                Uv::from_bits(bits >> 9, bits.wrapping_mul(5) >> 8),
            );
            let expected: [Option<Rgb565>; N] = core::array::from_fn(|i| {
                let at = uv.after(step, i);
                pattern[i].then(|| filter.texel::<_, Repeat, Repeat>(&texture, at))
            });
            let both = (uv, step);
            let mut pixels = [None; N];
            let mut seen = Seen(&pattern);
            piece_stretches::<F, _, Repeat, Repeat, _, N>(
                filter,
                &texture,
                both,
                &mut pixels,
                &mut seen,
            );
            assert_eq!(pixels, expected);
            let mut pixels = [None; N];
            fill_stretches::<F, _, Repeat, Repeat, _>(
                filter,
                &texture,
                both,
                0..0,
                &mut pixels,
                &mut seen,
            );
            assert_eq!(pixels, expected);
        }
    }

    /// As an Armv7-M fills them.
    #[test]
    fn stretches_are_filled_as_pixels_are() {
        check(NearestTexel);
        check(LinearTexels);
        check(LinearTexels5);
    }
}
