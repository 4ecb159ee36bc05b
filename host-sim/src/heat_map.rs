//! A picture of the error: each pixel coloured by the distance of its texture coordinates from
//! the reference, on a logarithmic scale, with a legend below.

use image::{Rgb, RgbImage};
use multum::embedded_graphics::text::Alignment;

use crate::lettering;

/// Exponents of two at both ends of the scale, in texels.
const SCALE: (i32, i32) = (-8, 4);
/// Height of the legend in pixels.
const LEGEND: u32 = 26;
/// Where nothing was drawn.
const NOTHING: [u8; 3] = [70, 70, 78];

/// Steps of colour to an octave: more than the eye tells apart, few enough for a palette.
const STEPS: f64 = 16.0;

/// The colour of an error in level-0 texels.
fn colour(texels: f64) -> [u8; 3] {
    let (low, high) = (f64::from(SCALE.0), f64::from(SCALE.1));
    let position = if texels > 0.0 {
        (((texels.log2() - low) * STEPS).round() / STEPS / (high - low)).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let c = colorous::INFERNO.eval_continuous(position);
    [c.r, c.g, c.b]
}

/// The map of a frame of `width` columns: errors in level-0 texels row by row, `None` where
/// nothing was drawn.
#[must_use]
pub fn heat_map(errors: &[Option<f64>], width: u32, title: &str) -> RgbImage {
    let height = errors.len() as u32 / width.max(1);
    let mut image = RgbImage::new(width, height + LEGEND);
    for (i, error) in errors.iter().enumerate() {
        let (x, y) = (i as u32 % width, i as u32 / width);
        image.put_pixel(x, y, Rgb(error.map_or(NOTHING, colour)));
    }
    legend(&mut image, height, title);
    image
}

/// A bar with all colours, marked in texels.
fn legend(image: &mut RgbImage, top: u32, title: &str) {
    let width = image.width();
    let (left, right) = (12, width.saturating_sub(12));
    let length = f64::from(right.saturating_sub(left).max(1));
    let (low, high) = (f64::from(SCALE.0), f64::from(SCALE.1));
    for x in left..right {
        let exponent = low + (high - low) * f64::from(x - left) / length;
        for y in 10..16 {
            image.put_pixel(x, top + y, Rgb(colour(exponent.exp2())));
        }
    }
    let mut write = |text: &str, x: f64, y: u32, alignment| {
        lettering::write(image, text, (x as u32, top + y), alignment);
    };
    write(title, f64::from(width) / 2.0, 7, Alignment::Center);
    for exponent in (SCALE.0..=SCALE.1).step_by(2) {
        let x = f64::from(left) + length * (f64::from(exponent) - low) / (high - low);
        let label = if exponent < 0 {
            format!("1/{}", 1 << -exponent)
        } else {
            (1 << exponent).to_string()
        };
        write(&label, x, 24, Alignment::Center);
    }
}
