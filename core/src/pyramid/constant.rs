//! Pyramids that the compiler computes: the picture's bytes enter, an array for flash leaves.
//!
//! ```
//! use multum::embedded_graphics::pixelcolor::Rgb565;
//! use multum::pyramid::{self, Pyramid, average::Average};
//! use multum::texture::Texture;
//!
//! // Usually include_bytes!("brick.raw").
//! static TEXELS: [Rgb565; pyramid::texels(2, 2)] =
//!     pyramid::constant::rgb565(&[0x00, 0xf8, 0xff, 0xff, 0xff, 0xff, 0x00, 0xf8], 2, 2, Average::Stored);
//! static BRICK: Pyramid<Texture<'static, Rgb565>> = match Pyramid::<Texture<'_, _>>::new(&TEXELS, 2, 2) {
//!     Ok(pyramid) => pyramid,
//!     Err(_) => panic!("not a pyramid"),
//! };
//! assert_eq!(BRICK.last(), 1);
//! ```
//!
//! A length that is not the one that the sides need does not compile:
//!
//! ```compile_fail
//! use multum::embedded_graphics::pixelcolor::Gray8;
//! use multum::pyramid::{self, average::Average};
//!
//! static TEXELS: [Gray8; 4] = pyramid::constant::gray8(&[1, 2, 3, 4], 2, 2, Average::Stored);
//! ```

use embedded_graphics::pixelcolor::{Gray8, Rgb565, Rgb888};

use super::average::{Average, mean};
use super::{level_size, levels, texels};
use crate::colour::Channel;

/// Writes a function for a colour with the given channels. A texel is a number of `$word` with the
/// channels at their shifts; `$read` takes one from the bytes.
macro_rules! pyramid {
    (
        $(#[$meta:meta])*
        $name:ident, $colour:ty, $bytes:literal,
        |$of:ident, $at:ident| $read:expr,
        [$(($shift:literal, $bits:literal)),+],
        |$texel:ident| $make:expr
    ) => {
        $(#[$meta])*
        ///
        /// # Panics
        ///
        /// Which in a `const` or `static` is a compile error: if a side is not a power of two up
        /// to 4096, if there are not as many bytes as the size needs, or if `N` is not
        /// [`texels`] of the size.
        #[must_use]
        pub const fn $name<const N: usize>(
            bytes: &[u8],
            width: u32,
            height: u32,
            average: Average,
        ) -> [$colour; N] {
            let base = width as usize * height as usize;
            check(bytes.len(), $bytes * base, N, width, height);
            let mut all = [0u32; N];
            let mut number = 0;
            while number < base {
                let ($of, $at) = (bytes, $bytes * number);
                all[number] = $read;
                number += 1;
            }
            let (mut from, mut to) = (0, base);
            let mut level = 1;
            while level < levels(width, height) {
                let (finer, _) = level_size(width, height, level - 1);
                let (columns, rows) = level_size(width, height, level);
                let (right, below) = steps(width, height, level);
                let mut place = 0;
                while place < columns as usize * rows as usize {
                    let (column, row) = (place as u32 % columns, place as u32 / columns);
                    let first = from + ((row << below) * finer + (column << right)) as usize;
                    let next = first + below as usize * finer as usize;
                    let right = right as usize;
                    let four = [all[first], all[first + right], all[next], all[next + right]];
                    all[to + place] = 0 $(| channel(four, $shift, $bits, average))+;
                    place += 1;
                }
                from = to;
                to += columns as usize * rows as usize;
                level += 1;
            }
            let mut colours = [{ let $texel = 0u32; $make }; N];
            let mut number = 0;
            while number < N {
                let $texel = all[number];
                colours[number] = $make;
                number += 1;
            }
            colours
        }
    };
}

/// One channel of the mean of four texels, where it was.
const fn channel(four: [u32; 4], shift: u32, bits: u32, average: Average) -> u32 {
    let most = (1 << bits) - 1;
    let [a, b, c, d] = four;
    let values = [
        a >> shift & most,
        b >> shift & most,
        c >> shift & most,
        d >> shift & most,
    ];
    let is_alpha = false;
    mean(values, Channel { bits, is_alpha }, average) << shift
}

/// Whether the level before this one is wider, and whether it is higher: 1 or 0.
const fn steps(width: u32, height: u32, level: u32) -> (u32, u32) {
    let (wide, high) = level_size(width, height, level - 1);
    ((wide > 1) as u32, (high > 1) as u32)
}

const fn check(given: usize, needed: usize, room: usize, width: u32, height: u32) {
    assert!(
        width.is_power_of_two() && height.is_power_of_two(),
        "the sides of a texture are powers of two"
    );
    assert!(
        width <= crate::texture::MAX_TEXTURE_SIZE && height <= crate::texture::MAX_TEXTURE_SIZE,
        "the sides of a texture are at most 4096"
    );
    assert!(given == needed, "not as many bytes as the picture needs");
    assert!(
        room == texels(width, height),
        "not as long as pyramid::texels says"
    );
}

pyramid!(
    /// From RGB565 texels, row by row from the top, each as two little-endian bytes.
    rgb565, Rgb565, 2,
    |bytes, at| bytes[at] as u32 | (bytes[at + 1] as u32) << 8,
    [(11, 5), (5, 6), (0, 5)],
    |texel| Rgb565::new((texel >> 11) as u8, (texel >> 5 & 63) as u8, (texel & 31) as u8)
);

pyramid!(
    /// From texels of three bytes, red, green and blue, row by row from the top.
    rgb888, Rgb888, 3,
    |bytes, at| (bytes[at] as u32) << 16 | (bytes[at + 1] as u32) << 8 | bytes[at + 2] as u32,
    [(16, 8), (8, 8), (0, 8)],
    |texel| Rgb888::new((texel >> 16) as u8, (texel >> 8) as u8, texel as u8)
);

pyramid!(
    /// From texels of one byte, row by row from the top.
    gray8, Gray8, 1,
    |bytes, at| bytes[at] as u32,
    [(0, 8)],
    |texel| Gray8::new(texel as u8)
);
