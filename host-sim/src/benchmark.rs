//! The benchmark scenes: triangles given after projection, so that only the rasterizer is at
//! work.

use std::sync::Arc;

use multum::fixed::types::{I16F16, I24F8};
use multum::project::ScreenVertex;
use multum::setup::Cull;
use multum::viewport::Viewport;

use crate::error::Error;
use crate::frame::{Batch, Frame, ScreenTriangle};
use crate::pattern;
use crate::reference::Beyond;

/// Names, and what each scene shows.
pub const SCENES: [(&str, &str); 6] = [
    ("wall", "flat, one texel a pixel"),
    (
        "floor",
        "w from 20 at the top to 1 at the bottom, constant along a scanline",
    ),
    ("receding", "the floor on its side: w varies along x"),
    ("oblique", "w from 1 to 4, left to right"),
    ("tilted", "w varies both ways"),
    ("mesh", "8,192 triangles of 9.4 pixels"),
];

/// x and y in pixels of a 320 x 240 frame, w, u and v in repeats.
type Corner = [f64; 5];

/// Triangles on a screen of 320 x 240.
#[derive(Clone, Debug)]
pub struct Projected {
    corners: Vec<Corner>,
    triangles: Vec<[usize; 3]>,
}

/// A benchmark scene by name.
#[must_use]
pub fn by_name(name: &str) -> Option<Projected> {
    let quad = |corners: [Corner; 4]| Projected {
        corners: corners.to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    match name {
        "wall" => Some(quad([
            [0.0, 0.0, 1.0, 0.0, 0.0],
            [0.0, 240.0, 1.0, 0.0, 0.9375],
            [320.0, 240.0, 1.0, 1.25, 0.9375],
            [320.0, 0.0, 1.0, 1.25, 0.0],
        ])),
        "floor" => Some(quad([
            [0.0, 0.0, 20.0, 0.0, 16.0],
            [0.0, 240.0, 1.0, 7.6, 0.0],
            [320.0, 240.0, 1.0, 8.4, 0.0],
            [320.0, 0.0, 20.0, 16.0, 16.0],
        ])),
        "receding" => Some(quad([
            [0.0, 0.0, 1.0, 0.0, 7.6],
            [0.0, 240.0, 1.0, 0.0, 8.4],
            [320.0, 240.0, 20.0, 16.0, 16.0],
            [320.0, 0.0, 20.0, 16.0, 0.0],
        ])),
        "oblique" => Some(quad([
            [0.0, 0.0, 1.0, 0.0, 0.0],
            [0.0, 240.0, 1.0, 0.0, 0.75],
            [320.0, 240.0, 4.0, 4.0, 3.0],
            [320.0, 0.0, 4.0, 4.0, 0.0],
        ])),
        "tilted" => Some(quad([
            [0.0, 0.0, 3.0, 0.0, 0.0],
            [0.0, 240.0, 1.0, 0.0, 2.0],
            [320.0, 240.0, 1.5, 2.0, 2.0],
            [320.0, 0.0, 1.0, 2.0, 0.0],
        ])),
        "mesh" => Some(mesh()),
        _ => None,
    }
}

/// 64 x 64 cells with jittered inner vertices.
fn mesh() -> Projected {
    const CELLS: usize = 64;
    let mut state: u32 = 12345;
    // A linear congruential generator (Numerical Recipes, "quick and dirty"), -0.5 to 0.5.
    let mut jitter = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24) - 0.5
    };
    let mut corners = Vec::new();
    for j in 0..=CELLS {
        for i in 0..=CELLS {
            let (mut x, mut y) = (5.0 * i as f64, 3.75 * j as f64);
            if (1..CELLS).contains(&i) && (1..CELLS).contains(&j) {
                x += jitter() * 2.4;
                y += jitter() * 1.8;
            }
            corners.push([x, y, 4.0 - 3.0 * j as f64 / 64.0, x / 256.0, y / 256.0]);
        }
    }
    let mut triangles = Vec::new();
    for j in 0..CELLS {
        for i in 0..CELLS {
            let a = j * (CELLS + 1) + i;
            let below = a + CELLS + 1;
            triangles.extend([[a, below, below + 1], [a, below + 1, a + 1]]);
        }
    }
    Projected { corners, triangles }
}

impl Projected {
    /// On a screen of this size: stretched from 320 x 240.
    ///
    /// # Errors
    ///
    /// [`Error::Core`] if a corner is beyond the core's range.
    pub fn frame(&self, viewport: Viewport) -> Result<Frame, Error> {
        let stretch = [
            f64::from(viewport.width()) / 320.0,
            f64::from(viewport.height()) / 240.0,
        ];
        let position = |c: Corner| [c[0] * stretch[0], c[1] * stretch[1]];
        let vertex = |c: Corner| {
            let [x, y] = position(c);
            ScreenVertex::new(
                I24F8::saturating_from_num((x * 256.0).round() / 256.0),
                I24F8::saturating_from_num((y * 256.0).round() / 256.0),
                I16F16::saturating_from_num(c[2]),
                [c[3], c[4]].map(I16F16::saturating_from_num),
            )
            .ok_or_else(|| Error::core("benchmark scene", multum::error::Error::Overflow))
        };
        let triangles = self
            .triangles
            .iter()
            .map(|indices| {
                let [a, b, c] = indices.map(|i| self.corners[i]);
                Ok(ScreenTriangle {
                    vertices: [vertex(a)?, vertex(b)?, vertex(c)?],
                    unsnapped: [a, b, c].map(position),
                })
            })
            .collect::<Result<_, Error>>()?;
        Ok(Frame {
            viewport,
            near: I16F16::ONE,
            cull: Cull::Off,
            depth: false,
            batches: vec![Batch {
                picture: Arc::new(pattern::coordinates()),
                wrap: Beyond::Repeat,
                triangles,
            }],
        })
    }
}
