//! Renderers from crates.io that can draw the scenes, each through its public interface. What of the
//! work is not the same is said in each module and in [`Peer::differences`].
//!
//! All take the corners where the core has snapped them to, as floating point, and write RGB565 from
//! the same texels: embedded-3dgfx because that is its format, the others because they take any.

mod embedded_3dgfx;
mod euc;
mod retrofire;

use std::fmt;

use crate::drawing::Drawing;
use crate::error::Error;
use crate::ours::Way;
use crate::scene::Scene;

/// A renderer that is not ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Peer {
    /// The crate `embedded-3dgfx`.
    Embedded3dgfx,
    /// The crate `euc`.
    Euc,
    /// The crate `retrofire-core`.
    Retrofire,
}

impl Peer {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Embedded3dgfx, Self::Euc, Self::Retrofire];

    /// Our way to draw that does the same work: ratios are to this one.
    #[must_use]
    pub fn counterpart(self) -> Way {
        match self {
            Self::Embedded3dgfx => Way::Every16Z16,
            Self::Euc | Self::Retrofire => Way::Exact,
        }
    }

    /// What it does that our counterpart does not, and the other way round.
    #[must_use]
    pub fn differences(self) -> &'static str {
        match self {
            Self::Embedded3dgfx => {
                "perspective every 16 pixels of a scanline, but affine down the edges, so that all but \
                 wall and mesh come out bent; corners on whole pixels; a depth test always, of 32 bits; shared \
                 edges drawn twice; pixels one by one through a DrawTarget"
            }
            Self::Euc => {
                "perspective at every pixel; tests every pixel of a triangle's box, here those of the \
                 frame twice; shared edges drawn twice; multiplies and adds with f32::mul_add, a \
                 function call without FMA; texture lookup in our shader, since it has none"
            }
            Self::Retrofire => {
                "perspective at every pixel, two divisions; f32::floor for the texel, a function call \
                 without SSE4.1; its rasterizer and sampler without its shader, which is 32-bit colour \
                 only"
            }
        }
    }

    /// A frame drawn by it.
    ///
    /// # Errors
    ///
    /// [`Error::Content`] if it refuses the texture.
    pub fn drawing(self, scene: &Scene) -> Result<Box<dyn Drawing>, Error> {
        match self {
            Self::Embedded3dgfx => embedded_3dgfx::drawing(scene),
            Self::Euc => Ok(euc::drawing(scene)),
            Self::Retrofire => Ok(retrofire::drawing(scene)),
        }
    }
}

impl fmt::Display for Peer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Embedded3dgfx => "embedded-3dgfx",
            Self::Euc => "euc",
            Self::Retrofire => "retrofire-core",
        })
    }
}
