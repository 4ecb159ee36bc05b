//! What can be drawn: by name, or from a file.

use multum::viewport::Viewport;

use crate::benchmark::{self, Projected};
use crate::error::{Error, one_line};
use crate::frame::Frame;
use crate::scene::Scene;
use crate::scenes;

/// What can be drawn by name or from a file.
#[derive(Clone, Debug)]
pub enum Subject {
    /// Meshes in the world.
    World(Scene),
    /// Triangles given after projection.
    Projected(Projected),
}

impl Subject {
    /// A built-in scene.
    ///
    /// # Errors
    ///
    /// [`Error::UnknownScene`], or a scene's own files missing.
    pub fn by_name(name: &str) -> Result<Self, Error> {
        if let Some(projected) = benchmark::by_name(name) {
            return Ok(Self::Projected(projected));
        }
        known(name, scenes::by_name(name))
    }

    /// A scene as the firmware's images have it.
    ///
    /// # Errors
    ///
    /// As [`Self::by_name`].
    pub fn on_device(name: &str) -> Result<Self, Error> {
        known(name, scenes::on_device(name))
    }

    /// The triangles on a screen of this size.
    ///
    /// # Errors
    ///
    /// [`Error::Core`] where something is beyond what the core can draw.
    pub fn frame(&self, viewport: Viewport) -> Result<Frame, Error> {
        match self {
            Self::World(scene) => Frame::of_scene(scene, viewport),
            Self::Projected(projected) => projected.frame(viewport),
        }
    }
}

/// A scene of the world, if there is one.
fn known(name: &str, scene: Result<Option<Scene>, Error>) -> Result<Subject, Error> {
    scene?
        .map(Subject::World)
        .ok_or_else(|| Error::UnknownScene {
            name: one_line(name),
            known: names().map(|(n, _)| n).collect::<Vec<_>>().join(", "),
        })
}

/// The names of all built-in scenes, with what each shows.
pub fn names() -> impl Iterator<Item = (&'static str, &'static str)> {
    scenes::SCENES.into_iter().chain(benchmark::SCENES)
}
