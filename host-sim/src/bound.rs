//! How far the core's texture coordinates may be from float64, and why: for every strategy the
//! bound at one pixel of one span. All bounds are derived from the arithmetic; none is fitted.
//!
//! A bound is the sum of what interpolation bends away ([`chord`]) and what the arithmetic rounds
//! away ([`exact`], [`every_pixel`], [`stepping`]). A new strategy is added by one line in `Bounds::find` and one
//! in [`anchors`].

use std::ops::Range;

use multum::span::Span;

use crate::choice::Perspective;
use crate::reference::{Corners, Planes, Sample};

/// One unit of an 8.24 texture coordinate, in repeats.
const UNIT: f64 = 1.0 / (1 << 24) as f64;

/// The least range, in repeats: one unit of a corner's texture coordinate.
const LEAST_RANGE: f64 = 1.0 / 65536.0;

/// R: the power of two of repeats that a triangle's coordinates on an axis fit in, at least 2^-16.
fn range(corners: &Corners, axis: usize) -> f64 {
    let [most, least] = extremes(corners.uv.map(|uv| uv[axis]));
    // The range has to exceed the difference, in units of 2^-16.
    let units = ((most - least) / LEAST_RANGE).round() as u64;
    (units + 1).next_power_of_two() as f64 * LEAST_RANGE
}

/// The error of a coordinate computed by one perspective division, in repeats.
///
/// C is the span of the triangle's coordinates on the axis, P the power of two of repeats that none on
/// either axis is farther from the first corner's, at least 2^-11, and rho the ratio of the triangle's depths.
///
/// | term | bound | from |
/// |---|---|---|
/// | 1/w of the corners | C rho 2^-30 | cut to a unit, where 1/w has at least 2^30 / rho units |
/// | u/w of the corners | P rho 2^-29 | cut to a unit of 2 P repeats, likewise |
/// | planes | C rho 2^-40 | exact, but for bits shifted out of large triangles |
/// | division | 2^-24 + P 3 2^-30 + C 2^-28 | coordinate rounded up, ratio and u/w cut to a unit; the reciprocal is off by 2^-29 and its divisor cut to 31 bits |
/// | words | 1.6 rho (2^-24 + C 2^-30) + 4 2^-24 | where depths are within 1:128 and P <= 32: words are rounded, and something is added so that nothing comes out before a texel's edge |
#[must_use]
pub fn exact(corners: &Corners, axis: usize) -> f64 {
    let [farthest, _] = extremes(corners.w);
    exact_at(corners, axis, farthest)
}

/// The same at a point of some depth: rho is the ratio of that to the nearest corner's.
#[must_use]
pub fn exact_at(corners: &Corners, axis: usize, w: f64) -> f64 {
    let [_, nearest] = extremes(corners.w);
    let (span, rho) = (span(corners, axis), w / nearest);
    let reach = reach(corners).max(power(-11));
    let corner_q = span * rho * power(-30);
    let corner_u = reach * rho * power(-29);
    let planes = span * rho * power(-40);
    let division = UNIT + reach * 3.0 * power(-30) + span * power(-28);
    corner_q + corner_u + planes + division + rounded(corners, axis, rho)
}

/// Whether the planes of a triangle may be those of small ones, for spans of so many pixels: which are, the
/// core tells more narrowly.
fn is_small(corners: &Corners, pixels: f64) -> bool {
    let [width, height] = box_of(corners);
    let most = pixels.min(16.0);
    width <= most && height <= most && reach(corners) <= 0.125 && depth_ratio(corners) < 1.6
}

/// What a small triangle's planes add, in repeats: they are found from 16 bits of w, and divided by with 16 bits.
/// Corners' 1/w has 20 bits, in the middle of the triangle it is 8/9 of that of the first corner or more, and w of
/// any corner is 7/9 of the largest or more.
///
/// | term | bound | from |
/// |---|---|---|
/// | 1/w of the corners | C 2^-15.6 | by how much they differ from the first's, a seventh at most: w cut to 16 bits, differences of w to a quarter of that, and of 1/w to 2^-19 |
/// | u/w of the corners | C 2^-15.8 + 2^-18.8 | 17 bits of 1/w, and cut to 2^-20 of it |
/// | planes | 33 (2^-25.8 + C 2^-24.8) | changes are cut to a unit, for 16 columns and 16 rows from the first corner, and the value there |
/// | division | C 2^-15.3 | the reciprocal |
/// | texels' edges | P 2^-15 + 48 2^-24 | added to all coordinates, so that none comes out before them that was on one |
fn small(corners: &Corners, axis: usize) -> f64 {
    if !is_small(corners, 16.0) {
        return 0.0;
    }
    let span = span(corners, axis);
    let two_to = |e: f64| e.exp2();
    let corner_q = span * two_to(-15.6);
    let corner_u = span * two_to(-15.8) + two_to(-18.8);
    let planes = 33.0 * (two_to(-25.8) + span * two_to(-24.8));
    let division = span * two_to(-15.3);
    let edges = reach(corners) * power(-15) + 48.0 * UNIT;
    corner_q + corner_u + planes + division + edges
}

/// What they add in the middle of a span of several pixels, of which the last one's coordinates come from the
/// first one's.
///
/// | term | bound | from |
/// |---|---|---|
/// | first pixel | 9/7 of [`small`] | 1/w at the last is less by that at most |
/// | division | C 2^-15.3 | another reciprocal |
/// | product | 0.29 2^-19 + 16 2^-25.8 | of what 1/w changes by, 2/7 at most, and the first pixel's coordinate, which is cut to 2^-19; and cut itself, at each of 16 pixels |
fn small_step(corners: &Corners, axis: usize) -> f64 {
    if !is_small(corners, 16.0) {
        return 0.0;
    }
    let division = span(corners, axis) * (-15.3f64).exp2();
    let product = 0.29 * power(-19) + 16.0 * (-25.8f64).exp2();
    small(corners, axis) * 2.0 / 7.0 + division + product
}

/// The error of a coordinate computed by a division at every pixel: [`exact`], and what the steps
/// between add.
#[must_use]
pub fn every_pixel(corners: &Corners, axis: usize) -> f64 {
    let [farthest, _] = extremes(corners.w);
    every_pixel_at(corners, axis, farthest)
}

/// The same at a point of some depth.
///
/// | term | bound | from |
/// |---|---|---|
/// | steps of u/w | 2^-18 | where there are words: up to 127, rounded up, and what is cut at the first |
/// | steps of 1/w | 81 C 2^-29 | likewise, off by five eighths of a unit and 2^-11, where 1/w has 30 bits at least |
/// | small triangles | C (2^-15.6 + 2^-15.8 + 2^-15.3 + 33 2^-24.8) + 2^-18.8 + 33 2^-25.8 + P 2^-15 + 48 2^-24 | see the core's documentation |
#[must_use]
pub fn every_pixel_at(corners: &Corners, axis: usize, w: f64) -> f64 {
    exact_at(corners, axis, w) + stepped(corners, axis) + small(corners, axis)
}

/// The error of coordinates at the ends of pieces of `n` pixels along a span of `pixels`, in repeats: [`exact`],
/// and what words that are stepped from piece to piece, or small triangles, add.
#[must_use]
pub fn every(corners: &Corners, axis: usize, pixels: i32, n: i32) -> f64 {
    let small = small(corners, axis) + small_step(corners, axis);
    exact(corners, axis) + leaping(corners, axis, pixels, n) + small
}

/// What a division from single words adds, in repeats.
///
/// At a span's first pixel they are off by half a unit, and by 2^-16 for each of up to 2^12 columns
/// and rows from the first corner. Up to 2^11 pixels farther they are cut to a unit, and 2^-16 again
/// for each: 1.6 units.
fn rounded(corners: &Corners, axis: usize, rho: f64) -> f64 {
    if !have_words(corners) {
        return 0.0;
    }
    words(corners, axis, 1.6 * rho) + 4.0 * UNIT
}

/// What it is in repeats that words are off by so many units, of which 1/w has at least 2^30, and 64 repeats are as
/// many of u/w. Where 1/w has at least `2^30 / rho` (31 bits at the nearest corner times 31 of the area, without
/// 30), a unit counts rho times.
fn words(corners: &Corners, axis: usize, units: f64) -> f64 {
    if !have_words(corners) {
        return 0.0;
    }
    units * (UNIT + span(corners, axis) * power(-30))
}

/// What steps from pixel to pixel add, see [`every_pixel_at`].
fn stepped(corners: &Corners, axis: usize) -> f64 {
    if !have_words(corners) {
        return 0.0;
    }
    power(-18) + 81.0 * span(corners, axis) * power(-29)
}

/// Whether the planes of a triangle may be words.
fn have_words(corners: &Corners) -> bool {
    // A margin for corners whose 1/w was cut.
    reach(corners) <= 32.0 && depth_ratio(corners) <= 128.01
}

/// P of [`exact`].
fn reach(corners: &Corners) -> f64 {
    let [first, ..] = corners.uv;
    let farthest = corners
        .uv
        .map(|uv| (uv[0] - first[0]).abs().max((uv[1] - first[1]).abs()));
    let [most, _] = extremes(farthest);
    // A negative one may reach the power itself.
    let units = (most / LEAST_RANGE).round() as u64;
    (units + 1).next_power_of_two() as f64 * LEAST_RANGE
}

/// C of [`exact`].
fn span(corners: &Corners, axis: usize) -> f64 {
    let [most, least] = extremes(corners.uv.map(|uv| uv[axis]));
    most - least
}

/// The arithmetic's error of affine mapping at the first pixel of a span, in repeats: u itself is
/// the plane, so the corners are exact and no division follows.
///
/// | term | bound | from |
/// |---|---|---|
/// | area | C 2^-29 | the gradient is too small by 2^-29 of itself, and u differs from the first corner's by at most C |
/// | gradient | (W + H) G 2^-25 | rounded to the unit that the plane has, for each column and row from the first corner: W and H are the box's sides |
/// | first pixel | G 2^-24 | cut to that unit |
/// | to 8.24 | 2^-25 | rounded to nearest |
/// | corners less than 16 pixels from the first | (C + P) 2^-15 | the reciprocal of the area has 16 bits; and added, so that nothing comes out before a texel's edge |
///
/// G is P/64 (see [`exact`]), but at most 1 and at least 1/32: gradients have up to 6 bits more than
/// 8.24, and those of short triangles are cut.
#[must_use]
pub fn affine(corners: &Corners, axis: usize) -> f64 {
    let [width, height] = box_of(corners);
    let unit = (reach(corners) / 64.0).clamp(1.0 / 32.0, 1.0) * power(-24);
    let span = span(corners, axis);
    let small = if farthest_from_first(corners) <= 16.0 && reach(corners) <= 1.0 {
        (span + reach(corners)) * power(-15)
    } else {
        0.0
    };
    span * power(-29) + (width + height) * 0.5 * unit + unit + power(-25) + small
}

/// What words that are stepped from piece to piece of `n` pixels along a span of `pixels` add to
/// [`exact`]: half a unit each time.
fn leaping(corners: &Corners, axis: usize, pixels: i32, n: i32) -> f64 {
    let rho = depth_ratio(corners);
    words(corners, axis, rho * 0.5 * f64::from(pixels / n))
}

/// What stepping over a piece of `pixels` pixels adds, in repeats: a step is off by at most one and a
/// half units of 2^-24 (one from being cut, one half from the reciprocal of the length).
#[must_use]
pub fn stepping(pixels: i32) -> f64 {
    1.5 * f64::from(pixels) * UNIT
}

/// The same where divisions every `n` pixels add n/2 units to all coordinates first, for steps that are
/// rounded down: what is left of the loss of one and a half units a step is at most one a step, and
/// half a unit that a step may gain comes on top.
#[must_use]
pub fn stepping_from_bias(pixels: i32, n: i32) -> f64 {
    (0.5 * f64::from(n) + f64::from(pixels)) * UNIT
}

/// The farthest that a coordinate bends away from its chord between two points, in repeats: it is
/// a hyperbola in the distance on the screen.
#[must_use]
pub fn chord(a: &Sample, b: &Sample, axis: usize) -> f64 {
    (a.uv[axis] - b.uv[axis]).abs() * weight_shift(a.w.max(b.w) / a.w.min(b.w))
}

/// The farthest that a coordinate bends away from its plane through the corners, in repeats.
///
/// A coordinate is a mean of the corners' values, with the barycentric weights for the affine one
/// and the same times 1/w for the correct one. No set of corners gains more weight by that than
/// `(sqrt r - 1) / (sqrt r + 1)`, r being the ratio of depths, so the mean moves by no more than
/// that part of the range.
#[must_use]
pub fn bend(corners: &Corners, axis: usize) -> f64 {
    let [most, least] = extremes(corners.uv.map(|uv| uv[axis]));
    (most - least) * weight_shift(depth_ratio(corners))
}

/// Whether the width and height of a triangle, in pixels, times what the ratio of its depths is more
/// than 1 are at most four times a bound in footprints.
#[must_use]
pub fn is_affine_within(corners: &Corners, bound: f64) -> bool {
    let [width, height] = box_of(corners);
    let [farthest, nearest] = extremes(corners.w);
    // In float64 all of it is exact; 10 bits of the bound count.
    let bound = (bound * 1024.0).floor() / 1024.0;
    (width + height) * (farthest - nearest) <= 4.0 * bound * nearest
}

/// `(sqrt r - 1) / (sqrt r + 1)` for a ratio of depths `r >= 1`.
fn weight_shift(r: f64) -> f64 {
    let root = r.sqrt();
    (root - 1.0) / (root + 1.0)
}

/// Width and height of the box around a triangle, in pixels.
fn box_of(corners: &Corners) -> [f64; 2] {
    [0, 1].map(|axis| {
        let [most, least] = extremes(corners.position.map(|position| position[axis]));
        most - least
    })
}

/// The farthest that a corner is from the first, along x or y, in pixels.
fn farthest_from_first(corners: &Corners) -> f64 {
    let [first, ..] = corners.position;
    let far = |[x, y]: [f64; 2]| (x - first[0]).abs().max((y - first[1]).abs());
    corners.position.map(far).into_iter().fold(0.0, f64::max)
}

fn depth_ratio(corners: &Corners) -> f64 {
    let [farthest, nearest] = extremes(corners.w);
    farthest / nearest
}

/// Most and least.
fn extremes(values: [f64; 3]) -> [f64; 2] {
    [
        values.iter().copied().fold(f64::MIN, f64::max),
        values.iter().copied().fold(f64::MAX, f64::min),
    ]
}

fn power(e: i32) -> f64 {
    f64::from(e).exp2()
}

/// Where the spans of a strategy have coordinates that do not depend on the span's ends: at the
/// columns that are multiples of the result. `None` if there are no such columns.
#[must_use]
pub fn anchors(perspective: Perspective) -> Option<i32> {
    match perspective {
        Perspective::Every(n) => Some(n.cast_signed()),
        Perspective::Exact => Some(1),
        Perspective::Affine
        | Perspective::AffineWithin(_)
        | Perspective::Adaptive(_)
        | Perspective::ConstantZ
        | Perspective::ConstantZColumns
        | Perspective::Quadratic(_)
        | Perspective::Extrapolated
        | Perspective::Subdivided(_) => None,
    }
}

/// The first and the last column of the piece with a column of a span, where divisions are made at
/// multiples of `n` columns and at both ends of the span. Spans of small triangles are one piece.
#[must_use]
pub fn piece(corners: &Corners, span: Span, x: i32, n: i32) -> (i32, i32) {
    let Span { left, right, .. } = span;
    if is_small(corners, f64::from(n)) {
        return (left, right - 1);
    }
    let first = x - x.rem_euclid(n);
    (first.max(left), (first + n).min(right - 1))
}

/// The bounds along one span of a triangle.
#[derive(Clone, Debug)]
pub struct Bounds<'a> {
    perspective: Perspective,
    planes: &'a Planes,
    /// Width and height of the texture.
    size: [f64; 2],
    span: Span,
    /// R of u and v.
    range: [f64; 2],
    corners: Corners,
    /// [`exact`], [`small`] with [`small_step`], [`every_pixel`], [`affine`] and [`bend`], for u and v.
    exact: [f64; 2],
    small: [f64; 2],
    every_pixel: [f64; 2],
    affine: [f64; 2],
    bend: [f64; 2],
    /// The pixels that the bound last found holds for.
    last: (Range<i32>, [f64; 2]),
}

impl<'a> Bounds<'a> {
    /// Of the spans of one triangle with one strategy and a texture of `size` texels; call
    /// [`Self::enter`] before each.
    #[must_use]
    pub fn new(
        perspective: Perspective,
        planes: &'a Planes,
        corners: &Corners,
        size: [f64; 2],
    ) -> Self {
        let axes = |term: fn(&Corners, usize) -> f64| [0, 1].map(|axis| term(corners, axis));
        Self {
            perspective,
            planes,
            size,
            span: Span {
                y: 0,
                left: 0,
                right: 0,
            },
            range: axes(range),
            corners: *corners,
            exact: axes(exact),
            small: axes(|corners, axis| small(corners, axis) + small_step(corners, axis)),
            every_pixel: axes(every_pixel),
            affine: axes(affine),
            bend: axes(bend),
            last: (0..0, [0.0; 2]),
        }
    }

    /// Goes to another span of the triangle.
    pub fn enter(&mut self, span: Span) {
        self.span = span;
        self.last = (0..0, [0.0; 2]);
    }

    /// The bounds of u and v at a column of the span, in repeats.
    #[must_use]
    pub fn at(&mut self, x: i32) -> [f64; 2] {
        if !self.last.0.contains(&x) {
            self.last = self.find(x);
        }
        self.last.1
    }

    /// The bounds at a column, and the pixels that they hold for: one line for each strategy.
    fn find(&self, x: i32) -> (Range<i32>, [f64; 2]) {
        match self.perspective {
            Perspective::Affine => self.on_the_plane(x),
            Perspective::AffineWithin(bound) => self.on_the_plane_or_a_piece(x, bound.to_num()),
            Perspective::Every(n) => {
                let n = n.cast_signed();
                self.on_a_piece(x, n, |axis, pixels| {
                    self.small[axis] + stepping_from_bias(pixels, n)
                })
            }
            Perspective::Exact => (self.span.left..self.span.right, self.every_pixel),
            Perspective::Adaptive(bound) => (x..x + 1, self.in_footprints(x, bound.to_num())),
            Perspective::ConstantZ => (x..x + 1, self.on_the_tangent(x)),
            Perspective::ConstantZColumns => self.in_columns(x),
            Perspective::Quadratic(n) => (x..x + 1, self.on_a_parabola(x, n.cast_signed())),
            Perspective::Extrapolated => self.predicted(),
            Perspective::Subdivided(bound) => self.in_texels(bound.to_num()),
        }
    }

    fn sample(&self, x: i32) -> Sample {
        self.planes
            .at(f64::from(x) + 0.5, f64::from(self.span.y) + 0.5)
    }

    /// First and last column of the span.
    fn ends(&self) -> [i32; 2] {
        [self.span.left, self.span.right - 1]
    }

    /// Where no pixel is farther off than so many footprints: two divisions measure the scanline,
    /// one or a mean of two gives the coordinate, steps are rounded to 1/32 texel in all, and words leap from piece to
    /// piece of a group of 16. Small triangles are not measured.
    fn in_footprints(&self, x: i32, bound: f64) -> [f64; 2] {
        let footprint = self.sample(x).footprint(self.size).max(1.0);
        [0, 1].map(|axis| {
            let group = leaping(&self.corners, axis, 16, 1);
            let measured = 3.0 * self.exact[axis] + self.small[axis] + group;
            (bound * footprint + 1.0 / 32.0) / self.size[axis] + measured
        })
    }

    /// Where a span of nearly constant depth is the tangent at its middle pixel, and others have
    /// pieces of 16.
    fn on_the_tangent(&self, x: i32) -> [f64; 2] {
        let [first, last] = self.ends();
        let [a, b] = [first, last].map(|x| 1.0 / self.sample(x).w);
        let changes = (a - b).abs() / a.min(b);
        let (here, middle) = (self.sample(x), self.sample(first + (last - first) / 2));
        let (_, pieces) = self.on_a_piece(x, 16, |_, pixels| stepping(pixels));
        [0, 1].map(|axis| {
            let tangent = (here.uv[axis] - middle.uv[axis]).abs() * (middle.w / here.w - 1.0).abs()
                + 2.0 * self.exact[axis]
                + stepping(last - first);
            // Near the tolerance of 1/256 rounding decides.
            if changes < 0.999 / 256.0 {
                tangent
            } else if changes > 1.001 / 256.0 {
                pieces[axis]
            } else {
                tangent.max(pieces[axis])
            }
        })
    }

    /// Where columns of constant depth, to within 2^-14, share a reciprocal, and others have
    /// pieces of 16.
    fn in_columns(&self, x: i32) -> (Range<i32>, [f64; 2]) {
        let (columns, pieces) = self.on_a_piece(x, 16, |_, pixels| stepping(pixels));
        let shared = |axis: usize| self.range[axis] * power(-14) + self.exact[axis];
        (columns, [0, 1].map(|axis| pieces[axis].max(shared(axis))))
    }

    /// Where three points of a piece, its ends and its middle, make a parabola: the remainder of the
    /// interpolation of a hyperbola, which is known in closed form; the parabola makes up to 5/4 of
    /// the errors of its points. Pieces of `most` pixels begin at the span's first, and behind them are
    /// shorter ones, halves of halves. Points are words that leap from middle to end; or every pixel is divided.
    ///
    /// `most / 2` units are added to all coordinates. The second difference c is off by half a unit, and so is the
    /// first, which makes up for c at the middle m: at step t, `t / 2 + t |t - m| / 4` units.
    fn on_a_parabola(&self, x: i32, most: i32) -> [f64; 2] {
        let Span { left, right, .. } = self.span;
        let (mut start, mut steps) = (left, most);
        while x >= start + steps {
            start += steps;
        }
        // The last piece ends at the last pixel's centre.
        while steps > 1 && start + steps > right - 1 {
            steps /= 2;
            if x >= start + steps && start + steps < right {
                start += steps;
            }
        }
        let (t, middle) = (x - start, steps / 2);
        let end = (start + steps).min(right - 1);
        let [a, m, b, here] = [start, start + middle, end, x].map(|x| self.sample(x));
        let rounded =
            f64::from(most) / 2.0 + f64::from(t) / 2.0 + f64::from((t * (t - middle)).abs()) / 4.0;
        [0, 1].map(|axis| {
            let du = (a.uv[axis] - b.uv[axis]).abs();
            let slope = (1.0 / a.w - 1.0 / b.w) / f64::from(steps);
            let product = f64::from((t * (t - middle) * (t - steps)).abs());
            let parabola = du * slope * slope * product / f64::from(steps) * m.w * here.w;
            let leaps = leaping(&self.corners, axis, right - left, most / 2);
            let points = 1.25 * (self.exact[axis] + leaps) + small(&self.corners, axis);
            parabola + points + rounded * UNIT
        })
    }

    /// Where a Newton step leaves the square of a prediction's error, watched to be 2^-11.
    fn predicted(&self) -> (Range<i32>, [f64; 2]) {
        let newton = power(-22) + power(-29);
        let bounds = [0, 1].map(|axis| self.range[axis] * newton + self.every_pixel[axis]);
        (self.span.left..self.span.right, bounds)
    }

    /// Where the triangle was split until no pixel is farther off than so many texels; 2^-19
    /// repeats for the rounding of middles.
    fn in_texels(&self, bound: f64) -> (Range<i32>, [f64; 2]) {
        let Span { left, right, .. } = self.span;
        let added = power(-19) + stepping(right - left);
        let bounds = [0, 1].map(|axis| bound / self.size[axis] + added + 2.0 * self.exact[axis]);
        (left..right, bounds)
    }

    /// Where u itself is taken for linear over the triangle.
    fn on_the_plane(&self, x: i32) -> (Range<i32>, [f64; 2]) {
        // A step is rounded to nearest, half a unit; what the gradient lost is part of `affine`.
        let steps = 0.5 * f64::from(x - self.span.left) * UNIT;
        let bounds = [0, 1].map(|axis| self.bend[axis] + self.affine[axis] + steps);
        (x..x + 1, bounds)
    }

    /// Where [`is_affine_within`] a bound, the plane, and elsewhere pieces of 16.
    fn on_the_plane_or_a_piece(&self, x: i32, bound: f64) -> (Range<i32>, [f64; 2]) {
        if is_affine_within(&self.corners, bound) {
            self.on_the_plane(x)
        } else {
            self.on_a_piece(x, 16, |axis, pixels| {
                self.small[axis] + stepping_from_bias(pixels, 16)
            })
        }
    }

    /// Where coordinates are linear along a [`piece`], exact at its ends, to within what `added` says of an axis
    /// and its length.
    fn on_a_piece(
        &self,
        x: i32,
        n: i32,
        added: impl Fn(usize, i32) -> f64,
    ) -> (Range<i32>, [f64; 2]) {
        let Span { left, right, .. } = self.span;
        let (start, end) = piece(&self.corners, self.span, x, n);
        let (a, b) = (self.sample(start), self.sample(end));
        let bounds = [0, 1].map(|axis| {
            let leaps = leaping(&self.corners, axis, right - left, n);
            chord(&a, &b, axis) + self.exact[axis] + leaps + added(axis, end - start)
        });
        // The end of a piece that is not the last belongs to the next.
        (
            start..(end + i32::from(end == right - 1)).max(x + 1),
            bounds,
        )
    }
}
