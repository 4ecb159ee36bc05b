//! Textures of palette indices.

use super::apart::{self, Decoder};
use super::{Repeat, Texels, Texture, fill_seen, log2_sides, nearest, packed};
use crate::arith::CARRIES;
use crate::error::Error;
use crate::uv::Uv;
use crate::visibility::Visibility;

/// Indices of `BITS` bits (1, 2, 4 or 8) into a palette, row by row from the top.
///
/// Where a byte holds several texels the leftmost is in its highest bits, and every row starts
/// with a byte of its own: the layout of embedded-graphics' `ImageRaw`.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Indexed<'a, C, const BITS: u32> {
    /// Those of several texels where they share one.
    bytes: Texture<'a, u8>,
    palette: &'a [C],
    log2_width: u8,
}

/// 16 colours, two texels a byte.
pub type Indexed4<'a, C> = Indexed<'a, C, 4>;

/// 256 colours, a byte a texel.
pub type Indexed8<'a, C> = Indexed<'a, C, 8>;

impl<'a, C, const BITS: u32> Indexed<'a, C, BITS> {
    const SUPPORTED: () = assert!(BITS == 1 || BITS == 2 || BITS == 4 || BITS == 8);
    /// Base-2 logarithm of the texels in a byte.
    const LOG2_PER_BYTE: u32 = 3 - BITS.trailing_zeros();

    /// Bytes of a picture of this size; `usize::MAX` for more than that.
    #[must_use]
    pub const fn bytes(width: u32, height: u32) -> usize {
        const { Self::SUPPORTED };
        (width as usize)
            .div_ceil(1 << Self::LOG2_PER_BYTE)
            .saturating_mul(height as usize)
    }

    /// Checks sizes and indices. In a `static` the compiler does the checking; at run time it
    /// reads every index once, unless the palette is complete.
    ///
    /// # Errors
    ///
    /// [`Error::TextureSize`] unless both sides are powers of two, 1 to
    /// [`MAX_TEXTURE_SIZE`](super::MAX_TEXTURE_SIZE); [`Error::BufferLength`] unless there are
    /// exactly [`Self::bytes`]; [`Error::PaletteIndex`] for the first texel that names a colour
    /// beyond the palette.
    pub const fn new(
        indices: &'a [u8],
        palette: &'a [C],
        width: u32,
        height: u32,
    ) -> Result<Self, Error> {
        let (log2_width, _) = match log2_sides(width, height) {
            Ok(sides) => sides,
            Err(error) => return Err(error),
        };
        let bytes_of_row = width.div_ceil(1 << Self::LOG2_PER_BYTE);
        let bytes = match Texture::new(indices, bytes_of_row, height) {
            Ok(bytes) => bytes,
            Err(error) => return Err(error),
        };
        let indexed = Self {
            bytes,
            palette,
            log2_width,
        };
        if palette.len() < 1 << BITS {
            let mut row = 0;
            while row < height {
                let mut column = 0;
                while column < width {
                    let (byte, shift) = indexed.place(column, row);
                    let index = indices[byte] as u32 >> shift & ((1 << BITS) - 1);
                    if index as usize >= palette.len() {
                        return Err(Error::PaletteIndex {
                            column,
                            row,
                            index,
                            colours: palette.len(),
                        });
                    }
                    column += 1;
                }
                row += 1;
            }
        }
        Ok(indexed)
    }

    /// The byte that a texel is in, and how far its index is shifted up there.
    #[inline]
    const fn place(&self, column: u32, row: u32) -> (usize, u32) {
        let per_byte = Self::LOG2_PER_BYTE;
        let (log2_bytes, _) = self.bytes.log2_size();
        let byte = (row << log2_bytes) | (column >> per_byte);
        let right = column & ((1 << per_byte) - 1);
        // The leftmost texel is the highest.
        (byte as usize, 8 - BITS - right * BITS)
    }
}

impl<'a, C: Copy + Default, const BITS: u32> Indexed<'a, C, BITS> {
    /// Whether texels are found in their bytes as those of a [`Texture`] are: with a rotation, or where a byte is one.
    const FAST: bool = CARRIES || BITS == 8;

    /// Whether all bits of the bytes are those of texels.
    #[inline]
    fn is_full(&self) -> bool {
        u32::from(self.log2_width) >= Self::LOG2_PER_BYTE
    }

    #[inline]
    const fn decoder(&self) -> Palette<'a, C, BITS> {
        Palette(self.palette)
    }
}

/// Colours of the indices in bytes.
#[derive(Clone, Copy)]
struct Palette<'a, C, const BITS: u32>(&'a [C]);

impl<C: Copy + Default, const BITS: u32> Palette<'_, C, BITS> {
    /// All indices were checked: the default is never used.
    #[inline]
    fn colour(self, index: u8) -> C {
        let Self(palette) = self;
        palette.get(usize::from(index)).copied().unwrap_or_default()
    }
}

impl<C: Copy + Default + Into<P>, P, const BITS: u32> Decoder<u8, P> for Palette<'_, C, BITS> {
    const BEHIND: u32 = Indexed::<C, BITS>::LOG2_PER_BYTE;

    #[inline]
    fn decode(self, byte: u8, word: u32) -> P {
        // The leftmost texel is the highest.
        let left = if const { BITS == 8 } {
            0
        } else {
            (word >> (32 - Indexed::<C, BITS>::LOG2_PER_BYTE)) * BITS
        };
        self.colour((u32::from(byte) << left) as u8 >> (8 - BITS))
            .into()
    }
}

impl<C: Copy + Default, const BITS: u32> Texels for Indexed<'_, C, BITS> {
    type Colour = C;

    #[inline]
    fn log2_size(&self) -> (u32, u32) {
        let (_, log2_height) = self.bytes.log2_size();
        (self.log2_width.into(), log2_height)
    }

    #[inline]
    fn texel(&self, column: u32, row: u32) -> C {
        let (byte, shift) = self.place(column, row);
        // Both were checked: the defaults are never used.
        let byte = self.bytes.texels().get(byte).copied().unwrap_or_default();
        let index = u32::from(byte) >> (shift & 7) & ((1 << BITS) - 1);
        self.decoder().colour(index as u8)
    }

    #[inline]
    fn nearest_repeating(&self, uv: Uv) -> C {
        if const { BITS == 8 } {
            self.decoder().colour(apart::nearest(&self.bytes, uv))
        } else {
            nearest::<_, Repeat, Repeat>(self, uv)
        }
    }

    #[inline]
    fn fill_repeating<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        C: Into<P>,
    {
        if const { CARRIES } && pixels.len() > packed::SHORT && self.is_full() {
            packed::fill(&self.bytes, uv, step, pixels, self.decoder());
        } else {
            let mut uv = uv;
            for pixel in pixels {
                *pixel = nearest::<_, Repeat, Repeat>(self, uv).into();
                uv = uv + step;
            }
        }
    }

    #[inline]
    fn fill_few_repeating<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        C: Into<P>,
    {
        // Of several texels a byte it would be more code than a call.
        if const { CARRIES && BITS == 8 } && pixels.len() <= packed::SHORT {
            apart::fill_few(&self.bytes, uv, step, pixels, self.decoder());
        } else {
            self.fill_repeating(uv, step, pixels);
        }
    }

    #[inline]
    fn piece_repeating<P, const N: usize>(&self, uv: Uv, step: Uv, pixels: &mut [P; N])
    where
        C: Into<P>,
    {
        if const { CARRIES && N > packed::SHORT && N <= packed::PIECE } && self.is_full() {
            packed::piece(&self.bytes, uv, step, pixels, self.decoder());
        } else {
            self.fill_repeating(uv, step, pixels);
        }
    }

    #[inline]
    fn fill_few_seen_repeating<P>(
        &self,
        uv: Uv,
        step: Uv,
        pixels: &mut [P],
        seen: &mut impl Visibility,
    ) where
        C: Into<P>,
    {
        if const { Self::FAST } && self.is_full() {
            apart::fill_seen(&self.bytes, uv, step, pixels, seen, self.decoder());
        } else {
            fill_seen::<_, Repeat, Repeat, _>(self, uv, step, pixels, seen);
        }
    }
}
