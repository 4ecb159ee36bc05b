//! Sine and cosine in single precision, for cameras that need more than micromath's three digits.
//!
//! Only additions and multiplications of `f32`, each rounded as IEEE 754 says, so the result is
//! the same on every target, with a floating-point unit or without.

use core::f32::consts::FRAC_2_PI;

/// Largest magnitude of an angle, in radians.
pub const MAX_ANGLE: f32 = 8192.0;

/// pi / 2 in three parts (Cody and Waite, *Software Manual for the Elementary Functions*, 1980):
/// the first two have few enough bits that their products with quadrants are exact.
const QUARTER: [f32; 3] = [1.570_312_5, 4.837_513e-4, 7.549_79e-8];

/// Sine and cosine of an angle in radians, each within 2^-22 of the true value. `None` for an
/// angle beyond [`MAX_ANGLE`] or one that is not a number.
///
/// Reduction to an eighth of a turn, then the polynomials of the Cephes library's `sinf`
/// (Moshier, 1992).
#[must_use]
pub fn sin_cos(angle: f32) -> Option<[f32; 2]> {
    // NaN is in no range.
    if !(-MAX_ANGLE..=MAX_ANGLE).contains(&angle) {
        return None;
    }
    // To the nearest: a cast rounds towards zero. At most 5216 quadrants.
    let half = if angle < 0.0 { -0.5 } else { 0.5 };
    let quadrant = (angle * FRAC_2_PI + half) as i32;
    let quadrants = quadrant as f32;
    let [high, middle, low] = QUARTER;
    let x = ((angle - quadrants * high) - quadrants * middle) - quadrants * low;
    let square = x * x;
    let sine =
        x + x * square * (-1.666_665_5e-1 + square * (8.332_161e-3 + square * -1.951_529_6e-4));
    let cosine = 1.0 - 0.5 * square
        + square * square * (4.166_664_6e-2 + square * (-1.388_731_6e-3 + square * 2.443_315_7e-5));
    Some(match quadrant & 3 {
        0 => [sine, cosine],
        1 => [cosine, -sine],
        2 => [-sine, -cosine],
        _ => [-cosine, sine],
    })
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;

    fn check(angle: f32) {
        let [sine, cosine] = sin_cos(angle).expect("an angle in range");
        let (s, c) = std::primitive::f64::sin_cos(f64::from(angle));
        let bound = 1.0 / f64::from(1 << 22);
        assert!((f64::from(sine) - s).abs() <= bound, "sin {angle}: {sine}");
        assert!(
            (f64::from(cosine) - c).abs() <= bound,
            "cos {angle}: {cosine}"
        );
    }

    #[test]
    fn within_2_to_the_minus_22_up_to_the_largest_angle() {
        for i in -1_000_000i32..=1_000_000 {
            check(i as f32 * 1e-5);
            check(i as f32 * 0.008_19);
        }
        check(MAX_ANGLE);
        check(-MAX_ANGLE);
    }

    #[test]
    fn exact_at_zero_and_refused_beyond_the_largest() {
        assert_eq!(sin_cos(0.0), Some([0.0, 1.0]));
        for angle in [8193.0, -8193.0, f32::INFINITY, f32::NAN] {
            assert_eq!(sin_cos(angle), None);
        }
    }
}
