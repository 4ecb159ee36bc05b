//! What is drawn: screen triangles with their textures, as the core's geometry, clip and
//! projection stages leave them, and beside each its corners before snapping.

use std::sync::Arc;

use multum::clip::{ClipVertex, ClipVolume, fan, transform};
use multum::fixed::types::I16F16;
use multum::geometry::Mesh;
use multum::project::ScreenVertex;
use multum::setup::Cull;
use multum::viewport::Viewport;

use crate::error::Error;
use crate::picture::Picture;
use crate::reference::{Beyond, Corners};
use crate::scene::Scene;

/// A picture to be drawn.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Its size.
    pub viewport: Viewport,
    /// Near distance in units: the scale of the depth buffer.
    pub near: I16F16,
    /// Which triangles are left out.
    pub cull: Cull,
    /// Whether it needs a depth buffer.
    pub depth: bool,
    /// The triangles, in drawing order.
    pub batches: Vec<Batch>,
}

/// Triangles with one texture.
#[derive(Clone, Debug)]
pub struct Batch {
    /// The texture.
    pub picture: Arc<Picture>,
    /// What lies beyond its edges.
    pub wrap: Beyond,
    /// The triangles, in drawing order.
    pub triangles: Vec<ScreenTriangle>,
}

/// A triangle as it goes to the rasterizer.
#[derive(Clone, Copy, Debug)]
pub struct ScreenTriangle {
    /// What the core draws.
    pub vertices: [ScreenVertex; 3],
    /// x and y of each corner before snapping, in pixels.
    pub unsnapped: [[f64; 2]; 3],
}

impl ScreenTriangle {
    /// The corners as the core has them, as plain numbers.
    #[must_use]
    pub fn corners(&self) -> Corners {
        let number = |n: I16F16| f64::from(n.to_bits()) / 65536.0;
        Corners {
            position: self.grid().map(|c| c.map(|c| c as f64 / 256.0)),
            w: self.vertices.map(|v| number(v.w())),
            uv: self.vertices.map(|v| v.uv().map(number)),
        }
    }

    /// The corners where they were before snapping.
    #[must_use]
    pub fn unsnapped_corners(&self) -> Corners {
        Corners {
            position: self.unsnapped,
            ..self.corners()
        }
    }

    /// x and y of each corner in 1/256 pixel.
    #[must_use]
    pub fn grid(&self) -> [[i64; 2]; 3] {
        self.vertices
            .map(|v| [v.x().to_bits(), v.y().to_bits()].map(i64::from))
    }

    /// Whether it shows on the screen at all: it has an area, and `cull` does not leave it out.
    #[must_use]
    pub fn is_shown(&self, cull: Cull) -> bool {
        let [a, b, c] = self.grid();
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        match cull {
            Cull::Off => area != 0,
            // Counter-clockwise where y points down: the front.
            Cull::Back => area < 0,
            Cull::Front => area > 0,
        }
    }
}

impl Frame {
    /// A scene seen by its camera.
    ///
    /// # Errors
    ///
    /// [`Error::Core`] where a mesh or the camera is beyond what the core can draw.
    pub fn of_scene(scene: &Scene, viewport: Viewport) -> Result<Self, Error> {
        let context = |error| Error::core(&format!("scene {}", scene.name), error);
        let camera = scene.view.camera(viewport).map_err(context)?;
        let volume = ClipVolume::new(viewport, camera.lens.near());
        let mut batches = Vec::with_capacity(scene.props.len());
        for prop in &scene.props {
            let mesh = Mesh::new(&prop.part.vertices, &prop.part.triangles).map_err(context)?;
            let to_clip = camera.to_clip(&prop.stand).map_err(context)?;
            let mut buffer = vec![ClipVertex::default(); mesh.vertices().len()];
            let vertices = transform(&mesh, &to_clip, &mut buffer).map_err(context)?;
            let mut triangles = Vec::new();
            for indices in mesh.triangles() {
                let triangle = indices.map(|i| vertices[usize::from(i)]);
                triangles.extend(cut(&volume, &triangle));
            }
            batches.push(Batch {
                picture: Arc::clone(&prop.part.picture),
                wrap: prop.wrap,
                triangles,
            });
        }
        Ok(Self {
            viewport,
            near: camera.lens.near(),
            cull: scene.cull,
            depth: scene.depth,
            batches,
        })
    }

    /// All triangles in drawing order, with their batch.
    pub fn triangles(&self) -> impl Iterator<Item = (&Batch, &ScreenTriangle)> {
        self.batches
            .iter()
            .flat_map(|batch| batch.triangles.iter().map(move |t| (batch, t)))
    }
}

/// What is left of a triangle in clip space, on the screen.
#[must_use]
pub fn cut(volume: &ClipVolume, triangle: &[ClipVertex; 3]) -> Vec<ScreenTriangle> {
    let viewport = volume.viewport();
    let mut left = Vec::new();
    for part in fan(&volume.clip(triangle)) {
        let [a, b, c] = part.map(|v| ScreenVertex::project(v, viewport));
        if let (Some(a), Some(b), Some(c)) = (a, b, c) {
            left.push(ScreenTriangle {
                vertices: [a, b, c],
                unsnapped: part.map(|v| project(v, viewport)),
            });
        }
    }
    left
}

/// The projection in float64, without snapping.
fn project(vertex: &ClipVertex, viewport: Viewport) -> [f64; 2] {
    let number = |n: I16F16| f64::from(n.to_bits());
    let w = number(vertex.w);
    [
        (number(vertex.x) / w + 1.0) * 0.5 * f64::from(viewport.width()),
        (1.0 - number(vertex.y) / w) * 0.5 * f64::from(viewport.height()),
    ]
}
