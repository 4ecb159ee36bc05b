//! How far the core may be from float64, and why: the error budget of its documentation, term by
//! term.

use host_sim::reference::Corners;

/// One unit of an 8.24 texture coordinate, in repeats.
const UNIT: f64 = 1.0 / (1 << 24) as f64;

/// The error of a coordinate computed by one perspective division, in repeats.
///
/// R is the power of two of repeats that the triangle's coordinates fit in, at least 2^-16, and
/// rho the ratio of its depths.
///
/// | term | bound | from |
/// |---|---|---|
/// | 1/w of the corners | R (2^-30 + rho 2^-32) | reciprocal (2^-29) and shared exponent (rho 2^-31); a weighted mean of coordinates moves by half of that, times R |
/// | u/w of the corners | R rho 2^-31 | rounded to half a unit, where 1/w has at least 2^30 / rho units |
/// | area | R rho 2^-29 | all planes are moved by 2^-29 of the distance from a corner; u changes at most rho times as fast at the end as on the average |
/// | gradients | R rho 2^-40 | 2^-11 units in u/w and in 1/w |
/// | division | R 2^-27 + 2^-25 | see `Homogeneous::divide` |
#[must_use]
pub fn exact(corners: &Corners, axis: usize) -> f64 {
    let values = corners.uv.map(|uv| uv[axis]);
    let [most, least] = [
        values.iter().copied().fold(f64::MIN, f64::max),
        values.iter().copied().fold(f64::MAX, f64::min),
    ];
    // The range has to exceed the difference, in units of 2^-16.
    let units = ((most - least) * 65536.0).round() as u64;
    let range = (units + 1).next_power_of_two() as f64 / 65536.0;
    let nearest = corners.w.iter().copied().fold(f64::MAX, f64::min);
    let farthest = corners.w.iter().copied().fold(f64::MIN, f64::max);
    let rho = farthest / nearest;
    let power = |e: i32| f64::from(e).exp2();
    let corner_q = range * (power(-30) + rho * power(-32));
    let corner_u = range * rho * power(-31);
    let area = range * rho * power(-29);
    let gradients = range * rho * power(-40);
    let division = range * power(-27) + power(-25);
    corner_q + corner_u + area + gradients + division
}

/// What stepping over a piece of `pixels` pixels adds, in repeats: a step is off by at most one
/// unit of 2^-24 (one half from its rounding, one half from the reciprocal of the length).
#[must_use]
pub fn stepping(pixels: i32) -> f64 {
    f64::from(pixels) * UNIT
}
