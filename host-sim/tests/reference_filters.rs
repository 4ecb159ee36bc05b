//! The reference's texture filters against the pixels that an OpenGL implementation drew.

use std::path::{Path, PathBuf};

use host_sim::conformance::own_copy;
use host_sim::reference::filter::{Filter, Image, Level};
use host_sim::reference::lod::{Choice, Lod, Rule};
use host_sim::reference::{Beyond, Corners, Coverage, Planes, Sample};
use serde::Deserialize;

/// Mask value where the colour must agree.
const AGREE: u8 = 255;
/// Mask value where it must if lambda comes from 2x2 quads.
const QUAD_LOD: u8 = 192;

/// 8-bit units, by the data set's README.
const TOLERANCE: f64 = 1.0;
/// The same where the driver's own log2 blends two levels.
const DRIVER_TOLERANCE: f64 = 11.0;

#[derive(Deserialize)]
struct Set {
    width: u32,
    height: u32,
    columns: u32,
    sheet: String,
    mask: String,
    levels: Vec<String>,
    cases: Vec<Case>,
}

/// x and y in 1/16 pixel, w, u, v.
type Vertex = (i32, i32, f64, f64, f64);

#[derive(Deserialize)]
struct Case {
    id: u32,
    tile: u32,
    min_filter: String,
    mag_filter: String,
    wrap_s: String,
    wrap_t: String,
    lambda: String,
    tris: Vec<[Vertex; 3]>,
}

impl Case {
    fn wrap(&self) -> [Beyond; 2] {
        [&self.wrap_s, &self.wrap_t].map(|mode| match mode.as_str() {
            "repeat" => Beyond::Repeat,
            "clamp" => Beyond::Clamp,
            "mirror" => Beyond::Mirror,
            other => panic!("wrap mode {other}"),
        })
    }

    fn filter(&self) -> Filter {
        let image = |name: &str| match name {
            "nearest" => Image::Nearest,
            "linear" => Image::Linear,
            other => panic!("filter {other}"),
        };
        let (min, mip) = match self.min_filter.split_once("_mipmap_") {
            Some((min, "nearest")) => (min, Choice::Nearest),
            Some((min, "linear")) => (min, Choice::Linear),
            Some((_, other)) => panic!("mip filter {other}"),
            None => (self.min_filter.as_str(), Choice::Base),
        };
        Filter {
            min: image(min),
            mag: image(&self.mag_filter),
            lod: Lod {
                rule: Rule::Euclidean,
                choice: mip,
                ..Lod::default()
            },
            taps: 1,
        }
    }

    /// Whether lambda blends two levels and is not exact: llvmpipe's log2 is piecewise linear.
    fn by_driver_log2(&self) -> bool {
        self.lambda == "driver" && self.min_filter.ends_with("_mipmap_linear")
    }
}

struct Data {
    set: Set,
    levels: Vec<Level>,
    sheet: image::RgbImage,
    mask: image::GrayImage,
}

/// One pixel of a case that is covered.
struct Pixel {
    planes: Planes,
    x: u32,
    y: u32,
    mask: u8,
    drawn: [u8; 3],
}

impl Pixel {
    /// Coordinates and their exact derivatives at the centre.
    fn sample(&self) -> Sample {
        self.planes
            .at(f64::from(self.x) + 0.5, f64::from(self.y) + 0.5)
    }

    /// The same with differences in the aligned 2x2 quad for derivatives.
    fn quad_sample(&self) -> Sample {
        let (left, top) = (f64::from(self.x & !1) + 0.5, f64::from(self.y & !1) + 0.5);
        let from = self.planes.at(left, top).uv;
        let step = |to: Sample| [to.uv[0] - from[0], to.uv[1] - from[1]];
        Sample {
            dx: step(self.planes.at(left + 1.0, top)),
            dy: step(self.planes.at(left, top + 1.0)),
            ..self.sample()
        }
    }

    /// How far a colour is off, in the worst channel.
    fn off(&self, colour: [f64; 4]) -> f64 {
        (0..3).fold(0.0, |worst, k| {
            f64::max(worst, (colour[k] - f64::from(self.drawn[k])).abs())
        })
    }
}

fn open(dir: &Path, name: &str) -> image::DynamicImage {
    image::open(dir.join(name)).expect("an image of the data set")
}

impl Data {
    fn load(name: &str) -> Self {
        let dir: PathBuf = own_copy().join("filter");
        let text = std::fs::read(dir.join(name)).expect("the data set");
        let set: Set = serde_json::from_slice(&text).expect("the format of its README");
        let levels = set
            .levels
            .iter()
            .map(|name| {
                let image = open(&dir, name).into_rgb8();
                let texels = image
                    .pixels()
                    .map(|p| [p.0[0], p.0[1], p.0[2], 255].map(f64::from));
                Level::new(image.width(), image.height(), texels.collect()).expect("a level")
            })
            .collect();
        Self {
            levels,
            sheet: open(&dir, &set.sheet).into_rgb8(),
            mask: open(&dir, &set.mask).into_luma8(),
            set,
        }
    }

    /// The covered pixels of a case; where triangles overlap, of the last.
    fn pixels(&self, case: &Case) -> Vec<Pixel> {
        let (width, height) = (self.set.width, self.set.height);
        let left = case.tile % self.set.columns * width;
        let top = case.tile / self.set.columns * height;
        let mut found: Vec<Option<Pixel>> = Vec::new();
        found.resize_with((width * height) as usize, || None);
        for corners in &case.tris {
            let grid = corners.map(|(x, y, ..)| [x, y].map(i64::from));
            let corners = Corners {
                position: corners.map(|(x, y, ..)| [x, y].map(|c| f64::from(c) / 16.0)),
                w: corners.map(|(_, _, w, ..)| w),
                uv: corners.map(|(.., u, v)| [u, v]),
            };
            let (Some(coverage), Some(planes)) = (Coverage::new(grid, 16), Planes::new(&corners))
            else {
                continue;
            };
            coverage.for_each(width, height, |x, y| {
                found[(y * width + x) as usize] = Some(Pixel {
                    planes,
                    x,
                    y,
                    mask: self.mask.get_pixel(left + x, top + y).0[0],
                    drawn: self.sheet.get_pixel(left + x, top + y).0,
                });
            });
        }
        found.into_iter().flatten().collect()
    }
}

/// Compares the pixels of all cases that have one of these masks, and counts them. `measure` gives
/// how far a pixel is off and how far it may be.
fn agree(name: &str, masks: &[u8], measure: impl Fn(&Data, &Case, &Pixel) -> (f64, f64)) -> usize {
    let data = Data::load(name);
    let mut compared = 0;
    for case in &data.set.cases {
        for pixel in data.pixels(case) {
            if masks.contains(&pixel.mask) {
                let (off, tolerance) = measure(&data, case, &pixel);
                let (id, x, y) = (case.id, pixel.x, pixel.y);
                assert!(off <= tolerance, "{name} {id} at {x} {y}: {off:.3}");
                compared += 1;
            }
        }
    }
    compared
}

/// lambda from the exact derivative at each pixel, colours rounded as the images are.
fn off_per_pixel(data: &Data, case: &Case, pixel: &Pixel) -> (f64, f64) {
    let colour = case
        .filter()
        .at(&data.levels, case.wrap(), &pixel.sample())
        .map(f64::round);
    let tolerance = if case.by_driver_log2() {
        DRIVER_TOLERANCE
    } else {
        TOLERANCE
    };
    (pixel.off(colour), tolerance)
}

/// lambda as llvmpipe takes it: from quads, and in the driver's cases with its own log2, that of
/// the squared length with a linear mantissa. What remains are 8-bit rounding and float32.
fn off_per_quad(data: &Data, case: &Case, pixel: &Pixel) -> (f64, f64) {
    let (filter, sample) = (case.filter(), pixel.quad_sample());
    let exact = filter.lod.lambda(&sample, data.levels[0].size());
    let lambda = if case.by_driver_log2() {
        let exponent = (2.0 * exact).floor();
        0.5 * (exponent + (2.0 * exact - exponent).exp2() - 1.0)
    } else {
        exact
    };
    let colour = filter.with_lambda(&data.levels, case.wrap(), sample.uv, lambda);
    (pixel.off(colour), TOLERANCE)
}

// How many pixels have which mask is in the data set's README.

#[test]
fn filters_agree_with_opengl() {
    assert_eq!(agree("filter.json", &[AGREE], off_per_pixel), 390_339);
    let masks = [AGREE, QUAD_LOD];
    assert_eq!(agree("filter.json", &masks, off_per_quad), 390_339 + 8_877);
}

#[test]
fn levels_of_detail_agree_with_opengl() {
    assert_eq!(agree("lod.json", &[AGREE], off_per_pixel), 39_830);
    let masks = [AGREE, QUAD_LOD];
    assert_eq!(agree("lod.json", &masks, off_per_quad), 39_830 + 28_210);
}
