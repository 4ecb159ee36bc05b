//! Clip space: vertices come in by a matrix, and leave as a polygon that can be projected, in
//! front of the near plane and inside the guard band. Everything is homogeneous: nothing is
//! judged by where it would be on the screen before the near plane has cut it, so a floor that
//! reaches behind the eye stays.

use fixed::types::I16F16;
use heapless::Vec;

use crate::arith::interpolate;
use crate::camera::ToClip;
use crate::error::Error;
use crate::geometry::{Mesh, Vertex};
use crate::viewport::{GUARD_BAND, Viewport};

/// A vertex in clip space.
///
/// On the screen it lies at `x / w` (-1 left edge, 1 right edge) and `y / w` (-1 bottom, 1 top);
/// `w` is the distance along the view axis in units, positive in front of the camera. All 16.16.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ClipVertex {
    /// Clip x.
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    pub x: I16F16,
    /// Clip y, up.
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    pub y: I16F16,
    /// Clip w.
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    pub w: I16F16,
    /// Texture coordinate to the right, in repeats.
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    pub u: I16F16,
    /// Texture coordinate down, in repeats.
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    pub v: I16F16,
}

impl ClipVertex {
    /// An empty place in a buffer: at the eye.
    pub const NONE: Self = Self {
        x: I16F16::ZERO,
        y: I16F16::ZERO,
        w: I16F16::ZERO,
        u: I16F16::ZERO,
        v: I16F16::ZERO,
    };

    /// A mesh vertex seen through a matrix.
    ///
    /// # Errors
    ///
    /// [`Error::Overflow`] where a clip coordinate leaves 16.16.
    pub fn new(vertex: &Vertex, to_clip: &ToClip) -> Result<Self, Error> {
        let [x, y, w] = to_clip.apply(vertex.position)?;
        let [u, v] = vertex.uv;
        Ok(Self { x, y, w, u, v })
    }

    /// The point of the segment from `inside` to `outside` where the distance to a plane, `n` at
    /// `inside` of `d` in all, is used up. Each coordinate is rounded to nearest, once.
    fn cut(inside: &Self, outside: &Self, n: u64, d: u64) -> Self {
        let along =
            |a: I16F16, b: I16F16| I16F16::from_bits(interpolate(a.to_bits(), b.to_bits(), n, d));
        Self {
            x: along(inside.x, outside.x),
            y: along(inside.y, outside.y),
            w: along(inside.w, outside.w),
            u: along(inside.u, outside.u),
            v: along(inside.v, outside.v),
        }
    }
}

/// Transforms all vertices of a mesh into `out`, one after the other; a frame drawn in bands does
/// it once. Gives the part of `out` that was filled.
///
/// # Errors
///
/// [`Error::BufferLength`] if `out` is shorter than the vertex table; [`Error::Overflow`] for a
/// vertex too far out for 16.16 clip coordinates.
pub fn transform<'o>(
    mesh: &Mesh<'_>,
    to_clip: &ToClip,
    out: &'o mut [ClipVertex],
) -> Result<&'o [ClipVertex], Error> {
    fill(mesh, out, |vertex| ClipVertex::new(vertex, to_clip))
}

/// Makes something of each vertex of a mesh.
#[inline]
pub(crate) fn fill<'o, T>(
    mesh: &Mesh<'_>,
    out: &'o mut [T],
    mut make: impl FnMut(&Vertex) -> Result<T, Error>,
) -> Result<&'o [T], Error> {
    let needed = mesh.vertices().len();
    let given = out.len();
    let out = out
        .get_mut(..needed)
        .ok_or(Error::BufferLength { needed, given })?;
    for (to, vertex) in out.iter_mut().zip(mesh.vertices()) {
        *to = make(vertex)?;
    }
    Ok(out)
}

/// A triangle cut by five planes has at most eight corners.
pub(crate) const MOST_CORNERS: usize = 8;

/// A convex polygon in clip space.
pub type ClipPolygon = Vec<ClipVertex, MOST_CORNERS>;

/// The half-spaces that a vertex must lie in to be projected.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ClipVolume {
    viewport: Viewport,
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    near: I16F16,
    /// As powers of two, how many times as far as the edges of the frame the guard band reaches.
    reach: [u8; 2],
}

/// Planes in the order in which they cut: near first, so that w > 0 for the others.
const PLANES: u32 = 5;

impl ClipVolume {
    /// What lies beyond `near` (units, positive) and within the guard band around a frame.
    #[must_use]
    pub fn new(viewport: Viewport, near: I16F16) -> Self {
        let band = 2 * GUARD_BAND.cast_unsigned();
        let reach = |size: u32| {
            (1..8u8)
                .take_while(|reach| size << reach <= band - size)
                .count() as u8
        };
        Self {
            viewport,
            near: near.max(I16F16::DELTA),
            reach: [viewport.width(), viewport.height()].map(reach),
        }
    }

    /// The size of the frame.
    #[must_use]
    pub const fn viewport(&self) -> Viewport {
        self.viewport
    }

    /// The distance of a vertex from plane `i`, in that plane's own scale; below zero outside.
    ///
    /// Screen x is `(x / w + 1) width / 2`; that it is at least `-guard` means
    /// `x width + w (width + 2 guard) >= 0`, and so on. At most `2^31 * (1024 + 3072) = 2^43`.
    #[inline(never)]
    fn distance(&self, i: u32, vertex: &ClipVertex) -> i64 {
        let band = 2 * i64::from(GUARD_BAND);
        let w = i64::from(vertex.w.to_bits());
        let low = |position: i64, size: u32| {
            let size = i64::from(size);
            position * size + w * (band + size)
        };
        let high = |position: i64, size: u32| {
            let size = i64::from(size);
            w * (band - size) - position * size
        };
        let (width, height) = (self.viewport.width(), self.viewport.height());
        let x = i64::from(vertex.x.to_bits());
        // Screen y points down.
        let y = -i64::from(vertex.y.to_bits());
        match i {
            0 => w - i64::from(self.near.to_bits()),
            1 => low(x, width),
            2 => high(x, width),
            3 => low(y, height),
            _ => high(y, height),
        }
    }

    /// Whether the vertex is inside all planes, with certainty: `false` may be wrong.
    #[inline]
    pub(crate) fn contains(&self, vertex: &ClipVertex) -> bool {
        let [x, y, w] = [vertex.x, vertex.y, vertex.w].map(|c| c.to_bits().unsigned_abs());
        // With |x| < w 2^reach and size 2^reach <= 2 guard - size both distances are above 0.
        let [reach_x, reach_y] = self.reach.map(|reach| reach & 31);
        vertex.w >= self.near && x >> reach_x < w && y >> reach_y < w
    }

    /// The planes that the vertex is outside of, a bit each.
    #[inline(never)]
    fn outside(&self, vertex: &ClipVertex) -> u32 {
        if self.contains(vertex) {
            return 0;
        }
        (0..PLANES).fold(0, |bits, i| {
            bits | u32::from(self.distance(i, vertex) < 0) << i
        })
    }

    /// The part of a triangle that can be projected, as a convex polygon in the same winding;
    /// empty if there is none.
    ///
    /// Sutherland and Hodgman, "Reentrant polygon clipping", CACM 17(1), 1974, in homogeneous
    /// coordinates (Blinn and Newell, "Clipping using homogeneous coordinates", SIGGRAPH 1978).
    /// A cut is always computed from the inner end of an edge, so that two triangles that share
    /// the edge get the same new vertex.
    #[must_use]
    pub fn clip(&self, triangle: &[ClipVertex; 3]) -> ClipPolygon {
        let mut polygon = ClipPolygon::new();
        self.clip_into(&mut polygon, triangle.each_ref());
        polygon
    }

    /// The same where the caller has room for it.
    #[inline(never)]
    pub(crate) fn clip_into(&self, polygon: &mut ClipPolygon, triangle: [&ClipVertex; 3]) {
        let [a, b, c] = triangle.map(|v| self.outside(v));
        if a & b & c != 0 {
            polygon.clear();
            return;
        }
        let crossed = a | b | c;
        let planes = || (0..PLANES).filter(|plane| crossed >> plane & 1 == 1);
        // The polygon goes from one to the other and back, the last time into the caller's.
        let (mut from, mut to) = (polygon, &mut ClipPolygon::new());
        if planes().count() % 2 == 1 {
            (from, to) = (to, from);
        }
        from.clear();
        for vertex in triangle {
            _ = from.push(*vertex);
        }
        for plane in planes() {
            self.cut(plane, from, to);
            (from, to) = (to, from);
        }
    }

    /// What of a polygon is inside of one plane.
    // A function of its own: what it reads and writes is known to be apart, and copied without a call.
    #[inline(never)]
    fn cut(&self, plane: u32, polygon: &ClipPolygon, result: &mut ClipPolygon) {
        result.clear();
        let Some(mut from) = polygon.last() else {
            return;
        };
        let mut from_distance = self.distance(plane, from);
        for to in polygon {
            let to_distance = self.distance(plane, to);
            if (from_distance < 0) != (to_distance < 0) {
                let (inside, outside, n) = if from_distance < 0 {
                    (to, from, to_distance)
                } else {
                    (from, to, from_distance)
                };
                let d = from_distance.abs_diff(to_distance);
                // Eight corners hold every convex case; a cut that rounding made slightly
                // concave may ask for a ninth, which is dropped.
                _ = result.push(ClipVertex::cut(inside, outside, n.unsigned_abs(), d));
            }
            if to_distance >= 0 {
                _ = result.push(*to);
            }
            from = to;
            from_distance = to_distance;
        }
    }
}

/// A convex polygon as triangles around its first corner, in the same winding.
pub fn fan(polygon: &[ClipVertex]) -> impl Iterator<Item = [&ClipVertex; 3]> {
    let (first, rest) = polygon
        .split_first()
        .map_or((None, polygon), |(f, r)| (Some(f), r));
    rest.iter()
        .zip(rest.iter().skip(1))
        .filter_map(move |(b, c)| Some([first?, b, c]))
}
