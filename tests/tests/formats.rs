//! Pixel formats, the way to a display, and the hash of a frame.

use multum::depth::NoDepth;
use multum::draw::Pipeline;
use multum::embedded_graphics::mock_display::MockDisplay;
use multum::embedded_graphics::pixelcolor::{Gray8, Rgb565, Rgb888};
use multum::embedded_graphics::prelude::*;
use multum::fixed::types::{I16F16, I24F8};
use multum::hash::FrameHash;
use multum::perspective::Every;
use multum::project::ScreenVertex;
use multum::sample::Nearest;
use multum::setup::Cull;
use multum::sink::Band;
use multum::texture::{Repeat, Texture};

const SIDE: u32 = 8;

/// A triangle pair over the whole frame that shows a texture of the frame's size texel by pixel.
fn drawn<C, P>(texels: &[C], background: P) -> Vec<P>
where
    C: Copy + Default + Into<P>,
    P: Copy,
{
    let corner = |x: u32, y: u32| {
        let repeats = |c: u32| I16F16::from_num(c) / I16F16::from_num(SIDE);
        let uv = [repeats(x), repeats(y)];
        ScreenVertex::new(I24F8::from_num(x), I24F8::from_num(y), I16F16::ONE, uv)
            .expect("a vertex in range")
    };
    let [a, b, c, d] = [
        corner(0, 0),
        corner(0, SIDE),
        corner(SIDE, SIDE),
        corner(SIDE, 0),
    ];
    let texture = Texture::new(texels, SIDE, SIDE).expect("a texture in range");
    let mut pixels = vec![background; (SIDE * SIDE) as usize];
    let mut band = Band::new(&mut pixels, SIDE, SIDE, SIDE as usize, 0).expect("a frame in range");
    let mut pipeline = Pipeline {
        strategy: Every::<16>,
        sampler: Nearest::<_, Repeat>::new(texture),
        depth: NoDepth,
        cull: Cull::Off,
    };
    pipeline.draw_triangle(&mut band, &[a, b, c]);
    pipeline.draw_triangle(&mut band, &[a, c, d]);
    pixels
}

fn grey() -> Vec<Gray8> {
    (0..SIDE * SIDE)
        .map(|i| Gray8::new((i * 4) as u8))
        .collect()
}

fn rgb888() -> Vec<Rgb888> {
    (0..SIDE * SIDE)
        .map(|i| Rgb888::new((i * 4) as u8, (255 - i) as u8, (i * 3) as u8))
        .collect()
}

fn rgb565() -> Vec<Rgb565> {
    rgb888().into_iter().map(Rgb565::from).collect()
}

#[test]
fn a_texture_is_drawn_texel_by_pixel_in_its_own_format() {
    assert_eq!(drawn(&grey(), Gray8::BLACK), grey());
    assert_eq!(drawn(&rgb888(), Rgb888::BLACK), rgb888());
    assert_eq!(drawn(&rgb565(), Rgb565::BLACK), rgb565());
}

#[test]
fn a_frame_of_another_format_takes_the_colours_that_embedded_graphics_converts_to() {
    let converted: Vec<Rgb565> = grey().into_iter().map(Rgb565::from).collect();
    assert_eq!(drawn(&grey(), Rgb565::BLACK), converted);
    assert_eq!(drawn(&rgb888(), Rgb565::BLACK), rgb565());
}

#[test]
fn a_band_goes_to_its_rows_of_a_display_without_what_the_stride_leaves_over() {
    // Two rows of three pixels, five apart, from row 4 on.
    let mut pixels = [Rgb565::WHITE; 8];
    for (i, colour) in [(0, Rgb565::RED), (1, Rgb565::GREEN), (2, Rgb565::BLUE)] {
        pixels[i] = colour;
    }
    for (i, colour) in [(5, Rgb565::YELLOW), (6, Rgb565::CYAN), (7, Rgb565::MAGENTA)] {
        pixels[i] = colour;
    }
    let band = Band::new(&mut pixels, 3, 2, 5, 4).expect("a band in range");
    let mut display = MockDisplay::new();
    band.send_to(&mut display)
        .expect("a display that takes all");
    display.assert_pattern(&["   ", "   ", "   ", "   ", "RGB", "YCM"]);
}

#[test]
fn the_hash_is_fnv_1a_of_little_endian_pixels() {
    fn hash<C>(pixels: &mut [C], width: u32) -> u64
    where
        C: PixelColor + multum::embedded_graphics::pixelcolor::raw::ToBytes,
        C::Bytes: AsRef<[u8]>,
    {
        let stride = width as usize;
        let height = (pixels.len() / stride) as u32;
        let band = Band::new(pixels, width, height, stride, 0).expect("a frame in range");
        let mut hash = FrameHash::new();
        hash.add(&band);
        hash.value()
    }
    // Test vectors of draft-eastlake-fnv: "a" and "foobar".
    assert_eq!(hash(&mut [Gray8::new(b'a')], 1), 0xaf63_dc4c_8601_ec8c);
    let mut letters = b"foobar".map(Gray8::new);
    assert_eq!(hash(&mut letters, 3), 0x8594_4171_f739_67e8);
    // Rgb565 of raw bits 0x6f66, 0x626f, 0x7261 are the same six letters.
    let mut colours = [0x6f66u16, 0x626f, 0x7261]
        .map(|raw| Rgb565::from(multum::embedded_graphics::pixelcolor::raw::RawU16::new(raw)));
    assert_eq!(hash(&mut colours, 3), 0x8594_4171_f739_67e8);
    assert_eq!(FrameHash::new().value(), 0xcbf2_9ce4_8422_2325);
}
