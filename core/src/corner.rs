//! Corners of triangles: vertices in clip space that are projected for each triangle that has them, or
//! once a frame.

use fixed::types::I24F8;

use crate::arith::product;
use crate::camera::ToClip;
use crate::clip::{ClipVertex, ClipVolume, fill};
use crate::error::Error;
use crate::geometry::Mesh;
use crate::project::ScreenVertex;
use crate::span::Area;
use crate::viewport::{GUARD, GUARD_BAND, SUBPIXEL_BITS, Viewport};

/// A corner of triangles in clip space that knows its place on the screen, or finds it.
pub trait Corner {
    /// In clip space.
    fn clip(&self) -> &ClipVertex;

    /// On the screen. `None` if it may lie outside the volume, or its texture coordinates are out of
    /// range.
    fn screen(&self, volume: &ClipVolume) -> Option<ScreenVertex>;

    /// [`Rows::ABOVE`] or [`Rows::BELOW`] if it certainly lies there, and inside the volume; else 0, which
    /// is never wrong. A triangle of which all corners lie on one side is not drawn.
    fn beside(&self, volume: &ClipVolume, rows: &Rows) -> u32;
}

/// The rows of a frame that are drawn to: a band of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Rows {
    /// In subpixels.
    top: i32,
    bottom: i32,
    /// Of the whole frame.
    height: i32,
    /// `y height / w` is more than the first half a pixel above the rows, and less than the second half
    /// a pixel below them, as a corner at y lies in row `(1 - y / w) height / 2`.
    above: i32,
    below: i32,
}

impl Rows {
    /// Above the first row.
    pub const ABOVE: u32 = 1;
    /// Below the last.
    pub const BELOW: u32 = 2;

    /// Those of an area, of a frame of this size; `None` if they are all that the frame has.
    #[inline]
    #[must_use]
    pub fn new(area: Area, viewport: Viewport) -> Option<Self> {
        let height = viewport.height().cast_signed();
        let [top, bottom] = [area.top, area.bottom].map(|row| row.clamp(-GUARD_BAND, GUARD_BAND));
        (top > 0 || bottom < height).then_some(Self {
            top: top << SUBPIXEL_BITS,
            bottom: bottom << SUBPIXEL_BITS,
            height,
            above: height - 2 * top + 1,
            below: height - 2 * bottom - 1,
        })
    }
}

/// Is projected each time that it is asked for.
impl Corner for ClipVertex {
    #[inline]
    fn clip(&self) -> &ClipVertex {
        self
    }

    // A function of its own: a copy for each corner of a triangle is 600 bytes.
    #[inline(never)]
    fn screen(&self, volume: &ClipVolume) -> Option<ScreenVertex> {
        if volume.contains(self) {
            ScreenVertex::project(self, volume.viewport())
        } else {
            None
        }
    }

    #[inline]
    fn beside(&self, volume: &ClipVolume, rows: &Rows) -> u32 {
        let w = self.w.to_bits();
        // Half a pixel is more than rounding to subpixels takes or adds.
        let y = product(self.y.to_bits(), rows.height);
        let side = if y > product(w, rows.above) {
            Rows::ABOVE
        } else if y < product(w, rows.below) {
            Rows::BELOW
        } else {
            return 0;
        };
        // Where a corner is cut off another one, rounded, may lie elsewhere.
        if volume.contains(self) { side } else { 0 }
    }
}

/// A vertex that is projected once a frame: not for each triangle that has it, which are six in a closed
/// mesh, and not in each band. Takes 28 bytes, 8 more than a [`ClipVertex`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ProjectedVertex {
    clip: ClipVertex,
    /// In subpixels from beyond the guard band; 0 if its place is not known.
    x: i32,
    /// In subpixels.
    y: i32,
}

impl ProjectedVertex {
    /// Where x begins.
    const LEFT: i32 = -GUARD - 1;

    /// An empty place in a buffer: zeros, so that a static one takes no flash.
    pub const NONE: Self = Self {
        clip: ClipVertex::NONE,
        x: 0,
        y: 0,
    };

    /// Projects a vertex, unless it may lie outside the volume.
    #[inline]
    #[must_use]
    pub fn new(clip: ClipVertex, volume: &ClipVolume) -> Self {
        let place = |v: ScreenVertex| [v.x().to_bits() - Self::LEFT, v.y().to_bits()];
        let [x, y] = clip.screen(volume).map_or([0; 2], place);
        Self { clip, x, y }
    }
}

impl Default for ProjectedVertex {
    fn default() -> Self {
        Self::NONE
    }
}

impl Corner for ProjectedVertex {
    #[inline]
    fn clip(&self) -> &ClipVertex {
        &self.clip
    }

    #[inline]
    fn screen(&self, _: &ClipVolume) -> Option<ScreenVertex> {
        let [x, y] = [self.x.wrapping_add(Self::LEFT), self.y].map(I24F8::from_bits);
        (self.x != 0).then(|| ScreenVertex::of_projected(x, y, &self.clip))
    }

    #[inline]
    fn beside(&self, _: &ClipVolume, rows: &Rows) -> u32 {
        if self.x == 0 {
            0
        } else if self.y < rows.top {
            Rows::ABOVE
        } else if self.y > rows.bottom {
            Rows::BELOW
        } else {
            0
        }
    }
}

/// Transforms and projects all vertices of a mesh into `out`, one after the other: in the place of
/// [`transform`](crate::clip::transform) where there is room for it. Gives the part of `out` that was
/// filled.
///
/// # Errors
///
/// [`Error::BufferLength`] if `out` is shorter than the vertex table; [`Error::Overflow`] for a
/// vertex too far out for 16.16 clip coordinates.
pub fn project<'o>(
    mesh: &Mesh<'_>,
    to_clip: &ToClip,
    volume: &ClipVolume,
    out: &'o mut [ProjectedVertex],
) -> Result<&'o [ProjectedVertex], Error> {
    fill(mesh, out, |vertex| {
        let vertex = ClipVertex::new(vertex, to_clip)?;
        Ok(ProjectedVertex::new(vertex, volume))
    })
}
