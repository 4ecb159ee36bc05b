//! What is measured: each scene with each of our ways and each peer.

use std::fmt;

use crate::drawing::Drawing;
use crate::error::Error;
use crate::ours::Way;
use crate::peers::Peer;
use crate::scene::{MESH, NAMES, Scene};

/// Who draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawer {
    /// The core.
    Ours(Way),
    /// Another renderer.
    Peer(Peer),
}

impl fmt::Display for Drawer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ours(way) => way.fmt(f),
            Self::Peer(peer) => peer.fmt(f),
        }
    }
}

/// A scene and who draws it. Displays as the budgets' keys do: `scene strategy filter depth format`,
/// or the scene and the peer's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Case {
    /// One of [`NAMES`].
    pub scene: &'static str,
    /// Who draws it.
    pub drawer: Drawer,
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.scene, self.drawer)
    }
}

impl Case {
    /// The case that displays as `name`.
    ///
    /// # Errors
    ///
    /// [`Error::Content`] if there is none.
    pub fn by_name(name: &str) -> Result<Self, Error> {
        all()
            .into_iter()
            .find(|case| case.to_string() == name)
            .ok_or_else(|| Error::content(name, "is not a case"))
    }

    /// The case, ready to be drawn.
    ///
    /// # Errors
    ///
    /// [`Error`] if the scene or the texture is refused.
    pub fn drawing(self) -> Result<Box<dyn Drawing>, Error> {
        let scene = Scene::new(self.scene)?;
        match self.drawer {
            Drawer::Ours(way) => way.drawing(scene),
            Drawer::Peer(peer) => peer.drawing(&scene),
        }
    }
}

/// All cases, scene by scene, ours first.
#[must_use]
pub fn all() -> Vec<Case> {
    NAMES
        .iter()
        .flat_map(|&scene| {
            let ours = ways(scene).into_iter().map(Drawer::Ours);
            let peers = Peer::ALL.map(Drawer::Peer);
            ours.chain(peers).map(move |drawer| Case { scene, drawer })
        })
        .collect()
}

/// Our ways to draw a scene. What a small triangle costs is its setup: for those there is what the
/// budgets name and what peers are compared with.
fn ways(scene: &str) -> Vec<Way> {
    if scene == MESH {
        vec![Way::Affine, Way::Every16, Way::Exact, Way::Every16Z16]
    } else {
        Way::ALL.to_vec()
    }
}
