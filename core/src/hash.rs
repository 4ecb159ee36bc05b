//! A fingerprint of a frame, to compare a chip's with a PC's.

use core::hash::Hasher as _;

use embedded_graphics::pixelcolor::PixelColor;
use embedded_graphics::pixelcolor::raw::ToBytes;
use fnv::FnvHasher;

use crate::sink::Band;

/// The 64-bit FNV-1a hash (Fowler, Noll and Vo; IETF draft-eastlake-fnv) of a frame's pixels, row
/// by row from the top, each as little-endian bytes.
///
/// Bands added from top to bottom give the hash of the frame.
#[derive(Default)]
pub struct FrameHash(FnvHasher);

impl FrameHash {
    /// The hash of no pixels.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds the pixels of a band.
    pub fn add<C>(&mut self, band: &Band<'_, C>)
    where
        C: PixelColor + ToBytes,
        C::Bytes: AsRef<[u8]>,
    {
        for pixel in band.rows().flatten() {
            self.0.write(pixel.to_le_bytes().as_ref());
        }
    }

    /// The hash of what was added.
    #[must_use]
    pub fn value(&self) -> u64 {
        self.0.finish()
    }
}
