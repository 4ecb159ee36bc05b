//! Filters within one level of a texture: which texels a coordinate takes, and their weights.

use crate::colour::{Colour, ONE, WEIGHT_BITS, Weights};
use crate::texture::{Texels, Wrap, nearest};
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
}

/// The four texels whose centres surround a coordinate, with their weights.
///
/// ```text
///    texel 0     texel 1         texel centres at + 1/2: half a texel is taken off, and
///  |-----+-----|-----+-----|     what is left of the point says which texel is upper left
///        |<-f->*                 and how far it is to the next
/// ```
#[inline]
fn around<T: Texels, U: Wrap, V: Wrap>(texture: &T, uv: Uv) -> ([T::Colour; 4], Weights) {
    let (log2_width, log2_height) = texture.log2_size();
    let (left, right, u) = neighbours::<U>(uv.u.to_bits(), log2_width);
    let (upper, lower, v) = neighbours::<V>(uv.v.to_bits(), log2_height);
    let texels = [
        texture.texel(left, upper),
        texture.texel(right, upper),
        texture.texel(left, lower),
        texture.texel(right, lower),
    ];
    (texels, Weights::new(u, v))
}

/// Along one axis: the two texels, and how far the coordinate is from the first one's centre to
/// the second's, in 2^-11, rounded down.
#[inline]
fn neighbours<W: Wrap>(coordinate: i32, log2_size: u32) -> (u32, u32, u32) {
    // 12 to 24 bits behind the texel's number.
    let below = Uv::FRACTION_BITS.wrapping_sub(log2_size) & 31;
    let from_centre = coordinate.wrapping_sub((1i32 << below) >> 1);
    let first = from_centre >> below;
    let fraction = from_centre >> (below.wrapping_sub(WEIGHT_BITS) & 31);
    (
        W::wrap(first, log2_size),
        W::wrap(first.wrapping_add(1), log2_size),
        fraction.cast_unsigned() & (ONE - 1),
    )
}
