//! Channels side by side in a word, a fast way to mix two colours by weights of few bits.

use super::{BLEND_BITS, Wide};

/// Bits of the weight between two colours whose channels share words.
pub const LANE_BITS: u32 = 5;

/// A colour whose channels lie apart in words, with [`LANE_BITS`] free above each.
pub trait Lanes: Wide {
    /// From `self` to `other`; `weight` in `0 ..= 2^`[`LANE_BITS`]. Rounds each channel to the
    /// nearest value, halves up.
    #[must_use]
    fn mix(self, other: Self, weight: u32) -> Self;
}

/// One of a word's layouts: as many multiplications as words, instead of channels.
///
/// ```text
///   self 2^5 + (other - self) weight = self (2^5 - weight) + other weight
/// ```
///
/// Differences borrow from the channel above, but what the right side says is added up holds in
/// each channel: it is never negative and below 2^5 times the channel's greatest value, 1/2 included.
#[inline]
pub(super) fn mix(one: u32, other: u32, weight: u32, lowest: u32, mask: u32) -> u32 {
    let halves = lowest << (LANE_BITS - 1);
    let whole = (one << LANE_BITS).wrapping_add(halves);
    let change = other.wrapping_sub(one).wrapping_mul(weight);
    whole.wrapping_add(change) >> LANE_BITS & mask
}

/// The weight between two levels, in the bits of lanes.
#[inline]
pub(super) fn of_blend(weight: u32) -> u32 {
    const DROPPED: u32 = BLEND_BITS - LANE_BITS;
    weight.wrapping_add(1 << (DROPPED - 1)) >> DROPPED
}

/// A sum of `2^times` colours, `times` up to 3, divided by their number; rounds to the nearest.
#[inline]
pub(super) fn half(sum: u32, times: u32, lowest: u32, mask: u32) -> u32 {
    let times = times & 3;
    let halves = lowest.wrapping_mul((1 << times) >> 1);
    sum.wrapping_add(halves) >> times & mask
}

/// Up to 8 bits in each half of `N` words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pairs<const N: usize>(pub(super) [u32; N]);

/// The lowest bit of each channel.
const LOWEST: u32 = 0x0001_0001;

/// All bits of the channels.
const MASK: u32 = 0x00ff_00ff;

impl<const N: usize> Default for Pairs<N> {
    fn default() -> Self {
        Self([0; N])
    }
}

impl<const N: usize> Pairs<N> {
    #[inline]
    fn with(self, other: Self, f: impl Fn(u32, u32) -> u32) -> Self {
        let mut result = self;
        for (a, b) in result.0.iter_mut().zip(other.0) {
            *a = f(*a, b);
        }
        result
    }
}

impl<const N: usize> Wide for Pairs<N> {
    #[inline]
    fn lerp(self, other: Self, weight: u32) -> Self {
        self.mix(other, of_blend(weight))
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        self.with(other, u32::wrapping_add)
    }

    #[inline]
    fn half(self, times: u32) -> Self {
        Self(self.0.map(|sum| half(sum, times, LOWEST, MASK)))
    }
}

impl<const N: usize> Lanes for Pairs<N> {
    #[inline]
    fn mix(self, other: Self, weight: u32) -> Self {
        self.with(other, |a, b| mix(a, b, weight, LOWEST, MASK))
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use core::fmt::Debug;

    use embedded_graphics::pixelcolor::raw::RawU16;
    use embedded_graphics::pixelcolor::{Gray8, Rgb565, Rgb888};

    use super::super::{
        BLEND_BITS, Colour, EightMixed as _, Fractions, Rgba5551, Rgba8888, WEIGHT_BITS, Weights,
        Wide,
    };
    use super::{LANE_BITS, Lanes};
    use crate::simd::U16x8;

    /// Mixes and means of colours against those of each channel.
    fn check<C: Colour + PartialEq + Debug>(mut colour: impl FnMut() -> C) {
        for round in 0..2000 {
            let [a, b, c, d] = core::array::from_fn(|_| colour());
            assert_eq!(C::gather(a.spread()), a);
            for weight in 0..=1u32 << LANE_BITS {
                let expected = C::by_channel([a, b, c, d], |_, [a, b, ..]| {
                    (a * (32 - weight) + b * weight + 16) / 32
                });
                let mixed = C::gather(a.spread().mix(b.spread(), weight));
                assert_eq!(mixed, expected, "{a:?} {b:?} {weight}");
            }
            // Between two levels, weights of 12 bits.
            let weight = round * 41 % ((1 << BLEND_BITS) + 1);
            let rounded = (weight + 64) / 128;
            let blended = a.spread().lerp(b.spread(), weight);
            let mixed = a.spread().mix(b.spread(), rounded);
            assert_eq!(C::gather(blended), C::gather(mixed), "{weight}");
            // Four texels are as many as `by_channel` takes: eight of them are some of them again.
            let eight = [a, b, c, d, d, c, d, d];
            for times in 0..=3 {
                let lanes = eight.iter().take(1 << times).map(|c| c.spread());
                let sum = lanes.fold(C::Lanes::default(), Wide::plus);
                let expected = C::by_channel([a, b, c, d], |_, [a, b, c, d]| match times {
                    0 => a,
                    1 => (a + b).div_ceil(2),
                    2 => (a + b + c + d + 2) / 4,
                    _ => (a + b + 2 * c + 4 * d + 4) / 8,
                });
                assert_eq!(C::gather(sum.half(times)), expected, "{eight:?} {times}");
            }
        }
    }

    /// What eight pixels get at a time is what each gets by itself.
    fn check_eights<C: Colour + PartialEq + Debug>(mut colour: impl FnMut() -> C) {
        let mut state = 9u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) as u16
        };
        for round in 0..2000 {
            let texels: [C; 32] = core::array::from_fn(|_| colour());
            let texel = |number: u16| texels[usize::from(number)];
            let numbers = [[0; 8]; 4].map(|eight| eight.map(|_: u16| next() % 32));
            let eights = numbers.map(U16x8::new);
            // One in four is at an end.
            let mut weights = |bits: u32| {
                let mask = (1u16 << bits) - 1;
                [[0; 8]; 2].map(|eight| {
                    eight.map(|_: u16| {
                        [0, mask, next() & mask, next() & mask][usize::from(next() % 4)]
                    })
                })
            };
            let few = weights(LANE_BITS);
            let many = weights(WEIGHT_BITS);
            let few_of = few.map(U16x8::new);
            let many_of = many.map(U16x8::new);
            let mixed = C::EightLanes::new(eights, texel, few_of);
            let mean = C::EightWide::new(eights, texel, many_of);
            // Of the same texels in another order.
            let [a, b, c, d] = eights;
            let weight = round * 41 % ((1 << BLEND_BITS) + 1);
            let other = C::EightLanes::new([d, b, a, c], texel, few_of);
            let between = mixed.lerp(other, weight).colours();
            let other = C::EightWide::new([d, b, a, c], texel, many_of);
            let mean_between = mean.lerp(other, weight).colours();
            let (mixed, mean) = (mixed.colours(), mean.colours());
            for pixel in 0..8 {
                let texels = numbers.map(|eight| texel(eight[pixel]));
                let [a, b, c, d] = texels.map(C::spread);
                let [u, v] = few.map(|weights| u32::from(weights[pixel]));
                let expected = a.mix(c, v).mix(b.mix(d, v), u);
                assert_eq!(mixed[pixel], C::gather(expected), "{texels:?} {u} {v}");
                let other = d.mix(a, v).mix(b.mix(c, v), u);
                let expected = C::gather(expected.lerp(other, weight));
                assert_eq!(between[pixel], expected, "{texels:?} {u} {v} {weight}");
                let [u, v] = many.map(|weights| u32::from(weights[pixel]));
                let weights = Weights::new(Fractions { u, v });
                let expected = C::mixed(texels, weights);
                assert_eq!(mean[pixel], expected, "{texels:?} {u} {v}");
                let [a, b, c, d] = texels;
                let other = C::mix([d, b, a, c], weights);
                let expected = C::narrow(C::mix(texels, weights).lerp(other, weight));
                assert_eq!(mean_between[pixel], expected, "{texels:?} {u} {v} {weight}");
            }
        }
    }

    fn check_all<C: Colour + PartialEq + Debug>(mut colour: impl FnMut() -> C) {
        check(&mut colour);
        check_eights(colour);
    }

    /// Channels do not touch, whatever their neighbours in a word hold.
    #[test]
    fn every_channel_by_itself() {
        let mut state = 5u64;
        let mut next = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let bits = (state >> 32) as u32;
            // Extremes are more likely than by chance.
            match state >> 29 & 7 {
                0 => 0,
                1 => u32::MAX,
                2 => bits | 0x00ff_ff00,
                _ => bits,
            }
        };
        let word = |bits: u32| RawU16::new(bits as u16);
        check_all(|| Rgb565::from(word(next())));
        check_all(|| Rgba5551(next() as u16));
        check_all(|| Rgba8888(next().to_le_bytes()));
        check_all(|| {
            let [r, g, b, _] = next().to_le_bytes();
            Rgb888::new(r, g, b)
        });
        check_all(|| Gray8::new(next() as u8));
    }
}
