//! Words in pictures: titles, labels and legends.

use image::{GenericImage as _, Rgb, RgbImage};
use multum::embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_5X8};
use multum::embedded_graphics::pixelcolor::{Rgb888, RgbColor};
use multum::embedded_graphics::prelude::*;
use multum::embedded_graphics::text::{Alignment, Text};

/// Height of a line of text and its margins, in pixels.
pub const LINE: u32 = 11;

/// Writes a white line; `at` is the column that the alignment refers to and the row of the text's
/// baseline. What reaches beyond the picture is cut off.
pub fn write(image: &mut RgbImage, text: &str, at: (u32, u32), alignment: Alignment) {
    let style = MonoTextStyle::new(&FONT_5X8, Rgb888::WHITE);
    let at = Point::new(at.0.cast_signed(), at.1.cast_signed());
    // A canvas cannot fail.
    _ = Text::with_alignment(text, at, style, alignment).draw(&mut Canvas(image));
}

/// A picture with a title and a legend of coloured fields below it.
#[must_use]
pub fn with_legend(image: &RgbImage, title: &str, fields: &[(String, [u8; 3])]) -> RgbImage {
    let (width, height) = image.dimensions();
    let mut result = RgbImage::new(width, height + 2 * LINE + 2);
    // The result is larger: it fits.
    _ = result.copy_from(image, 0, 0);
    write(
        &mut result,
        title,
        (width / 2, height + 8),
        Alignment::Center,
    );
    let each = width / (fields.len() as u32).max(1);
    for (number, (label, colour)) in (0..).zip(fields) {
        let left = number * each;
        for x in left + 2..(left + 10).min(width) {
            for y in height + LINE + 2..height + 2 * LINE - 1 {
                result.put_pixel(x, y, Rgb(*colour));
            }
        }
        let at = (left + 13, height + 2 * LINE - 2);
        write(&mut result, label, at, Alignment::Left);
    }
    result
}

/// Pictures of one size in rows of `columns`, each under its title.
#[must_use]
pub fn side_by_side(pictures: &[(String, RgbImage)], columns: u32) -> RgbImage {
    const GAP: u32 = 4;
    let (width, height) = pictures.first().map_or((1, 1), |(_, p)| p.dimensions());
    let columns = columns.clamp(1, (pictures.len() as u32).max(1));
    let rows = (pictures.len() as u32).div_ceil(columns);
    let mut result = RgbImage::new(
        columns * (width + GAP) - GAP,
        rows.max(1) * (height + LINE + GAP) - GAP,
    );
    for (number, (title, picture)) in (0..).zip(pictures) {
        let (left, top) = (
            number % columns * (width + GAP),
            number / columns * (height + LINE + GAP),
        );
        write(
            &mut result,
            title,
            (left + width / 2, top + 8),
            Alignment::Center,
        );
        // It was made for them; one of another size is cut off.
        _ = result.copy_from(picture, left, top + LINE);
    }
    result
}

/// Lets embedded-graphics write its fonts into an image.
struct Canvas<'a>(&'a mut RgbImage);

impl OriginDimensions for Canvas<'_> {
    fn size(&self) -> Size {
        Size::new(self.0.width(), self.0.height())
    }
}

impl DrawTarget for Canvas<'_> {
    type Color = Rgb888;
    type Error = core::convert::Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(
        &mut self,
        pixels: I,
    ) -> Result<(), Self::Error> {
        for Pixel(at, c) in pixels {
            if let (Ok(x), Ok(y)) = (u32::try_from(at.x), u32::try_from(at.y))
                && let Some(pixel) = self.0.get_pixel_mut_checked(x, y)
            {
                *pixel = Rgb([c.r(), c.g(), c.b()]);
            }
        }
        Ok(())
    }
}
