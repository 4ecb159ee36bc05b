//! Pictures of what goes on inside a frame: coordinates, levels, texels, errors.

use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use image::RgbImage;

use crate::choice::Perspective;
use crate::compare::compare;
use crate::error::Error;
use crate::filtering::{Filtering, Format, Within};
use crate::frame::Frame;
use crate::heat_map::heat_map;
use crate::lettering::with_legend;
use crate::output::image;
use crate::picture::Picture;
use crate::render::fragments;
use crate::shaded::{store, with_textures};
use crate::stored::Stored;

/// What to show in the place of the texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// Red grows with u within a repeat, green with v; blue marks odd repeats.
    Uv,
    /// A colour for each level, mixed where two are; a legend names them.
    Level,
    /// The error of the texture coordinates, as a heat map.
    Error,
    /// The texels of the level that is chosen, one by one: every other one darkened.
    TexelGrid,
}

impl View {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Uv, Self::Level, Self::Error, Self::TexelGrid];
}

impl fmt::Display for View {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Uv => "uv",
            Self::Level => "level",
            Self::Error => "error",
            Self::TexelGrid => "texel-grid",
        })
    }
}

impl FromStr for View {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|view| view.to_string() == s);
        found.ok_or_else(|| "choose one of uv, level, error, texel-grid".to_owned())
    }
}

/// Draws a view of a frame.
///
/// # Errors
///
/// [`Error::Core`] for a frame or texture that the core refuses.
pub fn view(
    frame: &Frame,
    perspective: Perspective,
    rows: u32,
    filtering: &Filtering,
    view: View,
) -> Result<RgbImage, Error> {
    let width = frame.viewport.width();
    // The choice of levels as it is, texels as they are.
    let plain = Filtering {
        min: crate::filtering::Minify {
            image: Within::Nearest,
            ..filtering.min
        },
        mag: Within::Nearest,
        format: Format::Rgb888,
        ..*filtering
    };
    let replaced = |texel: fn([u8; 3], Texel) -> [u8; 3]| {
        let textures = store(frame, &plain)?;
        let mut known: Vec<(&Arc<Stored>, Arc<Stored>)> = Vec::new();
        let mut all = Vec::new();
        for stored in &textures {
            let same = known.iter().find(|(other, _)| Arc::ptr_eq(other, stored));
            let new = if let Some((_, new)) = same {
                Arc::clone(new)
            } else {
                let new = Arc::new(Stored::of_levels(&levels(stored, texel)?)?);
                known.push((stored, Arc::clone(&new)));
                new
            };
            all.push(new);
        }
        with_textures(frame, perspective, rows, &plain, &all)
    };
    match view {
        View::Uv => {
            let pixels: Vec<_> = fragments(frame, perspective)?
                .into_iter()
                .map(|fragment| fragment.map_or([70, 70, 78], |f| repeat(f.uv)))
                .collect();
            Ok(image(&pixels, width))
        }
        View::Level => {
            let pixels = replaced(|_, texel| colour(texel.level))?.rgb();
            let most = frame
                .batches
                .iter()
                .map(|b| multum::pyramid::levels(b.picture.width(), b.picture.height()));
            let count = most.max().unwrap_or(1);
            let marks: Vec<_> = (0..count).map(|n| (n.to_string(), colour(n))).collect();
            let title = format!("level of detail, {filtering}");
            Ok(with_legend(&image(&pixels, width), &title, &marks))
        }
        View::TexelGrid => {
            let pixels = replaced(|rgb, texel| {
                if (texel.x + texel.y) % 2 == 0 {
                    rgb
                } else {
                    rgb.map(|c| (u16::from(c) * 5 / 8) as u8)
                }
            })?;
            Ok(image(&pixels.rgb(), width))
        }
        View::Error => {
            let report = compare(frame, perspective, rows, filtering)?;
            let title = format!("{perspective}: error in texels");
            Ok(heat_map(&report.error, width, &title))
        }
    }
}

/// Which texel it is.
#[derive(Clone, Copy)]
struct Texel {
    level: u32,
    x: u32,
    y: u32,
}

/// The levels of a pyramid with other colours.
fn levels(stored: &Stored, colour: fn([u8; 3], Texel) -> [u8; 3]) -> Result<Vec<Picture>, Error> {
    let mut pictures = Vec::new();
    for (number, level) in (0..).zip(stored.reference()) {
        let (width, height) = (level.width(), level.height());
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let pixels = places.zip(level.texels()).map(|((x, y), texel)| {
            let [r, g, b, _] = texel.map(|c| c as u8);
            let level = number;
            colour([r, g, b], Texel { level, x, y })
        });
        pictures.push(Picture::new(width, height, pixels.collect())?);
    }
    Ok(pictures)
}

/// The colour that stands for a level.
fn colour(level: u32) -> [u8; 3] {
    let c = colorous::TABLEAU10[level as usize % 10];
    [c.r, c.g, c.b]
}

/// The colour that stands for coordinates.
fn repeat(uv: multum::uv::Uv) -> [u8; 3] {
    let (u, v) = (uv.u.to_bits(), uv.v.to_bits());
    let within = |bits: i32| (bits >> 16 & 255) as u8;
    let odd = ((u >> 24) + (v >> 24)) & 1 != 0;
    [within(u), within(v), if odd { 160 } else { 32 }]
}
