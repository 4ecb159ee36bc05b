//! Scenes: what stands where, and the camera that looks at it.

use std::f32::consts::PI;
use std::sync::Arc;

use multum::camera::{Camera, Perspective};
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::setup::Cull;
use multum::transform::Transform;
use multum::viewport::Viewport;

use crate::error::Error;
use crate::model::{Model, Part};
use crate::picture::Picture;
use crate::reference::Beyond;

/// What an empty frame is filled with.
pub const BACKGROUND: Rgb565 = Rgb565::new(3, 8, 6);

/// Where the camera stands and how wide it sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Position of the eye, in units.
    pub eye: [f32; 3],
    /// The point in the middle of the picture.
    pub look: [f32; 3],
    /// A direction that points upwards in the picture.
    pub up: [f32; 3],
    /// Vertical field of view in degrees, above 0 and below 180.
    pub fov_y: f32,
    /// Distance of the near plane, in units.
    pub near: f32,
}

impl View {
    /// Vertical field of view in radians, as a device is given it.
    #[must_use]
    pub fn fov_y_radians(&self) -> f32 {
        self.fov_y * (PI / 180.0)
    }

    /// The core's camera, for a frame of this size with square pixels.
    ///
    /// # Errors
    ///
    /// The core's, for a view without a direction or out of range.
    pub fn camera(&self, viewport: Viewport) -> Result<Camera, multum::error::Error> {
        let aspect = viewport.width() as f32 / viewport.height() as f32;
        let lens = Perspective::new(self.fov_y_radians(), aspect, self.near)?;
        Camera::look_at(self.eye, self.look, self.up, lens)
    }
}

/// A mesh that stands in a scene.
#[derive(Clone, Debug)]
pub struct Prop {
    /// The mesh and its texture.
    pub part: Part,
    /// From the mesh's space to the world.
    pub stand: Transform,
    /// What lies beyond the texture's edges.
    pub wrap: Beyond,
}

/// Meshes in the world and a camera.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Its name.
    pub name: String,
    /// The camera.
    pub view: View,
    /// Scene units per unit of the file it came from: a camera in the file's units is multiplied
    /// by this.
    pub units: f32,
    /// The meshes, in drawing order.
    pub props: Vec<Prop>,
    /// Which triangles are left out.
    pub cull: Cull,
    /// Whether drawing order is not enough, so that a depth buffer is needed.
    pub depth: bool,
}

impl Scene {
    /// The scene reduced to what the flash of a chip holds: no side of a texture above `side`
    /// texels, a power of two.
    ///
    /// # Errors
    ///
    /// [`Error::Core`] if `side` is not a power of two that a texture may have.
    pub fn with_textures_up_to(mut self, side: u32) -> Result<Self, Error> {
        // Props that shared a picture share the smaller one.
        let mut known: Vec<(Arc<Picture>, Arc<Picture>)> = Vec::new();
        for prop in &mut self.props {
            let picture = &prop.part.picture;
            let same = known.iter().find(|(large, _)| Arc::ptr_eq(large, picture));
            let small = if let Some((_, small)) = same {
                Arc::clone(small)
            } else {
                let (width, height) = (picture.width().min(side), picture.height().min(side));
                let small = Arc::new(picture.resized(width, height)?);
                known.push((Arc::clone(picture), Arc::clone(&small)));
                small
            };
            prop.part.picture = small;
        }
        Ok(self)
    }

    /// A loaded file, seen by a camera that shows all of it in a frame of this size, from slightly
    /// above.
    #[must_use]
    pub fn of_model(name: &str, model: Model, viewport: Viewport) -> Self {
        let units = model.scale;
        let [x, y, z] = model.centre;
        let radius = model.radius.max(1e-3);
        let fov_y: f32 = 45.0;
        // The bounding sphere fills the shorter side of the picture but for a margin.
        let aspect = viewport.width() as f32 / viewport.height() as f32;
        let half_angle = ((0.5 * fov_y).to_radians().tan() * aspect.min(1.0)).atan();
        let distance = 1.05 * radius / half_angle.sin();
        let direction = [0.48f32, 0.36, 0.8];
        Self {
            name: name.to_owned(),
            view: View {
                eye: [
                    x + distance * direction[0],
                    y + distance * direction[1],
                    z + distance * direction[2],
                ],
                look: model.centre,
                up: [0.0, 1.0, 0.0],
                fov_y,
                near: (distance - radius) * 0.5,
            },
            units,
            props: model
                .parts
                .into_iter()
                .map(|part| Prop {
                    part,
                    stand: Transform::IDENTITY,
                    wrap: Beyond::Repeat,
                })
                .collect(),
            cull: Cull::Off,
            depth: true,
        }
    }
}
