//! Colours with an alpha channel, which embedded-graphics does not have. Alpha is straight, not
//! premultiplied: a texel that no pixel shows should have its neighbours' colour, or filters draw
//! a fringe.

use embedded_graphics::pixelcolor::{Rgb565, Rgb888};

use super::{Channel, Channels, Colour, EachLanes, EachWide, Pairs, Weights, channels, light};

/// Whether a texel is to be seen.
pub trait Opacity {
    /// Alpha of one half or more.
    fn is_opaque(&self) -> bool;
}

/// 5 bits each of red, green and blue and one of alpha, from the highest bit down: OpenGL's
/// `UNSIGNED_SHORT_5_5_5_1`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(transparent)]
pub struct Rgba5551(pub u16);

/// 8 bits each of red, green, blue and alpha, in this order in memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(transparent)]
pub struct Rgba8888(pub [u8; 4]);

/// A channel of opacity.
#[inline]
const fn alpha(bits: u32) -> Channel {
    Channel {
        bits,
        is_alpha: true,
    }
}

/// Four channels, two a word.
#[inline]
fn pairs([r, g, b, a]: [u32; 4]) -> Pairs<2> {
    Pairs([r << 16 | b, g << 16 | a])
}

/// The other way.
#[inline]
fn apart(Pairs([red_blue, green_alpha]): Pairs<2>) -> [u32; 4] {
    let low = |word| word & 0xffff;
    [
        red_blue >> 16,
        green_alpha >> 16,
        low(red_blue),
        low(green_alpha),
    ]
}

impl Rgba5551 {
    #[inline]
    fn channels(self) -> [u32; 4] {
        let bits = u32::from(self.0);
        [bits >> 11, bits >> 6 & 31, bits >> 1 & 31, bits & 1]
    }

    #[inline]
    fn of([r, g, b, a]: [u32; 4]) -> Self {
        Self((r << 11 | g << 6 | b << 1 | a) as u16)
    }
}

impl Opacity for Rgba5551 {
    #[inline]
    fn is_opaque(&self) -> bool {
        self.0 & 1 != 0
    }
}

impl From<Rgba5551> for Rgb565 {
    /// Drops alpha; green's new lowest bit repeats its highest.
    #[inline]
    fn from(colour: Rgba5551) -> Self {
        let [r, g, b, _] = colour.channels();
        Self::new(r as u8, (g << 1 | g >> 4) as u8, b as u8)
    }
}

impl From<Rgba5551> for Rgb888 {
    /// Drops alpha.
    #[inline]
    fn from(colour: Rgba5551) -> Self {
        let [r, g, b, _] = colour.channels().map(|c| (c << 3 | c >> 2) as u8);
        Self::new(r, g, b)
    }
}

impl Colour for Rgba5551 {
    type Wide = Channels<4>;
    type Lanes = Pairs<2>;
    type EightWide = EachWide<Self>;
    type EightLanes = EachLanes<Self>;

    #[inline]
    fn widen(self) -> Channels<4> {
        Channels::of(self.channels())
    }

    #[inline]
    fn narrow(wide: Channels<4>) -> Self {
        Self::of(wide.rounded())
    }

    #[inline]
    fn mix(texels: [Self; 4], weights: Weights) -> Channels<4> {
        Channels::mixed(texels.map(Self::channels), weights)
    }

    #[inline]
    fn spread(self) -> Pairs<2> {
        pairs(self.channels())
    }

    #[inline]
    fn gather(lanes: Pairs<2>) -> Self {
        Self::of(apart(lanes))
    }

    fn by_channel(texels: [Self; 4], each: impl Fn(Channel, [u32; 4]) -> u32) -> Self {
        let kinds = [light(5), light(5), light(5), alpha(1)];
        let mixed = channels(texels.map(Self::channels), kinds, each);
        let [r, g, b, a] = mixed;
        Self::of([r & 31, g & 31, b & 31, a & 1])
    }
}

impl Rgba8888 {
    #[inline]
    fn of(channels: [u32; 4]) -> Self {
        Self(channels.map(|c| c as u8))
    }
}

impl Opacity for Rgba8888 {
    #[inline]
    fn is_opaque(&self) -> bool {
        let [.., a] = self.0;
        a >= 128
    }
}

impl From<Rgba8888> for Rgb888 {
    /// Drops alpha.
    #[inline]
    fn from(colour: Rgba8888) -> Self {
        let [r, g, b, _] = colour.0;
        Self::new(r, g, b)
    }
}

impl From<Rgba8888> for Rgb565 {
    /// Drops alpha.
    #[inline]
    fn from(colour: Rgba8888) -> Self {
        Rgb888::from(colour).into()
    }
}

impl Colour for Rgba8888 {
    type Wide = Channels<4>;
    type Lanes = Pairs<2>;
    type EightWide = EachWide<Self>;
    type EightLanes = EachLanes<Self>;

    #[inline]
    fn widen(self) -> Channels<4> {
        Channels::of(self.0.map(u32::from))
    }

    #[inline]
    fn narrow(wide: Channels<4>) -> Self {
        Self::of(wide.rounded())
    }

    #[inline]
    fn mix(texels: [Self; 4], weights: Weights) -> Channels<4> {
        Channels::mixed(texels.map(|t| t.0.map(u32::from)), weights)
    }

    #[inline]
    fn spread(self) -> Pairs<2> {
        pairs(self.0.map(u32::from))
    }

    #[inline]
    fn gather(lanes: Pairs<2>) -> Self {
        Self::of(apart(lanes))
    }

    fn by_channel(texels: [Self; 4], each: impl Fn(Channel, [u32; 4]) -> u32) -> Self {
        let kinds = [light(8), light(8), light(8), alpha(8)];
        let texels = texels.map(|t| t.0.map(u32::from));
        Self::of(channels(texels, kinds, each))
    }
}
