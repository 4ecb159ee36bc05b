//! Hard cases by name: small frames, each there for one way in which a rasterizer can go wrong.

mod screen;
mod world;

use std::sync::Arc;

use multum::fixed::types::{I16F16, I24F8};
use multum::project::ScreenVertex;
use multum::setup::Cull;
use multum::viewport::Viewport;

use crate::error::Error;
use crate::frame::{Batch, Frame, ScreenTriangle};
use crate::picture::Picture;
use crate::reference::Beyond;

/// A frame that is hard to draw.
#[derive(Clone, Debug)]
pub struct HardCase {
    /// Its name, unique.
    pub name: String,
    /// What it is there for, in one line.
    pub reason: &'static str,
    /// The triangles.
    pub frame: Frame,
}

/// All hard cases.
///
/// # Errors
///
/// [`Error::Core`] if one of them is beyond what the core can draw.
pub fn all() -> Result<Vec<HardCase>, Error> {
    let mut cases = screen::cases()?;
    cases.extend(world::cases()?);
    Ok(cases)
}

/// x and y in pixels, w, u and v in repeats.
pub type Corner = [f64; 5];

/// A triangle given after projection; each number is rounded to its format.
///
/// # Errors
///
/// [`Error::Core`] if a corner is beyond the core's range.
pub fn triangle(corners: [Corner; 3]) -> Result<ScreenTriangle, Error> {
    let vertex = |[x, y, w, u, v]: Corner| {
        ScreenVertex::new(
            I24F8::saturating_from_num((x * 256.0).round() / 256.0),
            I24F8::saturating_from_num((y * 256.0).round() / 256.0),
            I16F16::saturating_from_num(w),
            [u, v].map(I16F16::saturating_from_num),
        )
        .ok_or_else(|| Error::core("a triangle on the screen", multum::error::Error::Overflow))
    };
    let [a, b, c] = corners;
    Ok(ScreenTriangle {
        vertices: [vertex(a)?, vertex(b)?, vertex(c)?],
        unsnapped: corners.map(|[x, y, ..]| [x, y]),
    })
}

/// A frame of triangles with one texture, of which only the size matters.
///
/// # Errors
///
/// [`Error::Core`] or [`Error::Content`] for sizes that the core cannot draw.
pub fn frame(
    [width, height]: [u32; 2],
    [texture_width, texture_height]: [u32; 2],
    wrap: Beyond,
    triangles: Vec<ScreenTriangle>,
) -> Result<Frame, Error> {
    Ok(Frame {
        viewport: Viewport::new(width, height).map_err(|e| Error::core("hard case", e))?,
        near: I16F16::ONE,
        cull: Cull::Off,
        depth: false,
        batches: vec![Batch {
            picture: blank(texture_width, texture_height)?,
            wrap,
            triangles,
        }],
    })
}

/// A texture of one colour.
pub(crate) fn blank(width: u32, height: u32) -> Result<Arc<Picture>, Error> {
    let pixels = vec![[128; 3]; width as usize * height as usize];
    Picture::new(width, height, pixels).map(Arc::new)
}
