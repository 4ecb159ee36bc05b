//! RGB565 by packed arithmetic: red and blue of a texel are mixed by one multiplication.
//!
//! ```text
//!   bit 31        27 26      16 15       11 10       0
//!   [     red      | fraction ][   blue    | fraction ]    5 bits each times a weight of 11
//! ```
//!
//! A channel of 5 bits times weights that sum to 2^11 fills 16 bits exactly, and the half that
//! rounds it still fits: 31 * 2048 + 1024 < 65536. Green, 6 bits, has a word of its own.

use embedded_graphics::pixelcolor::raw::RawU16;
use embedded_graphics::pixelcolor::{IntoStorage, Rgb565};

use super::lanes::{self, Lanes};
use super::{
    Channel, Channels, Colour, EightMixed, ONE, WEIGHT_BITS, Weights, Wide, channels, light, rgb,
};
use crate::simd::{COUNT, EIGHTS, U16x8, U32x8};

/// One half in both channels of the first word.
const HALVES: u32 = ((ONE / 2) << 16) | (ONE / 2);

/// Red and blue in one word, green where it is in a pixel.
#[inline]
fn spread(texel: Rgb565) -> (u32, u32) {
    let bits = u32::from(texel.into_storage());
    ((bits | bits << 5) & 0x001f_001f, bits & 0x7e0)
}

/// The weighted sums of both words.
#[inline]
fn sums(texels: [Rgb565; 4], weights: Weights) -> (u32, u32) {
    let (mut red_blue, mut green) = (0u32, 0u32);
    for (texel, weight) in texels.into_iter().zip(weights.0) {
        let (rb, g) = spread(texel);
        red_blue = red_blue.wrapping_add(rb.wrapping_mul(weight));
        green = green.wrapping_add(g.wrapping_mul(weight));
    }
    (red_blue, green)
}

/// All channels of a pixel in one word, where green leaves its place between the others:
///
/// ```text
///   bit 31   27 26   21 20   16 15  11 10    5 4    0
///   [  free   | green  |  free | red  |  free | blue ]
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lanes565(u32);

impl Lanes565 {
    const MASK: u32 = 0x07e0_f81f;
    /// The lowest bit of each channel.
    const LOWEST: u32 = 0x0020_0801;
}

impl Wide for Lanes565 {
    #[inline]
    fn lerp(self, other: Self, weight: u32) -> Self {
        self.mix(other, lanes::of_blend(weight))
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }

    #[inline]
    fn half(self, times: u32) -> Self {
        Self(lanes::half(self.0, times, Self::LOWEST, Self::MASK))
    }
}

impl Lanes for Lanes565 {
    #[inline]
    fn mix(self, other: Self, weight: u32) -> Self {
        let (lowest, mask) = (Self::LOWEST, Self::MASK);
        Self(lanes::mix(self.0, other.0, weight, lowest, mask))
    }
}

/// The channels of eight pixels.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lanes565x8([U16x8; 3]);

impl Lanes565x8 {
    /// Of texels, each by its number.
    #[inline(always)]
    fn of(numbers: U16x8, texel: impl Fn(u16) -> Rgb565) -> Self {
        let bits = numbers.through(|number| texel(number).into_storage());
        Self([bits.down(11), bits.down(5).and(0x3f), bits.and(0x1f)])
    }

    /// See [`Lanes::mix`].
    #[inline(always)]
    fn mix(self, other: Self, weight: U16x8) -> Self {
        let ([a, b, c], [d, e, f]) = (self.0, other.0);
        Self([a.to(d, weight), b.to(e, weight), c.to(f, weight)])
    }
}

impl EightMixed<Rgb565> for Lanes565x8 {
    #[inline(always)]
    fn new(
        [upper_left, upper_right, lower_left, lower_right]: [U16x8; 4],
        texel: impl Fn(u16) -> Rgb565,
        [u, v]: [U16x8; 2],
    ) -> Self {
        // As few at a time as registers hold.
        let left = Self::of(upper_left, &texel);
        let left = left.mix(Self::of(lower_left, &texel), v);
        let right = Self::of(upper_right, &texel);
        let right = right.mix(Self::of(lower_right, &texel), v);
        left.mix(right, u)
    }

    #[inline(always)]
    fn lerp(self, other: Self, weight: u32) -> Self {
        self.mix(other, U16x8::splat(lanes::of_blend(weight) as u16))
    }

    #[inline(always)]
    fn colours(self) -> [Rgb565; COUNT] {
        let Self([red, green, blue]) = self;
        let bits = red.up(11).or(green.up(5)).or(blue);
        bits.array().map(|bits| RawU16::new(bits).into())
    }
}

/// Weighted sums of the channels of eight pixels: red and blue fit 16 bits, as above.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sums565x8 {
    red: U16x8,
    green: U32x8,
    blue: U16x8,
}

impl Sums565x8 {
    /// Of two of the texels.
    #[inline(always)]
    fn of([a, b]: [U16x8; 2], texel: impl Fn(u16) -> Rgb565, weights: [U16x8; 2]) -> Self {
        let Lanes565x8([red_a, green_a, blue_a]) = Lanes565x8::of(a, &texel);
        let Lanes565x8([red_b, green_b, blue_b]) = Lanes565x8::of(b, &texel);
        let [weight_a, weight_b] = weights;
        let sum = |a: U16x8, b: U16x8| a.times(weight_a).plus(b.times(weight_b));
        Self {
            red: sum(red_a, red_b),
            green: U16x8::dot([green_a, green_b], weights),
            blue: sum(blue_a, blue_b),
        }
    }
}

impl EightMixed<Rgb565> for Sums565x8 {
    #[inline(always)]
    fn new(
        [upper_left, upper_right, lower_left, lower_right]: [U16x8; 4],
        texel: impl Fn(u16) -> Rgb565,
        [u, v]: [U16x8; 2],
    ) -> Self {
        const DOWN: u32 = u16::BITS - WEIGHT_BITS;
        // As `Weights::new` has it.
        let both = u.up(DOWN).times_high(v);
        let (right, below) = (u.minus(both), v.minus(both));
        let neither = U16x8::splat(ONE as u16).minus(u).minus(below);
        let upper = Self::of([upper_left, upper_right], &texel, [neither, right]);
        let lower = Self::of([lower_left, lower_right], &texel, [below, both]);
        Self {
            red: upper.red.plus(lower.red),
            green: upper.green.plus(lower.green),
            blue: upper.blue.plus(lower.blue),
        }
    }

    #[inline(always)]
    fn lerp(self, other: Self, weight: u32) -> Self {
        Self {
            red: self.red.lerp(other.red, weight),
            green: self.green.lerp(other.green, weight),
            blue: self.blue.lerp(other.blue, weight),
        }
    }

    #[inline(always)]
    fn colours(self) -> [Rgb565; COUNT] {
        const HALF: u32 = ONE / 2;
        let rounded = |sum: U16x8| sum.plus(U16x8::splat(HALF as u16)).down(WEIGHT_BITS);
        let green = self.green.plus(U32x8::splat(HALF));
        let green = green.down::<{ WEIGHT_BITS.cast_signed() }>();
        Lanes565x8([rounded(self.red), green, rounded(self.blue)]).colours()
    }
}

impl Colour for Rgb565 {
    type Wide = Channels<3>;
    type Lanes = Lanes565;
    type EightWide = Sums565x8;
    type EightLanes = Lanes565x8;

    #[inline]
    fn widen(self) -> Channels<3> {
        Channels::of(rgb(self))
    }

    #[inline]
    fn narrow(wide: Channels<3>) -> Self {
        let [r, g, b] = wide.rounded();
        RawU16::new((r << 11 | g << 5 | b) as u16).into()
    }

    #[inline]
    fn mix(texels: [Self; 4], weights: Weights) -> Channels<3> {
        let (red_blue, green) = sums(texels, weights);
        Channels([red_blue >> 16, green >> 5, red_blue & 0xffff])
    }

    #[inline]
    fn mixed(texels: [Self; 4], weights: Weights) -> Self {
        let (red_blue, green) = sums(texels, weights);
        let red_blue = red_blue.wrapping_add(HALVES);
        let green = green.wrapping_add((ONE / 2) << 5) >> WEIGHT_BITS;
        let bits = (red_blue >> 16 & 0xf800) | green & 0x7e0 | (red_blue >> WEIGHT_BITS & 0x1f);
        RawU16::new(bits as u16).into()
    }

    #[inline]
    fn spread(self) -> Lanes565 {
        let bits = u32::from(self.into_storage());
        Lanes565((bits | bits << 16) & Lanes565::MASK)
    }

    #[inline]
    fn gather(Lanes565(bits): Lanes565) -> Self {
        RawU16::new((bits | bits >> 16) as u16).into()
    }

    const HAS_EIGHTS: bool = EIGHTS;

    fn by_channel(texels: [Self; 4], each: impl Fn(Channel, [u32; 4]) -> u32) -> Self {
        let kinds = [light(5), light(6), light(5)];
        let [r, g, b] = channels(texels.map(rgb), kinds, each);
        Self::new(r as u8, g as u8, b as u8)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use embedded_graphics::pixelcolor::RgbColor;

    use super::super::Fractions;
    use super::*;

    /// Packed or channel by channel, the result is the same.
    #[test]
    fn packed_channels_do_not_touch() {
        let mut state = 7u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state >> 16
        };
        let check = |texels: [Rgb565; 4], u: u32, v: u32| {
            let weights = Weights::new(Fractions { u, v });
            let wide = Channels::mixed(texels.map(rgb), weights);
            assert_eq!(Rgb565::mix(texels, weights), wide, "{texels:?} {u} {v}");
            assert_eq!(
                Rgb565::mixed(texels, weights),
                Rgb565::narrow(wide),
                "{texels:?} {u} {v}"
            );
        };
        for (u, v) in [(0, 0), (2047, 2047), (1024, 1024), (2047, 0), (1, 2046)] {
            check([Rgb565::WHITE; 4], u, v);
            check([Rgb565::MAGENTA; 4], u, v);
            check([Rgb565::GREEN; 4], u, v);
        }
        for _ in 0..100_000 {
            let texels = [0; 4].map(|_| RawU16::new(next() as u16).into());
            check(texels, next(), next());
        }
    }
}
