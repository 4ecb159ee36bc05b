//! Where pixels go: bands of a frame in memory that the caller owns, and from there to a display.

use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{Point, Size};
use embedded_graphics::pixelcolor::PixelColor;
use embedded_graphics::primitives::Rectangle;

use crate::error::Error;
use crate::span::{Area, Span};
use crate::viewport::MAX_VIEWPORT;

/// Takes the pixels of spans.
pub trait PixelSink {
    /// What a pixel is stored as.
    type Pixel;

    /// The part of the frame that can be drawn to.
    fn area(&self) -> Area;

    /// The pixels of one span inside [`Self::area`], to be written from left to right. Called at
    /// most once per triangle and row. `None` leaves the span out.
    fn span(&mut self, span: Span) -> Option<&mut [Self::Pixel]>;
}

/// Some rows of a frame, in the caller's memory: a whole frame, or as few rows as fit.
///
/// Row `top` of the frame lies at the start of `pixels`, the next one `stride` pixels on.
#[derive(Debug)]
pub struct Band<'a, P> {
    pixels: &'a mut [P],
    width: u16,
    height: u16,
    stride: usize,
    top: u16,
}

impl<'a, P> Band<'a, P> {
    /// `height` rows of `width` pixels from row `top` of the frame on.
    ///
    /// # Errors
    ///
    /// [`Error::FrameSize`] if a side is zero, a row or column lies beyond [`MAX_VIEWPORT`], or
    /// the stride is below the width; [`Error::BufferLength`] if `pixels` is too short.
    pub fn new(
        pixels: &'a mut [P],
        width: u32,
        height: u32,
        stride: usize,
        top: u32,
    ) -> Result<Self, Error> {
        let bottom = top.saturating_add(height);
        if width == 0
            || height == 0
            || width > MAX_VIEWPORT
            || bottom > MAX_VIEWPORT
            || stride < width as usize
        {
            return Err(Error::FrameSize {
                width,
                height: bottom,
            });
        }
        let needed = stride
            .saturating_mul(height as usize - 1)
            .saturating_add(width as usize);
        let given = pixels.len();
        if given < needed {
            return Err(Error::BufferLength { needed, given });
        }
        Ok(Self {
            pixels,
            width: width as u16,
            height: height as u16,
            stride,
            top: top as u16,
        })
    }

    /// Columns.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.width as u32
    }

    /// Rows in this band.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.height as u32
    }

    /// First row of the frame in this band.
    #[must_use]
    pub const fn top(&self) -> u32 {
        self.top as u32
    }

    /// The rows from top to bottom, without what the stride leaves between them.
    pub fn rows(&self) -> impl Iterator<Item = &[P]> {
        self.pixels
            .chunks(self.stride.max(1))
            .take(usize::from(self.height))
            .filter_map(|row| row.get(..usize::from(self.width)))
    }
}

impl<P: Copy> Band<'_, P> {
    /// Gives every pixel of the band one value.
    pub fn clear(&mut self, value: P) {
        let width = usize::from(self.width);
        for row in self
            .pixels
            .chunks_mut(self.stride.max(1))
            .take(usize::from(self.height))
        {
            if let Some(row) = row.get_mut(..width) {
                row.fill(value);
            }
        }
    }
}

impl<C: PixelColor> Band<'_, C> {
    /// Sends the band to its place on a display, as one block.
    ///
    /// # Errors
    ///
    /// The display's own.
    pub fn send_to<D: DrawTarget<Color = C>>(&self, display: &mut D) -> Result<(), D::Error> {
        let block = Rectangle::new(
            Point::new(0, i32::from(self.top)),
            Size::new(self.width(), self.height()),
        );
        display.fill_contiguous(&block, self.rows().flatten().copied())
    }
}

impl<P> PixelSink for Band<'_, P> {
    type Pixel = P;

    #[inline]
    fn area(&self) -> Area {
        Area {
            width: i32::from(self.width),
            top: i32::from(self.top),
            bottom: i32::from(self.top) + i32::from(self.height),
        }
    }

    #[inline]
    fn span(&mut self, span: Span) -> Option<&mut [P]> {
        let Span { y, left, right } = span;
        let row = y.wrapping_sub(i32::from(self.top)).cast_unsigned();
        if row >= u32::from(self.height)
            || left < 0
            || right > i32::from(self.width)
            || left >= right
        {
            return None;
        }
        let start = (row as usize)
            .wrapping_mul(self.stride)
            .wrapping_add(left.unsigned_abs() as usize);
        self.pixels
            .get_mut(start..start.wrapping_add(left.abs_diff(right) as usize))
    }
}
