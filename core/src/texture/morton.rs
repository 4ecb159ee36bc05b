//! Texels in Morton order, so that neighbours in both directions are near in memory.

use super::{MAX_TEXTURE_SIZE, Texels, check_length, log2_sides};
use crate::error::Error;

/// A texture stored along a Z-shaped curve (Morton, *A Computer Oriented Geodetic Data Base*, IBM
/// 1966): the bits of column and row alternate in a texel's address, the column's first. Of a
/// texture that is not square, the longer side's upper bits lie above the alternating ones.
///
/// It helps where memory is read in lines and spans cross the texture in all directions; on a chip
/// without a cache it only costs the shuffling of bits.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Morton<'a, C> {
    texels: &'a [C],
    log2_width: u8,
    log2_height: u8,
}

impl<'a, C> Morton<'a, C> {
    /// Texels that are in this order already.
    ///
    /// # Errors
    ///
    /// As [`Texture::new`](super::Texture::new).
    pub const fn new(texels: &'a [C], width: u32, height: u32) -> Result<Self, Error> {
        let (log2_width, log2_height) = match log2_sides(width, height) {
            Ok(sides) => sides,
            Err(error) => return Err(error),
        };
        if let Err(error) = check_length(texels.len(), width as usize * height as usize) {
            return Err(error);
        }
        Ok(Self {
            texels,
            log2_width,
            log2_height,
        })
    }

    /// Arranges texels that lie row by row, and gives the texture.
    ///
    /// # Errors
    ///
    /// As [`Self::new`], for either slice; nothing is written then.
    pub fn arrange(rows: &[C], to: &'a mut [C], width: u32, height: u32) -> Result<Self, Error>
    where
        C: Copy,
    {
        let (log2_width, log2_height) = log2_sides(width, height)?;
        check_length(rows.len(), width as usize * height as usize)?;
        check_length(to.len(), rows.len())?;
        let (log2_width, log2_height) = (u32::from(log2_width), u32::from(log2_height));
        for (number, texel) in rows.iter().enumerate() {
            let (row, column) = (number >> log2_width, number as u32 & (width - 1));
            let place = address(column, row as u32, log2_width, log2_height);
            if let Some(to) = to.get_mut(place as usize) {
                *to = *texel;
            }
        }
        Self::new(to, width, height)
    }
}

/// Where a texel lies.
#[inline]
#[must_use]
pub(crate) fn address(column: u32, row: u32, log2_width: u32, log2_height: u32) -> u32 {
    let shared = log2_width.min(log2_height) & 31;
    let low = (1u32 << shared).wrapping_sub(1);
    // One of the two has nothing above the shared bits.
    let above = (column >> shared) | (row >> shared);
    spread(column & low) | spread(row & low) << 1 | above << (2 * shared)
}

/// A zero before each of 12 bits (Anderson, *Bit Twiddling Hacks*, "interleave bits by binary
/// magic numbers").
#[inline]
const fn spread(n: u32) -> u32 {
    let n = (n | n << 8) & 0x00ff_00ff;
    let n = (n | n << 4) & 0x0f0f_0f0f;
    let n = (n | n << 2) & 0x3333_3333;
    (n | n << 1) & 0x5555_5555
}

impl<C: Copy + Default> Texels for Morton<'_, C> {
    type Colour = C;

    #[inline]
    fn log2_size(&self) -> (u32, u32) {
        (self.log2_width.into(), self.log2_height.into())
    }

    #[inline]
    fn texel(&self, column: u32, row: u32) -> C {
        let (log2_width, log2_height) = self.log2_size();
        let place = address(column, row, log2_width, log2_height);
        // Wrapping keeps it inside; the default is never used.
        self.texels.get(place as usize).copied().unwrap_or_default()
    }
}

const _: () = assert!(
    MAX_TEXTURE_SIZE == 1 << 12,
    "12 bits of a column are spread"
);
