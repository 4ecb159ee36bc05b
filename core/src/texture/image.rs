//! embedded-graphics' own images as textures.

use embedded_graphics::geometry::{OriginDimensions, Point};
use embedded_graphics::image::GetPixel;

use super::{Texels, log2_sides};
use crate::error::Error;

/// An image of embedded-graphics, such as an `ImageRaw` of any colour and byte order, read in place.
///
/// Nothing is copied, whatever the layout; only the sides must be powers of two. A texel costs
/// what the image's own `pixel` does: some twice a [`Texture`](super::Texture)'s, which to use
/// instead where the data can be a slice of colours.
#[derive(Clone, Copy, Debug)]
pub struct ImageTexels<I> {
    image: I,
    log2_width: u8,
    log2_height: u8,
}

impl<I: GetPixel + OriginDimensions> ImageTexels<I> {
    /// Checks the sizes.
    ///
    /// # Errors
    ///
    /// [`Error::TextureSize`] unless both sides are powers of two, 1 to
    /// [`MAX_TEXTURE_SIZE`](super::MAX_TEXTURE_SIZE). An `ImageRaw` drops a last row that its data
    /// does not fill: this is how it shows.
    pub fn new(image: I) -> Result<Self, Error> {
        let size = image.size();
        let (log2_width, log2_height) = log2_sides(size.width, size.height)?;
        Ok(Self {
            image,
            log2_width,
            log2_height,
        })
    }
}

impl<I: GetPixel + Copy> Texels for ImageTexels<I>
where
    I::Color: Copy + Default,
{
    type Colour = I::Color;

    #[inline]
    fn log2_size(&self) -> (u32, u32) {
        (self.log2_width.into(), self.log2_height.into())
    }

    #[inline]
    fn texel(&self, column: u32, row: u32) -> I::Color {
        let point = Point::new(column.cast_signed(), row.cast_signed());
        self.image.pixel(point).unwrap_or_default()
    }
}
