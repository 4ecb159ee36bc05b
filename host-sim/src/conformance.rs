//! A conformance data set: triangles with the pixels that an independent OpenGL implementation
//! drew for them. The core draws every case; what differs is counted.
//!
//! The format is described in the data set's own README.md.

mod filter;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use image::{GrayImage, RgbImage};
use multum::depth::NoDepth;
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::{Rgb888, RgbColor};
use multum::fixed::types::{I16F16, I24F8};
use multum::perspective::PerPixel;
use multum::project::ScreenVertex;
use multum::sample::Nearest;
use multum::setup::Cull;
use multum::sink::Band;
use multum::texture::Texture;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::choice::with_wrap;
use crate::error::Error;
use crate::picture::Picture;
use crate::reference::{Beyond, Corners, Coverage, Planes};
use crate::render::spans;

/// Grid units per pixel of the data set's vertices.
const UNIT: i64 = 16;

/// What came of one family of cases.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Family {
    /// Its name.
    pub name: String,
    /// Cases in it.
    pub cases: usize,
    /// Pixels compared.
    pub pixels: usize,
    /// Pixels left out because they are too near to where another texel or level is taken.
    pub ties: usize,
    /// Pixels left out because they hold only for a lambda from differences in 2x2 pixels; the
    /// core's is the derivative at the pixel.
    pub quads: usize,
    /// Pixels left out because the independent renderer itself is wrong there.
    pub exempt: usize,
    /// Pixels that differ.
    pub mismatches: usize,
    /// Pixels that differ where only the data set's own ties are left out; texel cases only.
    pub strict_mismatches: Option<usize>,
}

/// Draws a data set and compares; `texel_tolerance` in texels is the width of a tie.
///
/// # Errors
///
/// [`Error::Read`] or [`Error::Content`] for a data set that is missing or broken.
pub fn run(dir: &Path, texel_tolerance: f64) -> Result<Vec<Family>, Error> {
    let mut families = coverage(&dir.join("coverage"))?;
    families.push(texel(&dir.join("texel"), texel_tolerance)?);
    for name in ["filter", "lod"] {
        families.push(filter::family(&dir.join("filter"), name)?);
    }
    Ok(families)
}

#[derive(Deserialize)]
struct Sheet {
    file: String,
    columns: u32,
}

#[derive(Deserialize)]
struct CoverageRow {
    id: u32,
    sheet: String,
    tile: u32,
    width: u32,
    height: u32,
    x0: i32,
    y0: i32,
    x1: i32,
    y1: i32,
    x2: i32,
    y2: i32,
}

fn coverage(dir: &Path) -> Result<Vec<Family>, Error> {
    let sheets: BTreeMap<String, Sheet> = json(&dir.join("sheets.json"))?;
    let path = dir.join("coverage.csv");
    let reader = csv::Reader::from_reader(open(&path)?);
    // The triangles of one mesh share an id.
    let mut cases: BTreeMap<u32, Vec<CoverageRow>> = BTreeMap::new();
    for row in reader.into_deserialize() {
        let row: CoverageRow = row.map_err(|e| broken(&path, &e))?;
        cases.entry(row.id).or_default().push(row);
    }
    let mut families = Vec::new();
    for (name, sheet) in &sheets {
        let file = dir.join(&sheet.file);
        let image = decode(&file)?.into_luma8();
        let mut family = Family {
            name: format!("coverage {name}"),
            ..Family::default()
        };
        for rows in cases.values() {
            let Some(first) = rows.first().filter(|row| row.sheet == *name) else {
                continue;
            };
            let (width, height) = (first.width, first.height);
            let tile = Tile::find(
                &file,
                image.dimensions(),
                sheet.columns,
                first.tile,
                width,
                height,
            )?;
            let mut drawn = vec![0u8; (width * height) as usize];
            for row in rows {
                let corners = [[row.x0, row.y0], [row.x1, row.y1], [row.x2, row.y2]];
                let vertices = vertices(corners, [1.0; 3], [[0.0; 2]; 3])
                    .ok_or_else(|| broken(&path, &"a vertex is out of range"))?;
                for span in spans(&vertices, width, height, Cull::Off) {
                    for x in span.left..span.right {
                        drawn[(span.y.cast_unsigned() * width + x.cast_unsigned()) as usize] += 1;
                    }
                }
            }
            // Meshes hold how often each pixel is drawn, single triangles 0 or 255.
            let value = if name == "mesh" { 1 } else { 255 };
            family.cases += 1;
            family.pixels += drawn.len();
            family.mismatches += drawn
                .iter()
                .zip(tile.of_grey(&image))
                .filter(|(drawn, wanted)| drawn.checked_mul(value) != Some(*wanted))
                .count();
        }
        families.push(family);
    }
    Ok(families)
}

#[derive(Deserialize)]
struct Cases<T> {
    cases: Vec<T>,
}

#[derive(Deserialize)]
struct TexelSet {
    width: u32,
    height: u32,
    columns: u32,
    sheet: String,
    mask: String,
    texture: String,
    #[serde(flatten)]
    cases: Cases<TexelCase>,
}

#[derive(Deserialize)]
struct TexelCase {
    tile: u32,
    wrap_s: Mode,
    wrap_t: Mode,
    tris: Vec<[TexelVertex; 3]>,
}

/// x and y in 1/16 pixel, w, u, v.
type TexelVertex = (i32, i32, f64, f64, f64);

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Mode {
    Repeat,
    Clamp,
    Mirror,
}

impl From<Mode> for Beyond {
    fn from(mode: Mode) -> Self {
        match mode {
            Mode::Repeat => Self::Repeat,
            Mode::Clamp => Self::Clamp,
            Mode::Mirror => Self::Mirror,
        }
    }
}

/// Values of the data set's masks.
mod mask {
    /// Nothing is drawn here.
    pub(super) const OUTSIDE: u8 = 0;
    /// The independent renderer is wrong here.
    pub(super) const EXEMPT: u8 = 64;
    /// Must agree if lambda comes from differences in 2x2 pixels.
    pub(super) const QUAD: u8 = 192;
    /// Must agree.
    pub(super) const AGREE: u8 = 255;
}

fn texel(dir: &Path, tolerance: f64) -> Result<Family, Error> {
    let path = dir.join("texel.json");
    let set: TexelSet = json(&path)?;
    let (sheet_path, mask_path) = (dir.join(&set.sheet), dir.join(&set.mask));
    let sheet = decode(&sheet_path)?.into_rgb8();
    let masks = decode(&mask_path)?.into_luma8();
    let (picture, _) = Picture::load(&dir.join(&set.texture))?;
    let texels: Vec<_> = picture
        .pixels()
        .iter()
        .map(|&[r, g, b]| Rgb888::new(r, g, b))
        .collect();
    let mut family = Family {
        name: "texel".to_owned(),
        strict_mismatches: Some(0),
        ..Family::default()
    };
    for case in &set.cases.cases {
        let tile =
            |path, image| Tile::find(path, image, set.columns, case.tile, set.width, set.height);
        let wanted = tile(&sheet_path, sheet.dimensions())?.of_rgb(&sheet);
        let masks = tile(&mask_path, masks.dimensions())?.of_grey(&masks);
        let triangles = triangles(&path, &case.tris)?;
        let (beyond_u, beyond_v) = (case.wrap_s.into(), case.wrap_t.into());
        let drawn = draw_exact(&set, &triangles, &picture, &texels, beyond_u, beyond_v)
            .map_err(|e| Error::core(&path.display().to_string(), e))?;
        let exact = exact_coordinates(&set, case);
        family.cases += 1;
        for (i, (wanted, mask)) in wanted.zip(masks).enumerate() {
            let tie = exact[i].is_some_and(|[u, v]| {
                near_edge(u, picture.width(), beyond_u, tolerance)
                    || near_edge(v, picture.height(), beyond_v, tolerance)
            });
            let differs = [drawn[i].r(), drawn[i].g(), drawn[i].b()] != wanted;
            match mask {
                mask::EXEMPT => family.exempt += 1,
                _ if tie => family.ties += 1,
                _ => {
                    family.pixels += 1;
                    family.mismatches += usize::from(differs);
                }
            }
            if matches!(mask, mask::AGREE | mask::OUTSIDE) && differs {
                *family.strict_mismatches.get_or_insert(0) += 1;
            }
        }
    }
    Ok(family)
}

/// The core's picture of one texel case, a division at every pixel.
fn draw_exact(
    set: &TexelSet,
    triangles: &[[ScreenVertex; 3]],
    picture: &Picture,
    texels: &[Rgb888],
    beyond_u: Beyond,
    beyond_v: Beyond,
) -> Result<Vec<Rgb888>, multum::error::Error> {
    let texture = Texture::new(texels, picture.width(), picture.height())?;
    let mut pixels = vec![Rgb888::BLACK; (set.width * set.height) as usize];
    let mut band = Band::new(&mut pixels, set.width, set.height, set.width as usize, 0)?;
    with_wrap!(beyond_u, U => with_wrap!(beyond_v, V => {
        let mut pipeline = Pipeline {
            strategy: PerPixel,
            sampler: Nearest::<_, U, V>::new(texture),
            depth: NoDepth,
            cull: Cull::Off,
        };
        for triangle in triangles {
            pipeline.draw_triangle(&mut band, triangle);
        }
    }));
    Ok(pixels)
}

/// u and v in float64 at each covered pixel, of the triangle that is drawn there last.
fn exact_coordinates(set: &TexelSet, case: &TexelCase) -> Vec<Option<[f64; 2]>> {
    let mut result = vec![None; (set.width * set.height) as usize];
    for corners in &case.tris {
        let corners_in_pixels = Corners {
            position: corners.map(|(x, y, ..)| [x, y].map(|c| f64::from(c) / UNIT as f64)),
            w: corners.map(|(_, _, w, ..)| w),
            uv: corners.map(|(.., u, v)| [u, v]),
        };
        let grid = corners.map(|(x, y, ..)| [x, y].map(i64::from));
        if let (Some(coverage), Some(planes)) =
            (Coverage::new(grid, UNIT), Planes::new(&corners_in_pixels))
        {
            coverage.for_each(set.width, set.height, |x, y| {
                let sample = planes.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
                result[(y * set.width + x) as usize] = Some(sample.uv);
            });
        }
    }
    result
}

/// Whether moving a coordinate by `tolerance` texels can select another texel.
fn near_edge(coordinate: f64, size: u32, beyond: Beyond, tolerance: f64) -> bool {
    let shift = tolerance / f64::from(size);
    beyond.texel(coordinate - shift, size) != beyond.texel(coordinate + shift, size)
}

/// Vertices from positions in 1/16 pixel, depths and repeats; all exact in the core's formats.
fn vertices(position: [[i32; 2]; 3], w: [f64; 3], uv: [[f64; 2]; 3]) -> Option<[ScreenVertex; 3]> {
    let vertex = |i: usize| {
        let [x, y] = position[i].map(|c| c.checked_mul(256 / UNIT as i32).map(I24F8::from_bits));
        let w = I16F16::checked_from_num(w[i])?;
        let [u, v] = uv[i].map(I16F16::checked_from_num);
        ScreenVertex::new(x?, y?, w, [u?, v?])
    };
    Some([vertex(0)?, vertex(1)?, vertex(2)?])
}

/// The triangles of a textured case.
fn triangles(path: &Path, given: &[[TexelVertex; 3]]) -> Result<Vec<[ScreenVertex; 3]>, Error> {
    given
        .iter()
        .map(|corners| {
            vertices(
                corners.map(|(x, y, ..)| [x, y]),
                corners.map(|(_, _, w, ..)| w),
                corners.map(|(.., u, v)| [u, v]),
            )
        })
        .collect::<Option<Vec<_>>>()
        .ok_or_else(|| broken(path, &"a vertex is out of range"))
}

/// One case's place on a contact sheet.
struct Tile {
    left: u32,
    top: u32,
    width: u32,
    height: u32,
}

impl Tile {
    fn find(
        path: &Path,
        sheet: (u32, u32),
        columns: u32,
        number: u32,
        width: u32,
        height: u32,
    ) -> Result<Self, Error> {
        let place = || {
            let left = number.checked_rem(columns)?.checked_mul(width)?;
            let top = number.checked_div(columns)?.checked_mul(height)?;
            let fits = left.checked_add(width)? <= sheet.0 && top.checked_add(height)? <= sheet.1;
            (fits && width > 0 && height > 0).then_some(Self {
                left,
                top,
                width,
                height,
            })
        };
        place().ok_or_else(|| broken(path, &format!("the sheet has no tile {number}")))
    }

    fn positions(&self) -> impl Iterator<Item = (u32, u32)> {
        let (left, top, width, height) = (self.left, self.top, self.width, self.height);
        (top..top + height).flat_map(move |y| (left..left + width).map(move |x| (x, y)))
    }

    fn of_grey<'i>(&self, image: &'i GrayImage) -> impl Iterator<Item = u8> + use<'i> {
        self.positions()
            .collect::<Vec<_>>()
            .into_iter()
            .map(|(x, y)| image.get_pixel(x, y).0[0])
    }

    fn of_rgb<'i>(&self, image: &'i RgbImage) -> impl Iterator<Item = [u8; 3]> + use<'i> {
        self.positions()
            .collect::<Vec<_>>()
            .into_iter()
            .map(|(x, y)| image.get_pixel(x, y).0)
    }
}

fn open(path: &Path) -> Result<BufReader<File>, Error> {
    File::open(path)
        .map(BufReader::new)
        .map_err(|e| Error::read(path, &e))
}

fn json<T: DeserializeOwned>(path: &Path) -> Result<T, Error> {
    serde_json::from_reader(open(path)?).map_err(|e| broken(path, &e))
}

fn decode(path: &Path) -> Result<image::DynamicImage, Error> {
    image::ImageReader::open(path)
        .map_err(|e| Error::read(path, &e))?
        .decode()
        .map_err(|e| broken(path, &e))
}

fn broken(path: &Path, problem: &dyn std::fmt::Display) -> Error {
    Error::content(
        &path.display().to_string(),
        &problem.to_string(),
        "give a data set in the format that its README.md describes",
    )
}

/// Where this project keeps its copy of the data set.
#[must_use]
pub fn own_copy() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/conformance")
}
