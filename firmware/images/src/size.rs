//! What the images share that show what a filter takes: one triangle, and a pyramid in flash.

use multum::depth::NoDepth;
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::fixed::types::{I16F16, I24F8};
use multum::hash::FrameHash;
use multum::perspective::Every;
use multum::project::ScreenVertex;
use multum::pyramid::average::Average;
use multum::pyramid::{self, Pyramid};
use multum::setup::Cull;
use multum::shade::Shader;
use multum::sink::Band;
use multum::texture::Texture;

use crate::host::{Output, exit};
use crate::machine::singleton;

const SIDE: u32 = 64;
const TEXELS: usize = SIDE as usize * SIDE as usize;
const WIDTH: u32 = 64;
const HEIGHT: u32 = 32;
const PIXELS: usize = WIDTH as usize * HEIGHT as usize;

/// A picture, as two bytes a texel.
static BYTES: [u8; 2 * TEXELS] = {
    let mut bytes = [0; 2 * TEXELS];
    let mut state: u32 = 1;
    let mut byte = 0;
    while byte < bytes.len() {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        bytes[byte] = (state >> 24) as u8;
        byte += 1;
    }
    bytes
};

/// Its levels, computed by the compiler.
static SIZE_LEVELS: [Rgb565; pyramid::texels(SIDE, SIDE)] =
    pyramid::constant::rgb565(&BYTES, SIDE, SIDE, Average::Light);

/// The first of them alone.
static SIZE_PICTURE: [Rgb565; TEXELS] = {
    let mut texels = [Rgb565::new(0, 0, 0); TEXELS];
    let mut texel = 0;
    while texel < TEXELS {
        texels[texel] = SIZE_LEVELS[texel];
        texel += 1;
    }
    texels
};

/// All levels.
pub static PYRAMID: Pyramid<Texture<'static, Rgb565>> =
    match Pyramid::<Texture<'_, _>>::new(&SIZE_LEVELS, SIDE, SIDE) {
        Ok(pyramid) => pyramid,
        Err(_) => panic!("not a pyramid"),
    };

/// The first level, in flash with all others.
pub const FINEST: Texture<'static, Rgb565> = texture(SIZE_LEVELS.split_at(TEXELS).0);

/// The same picture without other levels.
pub const PICTURE: Texture<'static, Rgb565> = texture(&SIZE_PICTURE);

const fn texture(texels: &'static [Rgb565]) -> Texture<'static, Rgb565> {
    match Texture::new(texels, SIDE, SIDE) {
        Ok(texture) => texture,
        Err(_) => panic!("not a texture"),
    }
}

/// Draws the triangle, prints its hash and ends.
pub fn draw<S: Shader<Texel: Into<Rgb565>>>(sampler: S) -> ! {
    let corner = |x: i32, y: i32, w: i32, u: i32, v: i32| {
        // Hidden from the compiler, which would draw the triangle itself.
        let [x, y, w, u, v] = core::hint::black_box([x, y, w, u, v]);
        ScreenVertex::new(
            I24F8::from_bits(x << 8),
            I24F8::from_bits(y << 8),
            I16F16::from_bits(w << 16),
            [u, v].map(|c| I16F16::from_bits(c << 16)),
        )
    };
    let corners = (
        corner(0, 0, 1, 0, 0),
        corner(0, 32, 1, 0, 2),
        corner(64, 32, 4, 8, 8),
    );
    let pixels = singleton!(: [Rgb565; PIXELS] = [Rgb565::new(0, 0, 0); PIXELS]);
    let ((Some(a), Some(b), Some(c)), Some(pixels)) = (corners, pixels) else {
        exit(false);
    };
    let Ok(mut band) = Band::new(pixels, WIDTH, HEIGHT, WIDTH as usize, 0) else {
        exit(false);
    };
    let mut pipeline = Pipeline {
        strategy: Every::<16>,
        sampler,
        depth: NoDepth,
        cull: Cull::Off,
    };
    pipeline.draw_triangle(&mut band, &[a, b, c]);
    let mut hash = FrameHash::new();
    hash.add(&band);
    Output::new().hex(hash.value()).text("\n");
    exit(true)
}
