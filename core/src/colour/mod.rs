//! Colours that filters compute with: four neighbouring texels enter with their weights, one
//! colour leaves. The one idea in between is a [`Wide`] colour that keeps 11 fraction bits in each
//! channel, so that a filter rounds once, at its end.
//!
//! Channels are mixed as they are stored, as OpenGL does for textures that are not sRGB.

mod eights;
mod lanes;
mod rgb565;
mod rgba;

pub use eights::{ByLanes, ByWeights, EachLanes, EachWide, EightMixed, MixesEights};
pub use lanes::{LANE_BITS, Lanes, Pairs};
pub use rgba::{Opacity, Rgba5551, Rgba8888};

use embedded_graphics::pixelcolor::{Gray8, GrayColor, Rgb888, RgbColor};

/// Fraction bits of the weights of four texels, and of [`Channels`].
pub const WEIGHT_BITS: u32 = 11;

/// A whole: what the weights of four texels sum to.
pub const ONE: u32 = 1 << WEIGHT_BITS;

/// Bits of the weight between two levels of a pyramid.
pub const BLEND_BITS: u32 = 12;

/// How far a point lies from the upper left texel's centre to its neighbours', in
/// 2^-[`WEIGHT_BITS`], rounded down: each below [`ONE`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fractions {
    /// To the right.
    pub u: u32,
    /// Down.
    pub v: u32,
}

/// Weights of four neighbouring texels: upper left, upper right, lower left, lower right. They
/// sum to [`ONE`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Weights(pub(crate) [u32; 4]);

impl Weights {
    /// For a point between the texels' centres.
    ///
    /// Only the product is rounded, down, and what it lacks goes to its neighbours: a channel that
    /// spans `c` is off by less than `c 2^-10`.
    #[inline]
    #[must_use]
    pub const fn new(at: Fractions) -> Self {
        let (u, v) = (at.u & (ONE - 1), at.v & (ONE - 1));
        let both = u.wrapping_mul(v) >> WEIGHT_BITS;
        let right = u.wrapping_sub(both);
        let below = v.wrapping_sub(both);
        let neither = ONE.wrapping_sub(u).wrapping_sub(below);
        Self([neither, right, below, both])
    }
}

/// What a channel of a colour holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel {
    /// Its bits, 1 to 8: the values are `0 .. 2^bits`.
    pub bits: u32,
    /// How opaque the texel is, not how bright.
    pub is_alpha: bool,
}

/// A colour that can be mixed with others of its kind.
pub trait Colour: Copy + Default {
    /// The same with room for fractions.
    type Wide: Wide;

    /// The same with its channels apart, for weights of few bits.
    type Lanes: Lanes;

    /// Exact.
    fn widen(self) -> Self::Wide;

    /// Rounds each channel to the nearest value, halves up.
    fn narrow(wide: Self::Wide) -> Self;

    /// The weighted mean of four texels, in the order of [`Weights`].
    fn mix(texels: [Self; 4], weights: Weights) -> Self::Wide;

    /// [`Self::mix`], rounded: for filters that end there.
    #[inline]
    fn mixed(texels: [Self; 4], weights: Weights) -> Self {
        Self::narrow(Self::mix(texels, weights))
    }

    /// Exact.
    fn spread(self) -> Self::Lanes;

    /// Exact: the other way.
    fn gather(lanes: Self::Lanes) -> Self;

    /// [`Self::Wide`] of eight pixels: [`EachWide`], unless there is something faster.
    type EightWide: EightMixed<Self>;

    /// [`Self::Lanes`] of eight pixels: [`EachLanes`], unless there is something faster.
    type EightLanes: EightMixed<Self>;

    /// Whether there is.
    const HAS_EIGHTS: bool = false;

    /// Makes one texel of four, channel by channel. What `each` returns is cut to the channel's
    /// bits. For building pyramids; no pixel loop uses it.
    #[must_use]
    fn by_channel(texels: [Self; 4], each: impl Fn(Channel, [u32; 4]) -> u32) -> Self;
}

/// A colour with fractions.
pub trait Wide: Copy + Default {
    /// From `self` to `other`; `weight` in `0 ..= 2^`[`BLEND_BITS`]. [`Channels`] round down to
    /// 2^-[`WEIGHT_BITS`]; [`Lanes`] round the weight to 2^-[`LANE_BITS`] and each channel to the
    /// nearest value.
    #[must_use]
    fn lerp(self, other: Self, weight: u32) -> Self;

    /// The sum, of which [`Self::half`] must follow before colours are narrowed: there is room
    /// for 8.
    #[must_use]
    fn plus(self, other: Self) -> Self;

    /// Divides by `2^times`, which is 2, 4 or 8, and rounds as [`Self::lerp`] does.
    #[must_use]
    fn half(self, times: u32) -> Self;
}

/// Up to 8 bits and [`WEIGHT_BITS`] fraction bits in each of `N` channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channels<const N: usize>(pub(crate) [u32; N]);

impl<const N: usize> Default for Channels<N> {
    fn default() -> Self {
        Self([0; N])
    }
}

impl<const N: usize> Channels<N> {
    #[inline]
    fn with(self, other: Self, f: impl Fn(u32, u32) -> u32) -> Self {
        let mut result = self;
        for (a, b) in result.0.iter_mut().zip(other.0) {
            *a = f(*a, b);
        }
        result
    }

    /// Whole values, without fractions.
    #[inline]
    fn of(values: [u32; N]) -> Self {
        Self(values.map(|v| v << WEIGHT_BITS))
    }

    /// The nearest whole values.
    #[inline]
    fn rounded(self) -> [u32; N] {
        self.0.map(|c| c.wrapping_add(ONE / 2) >> WEIGHT_BITS)
    }

    #[inline]
    fn mixed(texels: [[u32; N]; 4], weights: Weights) -> Self {
        let mut sum = [0u32; N];
        for (texel, weight) in texels.into_iter().zip(weights.0) {
            for (sum, channel) in sum.iter_mut().zip(texel) {
                *sum = sum.wrapping_add(channel.wrapping_mul(weight));
            }
        }
        Self(sum)
    }
}

impl<const N: usize> Wide for Channels<N> {
    #[inline]
    fn lerp(self, other: Self, weight: u32) -> Self {
        // 8 + 11 + 12 bits, and a sign.
        self.with(other, |a, b| {
            let change = b.wrapping_sub(a).wrapping_mul(weight).cast_signed();
            a.wrapping_add_signed(change >> BLEND_BITS)
        })
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        self.with(other, u32::wrapping_add)
    }

    #[inline]
    fn half(self, times: u32) -> Self {
        Self(self.0.map(|c| c >> (times & 31)))
    }
}

/// The channels of four texels, one after the other, through `each`.
#[inline]
fn channels<const N: usize>(
    texels: [[u32; N]; 4],
    kinds: [Channel; N],
    each: impl Fn(Channel, [u32; 4]) -> u32,
) -> [u32; N] {
    let mut result = [0; N];
    let [a, b, c, d] = texels;
    let columns = a.into_iter().zip(b).zip(c).zip(d);
    for ((to, kind), (((a, b), c), d)) in result.iter_mut().zip(kinds).zip(columns) {
        *to = each(kind, [a, b, c, d]);
    }
    result
}

/// A channel of light.
#[inline]
const fn light(bits: u32) -> Channel {
    Channel {
        bits,
        is_alpha: false,
    }
}

impl Colour for Gray8 {
    type Wide = Channels<1>;
    type Lanes = Pairs<1>;
    type EightWide = EachWide<Self>;
    type EightLanes = EachLanes<Self>;

    #[inline]
    fn widen(self) -> Channels<1> {
        Channels::of([u32::from(self.luma())])
    }

    #[inline]
    fn narrow(wide: Channels<1>) -> Self {
        let [luma] = wide.rounded();
        Self::new(luma as u8)
    }

    #[inline]
    fn mix(texels: [Self; 4], weights: Weights) -> Channels<1> {
        Channels::mixed(texels.map(|t| [u32::from(t.luma())]), weights)
    }

    #[inline]
    fn spread(self) -> Pairs<1> {
        Pairs([self.luma().into()])
    }

    #[inline]
    fn gather(Pairs([luma]): Pairs<1>) -> Self {
        Self::new(luma as u8)
    }

    fn by_channel(texels: [Self; 4], each: impl Fn(Channel, [u32; 4]) -> u32) -> Self {
        let texels = texels.map(|t| [u32::from(t.luma())]);
        let [luma] = channels(texels, [light(8)], each);
        Self::new(luma as u8)
    }
}

/// Red, green and blue.
#[inline]
fn rgb(colour: impl RgbColor) -> [u32; 3] {
    [colour.r(), colour.g(), colour.b()].map(u32::from)
}

impl Colour for Rgb888 {
    type Wide = Channels<3>;
    type Lanes = Pairs<2>;
    type EightWide = EachWide<Self>;
    type EightLanes = EachLanes<Self>;

    #[inline]
    fn widen(self) -> Channels<3> {
        Channels::of(rgb(self))
    }

    #[inline]
    fn narrow(wide: Channels<3>) -> Self {
        let [r, g, b] = wide.rounded();
        Self::new(r as u8, g as u8, b as u8)
    }

    #[inline]
    fn mix(texels: [Self; 4], weights: Weights) -> Channels<3> {
        Channels::mixed(texels.map(rgb), weights)
    }

    #[inline]
    fn spread(self) -> Pairs<2> {
        let [r, g, b] = rgb(self);
        Pairs([r << 16 | b, g])
    }

    #[inline]
    fn gather(Pairs([red_blue, green]): Pairs<2>) -> Self {
        Self::new((red_blue >> 16) as u8, green as u8, red_blue as u8)
    }

    fn by_channel(texels: [Self; 4], each: impl Fn(Channel, [u32; 4]) -> u32) -> Self {
        let [r, g, b] = channels(texels.map(rgb), [light(8); 3], each);
        Self::new(r as u8, g as u8, b as u8)
    }
}
