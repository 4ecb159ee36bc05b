//! Part of a texture as a texture of its own.

use super::{Texels, log2_sides};
use crate::error::Error;

/// A rectangle of an atlas: coordinates from 0 to 1 span the rectangle, and wrapping happens inside
/// it, so that no filter ever reads a neighbour.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Window<T> {
    atlas: T,
    left: u32,
    top: u32,
    log2_width: u8,
    log2_height: u8,
}

impl<T: Texels> Window<T> {
    /// The rectangle of `width` x `height` texels whose upper left texel is in column `left` and
    /// row `top`.
    ///
    /// # Errors
    ///
    /// [`Error::TextureSize`] unless both sides are powers of two;
    /// [`Error::WindowOutOfRange`] if the rectangle reaches beyond the atlas.
    pub fn new(atlas: T, left: u32, top: u32, width: u32, height: u32) -> Result<Self, Error> {
        let (log2_width, log2_height) = log2_sides(width, height)?;
        let (columns, rows) = atlas.log2_size();
        let fits = |first: u32, side: u32, log2: u32| {
            first
                .checked_add(side)
                .is_some_and(|end| end <= 1 << (log2 & 31))
        };
        if !fits(left, width, columns) || !fits(top, height, rows) {
            return Err(Error::WindowOutOfRange { left, top });
        }
        Ok(Self {
            atlas,
            left,
            top,
            log2_width,
            log2_height,
        })
    }
}

impl<T: Texels> Texels for Window<T> {
    type Colour = T::Colour;

    #[inline]
    fn log2_size(&self) -> (u32, u32) {
        (self.log2_width.into(), self.log2_height.into())
    }

    #[inline]
    fn texel(&self, column: u32, row: u32) -> T::Colour {
        self.atlas
            .texel(self.left.wrapping_add(column), self.top.wrapping_add(row))
    }
}
