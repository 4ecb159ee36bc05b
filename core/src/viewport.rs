//! The size of a frame and the fixed limits of screen space. A leaf.

use crate::error::Error;

/// Subpixel positions per pixel, as a power of two.
///
/// With `b` subpixel bits and a guard band of `g` pixels an edge extends over at most `2 g 2^b`
/// subpixels and `2 g` scanlines. The edge walk keeps 32 bits behind the point and gets too low by
/// less than `(2 g + 2) 2^-32`, which has to be less than one part of the edge's height: the product
/// of the two has to stay below 2^32. A quarter of that is used with:
///
/// | subpixel bits | largest guard band |
/// |---|---|
/// | 4 | 4096 px |
/// | 6 | 2048 px |
/// | 8 | 1024 px |
pub const SUBPIXEL_BITS: u32 = 8;

/// Screen coordinates stay within plus and minus this many pixels.
pub const GUARD_BAND: i32 = 1024;

/// Largest width and height of a frame in pixels.
pub const MAX_VIEWPORT: u32 = 1024;

/// One pixel in subpixels.
pub(crate) const SUBPIXELS: i32 = 1 << SUBPIXEL_BITS;

/// [`GUARD_BAND`] in subpixels.
pub(crate) const GUARD: i32 = GUARD_BAND << SUBPIXEL_BITS;

const _: () = {
    let extent = 2 * GUARD as i64;
    // What `arith::quotient` takes, and the edge walk's error.
    assert!(extent << SUBPIXEL_BITS < 1 << 28 && extent <= 1 << 19);
    assert!((2 * GUARD_BAND as i64 + 2) * extent < 1 << 32);
    assert!(MAX_VIEWPORT as i64 <= GUARD_BAND as i64);
};

/// Width and height of the whole frame, of which a band shows some rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Viewport {
    width: u16,
    height: u16,
}

impl Viewport {
    /// A frame of `width` x `height` pixels, each 1 to [`MAX_VIEWPORT`].
    ///
    /// # Errors
    ///
    /// [`Error::FrameSize`].
    pub const fn new(width: u32, height: u32) -> Result<Self, Error> {
        if width == 0 || height == 0 || width > MAX_VIEWPORT || height > MAX_VIEWPORT {
            return Err(Error::FrameSize { width, height });
        }
        Ok(Self {
            width: width as u16,
            height: height as u16,
        })
    }

    /// Columns.
    #[must_use]
    pub const fn width(self) -> u32 {
        self.width as u32
    }

    /// Rows.
    #[must_use]
    pub const fn height(self) -> u32 {
        self.height as u32
    }
}
