//! What rough trigonometry does to a camera: micromath's sine and cosine, and the core's precise
//! ones, against float64.

use multum::camera::Perspective;
use multum::transform::Transform;
use serde::Serialize;

/// Columns and rows of the frame in which pixels are counted.
const SIZE: [f64; 2] = [320.0, 240.0];

/// The vertical fields of view that are looked at, in degrees.
const FIELDS: [f32; 5] = [10.0, 30.0, 45.0, 60.0, 90.0];

/// Trigonometry that a camera can be built with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Trigonometry {
    /// `Transform::rotation` and `Perspective::new`.
    Micromath,
    /// `Transform::rotation_precise` and `Perspective::precise`.
    Precise,
}

/// The errors of cameras with one field of view.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Precision {
    /// How sines and cosines were found.
    pub trigonometry: Trigonometry,
    /// Vertical field of view in degrees.
    pub field: f32,
    /// Largest element of `R R^T - I`, over all turns.
    pub orthogonality: f64,
    /// Largest angle in radians between a turn and the one that was asked for.
    pub angle: f64,
    /// Largest distance that a turn's error moves a point of the screen, in pixels of 320x240.
    pub turn_pixels: f64,
    /// Largest distance that the lens's error moves a point of the screen, in pixels: at a corner.
    pub lens_pixels: f64,
}

/// Measures turns by every 1/100 radian about three axes, and lenses.
///
/// # Errors
///
/// The core's; all angles are in range.
pub fn measure() -> Result<Vec<Precision>, multum::error::Error> {
    let mut rows = Vec::new();
    for trigonometry in [Trigonometry::Micromath, Trigonometry::Precise] {
        for field in FIELDS {
            rows.push(of_field(trigonometry, field)?);
        }
    }
    Ok(rows)
}

fn of_field(trigonometry: Trigonometry, field: f32) -> Result<Precision, multum::error::Error> {
    let radians = field.to_radians();
    let aspect = (SIZE[0] / SIZE[1]) as f32;
    let lens = match trigonometry {
        Trigonometry::Micromath => Perspective::new(radians, aspect, 0.1),
        Trigonometry::Precise => Perspective::precise(radians, aspect, 0.1),
    }?;
    let cotangent = 1.0 / (0.5 * f64::from(radians)).tan();
    let exact = [cotangent / f64::from(aspect), cotangent];
    let scales = lens.scales().map(f64::from);
    let lens_pixels = (0.5 * SIZE[0] * (scales[0] / exact[0] - 1.0))
        .hypot(0.5 * SIZE[1] * (scales[1] / exact[1] - 1.0));

    let mut result = Precision {
        trigonometry,
        field,
        orthogonality: 0.0,
        angle: 0.0,
        turn_pixels: 0.0,
        lens_pixels,
    };
    for axis in [[0.0f32, 1.0, 0.0], [1.0, 0.0, 0.0], [0.6, 0.0, -0.8]] {
        for step in -315i16..=315 {
            let angle = f32::from(step) / 100.0;
            let turn = match trigonometry {
                Trigonometry::Micromath => Transform::rotation(axis, angle),
                Trigonometry::Precise => Transform::rotation_precise(axis, angle),
            }?;
            let found = turn.rows.map(|row| row.map(f64::from));
            let wanted = rotation(axis.map(f64::from), f64::from(angle));
            // found = error * wanted.
            let error = times_transposed(&found, &wanted);
            let square = times_transposed(&found, &found);
            let off = elements(&square, |r, c, e| (e - f64::from(u8::from(r == c))).abs());
            result.orthogonality = off.fold(result.orthogonality, f64::max);
            // Twice the sine of the angle, from the antisymmetric part.
            let sine = [
                error[2][1] - error[1][2],
                error[0][2] - error[2][0],
                error[1][0] - error[0][1],
            ]
            .iter()
            .map(|e| e * e)
            .sum::<f64>()
            .sqrt()
                * 0.5;
            result.angle = result.angle.max(sine.min(1.0).asin());
            result.turn_pixels = result.turn_pixels.max(moved(&error, exact));
        }
    }
    Ok(result)
}

/// The farthest that a small turn in view space moves a point of the screen, in pixels.
fn moved(turn: &[[f64; 3]; 3], scales: [f64; 2]) -> f64 {
    let mut most: f64 = 0.0;
    for (i, j) in (0..=8u8).flat_map(|i| (0..=6u8).map(move |j| (i, j))) {
        // -1 .. 1 across the screen.
        let at = [f64::from(i) / 4.0 - 1.0, f64::from(j) / 3.0 - 1.0];
        let ray = [at[0] / scales[0], at[1] / scales[1], -1.0];
        let [x, y, z] = turn.map(|row| row.iter().zip(ray).map(|(r, d)| r * d).sum::<f64>());
        let dx = (x / -z * scales[0] - at[0]) * 0.5 * SIZE[0];
        let dy = (y / -z * scales[1] - at[1]) * 0.5 * SIZE[1];
        most = most.max(dx.hypot(dy));
    }
    most
}

/// A turn about a unit axis, counter-clockwise when the axis points at the viewer.
fn rotation([x, y, z]: [f64; 3], angle: f64) -> [[f64; 3]; 3] {
    let length = (x * x + y * y + z * z).sqrt();
    let [x, y, z] = [x / length, y / length, z / length];
    let (s, c) = angle.sin_cos();
    let t = 1.0 - c;
    [
        [t * x * x + c, t * x * y - s * z, t * x * z + s * y],
        [t * x * y + s * z, t * y * y + c, t * y * z - s * x],
        [t * x * z - s * y, t * y * z + s * x, t * z * z + c],
    ]
}

/// `a b^T`.
fn times_transposed(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    a.map(|row| b.map(|other| row.iter().zip(other).map(|(p, q)| p * q).sum()))
}

fn elements(m: &[[f64; 3]; 3], f: impl Fn(usize, usize, f64) -> f64) -> impl Iterator<Item = f64> {
    m.iter()
        .enumerate()
        .flat_map(|(r, row)| row.iter().enumerate().map(move |(c, &e)| (r, c, e)))
        .map(move |(r, c, e)| f(r, c, e))
}
