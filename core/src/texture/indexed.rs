//! Textures of palette indices.

use super::{Texels, check_length, log2_sides};
use crate::error::Error;

/// Indices of `BITS` bits (1, 2, 4 or 8) into a palette, row by row from the top.
///
/// Where a byte holds several texels the leftmost is in its highest bits, and every row starts
/// with a byte of its own: the layout of embedded-graphics' `ImageRaw`.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Indexed<'a, C, const BITS: u32> {
    indices: &'a [u8],
    palette: &'a [C],
    log2_width: u8,
    log2_height: u8,
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
        let (log2_width, log2_height) = match log2_sides(width, height) {
            Ok(sides) => sides,
            Err(error) => return Err(error),
        };
        if let Err(error) = check_length(indices.len(), Self::bytes(width, height)) {
            return Err(error);
        }
        let indexed = Self {
            indices,
            palette,
            log2_width,
            log2_height,
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
        let log2_bytes = (self.log2_width as u32).saturating_sub(per_byte);
        let byte = (row << log2_bytes) | (column >> per_byte);
        let right = column & ((1 << per_byte) - 1);
        // The leftmost texel is the highest.
        (byte as usize, 8 - BITS - right * BITS)
    }
}

impl<C: Copy + Default, const BITS: u32> Texels for Indexed<'_, C, BITS> {
    type Colour = C;

    #[inline]
    fn log2_size(&self) -> (u32, u32) {
        (self.log2_width.into(), self.log2_height.into())
    }

    #[inline]
    fn texel(&self, column: u32, row: u32) -> C {
        let (byte, shift) = self.place(column, row);
        // Both were checked: the defaults are never used.
        let byte = self.indices.get(byte).copied().unwrap_or_default();
        let index = u32::from(byte) >> (shift & 7) & ((1 << BITS) - 1);
        self.palette
            .get(index as usize)
            .copied()
            .unwrap_or_default()
    }
}
