//! The benchmark scenes, given after projection on a screen of 320 x 240.

use multum::fixed::types::{I16F16, I24F8};
use multum::project::ScreenVertex;

/// Columns of the frame.
pub const WIDTH: u32 = 320;
/// Rows of the frame.
pub const HEIGHT: u32 = 240;

/// Triangles as raw bits: x and y, w, u and v of each corner.
#[derive(Debug)]
pub struct Scene {
    /// As host-sim calls it.
    pub name: &'static str,
    /// In drawing order.
    pub triangles: &'static [[[i32; 5]; 3]],
}

include!(concat!(env!("OUT_DIR"), "/benchmark.rs"));

/// Triangles of the largest scene.
pub const MOST_TRIANGLES: usize = {
    let (mut most, mut scene) = (0, 0);
    while scene < SCENES.len() {
        if SCENES[scene].triangles.len() > most {
            most = SCENES[scene].triangles.len();
        }
        scene += 1;
    }
    most
};

/// The corners of a triangle. `None` if the core refuses one, which it does not for these scenes.
#[must_use]
pub fn corners(bits: &[[i32; 5]; 3]) -> Option<[ScreenVertex; 3]> {
    let [a, b, c] = bits.map(|[x, y, w, u, v]| {
        ScreenVertex::new(
            I24F8::from_bits(x),
            I24F8::from_bits(y),
            I16F16::from_bits(w),
            [u, v].map(I16F16::from_bits),
        )
    });
    Some([a?, b?, c?])
}
