//! The families `filter` and `lod`: texels filtered within and between levels.

use std::path::Path;

use multum::depth::NoDepth;
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::{Rgb888, RgbColor};
use multum::lod::{EachPixel, Euclidean, Lod};
use multum::mipmap::Mipmapped;
use multum::perspective::PerPixel;
use multum::project::ScreenVertex;
use multum::pyramid::Pyramid;
use multum::setup::Cull;
use multum::sink::Band;
use multum::texture::Texture;
use serde::Deserialize;

use super::{Cases, Family, Mode, TexelVertex, Tile, broken, decode, json, mask, triangles};
use crate::any::{AnyChoice, AnyImage};
use crate::choice::with_wrap;
use crate::error::Error;
use crate::filtering::Within;
use crate::picture::Picture;
use crate::reference::lod::Choice;
use crate::stored::{AnyPyramid, Stored};

/// What a channel may differ by, in 8-bit units.
const TOLERANCE: u8 = 1;

/// The same where the independent renderer's own lambda is rough: linear between powers of two of
/// its square, up to 0.043 too small.
const ROUGH_TOLERANCE: u8 = 11;

#[derive(Deserialize)]
struct FilterSet {
    width: u32,
    height: u32,
    columns: u32,
    sheet: String,
    mask: String,
    levels: Vec<String>,
    #[serde(flatten)]
    cases: Cases<FilterCase>,
}

#[derive(Deserialize)]
struct FilterCase {
    tile: u32,
    min_filter: MinFilter,
    mag_filter: MagFilter,
    wrap_s: Mode,
    wrap_t: Mode,
    lambda: Lambda,
    tris: Vec<[TexelVertex; 3]>,
}

/// OpenGL's names in lower case.
#[derive(Clone, Copy, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
enum MinFilter {
    Nearest,
    Linear,
    NearestMipmapNearest,
    LinearMipmapNearest,
    NearestMipmapLinear,
    LinearMipmapLinear,
}

impl MinFilter {
    fn parts(self) -> (Within, Choice) {
        match self {
            Self::Nearest => (Within::Nearest, Choice::Base),
            Self::Linear => (Within::Linear, Choice::Base),
            Self::NearestMipmapNearest => (Within::Nearest, Choice::Nearest),
            Self::LinearMipmapNearest => (Within::Linear, Choice::Nearest),
            Self::NearestMipmapLinear => (Within::Nearest, Choice::Linear),
            Self::LinearMipmapLinear => (Within::Linear, Choice::Linear),
        }
    }
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum MagFilter {
    Nearest,
    Linear,
}

/// Who computed lambda.
#[derive(Clone, Copy, Deserialize, PartialEq)]
#[serde(rename_all = "lowercase")]
enum Lambda {
    Driver,
    Shader,
}

/// The family `name` of a data set's folder `filter`.
pub(super) fn family(dir: &Path, name: &str) -> Result<Family, Error> {
    let path = dir.join(name).with_extension("json");
    let set: FilterSet = json(&path)?;
    let (sheet_path, mask_path) = (dir.join(&set.sheet), dir.join(&set.mask));
    let sheet = decode(&sheet_path)?.into_rgb8();
    let masks = decode(&mask_path)?.into_luma8();
    let levels = set
        .levels
        .iter()
        .map(|file| Picture::load(&dir.join(file)).map(|(picture, _)| picture))
        .collect::<Result<Vec<_>, _>>()?;
    let stored = Stored::of_levels(&levels)?;
    let AnyPyramid::Rgb888(pyramid) = stored.pyramid()? else {
        return Err(broken(&path, &"the levels are not RGB"));
    };
    let mut family = Family {
        name: name.to_owned(),
        ..Family::default()
    };
    for case in &set.cases.cases {
        let tile =
            |path, image| Tile::find(path, image, set.columns, case.tile, set.width, set.height);
        let wanted = tile(&sheet_path, sheet.dimensions())?.of_rgb(&sheet);
        let masks = tile(&mask_path, masks.dimensions())?.of_grey(&masks);
        let triangles = triangles(&path, &case.tris)?;
        let size = (set.width, set.height);
        let drawn = draw(case, &triangles, &pyramid, size)
            .map_err(|e| Error::core(&path.display().to_string(), e))?;
        let (_, choice) = case.min_filter.parts();
        let tolerance = if case.lambda == Lambda::Driver && choice == Choice::Linear {
            ROUGH_TOLERANCE
        } else {
            TOLERANCE
        };
        family.cases += 1;
        for ((drawn, wanted), mask) in drawn.into_iter().zip(wanted).zip(masks) {
            let drawn = [drawn.r(), drawn.g(), drawn.b()];
            let off = drawn.iter().zip(wanted).map(|(a, b)| a.abs_diff(b));
            let off = off.max().unwrap_or_default();
            match mask {
                mask::AGREE => {
                    family.pixels += 1;
                    family.mismatches += usize::from(off > tolerance);
                }
                mask::OUTSIDE => {
                    family.pixels += 1;
                    family.mismatches += usize::from(off > 0);
                }
                mask::EXEMPT => family.exempt += 1,
                mask::QUAD => family.quads += 1,
                _ => family.ties += 1,
            }
        }
    }
    Ok(family)
}

/// The core's picture of a case.
fn draw(
    case: &FilterCase,
    triangles: &[[ScreenVertex; 3]],
    pyramid: &Pyramid<Texture<'_, Rgb888>>,
    (width, height): (u32, u32),
) -> Result<Vec<Rgb888>, multum::error::Error> {
    let mut pixels = vec![Rgb888::BLACK; (width * height) as usize];
    let mut band = Band::new(&mut pixels, width, height, width as usize, 0)?;
    let (min, choice) = case.min_filter.parts();
    let mag = match case.mag_filter {
        MagFilter::Nearest => Within::Nearest,
        MagFilter::Linear => Within::Linear,
    };
    let lod = Lod::new(AnyChoice(choice), Euclidean, EachPixel);
    with_wrap!(case.wrap_s.into(), U => with_wrap!(case.wrap_t.into(), V => {
        let sampler = Mipmapped::<_, _, _, _, U, V>::new(pyramid, AnyImage(min), AnyImage(mag), lod);
        let mut pipeline = Pipeline {
            strategy: PerPixel,
            sampler,
            depth: NoDepth,
            cull: Cull::Off,
        };
        for triangle in triangles {
            pipeline.draw_triangle(&mut band, triangle);
        }
    }));
    Ok(pixels)
}
