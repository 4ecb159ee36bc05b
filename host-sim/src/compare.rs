//! Comparing what the core drew with the reference: coverage, texture coordinates, colours.

use std::collections::{HashMap, HashSet};

use multum::embedded_graphics::pixelcolor::{Rgb565, RgbColor};
use multum::fixed::types::I8F24;
use serde::Serialize;

use crate::choice::Perspective;
use crate::error::Error;
use crate::filtering::Filtering;
use crate::frame::{Frame, ScreenTriangle};
use crate::reference::{Coverage, Planes};
use crate::render::{divisions, fragments, spans};
use crate::scene::BACKGROUND;
use crate::shaded::{pixels, store};

/// Largest, 99th percentile and mean of something measured at many pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// The largest.
    pub max: f64,
    /// The smallest value that 99 % of the pixels do not exceed.
    pub p99: f64,
    /// The mean.
    pub mean: f64,
}

impl Spread {
    /// Of some values; all zero if there are none.
    #[must_use]
    pub fn of(mut values: Vec<f64>) -> Self {
        let Some(last) = values.len().checked_sub(1) else {
            return Self::default();
        };
        values.sort_by(f64::total_cmp);
        let rank = (values.len() * 99).div_ceil(100) - 1;
        Self {
            max: values[last],
            p99: values[rank],
            mean: values.iter().sum::<f64>() / values.len() as f64,
        }
    }
}

/// A spread of distances between texture coordinates: of u or v, whichever is farther off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct UvError {
    /// In level-0 texels.
    pub texels: Spread,
    /// In footprints: divided by the texels that a pixel spans, where that is more than one.
    pub footprints: Spread,
}

/// The numbers of one frame.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Triangles that show on the screen: after clipping and culling, with an area.
    pub triangles: usize,
    /// Pixels drawn.
    pub pixels: usize,
    /// Perspective divisions along the spans, hidden pixels included; not the three that set up a
    /// triangle.
    pub divisions: u64,
    /// Pixels, summed over all triangles, where the core's coverage is not the exact one.
    pub coverage_mismatches: usize,
    /// Pixels drawn by two triangles that share an edge and face the same way.
    pub double_draws: usize,
    /// Pixels that a triangle covers exactly and the core draws by none.
    pub gaps: usize,
    /// Pixels where another triangle is in front than in the reference: the depth buffer's
    /// resolution.
    pub depth_mismatches: usize,
    /// Distance between the core's coordinates and the reference's.
    pub uv_error: UvError,
    /// Distance that snapping to 1/256 pixel itself adds: between the reference with snapped and
    /// with unsnapped vertices.
    pub snap_error: UvError,
    /// Largest difference of a pixel's channels, in 8-bit units.
    pub colour_error: Spread,
    /// Peak signal to noise ratio of the colours in dB; `None` (null) where all pixels are equal.
    pub psnr: Option<f64>,
}

/// A frame drawn both ways.
#[derive(Clone, Debug)]
pub struct Report {
    /// What the core drew, 8 bits a channel.
    pub core: Vec<[u8; 3]>,
    /// What the reference draws.
    pub reference: Vec<[u8; 3]>,
    /// At each pixel the distance of the coordinates in level-0 texels; `None` where nothing is
    /// drawn.
    pub error: Vec<Option<f64>>,
    /// The numbers.
    pub comparison: Comparison,
}

/// Draws a frame with the core, in bands of `rows` rows, and with the reference, and compares.
///
/// The reference filters at every pixel with that pixel's own lambda, whatever rate was chosen.
///
/// # Errors
///
/// [`Error::Core`] for a frame that the core refuses.
pub fn compare(
    frame: &Frame,
    perspective: Perspective,
    rows: u32,
    filtering: &Filtering,
) -> Result<Report, Error> {
    let core = pixels(frame, perspective, rows, filtering)?.rgb();
    let fragments = fragments(frame, perspective)?;
    let shown: Vec<_> = frame
        .triangles()
        .map(|(_, t)| t.is_shown(frame.cull))
        .collect();

    let coverage = check_coverage(frame, &shown);
    let visible = Visible::find(frame, &shown, filtering)?;

    let all: Vec<_> = frame.triangles().collect();
    let mut texels = Vec::new();
    let mut footprints = Vec::new();
    let mut snap_texels = Vec::new();
    let mut snap_footprints = Vec::new();
    let mut depth_mismatches = 0;
    let mut error = vec![None; fragments.len()];
    let width = frame.viewport.width() as usize;
    let planes: Vec<_> = all
        .iter()
        .map(|(_, t)| {
            (
                Planes::new(&t.corners()),
                Planes::new(&t.unsnapped_corners()),
            )
        })
        .collect();
    for (i, fragment) in fragments.iter().enumerate() {
        let Some(fragment) = fragment else { continue };
        let number = fragment.triangle as usize;
        if visible.triangle[i] != Some(number) {
            depth_mismatches += 1;
        }
        let (batch, _) = all[number];
        let (Some(snapped), unsnapped) = &planes[number] else {
            continue;
        };
        let size = [batch.picture.width(), batch.picture.height()].map(f64::from);
        let (x, y) = ((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
        let exact = snapped.at(x, y);
        let footprint = exact.footprint(size).max(1.0);
        let distance = |a: [f64; 2], b: [f64; 2]| {
            ((a[0] - b[0]) * size[0])
                .abs()
                .max(((a[1] - b[1]) * size[1]).abs())
        };
        let number = |c: I8F24| f64::from(c.to_bits()) / f64::from(1 << 24);
        let off = distance([number(fragment.uv.u), number(fragment.uv.v)], exact.uv);
        texels.push(off);
        footprints.push(off / footprint);
        error[i] = Some(off);
        if let Some(unsnapped) = unsnapped {
            let off = distance(unsnapped.at(x, y).uv, exact.uv);
            snap_texels.push(off);
            snap_footprints.push(off / footprint);
        }
    }

    let comparison = Comparison {
        triangles: shown.iter().filter(|&&s| s).count(),
        pixels: texels.len(),
        divisions: divisions(frame, perspective),
        coverage_mismatches: coverage.mismatches,
        double_draws: coverage.double_draws,
        gaps: coverage.gaps,
        depth_mismatches,
        uv_error: UvError {
            texels: Spread::of(texels),
            footprints: Spread::of(footprints),
        },
        snap_error: UvError {
            texels: Spread::of(snap_texels),
            footprints: Spread::of(snap_footprints),
        },
        colour_error: colour_error(&core, &visible),
        psnr: psnr(&core, &visible.colour),
    };
    Ok(Report {
        core,
        reference: visible.colour,
        error,
        comparison,
    })
}

/// What the reference shows at each pixel.
pub(crate) struct Visible {
    /// The triangle that is seen.
    pub(crate) triangle: Vec<Option<usize>>,
    /// Its colour.
    pub(crate) colour: Vec<[u8; 3]>,
}

impl Visible {
    /// Draws all triangles in order; where the frame has a depth buffer, the nearest wins, and
    /// the first of equals.
    pub(crate) fn find(
        frame: &Frame,
        shown: &[bool],
        filtering: &Filtering,
    ) -> Result<Self, Error> {
        let (width, height) = (frame.viewport.width(), frame.viewport.height());
        let pixels = (width * height) as usize;
        let mut triangle = vec![None; pixels];
        let mut colour = vec![rgb(BACKGROUND); pixels];
        let mut nearest = vec![0.0; pixels];
        let filter = filtering.reference();
        let stored = store(frame, filtering)?;
        let textures: Vec<_> = stored.iter().map(|s| s.reference()).collect();
        let batches = frame
            .batches
            .iter()
            .zip(&textures)
            .flat_map(|(b, t)| b.triangles.iter().map(move |_| t));
        for ((number, (batch, t)), levels) in frame.triangles().enumerate().zip(batches) {
            if !shown[number] {
                continue;
            }
            let (Some(coverage), Some(planes)) =
                (Coverage::new(t.grid(), 256), Planes::new(&t.corners()))
            else {
                continue;
            };
            coverage.for_each(width, height, |x, y| {
                let i = (y * width + x) as usize;
                let sample = planes.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let inverse = 1.0 / sample.w;
                if frame.depth && inverse <= nearest[i] {
                    return;
                }
                let exact = filter.at(levels, [batch.wrap; 2], &sample);
                if let Some(shown) = filtering.format.shown(exact) {
                    nearest[i] = inverse;
                    triangle[i] = Some(number);
                    colour[i] = shown;
                }
            });
        }
        Ok(Self { triangle, colour })
    }
}

/// Of the pixels that something is drawn at.
pub(crate) fn colour_error(core: &[[u8; 3]], visible: &Visible) -> Spread {
    let drawn = core.iter().zip(&visible.colour).zip(&visible.triangle);
    let errors = drawn.filter(|(_, triangle)| triangle.is_some());
    let largest = |(a, b): (&[u8; 3], &[u8; 3])| {
        let off = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b));
        f64::from(off.max().unwrap_or_default())
    };
    Spread::of(errors.map(|(pair, _)| largest(pair)).collect())
}

struct CoverageCheck {
    mismatches: usize,
    double_draws: usize,
    gaps: usize,
}

/// The core's spans of every triangle against the exact rule, hidden pixels included.
fn check_coverage(frame: &Frame, shown: &[bool]) -> CoverageCheck {
    let (width, height) = (frame.viewport.width(), frame.viewport.height());
    let pixels = (width * height) as usize;
    let mut mismatches = 0;
    let mut wanted = vec![false; pixels];
    let mut drawn: Vec<Vec<u32>> = vec![Vec::new(); pixels];
    let mut pending = HashSet::new();
    for (number, (_, triangle)) in frame.triangles().enumerate() {
        pending.clear();
        if shown[number]
            && let Some(coverage) = Coverage::new(triangle.grid(), 256)
        {
            coverage.for_each(width, height, |x, y| {
                let i = (y * width + x) as usize;
                wanted[i] = true;
                pending.insert(i);
            });
        }
        for span in spans(&triangle.vertices, width, height, frame.cull) {
            let row = span.y as usize * width as usize;
            let columns = row + span.left as usize..row + span.right as usize;
            for (i, by) in columns.clone().zip(&mut drawn[columns]) {
                if !pending.remove(&i) {
                    mismatches += 1;
                }
                by.push(number as u32);
            }
        }
        mismatches += pending.len();
    }
    let gaps = wanted
        .iter()
        .zip(&drawn)
        .filter(|(wanted, by)| **wanted && by.is_empty())
        .count();
    let neighbours = Neighbours::find(frame, shown);
    let double_draws = drawn
        .iter()
        .filter(|by| {
            by.iter()
                .enumerate()
                .any(|(i, a)| by[..i].iter().any(|b| neighbours.share_edge(*a, *b)))
        })
        .count();
    CoverageCheck {
        mismatches,
        double_draws,
        gaps,
    }
}

/// Which triangles share an edge of the screen, running along it in opposite directions: then
/// they face the same way and lie on its two sides.
struct Neighbours(HashSet<(u32, u32)>);

impl Neighbours {
    fn find(frame: &Frame, shown: &[bool]) -> Self {
        let mut edges: HashMap<_, Vec<u32>> = HashMap::new();
        let mut pairs = HashSet::new();
        for (number, (_, triangle)) in frame.triangles().enumerate() {
            if !shown[number] {
                continue;
            }
            for (a, b) in directed_edges(triangle) {
                for &other in edges.get(&(b, a)).into_iter().flatten() {
                    pairs.insert((other, number as u32));
                }
            }
            for edge in directed_edges(triangle) {
                edges.entry(edge).or_default().push(number as u32);
            }
        }
        Self(pairs)
    }

    fn share_edge(&self, a: u32, b: u32) -> bool {
        self.0.contains(&(a.min(b), a.max(b)))
    }
}

/// The three edges, turned to one winding, in 1/256 pixel and with depth: edges that only
/// look the same on the screen are not shared.
fn directed_edges(triangle: &ScreenTriangle) -> [([i64; 3], [i64; 3]); 3] {
    let [a, b, c] = triangle.grid();
    let [wa, wb, wc] = triangle.vertices.map(|v| i64::from(v.w().to_bits()));
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let (a, b, c) = ([a[0], a[1], wa], [b[0], b[1], wb], [c[0], c[1], wc]);
    if area < 0 {
        [(a, c), (c, b), (b, a)]
    } else {
        [(a, b), (b, c), (c, a)]
    }
}

/// Peak signal to noise ratio over the three channels, 8 bits each, in dB.
fn psnr(a: &[[u8; 3]], b: &[[u8; 3]]) -> Option<f64> {
    let square: f64 = a
        .iter()
        .flatten()
        .zip(b.iter().flatten())
        .map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2))
        .sum();
    let mean = square / (3 * a.len().max(1)) as f64;
    (mean > 0.0).then(|| 10.0 * (255.0 * 255.0 / mean).log10())
}

/// A colour with 8 bits a channel.
#[must_use]
pub fn rgb(colour: Rgb565) -> [u8; 3] {
    let scaled =
        |c: u8, max: u8| ((u32::from(c) * 510 + u32::from(max)) / (2 * u32::from(max))) as u8;
    [
        scaled(colour.r(), Rgb565::MAX_R),
        scaled(colour.g(), Rgb565::MAX_G),
        scaled(colour.b(), Rgb565::MAX_B),
    ]
}
