//! Comparing what the core drew with the reference: coverage, texture coordinates, colours.

pub(crate) mod coordinates;
pub(crate) mod coverage;

use multum::embedded_graphics::pixelcolor::{Rgb565, RgbColor};
use serde::Serialize;

use crate::choice::Perspective;
use crate::error::Error;
use crate::filtering::Filtering;
use crate::frame::{Frame, ScreenTriangle};
use crate::reference::{Coverage, Planes};
use crate::render::{divisions, fragments};
use crate::scene::BACKGROUND;
use crate::shaded::{pixels, store};
use crate::similarity::psnr;
use coordinates::Coordinates;

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
    let shown = shown(frame);
    let coverage = coverage::check(frame, &shown);
    let visible = Visible::find(frame, &shown, filtering)?;

    let coordinates = Coordinates::of(frame, &fragments(frame, perspective)?);

    let comparison = Comparison {
        triangles: shown.iter().filter(|&&s| s).count(),
        pixels: coordinates.pixels,
        divisions: divisions(frame, perspective),
        coverage_mismatches: coverage.mismatches,
        double_draws: coverage.double_draws,
        gaps: coverage.gaps,
        depth_mismatches: coordinates.depth_mismatches(&visible),
        uv_error: coordinates.uv_error,
        snap_error: coordinates.snap_error,
        colour_error: colour_error(&core, &visible),
        psnr: psnr(&core, &visible.colour),
    };
    Ok(Report {
        core,
        reference: visible.colour,
        error: coordinates.error,
        comparison,
    })
}

/// Which triangles show on the screen.
pub(crate) fn shown(frame: &Frame) -> Vec<bool> {
    let shown = |(_, t): (_, &ScreenTriangle)| t.is_shown(frame.cull);
    frame.triangles().map(shown).collect()
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
