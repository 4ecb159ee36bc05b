//! The benchmark scenes on a screen of 320x240, as host-sim has them.

use host_sim::benchmark;
use host_sim::frame::ScreenTriangle;
use multum::project::ScreenVertex;
use multum::viewport::Viewport;

use crate::error::Error;

/// Columns of the frame.
pub const WIDTH: u32 = 320;

/// Rows of the frame.
pub const HEIGHT: u32 = 240;

/// Pixels of the frame. Every scene covers all of them.
pub const PIXELS: usize = WIDTH as usize * HEIGHT as usize;

/// The scenes' names.
pub const NAMES: [&str; 6] = ["wall", "floor", "receding", "oblique", "tilted", "mesh"];

/// The scene of many small triangles.
pub const MESH: &str = "mesh";

/// Triangles of [`MESH`].
pub const MESH_TRIANGLES: usize = 8192;

/// A corner for renderers that take floating point.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// x and y in pixels from the top-left corner of the frame, y down.
    pub position: [f32; 2],
    /// Distance along the view axis, 1 to 20.
    pub w: f32,
    /// Texture coordinates in repeats, v down.
    pub uv: [f32; 2],
}

/// Triangles as the core's and as the peers' rasterizers take them: the same positions, which lie
/// on the core's grid of 1/256 pixel.
#[derive(Clone, Debug)]
pub struct Scene {
    /// For the core.
    pub vertices: Vec<[ScreenVertex; 3]>,
    /// For the peers.
    pub corners: Vec<[Corner; 3]>,
}

impl Scene {
    /// A scene by name.
    ///
    /// # Errors
    ///
    /// [`Error::Content`] for an unknown name, [`Error::Scene`] if the core refuses a corner.
    pub fn new(name: &str) -> Result<Self, Error> {
        let projected =
            benchmark::by_name(name).ok_or_else(|| Error::content(name, "is not a scene"))?;
        let frame = projected.frame(Viewport::new(WIDTH, HEIGHT)?)?;
        let (vertices, corners) = frame
            .triangles()
            .map(|(_, triangle)| (triangle.vertices, corners(triangle)))
            .unzip();
        Ok(Self { vertices, corners })
    }
}

fn corners(triangle: &ScreenTriangle) -> [Corner; 3] {
    let exact = triangle.corners();
    [0, 1, 2].map(|i| Corner {
        position: exact.position[i].map(|c| c as f32),
        w: exact.w[i] as f32,
        uv: exact.uv[i].map(|c| c as f32),
    })
}

/// What costs are given per: the pixels of a scene, or its triangles if those are small.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit {
    /// Its name.
    pub name: &'static str,
    /// How many a frame has.
    pub count: usize,
}

impl Unit {
    /// A pixel.
    pub const PIXEL: Self = Self {
        name: "pixel",
        count: PIXELS,
    };

    /// A triangle of [`MESH`].
    pub const TRIANGLE: Self = Self {
        name: "triangle",
        count: MESH_TRIANGLES,
    };

    /// The unit of a scene.
    #[must_use]
    pub fn of(scene: &str) -> Self {
        if scene == MESH {
            Self::TRIANGLE
        } else {
            Self::PIXEL
        }
    }
}
