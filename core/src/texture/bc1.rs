//! Compressed textures: 4 bits a texel.

use embedded_graphics::pixelcolor::Rgb565;
use embedded_graphics::pixelcolor::raw::RawU16;

use super::{Repeat, Texels, Wrap, check_length, log2_sides, nearest};
use crate::error::Error;
use crate::uv::Uv;

/// BC1, also called DXT1 or S3TC (Khronos Data Format Specification, chapter 18): blocks of 4x4
/// texels in 8 bytes, row by row of blocks from the top.
///
/// A block holds two RGB565 colours, little-endian, and 2 bits a texel, the upper left texel's
/// lowest. If the first colour is the greater number, the other two are mixed from them by thirds;
/// else one lies half way and the other is black (in its variant with alpha: transparent). Mixed
/// colours are rounded to the nearest RGB565.
///
/// A side below 4 texels takes a whole block and uses its first columns or rows.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Bc1<'a> {
    blocks: &'a [[u8; 8]],
    log2_width: u8,
    log2_height: u8,
}

/// The four colours of a block.
type Palette = [Rgb565; 4];

impl<'a> Bc1<'a> {
    /// Blocks of a picture of this size; `usize::MAX` for more than that.
    #[must_use]
    pub const fn blocks(width: u32, height: u32) -> usize {
        (width.div_ceil(4) as usize).saturating_mul(height.div_ceil(4) as usize)
    }

    /// Checks the sizes. In a `static` the compiler does the checking.
    ///
    /// # Errors
    ///
    /// [`Error::TextureSize`] unless both sides are powers of two, 1 to
    /// [`MAX_TEXTURE_SIZE`](super::MAX_TEXTURE_SIZE); [`Error::BufferLength`] unless there are
    /// exactly [`Self::blocks`] blocks.
    pub const fn new(blocks: &'a [[u8; 8]], width: u32, height: u32) -> Result<Self, Error> {
        let (log2_width, log2_height) = match log2_sides(width, height) {
            Ok(sides) => sides,
            Err(error) => return Err(error),
        };
        if let Err(error) = check_length(blocks.len(), Self::blocks(width, height)) {
            return Err(error);
        }
        Ok(Self {
            blocks,
            log2_width,
            log2_height,
        })
    }

    /// The number of a texel's block.
    #[inline]
    fn block(&self, column: u32, row: u32) -> usize {
        let log2_blocks = u32::from(self.log2_width).saturating_sub(2);
        ((row >> 2) << (log2_blocks & 31) | column >> 2) as usize
    }

    /// [`Texels::fill_repeating`] that mixes a block's four colours when the run enters it and looks
    /// them up from there on: worth it where the run stays in a block for more than some four
    /// pixels.
    pub fn fill_block_by_block<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        Rgb565: Into<P>,
    {
        let (log2_width, log2_height) = self.log2_size();
        let mut known = usize::MAX;
        let mut block = &[0; 8];
        let mut palette = Palette::default();
        let mut uv = uv;
        for to in pixels {
            let at = |bits: i32, log2: u32| {
                Repeat::wrap(bits >> ((Uv::FRACTION_BITS - log2) & 31), log2)
            };
            let column = at(uv.u.to_bits(), log2_width);
            let row = at(uv.v.to_bits(), log2_height);
            let number = self.block(column, row);
            if number != known {
                known = number;
                let Some(found) = self.blocks.get(number) else {
                    return;
                };
                block = found;
                let ends = ends(block);
                palette = [0, 1, 2, 3].map(|choice| pixel(colour(ends, choice)));
            }
            let choice = choice(block, column, row) as usize;
            *to = palette.get(choice).copied().unwrap_or_default().into();
            uv = uv + step;
        }
    }

    /// Whether a run crosses at least two pixels to the texel: then it stays in most blocks for
    /// eight.
    #[inline]
    fn is_magnified(&self, step: Uv) -> bool {
        let (log2_width, log2_height) = self.log2_size();
        let small = |bits: i32, log2: u32| {
            bits.unsigned_abs() <= (1 << (Uv::FRACTION_BITS - 1)) >> (log2 & 31)
        };
        small(step.u.to_bits(), log2_width) && small(step.v.to_bits(), log2_height)
    }
}

/// Which of its block's four colours a texel has.
#[inline]
fn choice(block: &[u8; 8], column: u32, row: u32) -> u32 {
    let [.., a, b, c, d] = *block;
    let bits = u32::from_le_bytes([a, b, c, d]);
    bits >> ((row & 3) << 3 | (column & 3) << 1) & 3
}

/// The block's two colours.
#[inline]
fn ends(block: &[u8; 8]) -> [u32; 2] {
    let [a, b, c, d, ..] = *block;
    [
        u32::from(a) | u32::from(b) << 8,
        u32::from(c) | u32::from(d) << 8,
    ]
}

/// Two thirds of one colour and one of another, each channel rounded to the nearest.
#[inline]
fn third(far: u32, near: u32) -> u32 {
    // Red and blue in 16 bits each; `n / 3 = n * 171 >> 9` for n below 512.
    let red_blue = |bits: u32| (bits & 0xf800) << 5 | bits & 0x1f;
    let green = |bits: u32| bits >> 5 & 0x3f;
    let sum = |a: u32, b: u32| a.wrapping_mul(2).wrapping_add(b);
    let rb = sum(red_blue(far), red_blue(near)).wrapping_add(0x0001_0001);
    let rb = rb.wrapping_mul(171) >> 9;
    let g = sum(green(far), green(near))
        .wrapping_add(1)
        .wrapping_mul(171)
        >> 9;
    rb >> 5 & 0xf800 | g << 5 | rb & 0x1f
}

/// Half way between two colours, each channel rounded up.
#[inline]
fn middle(a: u32, b: u32) -> u32 {
    // The mean is what is common and half of what is not; rounding up takes from the union.
    const LOWEST: u32 = 0x0821;
    (a | b).wrapping_sub(((a ^ b) & !LOWEST) >> 1)
}

/// The raw bits of one of a block's colours.
#[inline]
fn colour([first, second]: [u32; 2], choice: u32) -> u32 {
    match (choice, first > second) {
        (0, _) => first,
        (1, _) => second,
        (2, true) => third(first, second),
        (2, false) => middle(first, second),
        (_, true) => third(second, first),
        (_, false) => 0,
    }
}

#[inline]
fn pixel(bits: u32) -> Rgb565 {
    RawU16::new(bits as u16).into()
}

impl Texels for Bc1<'_> {
    type Colour = Rgb565;

    #[inline]
    fn log2_size(&self) -> (u32, u32) {
        (self.log2_width.into(), self.log2_height.into())
    }

    #[inline]
    fn texel(&self, column: u32, row: u32) -> Rgb565 {
        match self.blocks.get(self.block(column, row)) {
            Some(block) => pixel(colour(ends(block), choice(block, column, row))),
            // Wrapping keeps it inside.
            None => Rgb565::default(),
        }
    }

    #[inline]
    fn fill_repeating<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        Rgb565: Into<P>,
    {
        if self.is_magnified(step) {
            self.fill_block_by_block(uv, step, pixels);
        } else {
            let mut uv = uv;
            for pixel in pixels {
                *pixel = nearest::<_, Repeat, Repeat>(self, uv).into();
                uv = uv + step;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The packed means against the same in each channel, for all pairs of values.
    #[test]
    fn means_are_of_each_channel() {
        let split = |bits: u32| [bits >> 11, bits >> 5 & 63, bits & 31];
        for a in 0..64u32 {
            for b in 0..64u32 {
                let grey = |n: u32| (n >> 1) << 11 | n << 5 | n >> 1;
                let (p, q) = (grey(a), grey(b ^ 21));
                let (s, t) = (split(p), split(q));
                let of = |f: fn(u32, u32) -> u32| [0, 1, 2].map(|i| f(s[i], t[i]));
                assert_eq!(split(third(p, q)), of(|a, b| (2 * a + b + 1) / 3));
                assert_eq!(split(middle(p, q)), of(|a, b| (a + b).div_ceil(2)));
            }
        }
    }
}
