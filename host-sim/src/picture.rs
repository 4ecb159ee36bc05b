//! Pictures from PNG and JPEG files. An encoded file enters; what leaves is 8-bit RGB, and alpha
//! where the file has it, with sides that are powers of two, which is what a texture of the core
//! needs.

use std::io::Cursor;
use std::path::Path;

use image::imageops::{self, FilterType};
use image::{
    DynamicImage, GenericImageView as _, GrayImage, ImageDecoder, ImageReader, Limits, RgbImage,
};
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::error::Error as CoreError;
use multum::texture::MAX_TEXTURE_SIZE;

use crate::error::{Error, one_line};
use crate::file;

/// Largest side of a picture as loaded; larger ones are resampled to it.
pub const MAX_LOADED_SIDE: u32 = 1024;

/// Largest side of a file that is decoded at all.
pub const MAX_ENCODED_SIDE: u32 = 16_384;

/// Most memory that a decoder may take, in bytes: an RGBA picture of the largest size.
const MAX_DECODER_BYTES: u64 = 1 << 30;

/// An RGB picture, row by row from the top, with sides that are powers of two. Some have alpha.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    width: u32,
    height: u32,
    pixels: Vec<[u8; 3]>,
    /// One byte a pixel; not all are 255.
    alpha: Option<Vec<u8>>,
}

impl Picture {
    /// An opaque picture of `width * height` pixels, row by row from the top.
    ///
    /// # Errors
    ///
    /// [`Error::Core`] unless both sides are powers of two up to [`MAX_TEXTURE_SIZE`] and the
    /// number of pixels fits.
    pub fn new(width: u32, height: u32, pixels: Vec<[u8; 3]>) -> Result<Self, Error> {
        check_sides(width, height)?;
        check_length(width, height, pixels.len())?;
        Ok(Self {
            width,
            height,
            pixels,
            alpha: None,
        })
    }

    /// The picture with this alpha, one byte a pixel: 0 is transparent, 255 opaque. Colours are
    /// not multiplied by it.
    ///
    /// # Errors
    ///
    /// [`Error::Core`] unless there are as many values as pixels.
    pub fn with_alpha(mut self, alpha: Vec<u8>) -> Result<Self, Error> {
        check_length(self.width, self.height, alpha.len())?;
        self.alpha = unless_opaque(alpha);
        Ok(self)
    }

    /// One pixel of one colour.
    #[must_use]
    pub fn of_colour(rgb: [u8; 3]) -> Self {
        Self {
            width: 1,
            height: 1,
            pixels: vec![rgb],
            alpha: None,
        }
    }

    /// Loads a PNG or JPEG file, as [`Picture::from_encoded`] does.
    ///
    /// # Errors
    ///
    /// [`Error::Read`] or [`Error::Content`].
    pub fn load(path: &Path) -> Result<(Self, Option<String>), Error> {
        let bytes = file::read(path)?;
        decode(&bytes, &path.display().to_string(), &file::name(path))
    }

    /// Decodes a PNG or JPEG picture; `label` names it in messages. Each side is resampled to the
    /// nearest power of two, at most [`MAX_LOADED_SIDE`]; the text, if any, tells the user so.
    ///
    /// # Errors
    ///
    /// [`Error::Content`] if the data is broken, not PNG or JPEG, empty, or has a side above
    /// [`MAX_ENCODED_SIDE`]; sizes are checked before any pixel is decoded.
    pub fn from_encoded(bytes: &[u8], label: &str) -> Result<(Self, Option<String>), Error> {
        decode(bytes, label, label)
    }

    /// The picture resampled to other sides; alpha is resampled like a colour.
    ///
    /// # Errors
    ///
    /// [`Error::Core`] unless both sides are powers of two up to [`MAX_TEXTURE_SIZE`].
    pub fn resized(&self, width: u32, height: u32) -> Result<Self, Error> {
        check_sides(width, height)?;
        if (width, height) == (self.width, self.height) {
            return Ok(self.clone());
        }
        let image = RgbImage::from_fn(self.width, self.height, |x, y| {
            image::Rgb(self.pixels[(y * self.width + x) as usize])
        });
        let alpha = self.alpha.as_ref().map(|alpha| {
            GrayImage::from_fn(self.width, self.height, |x, y| {
                image::Luma([alpha[(y * self.width + x) as usize]])
            })
        });
        Ok(resample(&image, alpha.as_ref(), width, height))
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Red, green and blue, row by row from the top.
    #[must_use]
    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.pixels
    }

    /// Opacity, one byte a pixel like [`Picture::pixels`]; `None` if all are opaque.
    #[must_use]
    pub fn alpha(&self) -> Option<&[u8]> {
        self.alpha.as_deref()
    }

    /// The pixels in RGB565, each channel rounded to the nearest value.
    #[must_use]
    pub fn rgb565(&self) -> Vec<Rgb565> {
        // 255 is odd, so no channel lies half way between two values.
        let channel = |value: u8, max: u32| ((u32::from(value) * max + 127) / 255) as u8;
        self.pixels
            .iter()
            .map(|&[r, g, b]| Rgb565::new(channel(r, 31), channel(g, 63), channel(b, 31)))
            .collect()
    }
}

fn check_sides(width: u32, height: u32) -> Result<(), Error> {
    let fits = |side: u32| side.is_power_of_two() && side <= MAX_TEXTURE_SIZE;
    if fits(width) && fits(height) {
        Ok(())
    } else {
        let refused = CoreError::TextureSize { width, height };
        Err(Error::core("picture", refused))
    }
}

fn check_length(width: u32, height: u32, given: usize) -> Result<(), Error> {
    let needed = width as usize * height as usize;
    if given == needed {
        Ok(())
    } else {
        let refused = CoreError::BufferLength { needed, given };
        Err(Error::core("picture", refused))
    }
}

fn unless_opaque(alpha: Vec<u8>) -> Option<Vec<u8>> {
    alpha.iter().any(|&a| a != u8::MAX).then_some(alpha)
}

/// `place` names the picture in errors, `name` in the notice.
fn decode(bytes: &[u8], place: &str, name: &str) -> Result<(Picture, Option<String>), Error> {
    let broken = |e: image::ImageError| {
        Error::content(
            place,
            &format!("not a usable picture ({e})"),
            "give an undamaged PNG or JPEG file of 1x1 to 16384x16384 pixels",
        )
    };
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_DECODER_BYTES);
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|e| broken(e.into()))?;
    reader.limits(limits.clone());
    let mut decoder = reader.into_decoder().map_err(broken)?;
    let (width, height) = decoder.dimensions();
    if width == 0 || height == 0 || width > MAX_ENCODED_SIDE || height > MAX_ENCODED_SIDE {
        return Err(Error::content(
            place,
            &format!("a picture of {width}x{height} pixels"),
            "give one of 1x1 to 16384x16384",
        ));
    }
    limits.reserve(decoder.total_bytes()).map_err(broken)?;
    decoder.set_limits(limits).map_err(broken)?;
    let image = DynamicImage::from_decoder(decoder).map_err(broken)?;
    // A plane of its own: the colours stay what they are without alpha.
    let alpha = image.color().has_alpha().then(|| {
        GrayImage::from_fn(width, height, |x, y| {
            image::Luma([image.get_pixel(x, y).0[3]])
        })
    });
    let image = image.into_rgb8();
    let (to_width, to_height) = (nearest_side(width), nearest_side(height));
    let notice = ((width, height) != (to_width, to_height)).then(|| {
        one_line(&format!(
            "{name}: {width}x{height} resampled to {to_width}x{to_height}"
        ))
    });
    Ok((
        resample(&image, alpha.as_ref(), to_width, to_height),
        notice,
    ))
}

/// The power of two nearest to `side` (the larger of two equally near), at most
/// [`MAX_LOADED_SIDE`].
fn nearest_side(side: u32) -> u32 {
    let above = side.next_power_of_two();
    let below = (above / 2).max(1);
    let nearest = if side - below < above - side {
        below
    } else {
        above
    };
    nearest.min(MAX_LOADED_SIDE)
}

/// A picture of sides that the caller has checked.
fn resample(image: &RgbImage, alpha: Option<&GrayImage>, width: u32, height: u32) -> Picture {
    let same = image.dimensions() == (width, height);
    let filter = FilterType::Lanczos3;
    let pixels = if same {
        image.pixels().map(|p| p.0).collect()
    } else {
        let image = imageops::resize(image, width, height, filter);
        image.pixels().map(|p| p.0).collect()
    };
    let alpha = alpha.and_then(|alpha| {
        unless_opaque(if same {
            alpha.as_raw().clone()
        } else {
            imageops::resize(alpha, width, height, filter).into_raw()
        })
    });
    Picture {
        width,
        height,
        pixels,
        alpha,
    }
}

#[cfg(test)]
mod tests {
    use super::nearest_side;

    #[test]
    fn sides_go_to_the_nearest_power_of_two() {
        let cases = [
            (1, 1),
            (2, 2),
            (3, 4),
            (5, 4),
            (6, 8),
            (300, 256),
            (383, 256),
            (384, 512),
            (451, 512),
            (1024, 1024),
            (1025, 1024),
            (16_384, 1024),
        ];
        for (side, expected) in cases {
            assert_eq!(nearest_side(side), expected, "{side}");
        }
    }
}
