//! Fits meshes to the core's ranges: positions scaled by a power of two, whole repeats taken off
//! texture coordinates, equal vertices merged, and tables cut where 16-bit indices end.

use std::collections::HashMap;
use std::sync::Arc;

use multum::fixed::types::I16F16;
use multum::geometry::{MAX_UV, MAX_UV_SPAN, Mesh, Vertex};

use super::{Model, Part, RawMesh, Source, Surface};
use crate::error::Error;
use crate::picture::Picture;

/// Coordinates up to this stay as they are: a factor of 8 below what the core takes.
const LARGEST_UNSCALED: f32 = 1024.0;

/// Below this, 16.16 positions would be coarser than 1/16384 of the model.
const SMALLEST_UNSCALED: f32 = 0.25;

/// Vertices in one part.
pub(crate) const MAX_PART_VERTICES: usize = 65_535;

/// Raw bits of a [`Vertex`]: x, y, z, u, v.
type Key = [i32; 5];

/// Each mesh with its picture. A plain colour becomes a picture of one pixel.
pub(super) fn surfaces(
    meshes: Vec<RawMesh>,
    source: &mut Source,
) -> Result<Vec<(RawMesh, Arc<Picture>)>, Error> {
    let textured = |mesh: &RawMesh| matches!(mesh.surface, Surface::Picture(_));
    if !meshes.iter().any(textured) {
        return Err(source.error(
            "no texture in the file",
            "give a picture with --texture FILE",
        ));
    }
    let mut colours: HashMap<[u8; 3], Arc<Picture>> = HashMap::new();
    let mut parts = Vec::new();
    for mesh in meshes {
        let picture = match &mesh.surface {
            Surface::Picture(picture) => Arc::clone(picture),
            Surface::Colour { material, rgb } => {
                source.notice(&format!(
                    "{material} has no texture: its plain colour is used"
                ));
                let colour = || Arc::new(Picture::of_colour(*rgb));
                Arc::clone(colours.entry(*rgb).or_insert_with(colour))
            }
        };
        parts.push((mesh, picture));
    }
    Ok(parts)
}

/// The finished model.
pub(super) fn model(meshes: &[(RawMesh, Arc<Picture>)], source: Source) -> Result<Model, Error> {
    let bounds = Bounds::of(meshes, &source)?;
    let scale = scale_for(bounds.largest());
    let mut packer = Packer {
        scale,
        open: Vec::new(),
        closed: Vec::new(),
    };
    for (mesh, picture) in meshes {
        packer.add(mesh, picture, &source)?;
    }
    let parts = packer.finish();
    for part in &parts {
        Mesh::new(&part.vertices, &part.triangles).map_err(|e| Error::core(&source.place, e))?;
    }

    let middle = |axis: usize| (f64::from(bounds.min[axis]) + f64::from(bounds.max[axis])) / 2.0;
    let middle = [middle(0), middle(1), middle(2)];
    let squared = |p: &[f32; 3]| -> f64 {
        (0..3)
            .map(|axis| (f64::from(p[axis]) - middle[axis]).powi(2))
            .sum()
    };
    let positions = meshes.iter().flat_map(|(mesh, _)| &mesh.positions);
    let radius = positions.map(squared).fold(0.0, f64::max).sqrt();
    let scaled = |x: f64| (x * f64::from(scale)) as f32;
    Ok(Model {
        parts,
        scale,
        centre: middle.map(scaled),
        radius: scaled(radius),
        notices: source.notices,
    })
}

/// The box around all positions, in the file's units.
struct Bounds {
    min: [f32; 3],
    max: [f32; 3],
}

impl Bounds {
    fn of(meshes: &[(RawMesh, Arc<Picture>)], source: &Source) -> Result<Self, Error> {
        let mut bounds = Self {
            min: [f32::INFINITY; 3],
            max: [f32::NEG_INFINITY; 3],
        };
        for (mesh, _) in meshes {
            for (number, position) in mesh.positions.iter().enumerate() {
                for (axis, &x) in position.iter().enumerate() {
                    if !x.is_finite() {
                        return Err(source.error(
                            &format!("vertex {number} of {} is not finite", mesh.name),
                            "repair the model and export it again",
                        ));
                    }
                    bounds.min[axis] = bounds.min[axis].min(x);
                    bounds.max[axis] = bounds.max[axis].max(x);
                }
            }
        }
        Ok(bounds)
    }

    /// The largest magnitude of a coordinate.
    fn largest(&self) -> f32 {
        let both = self.min.iter().chain(&self.max);
        both.fold(0.0, |largest, x| x.abs().max(largest))
    }
}

/// 1, or the power of two that brings `largest` into 1 to 2 (nearer to it, where the power would
/// not fit f32).
fn scale_for(largest: f32) -> f32 {
    if largest == 0.0 || (SMALLEST_UNSCALED..=LARGEST_UNSCALED).contains(&largest) {
        return 1.0;
    }
    // log2 may round up to the next integer just below a power of two: then the result is just
    // below 1, so look at the product.
    let exponent = -f64::from(largest).log2().floor();
    let scale = exponent.exp2();
    let product = f64::from(largest) * scale;
    let scale = if product < 1.0 { scale * 2.0 } else { scale };
    scale.min(127f64.exp2()) as f32
}

/// A part that still grows.
struct Open {
    part: Part,
    numbers: HashMap<Key, u16>,
}

impl Open {
    fn new(picture: &Arc<Picture>) -> Self {
        Self {
            part: Part {
                vertices: Vec::new(),
                triangles: Vec::new(),
                picture: Arc::clone(picture),
            },
            numbers: HashMap::new(),
        }
    }

    /// The number of the vertex, new or known.
    fn number(&mut self, key: Key) -> u16 {
        *self.numbers.entry(key).or_insert_with(|| {
            let [x, y, z, u, v] = key;
            self.part
                .vertices
                .push(Vertex::from_bits([x, y, z], [u, v]));
            (self.part.vertices.len() - 1) as u16
        })
    }
}

/// Sorts triangles into parts, one growing part for each picture.
struct Packer {
    scale: f32,
    open: Vec<Open>,
    closed: Vec<Part>,
}

impl Packer {
    fn add(
        &mut self,
        mesh: &RawMesh,
        picture: &Arc<Picture>,
        source: &Source,
    ) -> Result<(), Error> {
        if mesh.triangles.is_empty() {
            return Ok(());
        }
        let known = |open: &Open| Arc::ptr_eq(&open.part.picture, picture);
        let slot = self.open.iter().position(known).unwrap_or_else(|| {
            self.open.push(Open::new(picture));
            self.open.len() - 1
        });
        for (number, corners) in mesh.triangles.iter().enumerate() {
            let corners = corners.map(|corner| corner as usize);
            let uvs = corner_uvs(mesh, number, corners, source)?;
            let keys = [0, 1, 2].map(|i| {
                let [x, y, z] = mesh.positions[corners[i]].map(|x| self.position(x));
                [x, y, z, uvs[i][0], uvs[i][1]]
            });
            if self.open[slot].part.vertices.len() + 3 > MAX_PART_VERTICES {
                let full = std::mem::replace(&mut self.open[slot], Open::new(picture));
                self.closed.push(full.part);
            }
            let open = &mut self.open[slot];
            let triangle = keys.map(|key| open.number(key));
            open.part.triangles.push(triangle);
        }
        Ok(())
    }

    /// Scaled 16.16 bits, to the nearest. At most 1024 in magnitude after scaling.
    fn position(&self, x: f32) -> i32 {
        I16F16::from_num((f64::from(x) * f64::from(self.scale) * 65_536.0).round() / 65_536.0)
            .to_bits()
    }

    fn finish(self) -> Vec<Part> {
        let mut parts = self.closed;
        parts.extend(self.open.into_iter().map(|open| open.part));
        parts.retain(|part| !part.triangles.is_empty());
        parts
    }
}

/// The 16.16 bits of a triangle's texture coordinates, brought into the core's range.
fn corner_uvs(
    mesh: &RawMesh,
    number: usize,
    corners: [usize; 3],
    source: &Source,
) -> Result<[[i32; 2]; 3], Error> {
    let uvs = corners.map(|corner| mesh.uvs[corner].map(f64::from));
    if let Some(bad) = uvs.iter().position(|uv| !uv.iter().all(|x| x.is_finite())) {
        return Err(source.error(
            &format!(
                "vertex {} of {} has the texture coordinate {:?}, which is not finite",
                corners[bad], mesh.name, uvs[bad]
            ),
            "repair the UVs in the modelling program and export the file again",
        ));
    }
    let (u, v) = (uvs.map(|[u, _]| u), uvs.map(|[_, v]| v));
    let (Some(fixed_u), Some(fixed_v)) = (fit(u), fit(v)) else {
        return Err(source.error(
            &format!(
                "triangle {number} of {} spans {:.1} repeats of its texture, and 127 are the most",
                mesh.name,
                span(u).max(span(v))
            ),
            "split the face or scale its UVs down",
        ));
    };
    Ok([0, 1, 2].map(|corner| [fixed_u[corner], fixed_v[corner]]))
}

/// One coordinate of three corners in 16.16 bits; `None` if they span too many repeats.
///
/// What is taken off is an even number of repeats, the same for the three corners: the picture
/// stays in place when it repeats and when it is mirrored.
fn fit(values: [f64; 3]) -> Option<[i32; 3]> {
    let beyond = values.iter().any(|x| x.abs() > f64::from(MAX_UV));
    let [min, max] = range(values);
    let taken_off = if beyond {
        2.0 * ((min + max) / 4.0).round()
    } else {
        0.0
    };
    let bits = values.map(|x| ((x - taken_off) * 65_536.0).round());
    // A span below 128 around a middle within 1 of zero lies within the core's 127.
    (span(bits) < f64::from(MAX_UV_SPAN) * 65_536.0).then(|| bits.map(|x| x as i32))
}

fn range(values: [f64; 3]) -> [f64; 2] {
    let [a, b, c] = values;
    [a.min(b).min(c), a.max(b).max(c)]
}

fn span(values: [f64; 3]) -> f64 {
    let [min, max] = range(values);
    max - min
}

#[cfg(test)]
mod tests {
    use super::{fit, scale_for};

    #[test]
    fn scale_is_a_power_of_two_into_one_to_two() {
        assert_eq!(scale_for(0.0), 1.0);
        assert_eq!(scale_for(0.25), 1.0);
        assert_eq!(scale_for(1024.0), 1.0);
        assert_eq!(scale_for(1025.0), 1.0 / 1024.0);
        assert_eq!(scale_for(0.249), 8.0);
        for largest in [
            f32::MAX,
            2048.0,
            f32::from_bits(2048f32.to_bits() - 1),
            f32::from_bits(0.125f32.to_bits() - 1),
            1e-30,
            f32::MIN_POSITIVE,
        ] {
            let scale = scale_for(largest);
            let product = f64::from(largest) * f64::from(scale);
            assert!((1.0..2.0).contains(&product), "{largest}: {scale}");
        }
        assert!(scale_for(f32::from_bits(1)).is_finite());
    }

    #[test]
    fn even_repeats_are_taken_off_where_needed() {
        let bits = |values: [f64; 3]| Some(values.map(|x| (x * 65_536.0) as i32));
        assert_eq!(fit([-0.25, 0.5, 126.5]), bits([-0.25, 0.5, 126.5]));
        assert_eq!(fit([127.0, 0.0, 0.0]), bits([127.0, 0.0, 0.0]));
        assert_eq!(fit([127.5, 127.0, 128.0]), bits([-0.5, -1.0, 0.0]));
        assert_eq!(fit([-1001.25, -1000.0, -1001.0]), bits([-1.25, 0.0, -1.0]));
        assert_eq!(fit([1000.0, 1127.5, 1000.0]), bits([-64.0, 63.5, -64.0]));
        assert_eq!(fit([0.0, 128.0, 0.0]), None);
        assert_eq!(fit([-127.0, 1.0, 0.0]), None);
        // Rounds to a span of 128.
        assert_eq!(fit([0.0, 128.0 - 1e-6, 0.0]), None);
        assert_eq!(fit([1e30, 1e30, 1e30]), bits([0.0; 3]));
        assert_eq!(fit([-3e38, 3e38, 0.0]), None);
    }
}
