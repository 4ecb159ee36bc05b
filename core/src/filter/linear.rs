//! Filters of four texels: bilinear.

use super::{ImageFilter, fill_stretches, piece_stretches};
use crate::arith::SHIFTS_OPERANDS;
use crate::colour::{
    ByLanes, ByWeights, Colour, Fractions, LANE_BITS, Lanes as _, MixesEights, WEIGHT_BITS,
    Weights, Wide,
};
use crate::simd::EIGHTS;
use crate::texture::{BLENDED, PIECE, Texels, Wrap, around};
use crate::uv::Uv;
use crate::visibility::{Candidate as _, Visibility};

/// What is made of the four texels around a coordinate; all else is the same for every such filter.
pub trait FourTexels: Copy {
    /// What it gives to be mixed with others.
    type Wide<C: Colour>: Wide;

    /// How it mixes for eight pixels at a time.
    type Eights: MixesEights;

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
    type Eights = ByWeights;

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
    type Eights = ByLanes;

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
        if const { EIGHTS }
            && const { by_eights::<T, U, V>() }
            && fill_eights::<F::Eights, T, P>(texture, uv, step, pixels)
        {
            return;
        }
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
        let uv = F::place(texture, uv);
        if const { EIGHTS }
            && const { by_eights::<T, U, V>() }
            && piece_eights::<F::Eights, T, P, N>(texture, uv, step, pixels)
        {
            return;
        }
        let pixels = pixels.iter_mut();
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
        if const { BY_STRETCHES }
            || const { EIGHTS } && const { by_eights::<T, U, V>() } && pixels.len() > FEW
        {
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
        if const { BY_STRETCHES } || const { EIGHTS } && const { by_eights::<T, U, V>() } {
            piece_stretches::<F, T, U, V, P, N>(*self, texture, (uv, step), pixels, seen);
        } else {
            self.fill_seen::<T, U, V, P>(texture, uv, step, pixels, seen);
        }
    }

    #[inline]
    fn blend<T, U, V, P>(
        &self,
        levels: [&T; 2],
        weight: u32,
        uv: Uv,
        step: Uv,
        pixels: &mut [P],
    ) -> bool
    where
        T: Texels<Colour: Colour + Into<P>>,
        U: Wrap,
        V: Wrap,
    {
        if const { !by_eights::<T, U, V>() } || !(FEW + 1..=BLENDED).contains(&pixels.len()) {
            return false;
        }
        let levels = levels.map(|level| (level, F::place(level, uv)));
        T::eights_between::<P, F::Eights>(levels, weight, step, pixels)
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

/// As few pixels as are filled faster one by one.
const FEW: usize = 3;

/// Whether pixels are filled eight at a time, as far as the types say.
// Who asks has to ask `EIGHTS` before: that needs no types, so that where there are none nothing is left of the question
// when the compiler decides on what to inline.
const fn by_eights<T: Texels<Colour: Colour>, U: Wrap, V: Wrap>() -> bool {
    <T::Colour as Colour>::HAS_EIGHTS && U::REPEATS && V::REPEATS
}

/// Fills a run eight pixels at a time; `false`, and nothing is written, if that cannot be or does not pay.
#[inline(never)]
fn fill_eights<M: MixesEights, T, P>(texture: &T, uv: Uv, step: Uv, pixels: &mut [P]) -> bool
where
    T: Texels<Colour: Colour + Into<P>>,
{
    pixels.len() > FEW && texture.eights_repeating::<P, M>(uv, step, pixels)
}

/// The same for a run of known length.
#[inline(always)]
fn piece_eights<M: MixesEights, T, P, const N: usize>(
    texture: &T,
    uv: Uv,
    step: Uv,
    pixels: &mut [P; N],
) -> bool
where
    T: Texels<Colour: Colour + Into<P>>,
{
    N > FEW && texture.eights_repeating::<P, M>(uv, step, pixels)
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

#[cfg(test)]
mod tests {
    extern crate std;

    use std::vec::Vec;

    use embedded_graphics::pixelcolor::Rgb565;
    use embedded_graphics::pixelcolor::raw::RawU16;

    use super::*;
    use crate::colour::BLEND_BITS;
    use crate::texture::{Repeat, SizedTexture, Texture};

    const COLOURS: usize = 1 << 17;

    fn colours() -> Vec<Rgb565> {
        let mut state = 1u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            RawU16::new((state >> 16) as u16).into()
        };
        (0..COLOURS).map(|_| next()).collect()
    }

    /// Places and steps: any, those of a run that is worth filtering, and along the edges of the texture.
    fn runs(seed: u32) -> impl Iterator<Item = (Uv, Uv)> {
        let mut state = seed;
        let mut next = move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state ^ state >> 15).cast_signed()
        };
        (0..60).map(move |run| {
            let steep = [0, 8, 16, 24][run % 4];
            let step = Uv::from_bits(next() >> steep, next() >> steep);
            let edge = [-1, 0x00ff_ffff, 0x00ff_ff00][run % 3];
            let uv = Uv::from_bits(next() & edge, next() & edge);
            (uv, step)
        })
    }

    /// Checks a texture, of which eights may or may not be filled.
    fn check<T: Texels<Colour = Rgb565>>(texture: &T, fits: bool) {
        check_filter(LinearTexels, texture, fits);
        check_filter(LinearTexels5, texture, fits);
    }

    fn check_filter<F: FourTexels, T: Texels<Colour = Rgb565>>(filter: F, texture: &T, fits: bool) {
        let (log2_width, log2_height) = texture.log2_size();
        for (run, (uv, step)) in runs(log2_width * 16 + log2_height).enumerate() {
            let expected: [Rgb565; 40] = core::array::from_fn(|pixel| {
                filter.texel::<_, Repeat, Repeat>(texture, uv.after(step, pixel))
            });
            let context = (log2_width, log2_height, uv, step);
            let length = run % 40 + 1;
            let blank = [Rgb565::default(); 40];
            let mut pixels = blank;
            let place = F::place(texture, uv);
            let few = &mut pixels[..length];
            let filled = texture.eights_repeating::<_, F::Eights>(place, step, few);
            assert_eq!(filled, fits, "{context:?}");
            if filled {
                assert_eq!(pixels[..length], expected[..length], "{context:?}");
            }
            assert!(pixels[length..] == blank[length..], "{context:?}");
            pixels = blank;
            filter.fill::<_, Repeat, Repeat, _>(texture, uv, step, &mut pixels[..length]);
            assert_eq!(pixels[..length], expected[..length], "{context:?}");
            let mut piece = [Rgb565::default(); 16];
            filter.piece::<_, Repeat, Repeat, _, 16>(texture, uv, step, &mut piece);
            assert_eq!(piece, expected[..16], "{context:?}");
        }
    }

    /// Whether by eights, with a rest or without, or one by one.
    #[test]
    fn all_ways_give_the_same_bits() {
        let colours = colours();
        let of_size = |log2_width: u32, log2_height: u32, fits| {
            let texels = &colours[..1 << (log2_width + log2_height)];
            let texture = Texture::new(texels, 1 << log2_width, 1 << log2_height);
            check(&texture.expect("powers of two"), fits);
        };
        for log2_height in 0..=11 {
            of_size(0, log2_height, true);
            of_size(log2_height, 0, true);
            of_size(5, log2_height, true);
        }
        of_size(11, 5, true);
        of_size(8, 8, true);
        of_size(8, 9, false);
        of_size(9, 8, false);
        of_size(12, 0, false);
        of_size(0, 12, false);
        let sized = colours.first_chunk().expect("as many");
        check(
            &SizedTexture::<_, 1, 1>::new(sized.first_chunk().expect("one")),
            true,
        );
        check(&SizedTexture::<_, 256, 65_536>::new(sized), true);
        let sized = colours.first_chunk().expect("as many");
        check(&SizedTexture::<_, 16, 2_048>::new(sized), true);
        let sized = colours.first_chunk().expect("as many");
        check(&SizedTexture::<_, 4_096, 8_192>::new(sized), false);
    }

    /// Two levels, by all weights.
    #[test]
    fn levels_are_blended_as_one_by_one() {
        let colours = colours();
        let level = |log2: u32| {
            let texels = &colours[1 << log2..][..1 << (2 * log2)];
            Texture::new(texels, 1 << log2, 1 << log2).expect("powers of two")
        };
        check_blend(LinearTexels5, [&level(6), &level(5)]);
        check_blend(LinearTexels, [&level(5), &level(6)]);
    }

    fn check_blend<F: FourTexels>(filter: F, levels: [&Texture<'_, Rgb565>; 2]) {
        const MOST: usize = BLENDED + 4;
        for weight in 0..1u32 << BLEND_BITS {
            let (uv, step) = runs(weight).nth(weight as usize % 60).expect("so many");
            let length = weight as usize % MOST + 1;
            let mut pixels = [Rgb565::default(); MOST];
            let blended = filter.blend::<_, Repeat, Repeat, _>(
                levels,
                weight,
                uv,
                step,
                &mut pixels[..length],
            );
            assert_eq!(blended, EIGHTS && length > FEW && length <= BLENDED);
            for (pixel, colour) in pixels[..length].iter().enumerate() {
                let uv = uv.after(step, pixel);
                let [fine, coarse] =
                    levels.map(|level| filter.wide::<_, Repeat, Repeat>(level, uv));
                let one: Rgb565 = <F as FourTexels>::narrow(fine.lerp(coarse, weight));
                assert!(
                    !blended || *colour == one,
                    "{weight} {uv:?} {step:?} {pixel}"
                );
            }
            assert!(
                pixels[length..]
                    .iter()
                    .all(|&colour| colour == Rgb565::default())
            );
        }
    }
}
