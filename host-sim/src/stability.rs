//! What the core does with a frame, triangle by triangle and pixel by pixel, against the derived
//! bounds: hidden pixels count as well as visible ones.

use multum::texture::Texture;
use serde::Serialize;

use crate::bound::Bounds;
use crate::choice::Perspective;
use crate::error::Error;
use crate::frame::{Batch, Frame, ScreenTriangle};
use crate::probe::{Record, probe, texel_numbers};
use crate::reference::{Beyond, Coverage, Planes, Sample};

/// The pixel whose error is the largest part of its bound.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Worst {
    /// Column.
    pub x: i32,
    /// Row.
    pub y: i32,
    /// Number of the triangle in drawing order.
    pub triangle: usize,
    /// Error of u or v, in level-0 texels.
    pub error: f64,
    /// Its bound, in level-0 texels.
    pub bound: f64,
    /// Error divided by bound; above 1 the strategy breaks its promise.
    pub ratio: f64,
}

/// What came of one frame with one strategy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Outcome {
    /// Pixels drawn, summed over all triangles.
    pub pixels: usize,
    /// Largest error of u or v in level-0 texels.
    pub texels: f64,
    /// Largest error of u or v in footprints.
    pub footprints: f64,
    /// The pixel nearest to its bound, or beyond it.
    pub worst: Worst,
    /// Pixels whose error exceeds the bound.
    pub beyond_bound: usize,
    /// Pixels that the core draws and the rule does not, or the other way round, or that a span
    /// leaves out.
    pub coverage_mismatches: usize,
    /// Pixels with a texel that neither the exact coordinates nor any within the bound choose.
    pub texel_mismatches: usize,
}

impl Outcome {
    /// Whether everything is as derived.
    #[must_use]
    pub fn passes(&self) -> bool {
        self.beyond_bound == 0 && self.coverage_mismatches == 0 && self.texel_mismatches == 0
    }
}

/// Draws every triangle of a frame alone and compares each of its pixels.
///
/// # Errors
///
/// [`Error::Core`] for a texture that the core refuses.
pub fn examine(frame: &Frame, perspective: Perspective) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    let mut number = 0;
    for batch in &frame.batches {
        let (width, height) = (batch.picture.width(), batch.picture.height());
        let texels = texel_numbers(width, height);
        let texture =
            Texture::new(&texels, width, height).map_err(|e| Error::core("texture", e))?;
        for triangle in &batch.triangles {
            let record = probe(
                &triangle.vertices,
                frame.viewport,
                perspective,
                texture,
                batch.wrap,
            );
            check_coverage(frame, triangle, &record, &mut outcome);
            check_coordinates(number, batch, triangle, &record, perspective, &mut outcome);
            number += 1;
        }
    }
    Ok(outcome)
}

fn check_coverage(
    frame: &Frame,
    triangle: &ScreenTriangle,
    record: &Record,
    outcome: &mut Outcome,
) {
    let (width, height) = (frame.viewport.width(), frame.viewport.height());
    let mut wanted = Vec::new();
    if let Some(coverage) = Coverage::new(triangle.grid(), 256) {
        coverage.for_each(width, height, |x, y| {
            wanted.push((y.cast_signed(), x.cast_signed()));
        });
    }
    let mut drawn: Vec<_> = record
        .spans()
        .flat_map(|(span, pixels)| {
            (span.left..span.right)
                .zip(pixels)
                .filter(|(_, pixel)| pixel.drawn)
                .map(move |(x, _)| (span.y, x))
        })
        .collect();
    drawn.sort_unstable();
    // Both are in order; what is not common to both differs.
    let common = {
        let (mut i, mut j, mut common) = (0, 0, 0);
        while let (Some(a), Some(b)) = (wanted.get(i), drawn.get(j)) {
            match a.cmp(b) {
                std::cmp::Ordering::Less => i += 1,
                std::cmp::Ordering::Greater => j += 1,
                std::cmp::Ordering::Equal => {
                    (i, j, common) = (i + 1, j + 1, common + 1);
                }
            }
        }
        common
    };
    outcome.pixels += drawn.len();
    outcome.coverage_mismatches += wanted.len() + drawn.len() - 2 * common;
}

fn check_coordinates(
    number: usize,
    batch: &Batch,
    triangle: &ScreenTriangle,
    record: &Record,
    perspective: Perspective,
    outcome: &mut Outcome,
) {
    let corners = triangle.corners();
    let Some(planes) = Planes::new(&corners) else {
        return;
    };
    let sides = [batch.picture.width(), batch.picture.height()];
    let size = sides.map(f64::from);
    let mut bounds = Bounds::new(perspective, &planes, &corners, size);
    for (span, pixels) in record.spans() {
        bounds.enter(span);
        for (x, pixel) in (span.left..span.right).zip(pixels) {
            let exact = planes.at(f64::from(x) + 0.5, f64::from(span.y) + 0.5);
            let bound = bounds.at(x);
            let found = pixel.coordinates();
            let footprint = exact.footprint(size).max(1.0);
            let mut kept = true;
            for axis in [0, 1] {
                let error = (found[axis] - exact.uv[axis]).abs();
                let ratio = error / bound[axis];
                // Written so that what is not a number counts as a violation.
                kept &= ratio <= 1.0;
                let texels = error * size[axis];
                outcome.texels = outcome.texels.max(texels);
                outcome.footprints = outcome.footprints.max(texels / footprint);
                if ratio > outcome.worst.ratio || ratio.is_nan() {
                    outcome.worst = Worst {
                        x,
                        y: span.y,
                        triangle: number,
                        error: texels,
                        bound: bound[axis] * size[axis],
                        ratio,
                    };
                }
            }
            outcome.beyond_bound += usize::from(!kept);
            let right = right_texel(pixel.texel, &exact, bound, sides, batch.wrap);
            outcome.texel_mismatches += usize::from(!right);
        }
    }
}

/// Whether a texel is one that coordinates within the bound can choose. Where the bound reaches a
/// texel or more, that is not asked.
fn right_texel(texel: u32, exact: &Sample, bound: [f64; 2], sides: [u32; 2], wrap: Beyond) -> bool {
    let found = [texel % sides[0], texel / sides[0]];
    [0, 1].into_iter().all(|axis| {
        let (uv, bound, side) = (exact.uv[axis], bound[axis], sides[axis]);
        bound * f64::from(side) >= 0.5
            || [uv - bound, uv, uv + bound]
                .into_iter()
                .any(|c| wrap.texel(c, side) == found[axis])
    })
}
