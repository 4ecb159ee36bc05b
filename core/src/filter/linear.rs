//! Filters of four texels: bilinear.

use super::{ImageFilter, fill_stretches, piece_stretches};
use crate::arith::SHIFTS_OPERANDS;
use crate::colour::{Colour, Fractions, LANE_BITS, Lanes as _, WEIGHT_BITS, Weights, Wide};
use crate::texture::{PIECE, Texels, Wrap, around};
use crate::uv::Uv;
use crate::visibility::{Candidate as _, Visibility};

/// What is made of the four texels around a coordinate; all else is the same for every such filter.
pub trait FourTexels: Copy {
    /// What it gives to be mixed with others.
    type Wide<C: Colour>: Wide;

    /// Rounds to the nearest colour.
    fn narrow<C: Colour>(wide: Self::Wide<C>) -> C;

    /// Where the coordinate is looked for.
    #[inline]
    fn place<T: Texels>(_texture: &T, uv: Uv) -> Uv {
        uv
    }

    /// The mean of four texels: upper left, upper right, lower left, lower right.
    fn mix<C: Colour>(texels: [C; 4], between: Fractions) -> Self::Wide<C>;

    /// The same, rounded.
    #[inline]
    fn mixed<C: Colour>(texels: [C; 4], between: Fractions) -> C {
        Self::narrow(Self::mix(texels, between))
    }
}

/// The four texels around the coordinate by their nearness: OpenGL's `LINEAR`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LinearTexels;

impl FourTexels for LinearTexels {
    type Wide<C: Colour> = C::Wide;

    #[inline]
    fn narrow<C: Colour>(wide: C::Wide) -> C {
        C::narrow(wide)
    }

    #[inline]
    fn mix<C: Colour>(texels: [C; 4], between: Fractions) -> C::Wide {
        C::mix(texels, Weights::new(between))
    }

    #[inline]
    fn mixed<C: Colour>(texels: [C; 4], between: Fractions) -> C {
        C::mixed(texels, Weights::new(between))
    }
}

/// [`LinearTexels`] with 5 bits of subtexel precision, of which Vulkan asks 4 at least: a coordinate is
/// rounded to the nearest 1/32 of a texel, and the four texels are mixed along v first, then along
/// u, all channels of an RGB565 texel by one multiplication.
///
/// Where a channel's four values span c, it is off by at most `c / 32 + 1`: 1/64 of a texel along
/// each axis, and one half for each rounding. Of 8 bits a channel that is much; it is meant for
/// RGB565.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LinearTexels5;

impl FourTexels for LinearTexels5 {
    type Wide<C: Colour> = C::Lanes;

    #[inline]
    fn narrow<C: Colour>(lanes: C::Lanes) -> C {
        C::gather(lanes)
    }

    /// Half a step further; what is behind a step is dropped then.
    #[inline]
    fn place<T: Texels>(texture: &T, uv: Uv) -> Uv {
        const STEP: u32 = Uv::FRACTION_BITS - LANE_BITS;
        let (log2_width, log2_height) = texture.log2_size();
        // Sides of at most 2^12 leave 6 bits.
        let half = |log2: u32| 1 << ((STEP - 1).wrapping_sub(log2) & 31);
        uv + Uv::from_bits(half(log2_width), half(log2_height))
    }

    #[inline]
    fn mix<C: Colour>(texels: [C; 4], between: Fractions) -> C::Lanes {
        let [upper_left, upper_right, lower_left, lower_right] = texels.map(C::spread);
        let weight = |fraction: u32| fraction >> (WEIGHT_BITS - LANE_BITS);
        let left = upper_left.mix(lower_left, weight(between.v));
        let right = upper_right.mix(lower_right, weight(between.v));
        left.mix(right, weight(between.u))
    }
}

/// Whether depths are tested before the loop over four texels, and not in it: an Armv7-M has the registers for one of
/// both; an Armv6-M has them for neither, and others for both.
const BY_STRETCHES: bool = SHIFTS_OPERANDS;

impl<F: FourTexels> ImageFilter for F {
    type Wide<C: Colour> = <F as FourTexels>::Wide<C>;

    #[inline]
    fn narrow<C: Colour>(wide: Self::Wide<C>) -> C {
        <F as FourTexels>::narrow(wide)
    }

    #[inline]
    fn texel<T, U, V>(&self, texture: &T, uv: Uv) -> T::Colour
    where
        T: Texels<Colour: Colour>,
        U: Wrap,
        V: Wrap,
    {
        let (texels, between) = around::<T, U, V>(texture, F::place(texture, uv));
        F::mixed(texels, between)
    }

    #[inline]
    fn wide<T, U, V>(&self, texture: &T, uv: Uv) -> Self::Wide<T::Colour>
    where
        T: Texels<Colour: Colour>,
        U: Wrap,
        V: Wrap,
    {
        let (texels, between) = around::<T, U, V>(texture, F::place(texture, uv));
        F::mix(texels, between)
    }

    #[inline]
    fn fill<T, U, V, P>(&self, texture: &T, uv: Uv, step: Uv, pixels: &mut [P])
    where
        T: Texels<Colour: Colour + Into<P>>,
        U: Wrap,
        V: Wrap,
    {
        let mut uv = F::place(texture, uv);
        for pixels in pixels.chunks_mut(PIECE) {
            let pixels = pixels.iter_mut();
            fours::<T, U, V, _>(texture, uv, step, pixels, set::<F, _, _>);
            uv = uv.after(step, PIECE);
        }
    }

    #[inline]
    fn piece<T, U, V, P, const N: usize>(&self, texture: &T, uv: Uv, step: Uv, pixels: &mut [P; N])
    where
        T: Texels<Colour: Colour + Into<P>>,
        U: Wrap,
        V: Wrap,
    {
        let (uv, pixels) = (F::place(texture, uv), pixels.iter_mut());
        fours::<T, U, V, _>(texture, uv, step, pixels, set::<F, _, _>);
    }

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
        if const { BY_STRETCHES } {
            fill_stretches::<F, T, U, V, P>(*self, texture, (uv, step), 0..0, pixels, seen);
            return;
        }
        let uv = F::place(texture, uv);
        let pixels = seen.among(pixels);
        fours::<T, U, V, _>(texture, uv, step, pixels, |pixel, texels, between| {
            pixel.write(|pixel| {
                set::<F, _, _>(pixel, texels, between);
                true
            });
        });
    }

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
        if const { BY_STRETCHES } {
            piece_stretches::<F, T, U, V, P, N>(*self, texture, (uv, step), pixels, seen);
        } else {
            self.fill_seen::<T, U, V, P>(texture, uv, step, pixels, seen);
        }
    }

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
        let uv = F::place(texture, uv);
        fours::<T, U, V, _>(texture, uv, step, items, |item, texels, between| {
            each(item, F::mix(texels, between));
        });
    }
}

/// Gives a pixel the mean of four texels.
// A function and not a closure, so that all who fill share the loop that it is in.
#[inline]
fn set<F: FourTexels, C: Colour + Into<P>, P>(pixel: &mut P, texels: [C; 4], between: Fractions) {
    *pixel = F::mixed(texels, between).into();
}

/// The four texels around `uv`, `uv + step` and so on, each with one of `items`.
#[inline]
fn fours<T: Texels, U: Wrap, V: Wrap, I: ExactSizeIterator>(
    texture: &T,
    uv: Uv,
    step: Uv,
    items: I,
    mut each: impl FnMut(I::Item, [T::Colour; 4], Fractions),
) {
    if const { U::REPEATS && V::REPEATS } {
        texture.fours_repeating(uv, step, items, each);
    } else {
        let mut uv = uv;
        for item in items {
            let (texels, between) = around::<T, U, V>(texture, uv);
            each(item, texels, between);
            uv = uv + step;
        }
    }
}
