//! Cameras built with the core's precise trigonometry, against float64.

use host_sim::camera_precision::{Trigonometry, measure};

/// A sine or cosine is off by 2^-22, the axis and the products by a few 2^-24, an element of the
/// matrix by 2^-25: an angle of less than 2^-20. A pixel is seen at 1/1372 of a radian or more (10
/// degrees over 240 rows), and the lens has 2^-17 of its least scale, 0.75, at 200 pixels from the
/// middle: 1/500 px.
#[test]
fn precise_cameras_miss_by_less_than_a_hundredth_of_a_pixel() {
    let rows = measure().expect("angles in range");
    let precise: Vec<_> = rows
        .iter()
        .filter(|row| row.trigonometry == Trigonometry::Precise)
        .collect();
    assert_eq!(precise.len(), 5);
    for row in precise {
        assert!(row.angle <= 1.0 / f64::from(1 << 20), "{row:?}");
        assert!(row.orthogonality <= 1.0 / f64::from(1 << 20), "{row:?}");
        assert!(row.turn_pixels + row.lens_pixels < 0.01, "{row:?}");
    }
}
