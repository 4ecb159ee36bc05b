//! Lines of constant depth: "free direction" or "constant z" mapping.
//!
//! On the screen 1/w of a triangle is a plane (C. Hecker, "Perspective Texture Mapping", Game
//! Developer 1995-96), so there is a direction along which it is constant. Along such a line u and
//! v are affine: one division a line and none along it. Doom's floors and walls are the cases
//! where the direction is a row or a column; the Build engine's sloped floors and the
//! free-direction mappers of the 1990s take any.
//!
//! A line at an angle passes no pixel centres. It steps a pixel at a time along its major axis and
//! takes the pixel that it is in, whose centre is up to half a pixel away along the minor axis,
//! and draws it with the coordinates of the line. With d that distance, the error is
//! d |du/dminor| w(line)/w(pixel), exactly: at most half a footprint times the ratio of depths
//! half a pixel apart.
//!
//! If all lines are one line moved by whole pixels along the minor axis, they tile the screen:
//! no holes and no pixel twice. For that each line must start in the common pattern wherever it
//! enters the triangle. Bresenham's algorithm started afresh at each line's own end is the
//! simpler code and steps out of phase with its neighbours: holes, repeated pixels, and pixels up
//! to a whole one away from their line.
//! Such lines also end where the line leaves the triangle and not where the coverage rule says, so
//! small triangles lose and gain pixels along their edges.
//!
//! What remains is bookkeeping: the ends of every line along a slanted direction, and writes that
//! jump from row to row, which bands and bursts to memory do not take well.

use super::{Canvas, Paint};
use crate::frame::ScreenTriangle;
use crate::reference::{Corners, Coverage, Planes};

/// The lines of a triangle. Along the major axis they advance by a pixel, along the minor one by
/// at most as much.
struct Lines {
    /// Whether x is the major axis.
    along_x: bool,
    /// Whether the depth is the same everywhere.
    flat: bool,
    /// Change along the minor axis per step, -1 to 1.
    slope: f64,
    /// Pixels along the major axis: first, and one past the last.
    major: [i64; 2],
    /// Numbers of the lines: first, and one past the last. Line k is at k + 1/2 along the minor
    /// axis at the centre of the first major pixel.
    numbers: [i64; 2],
    /// Pixels of the screen along the minor axis.
    end: i64,
}

impl Lines {
    fn new(corners: &Corners, planes: &Planes, screen: [u32; 2]) -> Self {
        let inverse = |x: f64, y: f64| 1.0 / planes.at(x, y).w;
        let [x, y] = corners.position[0];
        let here = inverse(x, y);
        let [gx, gy] = [inverse(x + 1.0, y) - here, inverse(x, y + 1.0) - here];
        // Where the depth is constant the gradient is rounding and must not choose a direction.
        let flat = corners.w.iter().all(|&w| w == corners.w[0]);
        let along_x = flat || gy.abs() >= gx.abs();
        let (axis, slope) = match (along_x, flat) {
            (_, true) => (0, 0.0),
            (true, _) => (0, -gx / gy),
            (false, _) => (1, -gy / gx),
        };
        let bounds = |axis: usize| {
            let low = corners
                .position
                .iter()
                .map(|c| c[axis])
                .fold(f64::INFINITY, f64::min);
            let high = corners.position.iter().map(|c| c[axis]).fold(0.0, f64::max);
            let end = i64::from(screen[axis]);
            [
                (low.floor() as i64).clamp(0, end),
                (high.ceil() as i64).clamp(0, end),
            ]
        };
        let major = bounds(axis);
        let minor = bounds(1 - axis);
        // Lines that are in the box anywhere.
        let drift = slope * (major[1] - major[0]) as f64;
        let numbers = [
            minor[0] - drift.max(0.0).ceil() as i64 - 1,
            minor[1] - drift.min(0.0).floor() as i64 + 1,
        ];
        Self {
            along_x,
            flat,
            slope,
            major,
            numbers,
            end: i64::from(screen[1 - axis]),
        }
    }

    /// Where line `k` is along the minor axis at the centre of a major pixel.
    fn minor(&self, k: i64, major: i64) -> f64 {
        k as f64 + 0.5 + self.slope * (major - self.major[0]) as f64
    }

    fn xy<T>(&self, major: T, minor: T) -> [T; 2] {
        if self.along_x {
            [major, minor]
        } else {
            [minor, major]
        }
    }
}

/// Draws a triangle. `afresh`: each line starts its steps at its own end instead of in the common
/// pattern.
pub(super) fn draw(
    canvas: &mut Canvas,
    paint: &Paint<'_>,
    triangle: &ScreenTriangle,
    planes: &Planes,
    afresh: bool,
) {
    let corners = triangle.corners();
    let Some(coverage) = Coverage::new(triangle.grid(), 256) else {
        return;
    };
    let lines = Lines::new(&corners, planes, [canvas.width, canvas.height]);
    let inverses = corners.w.map(|w| 1.0 / w);
    let farthest = inverses.into_iter().fold(f64::INFINITY, f64::min);
    let nearest = inverses.into_iter().fold(0.0, f64::max);
    for k in lines.numbers[0]..lines.numbers[1] {
        let mut pixels = Vec::new();
        if afresh {
            let inside = |m: i64| {
                let [x, y] = lines.xy(m as f64 + 0.5, lines.minor(k, m));
                within(&corners.position, x, y)
            };
            let mut start = None;
            for m in (lines.major[0]..lines.major[1]).filter(|&m| inside(m)) {
                let first = *start.get_or_insert(m);
                // In whole steps from the pixel that the line starts in.
                let steps = (lines.slope * (m - first) as f64).round() as i64;
                pixels.push((m, lines.minor(k, first).floor() as i64 + steps));
            }
        } else {
            for m in lines.major[0]..lines.major[1] {
                let n = lines.minor(k, m).floor() as i64;
                let [x, y] = lines.xy(m, n);
                if coverage.covers(x, y) {
                    pixels.push((m, n));
                }
            }
        }
        pixels.retain(|&(_, n)| (0..lines.end).contains(&n));
        let Some(&(first, _)) = pixels.first() else {
            continue;
        };
        // A line that runs beside the triangle's corner is moved to the corner's depth: beyond
        // it the plane may pass the horizon.
        let middle = first as f64 + 0.5;
        let at = |minor: f64| {
            let [x, y] = lines.xy(middle, minor);
            1.0 / planes.at(x, y).w
        };
        let here = lines.minor(k, first);
        let inverse = at(here);
        let slope = at(here + 1.0) - inverse;
        let kept = inverse.clamp(farthest, nearest);
        let shift = if lines.flat || kept == inverse {
            0.0
        } else {
            (kept - inverse) / slope
        };
        canvas.cost.lines += 1;
        canvas.cost.divisions += 1;
        for &(m, n) in &pixels {
            // Affine along the line; the planes give the same numbers as steps would.
            let [x, y] = lines.xy(m as f64 + 0.5, lines.minor(k, m) + shift);
            let sample = planes.at(x, y);
            canvas.cost.texels += 1;
            canvas.write(paint, lines.xy(m, n), sample.uv, kept);
        }
    }
}

/// Whether a point is in a triangle of either winding.
fn within(corners: &[[f64; 2]; 3], x: f64, y: f64) -> bool {
    let side = |i: usize| {
        let ([px, py], [qx, qy]) = (corners[i], corners[(i + 1) % 3]);
        (qx - px) * (y - py) - (qy - py) * (x - px)
    };
    let sides = [side(0), side(1), side(2)];
    sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0)
}
