//! Texels in the formats that chips and displays take. A [`Picture`] enters, of any size that one
//! may have, so each mip level can be encoded by itself; what leaves is the table that goes into
//! flash. RGB565 is [`Picture::rgb565`].
//!
//! Colours are those of the picture, encoded in sRGB: nothing here goes through linear light.

mod block;
mod palette;

pub use self::palette::{Indexed, indexed, pack4};
use crate::picture::Picture;

/// From this alpha on, a texel counts as opaque where a format has one bit for it.
pub const OPAQUE_FROM: u8 = 128;

/// Side of a BC1 block in texels.
const BLOCK: u32 = 4;

/// Luma, 0 to 255, one byte a texel: the Rec. 709 weights 0.2126, 0.7152 and 0.0722 on the
/// encoded values (Y' of ITU-R BT.709, not luminance), rounded to the nearest. Alpha is left out.
#[must_use]
pub fn gray8(picture: &Picture) -> Vec<u8> {
    picture
        .pixels()
        .iter()
        .map(|&rgb| {
            let [r, g, b] = rgb.map(u32::from);
            ((2126 * r + 7152 * g + 722 * b + 5000) / 10_000) as u8
        })
        .collect()
}

/// `RRRRRGGGGGBBBBBA` from the highest bit, as OpenGL's `UNSIGNED_SHORT_5_5_5_1`: each channel
/// rounded to the nearest value; A is 1 from [`OPAQUE_FROM`] on.
#[must_use]
pub fn rgba5551(picture: &Picture) -> Vec<u16> {
    // 255 is odd, so no channel lies half way between two values.
    let five = |value: u8| (u16::from(value) * 31 + 127) / 255;
    rgba8888(picture)
        .into_iter()
        .map(|[r, g, b, a]| {
            five(r) << 11 | five(g) << 6 | five(b) << 1 | u16::from(a >= OPAQUE_FROM)
        })
        .collect()
}

/// Red, green, blue and alpha, a byte each; 255 is opaque. Colours are not multiplied by alpha.
#[must_use]
pub fn rgba8888(picture: &Picture) -> Vec<[u8; 4]> {
    let alpha = |i: usize| picture.alpha().map_or(u8::MAX, |alpha| alpha[i]);
    picture
        .pixels()
        .iter()
        .enumerate()
        .map(|(i, &[r, g, b])| [r, g, b, alpha(i)])
        .collect()
}

/// BC1 (DXT1): blocks of 4x4 texels in 8 bytes each, row by row of blocks. A side below 4 texels
/// is filled up to one block by repeating the last texel.
///
/// A block with a texel below [`OPAQUE_FROM`] is in the mode with three colours, where index 3 is
/// transparent. Others use either mode, whichever fits better, and never that index: what was
/// opaque decodes as opaque.
///
/// The format: Khronos Data Format Specification, chapter "S3TC Compressed Texture Image Formats".
#[must_use]
pub fn bc1(picture: &Picture) -> Vec<u8> {
    let texels = rgba8888(picture);
    let (width, height) = (picture.width(), picture.height());
    let texel = |x: u32, y: u32| texels[(y.min(height - 1) * width + x.min(width - 1)) as usize];
    let mut bytes = Vec::new();
    for top in (0..height).step_by(BLOCK as usize) {
        for left in (0..width).step_by(BLOCK as usize) {
            let block: [[u8; 4]; 16] = std::array::from_fn(|i| {
                let i = i as u32;
                texel(left + i % BLOCK, top + i / BLOCK)
            });
            bytes.extend(block::encoded(&block));
        }
    }
    bytes
}
