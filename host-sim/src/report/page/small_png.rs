//! Pictures in few bytes: a page holds hundreds.

use std::collections::BTreeMap;

use image::RgbImage;
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter};

use crate::error::Error;

/// Most colours of a palette.
const COLOURS: usize = 256;

/// The smallest of several ways to write a picture as PNG, all without loss: with a palette where
/// it has few colours, rows as they are or as differences from their neighbours.
///
/// # Errors
///
/// [`Error::Content`] for a picture without pixels.
pub(super) fn smallest(picture: &RgbImage) -> Result<Vec<u8>, Error> {
    let ways = match palette(picture) {
        Some((palette, indices)) => vec![indexed(picture, &palette, &indices)],
        None => [Filter::NoFilter, Filter::Adaptive]
            .into_iter()
            .map(|filter| direct(picture, filter))
            .collect(),
    };
    let failed = |e: EncodingError| Error::content("picture", &e.to_string(), "report this");
    let ways: Vec<Vec<u8>> = ways.into_iter().collect::<Result<_, _>>().map_err(failed)?;
    Ok(ways.into_iter().min_by_key(Vec::len).unwrap_or_default())
}

/// The colours one after the other, and the number of each pixel's; none if there are too many.
fn palette(picture: &RgbImage) -> Option<(Vec<u8>, Vec<u8>)> {
    let mut known = BTreeMap::new();
    for pixel in picture.pixels() {
        known.insert(pixel.0, 0);
        if known.len() > COLOURS {
            return None;
        }
    }
    for (number, index) in (0..=u8::MAX).zip(known.values_mut()) {
        *index = number;
    }
    let indices = picture.pixels().map(|pixel| known[&pixel.0]).collect();
    Some((known.into_keys().flatten().collect(), indices))
}

fn indexed(picture: &RgbImage, palette: &[u8], indices: &[u8]) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, picture.width(), picture.height());
    encoder.set_color(ColorType::Indexed);
    encoder.set_palette(palette);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::High);
    encoder.set_filter(Filter::NoFilter);
    encoder.write_header()?.write_image_data(indices)?;
    Ok(bytes)
}

fn direct(picture: &RgbImage, filter: Filter) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, picture.width(), picture.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::High);
    encoder.set_filter(filter);
    encoder.write_header()?.write_image_data(picture.as_raw())?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::smallest;
    use image::{Rgb, RgbImage};

    fn is_kept(picture: &RgbImage) {
        let bytes = smallest(picture).expect("a PNG");
        let read = image::load_from_memory(&bytes).expect("a PNG").into_rgb8();
        assert_eq!(read, *picture);
    }

    #[test]
    fn few_colours_and_many_come_back() {
        is_kept(&RgbImage::from_fn(64, 64, |x, y| {
            Rgb([(x % 16) as u8, (y % 16) as u8, 7])
        }));
        is_kept(&RgbImage::from_fn(64, 64, |x, y| {
            Rgb([x as u8, y as u8, (x * y) as u8])
        }));
        // One more colour than a palette has.
        is_kept(&RgbImage::from_fn(257, 1, |x, _| {
            Rgb([(x / 2) as u8, x as u8, (x >> 8) as u8])
        }));
    }
}
