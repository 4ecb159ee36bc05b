//! The core's texture coordinates against the reference's, pixel by pixel.

use multum::fixed::types::I8F24;

use super::{Spread, UvError, Visible};
use crate::frame::Frame;
use crate::reference::Planes;
use crate::render::Fragment;

/// What is wrong with the coordinates of a frame's visible pixels.
#[derive(Clone, Debug)]
pub(crate) struct Coordinates {
    /// Pixels compared.
    pub(crate) pixels: usize,
    /// Distance from the reference.
    pub(crate) uv_error: UvError,
    /// Distance between the reference with snapped and with unsnapped vertices.
    pub(crate) snap_error: UvError,
    /// At each pixel the distance in level-0 texels; `None` where nothing is drawn.
    pub(crate) error: Vec<Option<f64>>,
    /// At each pixel the number of the triangle that the core shows.
    triangles: Vec<Option<usize>>,
}

/// Distances in both units.
#[derive(Default)]
struct Distances {
    texels: Vec<f64>,
    footprints: Vec<f64>,
}

impl Distances {
    fn add(&mut self, texels: f64, footprint: f64) {
        self.texels.push(texels);
        self.footprints.push(texels / footprint);
    }

    fn spread(self) -> UvError {
        UvError {
            texels: Spread::of(self.texels),
            footprints: Spread::of(self.footprints),
        }
    }
}

impl Coordinates {
    /// Of what the core put at each pixel.
    pub(crate) fn of(frame: &Frame, fragments: &[Option<Fragment>]) -> Self {
        let planes: Vec<_> = frame
            .triangles()
            .map(|(batch, t)| {
                let size = [batch.picture.width(), batch.picture.height()].map(f64::from);
                let exact = Planes::new(&t.corners());
                (size, exact, Planes::new(&t.unsnapped_corners()))
            })
            .collect();
        let width = frame.viewport.width() as usize;
        let mut off = Distances::default();
        let mut snapping = Distances::default();
        let mut error = vec![None; fragments.len()];
        let mut triangles = vec![None; fragments.len()];
        for (i, fragment) in fragments.iter().enumerate() {
            let Some(fragment) = fragment else { continue };
            let number = fragment.triangle as usize;
            triangles[i] = Some(number);
            let (size, Some(snapped), unsnapped) = &planes[number] else {
                continue;
            };
            let (x, y) = ((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
            let exact = snapped.at(x, y);
            let footprint = exact.footprint(*size).max(1.0);
            let distance = |uv: [f64; 2]| {
                let axis = |k: usize| ((uv[k] - exact.uv[k]) * size[k]).abs();
                axis(0).max(axis(1))
            };
            let number = |c: I8F24| f64::from(c.to_bits()) / f64::from(1 << 24);
            let texels = distance([number(fragment.uv.u), number(fragment.uv.v)]);
            off.add(texels, footprint);
            error[i] = Some(texels);
            if let Some(unsnapped) = unsnapped {
                snapping.add(distance(unsnapped.at(x, y).uv), footprint);
            }
        }
        Self {
            pixels: off.texels.len(),
            uv_error: off.spread(),
            snap_error: snapping.spread(),
            error,
            triangles,
        }
    }

    /// Pixels where another triangle is in front than in the reference.
    pub(crate) fn depth_mismatches(&self, visible: &Visible) -> usize {
        let pairs = self.triangles.iter().zip(&visible.triangle);
        pairs
            .filter(|(core, reference)| core.is_some() && core != reference)
            .count()
    }
}
