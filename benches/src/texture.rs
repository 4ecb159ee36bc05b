//! The texture that all draw with: a map of coordinates, 256x256 texels of RGB565.

use std::sync::LazyLock;

use host_sim::pattern;
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::pyramid::average::Average;
use multum::pyramid::{build::build, texels};

/// Texels of a side.
pub const SIDE: u32 = 256;

/// Texels of the finest level.
pub const TEXELS: usize = SIDE as usize * SIDE as usize;

static PYRAMID: LazyLock<Vec<Rgb565>> = LazyLock::new(|| {
    let mut all = pattern::coordinates().rgb565();
    all.resize(texels(SIDE, SIDE), Rgb565::default());
    build(&mut all, SIDE, SIDE, Average::default()).expect("a complete pyramid has this length");
    all
});

/// All levels, the finest first.
#[must_use]
pub fn pyramid() -> &'static [Rgb565] {
    &PYRAMID
}

/// The finest level, row by row from the top.
#[must_use]
pub fn finest() -> &'static [Rgb565; TEXELS] {
    PYRAMID
        .first_chunk()
        .expect("a pyramid begins with its finest level")
}
