//! A frame that can be drawn again and again: what is measured.

use multum::embedded_graphics::pixelcolor::{Rgb565, RgbColor};

/// What an unwritten pixel has. No texel is black.
pub const EMPTY: Rgb565 = Rgb565::BLACK;

/// Everything that drawing one frame needs, ready.
pub trait Drawing {
    /// Empties the frame and the depth buffer: not measured.
    fn clear(&mut self);

    /// Draws all triangles: measured.
    fn draw(&mut self);

    /// The frame, row by row from the top.
    fn pixels(&self) -> &[Rgb565];
}
