//! A scene as it lies in flash; the build script writes its tables.

use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::geometry::Mesh;
use multum::pyramid::Pyramid;
use multum::setup::Cull;
use multum::texture::Texture;
use multum::transform::Transform;

/// A texture and how it is filtered; it repeats beyond its edges.
#[derive(Debug)]
pub enum Skin {
    /// The nearest texel.
    Plain(Texture<'static, Rgb565>),
    /// Trilinear, with a level for each 16 columns.
    Levels(&'static Pyramid<Texture<'static, Rgb565>>),
}

/// A mesh, its texture and its place in the world.
#[derive(Debug)]
pub struct Part {
    /// The mesh.
    pub mesh: Mesh<'static>,
    /// Its texture.
    pub skin: Skin,
    /// Model to world.
    pub stand: Transform,
}

/// What is drawn, from where, and how.
#[derive(Debug)]
pub struct Scene {
    /// The name that it is printed with.
    pub name: &'static str,
    /// Where the camera stands, in world units.
    pub eye: [f32; 3],
    /// What it looks at, in world units.
    pub look: [f32; 3],
    /// The direction that is up in the picture.
    pub up: [f32; 3],
    /// Vertical field of view in radians.
    pub fov_y: f32,
    /// Distance of the near plane in world units.
    pub near: f32,
    /// Whether it needs a depth buffer.
    pub depth: bool,
    /// Which triangles are left out.
    pub cull: Cull,
    /// What a pixel has that nothing is drawn on.
    pub background: Rgb565,
    /// What stands in the world, in the order of drawing.
    pub parts: &'static [Part],
}

impl Scene {
    /// The number of vertices of all parts.
    #[must_use]
    pub const fn vertices(&self) -> usize {
        let mut sum = 0;
        let mut part = 0;
        while part < self.parts.len() {
            sum += self.parts[part].mesh.vertices().len();
            part += 1;
        }
        sum
    }
}
