//! The shaders of the images that measure filters.

use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::filter::{ImageFilter, LinearTexels, NearestTexel};
use multum::lod::{EachPiece, LinearLevels, Lod, LongestAxis, NearestLevel, Rate};
use multum::mipmap::Mipmapped;
use multum::pyramid::average::Average;
use multum::pyramid::build::build;
use multum::pyramid::{self, Pyramid};
use multum::shade::Shader;
use multum::texture::{Repeat, Texture};

use crate::machine::singleton;
use crate::measure::{SIDE, TEXELS, noise};

/// Levels of RGB565.
pub type Levels = Pyramid<Texture<'static, Rgb565>>;

/// Texels of a pyramid.
pub const ALL_TEXELS: usize = pyramid::texels(SIDE, SIDE);

/// The texels of a pyramid, of which the finest level is noise. Once.
#[must_use]
pub fn unbuilt() -> Option<&'static mut [Rgb565]> {
    use multum::embedded_graphics::pixelcolor::raw::RawU16;
    let texels = singleton!(: [Rgb565; ALL_TEXELS] = [Rgb565::new(0, 0, 0); ALL_TEXELS])?;
    for (texel, bits) in texels.iter_mut().zip(noise()).take(TEXELS) {
        *texel = RawU16::new(bits).into();
    }
    Some(texels)
}

/// A pyramid over noise. Once.
#[must_use]
pub fn levels() -> Option<Levels> {
    build(unbuilt()?, SIDE, SIDE, Average::Stored).ok()
}

/// The nearest texel of the nearest level.
pub fn nearest_level<R: Rate>(levels: &Levels, rate: R) -> impl Shader<Texel = Rgb565> {
    let lod = Lod::new(NearestLevel, LongestAxis, rate);
    Mipmapped::<_, _, _, _, Repeat>::new(levels, NearestTexel, NearestTexel, lod)
}

/// Bilinear on the nearest level.
pub fn linear_nearest_level(levels: &Levels) -> impl Shader<Texel = Rgb565> {
    let lod = Lod::new(NearestLevel, LongestAxis, EachPiece);
    Mipmapped::<_, _, _, _, Repeat>::new(levels, LinearTexels, LinearTexels, lod)
}

/// Trilinear, by a filter within a level.
pub fn trilinear<F: ImageFilter, R: Rate>(
    levels: &Levels,
    filter: F,
    rate: R,
) -> Mipmapped<'_, Texture<'static, Rgb565>, F, F, Lod<LinearLevels, LongestAxis, R>, Repeat> {
    let lod = Lod::new(LinearLevels, LongestAxis, rate);
    Mipmapped::new(levels, filter, filter, lod)
}
