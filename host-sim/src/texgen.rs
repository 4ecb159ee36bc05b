//! Texture coordinates from positions, for meshes that have none or others. Meshes enter; they
//! leave with coordinates that a projection gives, cut where a map ends and begins.
//!
//! y is up. Longitude and latitude are those of [`shape::sphere`](crate::shape::sphere): u runs
//! once around eastwards and begins at -z, v runs from the top to the bottom. All is seen from the
//! middle of the box around the meshes. The formulas are the usual ones, as in Ebert et al.,
//! "Texturing and Modeling", or OpenGL's quadrics.

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use multum::fixed::types::I16F16;
use multum::geometry::{MAX_UV, Mesh, Vertex};

use crate::error::Error;
use crate::model::Part;
use crate::model::pack::MAX_PART_VERTICES;

/// Nearer to the axis than this share of the box's larger half width, a vertex has no longitude of
/// its own: rounding would decide it.
const POLE: f64 = 1e-4;

/// The same in 16.16 steps, for small meshes.
const POLE_STEPS: f64 = 2.0 / 65_536.0;

/// An axis of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// To the right.
    X,
    /// Up.
    Y,
    /// Towards the viewer.
    Z,
}

/// Where texture coordinates come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// Along an axis: the box's side as seen from the axis' positive end shows the texture once,
    /// the right way round. From above, -z is up.
    Planar(Axis),
    /// u from the longitude, v from the height in the box.
    Cylindrical,
    /// u from the longitude, v from the latitude: an equirectangular map.
    Spherical,
}

impl Projection {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Planar(Axis::X),
        Self::Planar(Axis::Y),
        Self::Planar(Axis::Z),
        Self::Cylindrical,
        Self::Spherical,
    ];
}

impl FromStr for Projection {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        let named = Self::ALL.into_iter().find(|choice| choice.to_string() == s);
        named.ok_or_else(|| {
            let names = Self::ALL.map(|choice| choice.to_string());
            format!("choose one of {}", names.join(", "))
        })
    }
}

impl fmt::Display for Projection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Planar(Axis::X) => "planar:x",
            Self::Planar(Axis::Y) => "planar:y",
            Self::Planar(Axis::Z) => "planar:z",
            Self::Cylindrical => "cylindrical",
            Self::Spherical => "spherical",
        })
    }
}

/// Gives the parts of one model new texture coordinates, the texture repeated `repeats` times
/// across and down.
///
/// A triangle across the meridian where u begins gets vertices of its own with u up to 2, so the
/// texture has to repeat, and a number of repeats across that is whole joins there. A vertex on
/// the axis takes the mean u of the other two in each triangle. A triangle around the axis, such
/// as the whole lid of a prism, can't be right. Parts are cut where their vertices become too many
/// for 16-bit indices.
///
/// # Errors
///
/// [`Error::Content`] if the repeats lead beyond the core's 127, [`Error::Core`] if an index names
/// no vertex; the parts are then as before.
pub fn apply(
    parts: &mut Vec<Part>,
    projection: Projection,
    repeats: [f32; 2],
) -> Result<(), Error> {
    // Indices first: everything below relies on them.
    for part in parts.iter() {
        Mesh::new(&part.vertices, &part.triangles).map_err(|e| Error::core("texgen", e))?;
    }
    let generator = Generator {
        projection,
        repeats: repeats.map(f64::from),
        bounds: Bounds::of(parts),
    };
    let mut finished = Vec::with_capacity(parts.len());
    for part in parts.iter() {
        generator.part(part, &mut finished)?;
    }
    *parts = finished;
    Ok(())
}

/// The box around all corners of triangles.
struct Bounds {
    min: [f64; 3],
    max: [f64; 3],
}

impl Bounds {
    fn of(parts: &[Part]) -> Self {
        let mut bounds = Self {
            min: [f64::INFINITY; 3],
            max: [f64::NEG_INFINITY; 3],
        };
        for part in parts {
            for &corner in part.triangles.as_flattened() {
                let position = part.vertices[usize::from(corner)].position;
                for (axis, x) in position.into_iter().enumerate() {
                    let x = x.to_num::<f64>();
                    bounds.min[axis] = bounds.min[axis].min(x);
                    bounds.max[axis] = bounds.max[axis].max(x);
                }
            }
        }
        bounds
    }

    /// 0 at the lower end of an axis, 1 at the upper one; 0 in a flat box.
    fn share(&self, position: [f64; 3], axis: Axis) -> f64 {
        let axis = axis as usize;
        let size = self.max[axis] - self.min[axis];
        if size > 0.0 {
            (position[axis] - self.min[axis]) / size
        } else {
            0.0
        }
    }

    /// 1 at the lower end, 0 at the upper one and in a flat box.
    fn share_from_above(&self, position: [f64; 3], axis: Axis) -> f64 {
        let axis = axis as usize;
        let size = self.max[axis] - self.min[axis];
        if size > 0.0 {
            (self.max[axis] - position[axis]) / size
        } else {
            0.0
        }
    }

    fn about_centre(&self, position: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| position[axis] - (self.min[axis] + self.max[axis]) / 2.0)
    }

    /// Distance from the axis below which there is no longitude.
    fn pole(&self) -> f64 {
        let half = |axis: usize| (self.max[axis] - self.min[axis]) / 2.0;
        (half(0).max(half(2)) * POLE).max(POLE_STEPS)
    }
}

struct Generator {
    projection: Projection,
    repeats: [f64; 2],
    bounds: Bounds,
}

impl Generator {
    fn part(&self, part: &Part, finished: &mut Vec<Part>) -> Result<(), Error> {
        let empty = || Part {
            vertices: Vec::new(),
            triangles: Vec::new(),
            picture: Arc::clone(&part.picture),
        };
        let mut open = empty();
        let mut numbers: HashMap<[i32; 5], u16> = HashMap::new();
        for triangle in &part.triangles {
            if open.vertices.len() + 3 > MAX_PART_VERTICES {
                finished.push(std::mem::replace(&mut open, empty()));
                numbers.clear();
            }
            let corners = triangle.map(|corner| part.vertices[usize::from(corner)].position);
            let uvs = self.corners(corners.map(|p| p.map(|x| x.to_num())));
            let mut renumbered = [0; 3];
            for ((number, position), uv) in renumbered.iter_mut().zip(corners).zip(uvs) {
                let position = position.map(I16F16::to_bits);
                let uv = self.fixed(uv)?;
                let [x, y, z] = position;
                *number = *numbers.entry([x, y, z, uv[0], uv[1]]).or_insert_with(|| {
                    open.vertices.push(Vertex::from_bits(position, uv));
                    (open.vertices.len() - 1) as u16
                });
            }
            open.triangles.push(renumbered);
        }
        finished.push(open);
        Ok(())
    }

    /// The coordinates in repeats, in 16.16 to the nearest.
    fn fixed(&self, uv: [f64; 2]) -> Result<[i32; 2], Error> {
        let uv = [0, 1].map(|i| uv[i] * self.repeats[i]);
        // Not the other way round, for NaN.
        if uv.iter().all(|x| x.abs() <= f64::from(MAX_UV)) {
            Ok(uv.map(|x| (x * 65_536.0).round() as i32))
        } else {
            let [across, down] = self.repeats;
            Err(Error::content(
                "texgen",
                &format!(
                    "{across} by {down} repeats lead to the texture coordinate {uv:?}, and \
                     {MAX_UV} is the most"
                ),
                "give fewer repeats",
            ))
        }
    }

    /// Texture coordinates of a triangle, in textures.
    fn corners(&self, positions: [[f64; 3]; 3]) -> [[f64; 2]; 3] {
        let share = |position, axis| self.bounds.share(position, axis);
        let from_above = |position, axis| self.bounds.share_from_above(position, axis);
        let v = |position| match self.projection {
            Projection::Planar(Axis::Y) => share(position, Axis::Z),
            Projection::Planar(_) | Projection::Cylindrical => from_above(position, Axis::Y),
            Projection::Spherical => {
                let [x, y, z] = self.bounds.about_centre(position);
                let ring = x.hypot(z);
                // The middle itself is on the equator.
                if ring == 0.0 && y == 0.0 {
                    0.5
                } else {
                    ring.atan2(y) / PI
                }
            }
        };
        let us = match self.projection {
            // Seen from +x, -z is on the right.
            Projection::Planar(Axis::X) => positions.map(|p| from_above(p, Axis::Z)),
            Projection::Planar(Axis::Y | Axis::Z) => positions.map(|p| share(p, Axis::X)),
            Projection::Cylindrical | Projection::Spherical => {
                together(positions.map(|p| self.turn(p)))
            }
        };
        [0, 1, 2].map(|i| [us[i], v(positions[i])])
    }

    /// The longitude, 0 to below 1; `None` on the axis.
    fn turn(&self, position: [f64; 3]) -> Option<f64> {
        let [x, _, z] = self.bounds.about_centre(position);
        (x.hypot(z) > self.bounds.pole()).then(|| {
            let turn = ((-x).atan2(-z) / TAU).rem_euclid(1.0);
            // What is just below zero rounds to a whole turn.
            if turn < 1.0 { turn } else { 0.0 }
        })
    }
}

/// Three longitudes in turns as near to each other as whole turns bring them, the least from 0 to
/// below 1; where one is missing, the mean of the others.
fn together(turns: [Option<f64>; 3]) -> [f64; 3] {
    let mut sorted: Vec<f64> = turns.into_iter().flatten().collect();
    sorted.sort_by(f64::total_cmp);
    let (Some(&first), Some(&last)) = (sorted.first(), sorted.last()) else {
        return [0.0; 3];
    };
    // The triangle lies beside the widest gap of the circle. Where that is not the one across the
    // meridian, all before it are a turn further.
    let mut widest = 1.0 - (last - first);
    let mut begin = first;
    for pair in sorted.windows(2) {
        if pair[1] - pair[0] > widest {
            widest = pair[1] - pair[0];
            begin = pair[1];
        }
    }
    let near = turns.map(|turn| turn.map(|turn| if turn < begin { turn + 1.0 } else { turn }));
    let mean = near.iter().flatten().sum::<f64>() / sorted.len() as f64;
    near.map(|turn| turn.unwrap_or(mean))
}
