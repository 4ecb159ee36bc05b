//! Simple meshes: quads, a cube, a sphere.

use std::sync::Arc;

use multum::fixed::types::I16F16;
use multum::geometry::Vertex;

use crate::model::Part;
use crate::picture::Picture;

/// A vertex from numbers that fit its formats.
fn vertex(position: [f32; 3], uv: [f32; 2]) -> Vertex {
    Vertex {
        position: position.map(I16F16::saturating_from_num),
        uv: uv.map(I16F16::saturating_from_num),
    }
}

/// One quad with corners top left, bottom left, bottom right, top right as seen from its front,
/// the texture repeated `repeats` times across and down.
#[must_use]
pub fn quad(corners: [[f32; 3]; 4], repeats: [f32; 2], picture: &Arc<Picture>) -> Part {
    quads(&[corners], repeats, picture)
}

/// Several quads with one texture.
#[must_use]
pub fn quads(quads: &[[[f32; 3]; 4]], [u, v]: [f32; 2], picture: &Arc<Picture>) -> Part {
    let uvs = [[0.0, 0.0], [0.0, v], [u, v], [u, 0.0]];
    let mut part = Part {
        vertices: Vec::new(),
        triangles: Vec::new(),
        picture: Arc::clone(picture),
    };
    for corners in quads {
        let i = part.vertices.len() as u16;
        for (&position, uv) in corners.iter().zip(uvs) {
            part.vertices.push(vertex(position, uv));
        }
        part.triangles
            .extend([[i, i + 1, i + 2], [i, i + 2, i + 3]]);
    }
    part
}

/// A cube of side 1 around the origin, the whole texture on each face, fronts outside.
#[must_use]
pub fn cube(picture: &Arc<Picture>) -> Part {
    let (l, h) = (-0.5, 0.5);
    quads(
        &[
            [[l, h, h], [l, l, h], [h, l, h], [h, h, h]],
            [[h, h, l], [h, l, l], [l, l, l], [l, h, l]],
            [[h, h, h], [h, l, h], [h, l, l], [h, h, l]],
            [[l, h, l], [l, l, l], [l, l, h], [l, h, h]],
            [[l, h, l], [l, h, h], [h, h, h], [h, h, l]],
            [[l, l, h], [l, l, l], [h, l, l], [h, l, h]],
        ],
        [1.0, 1.0],
        picture,
    )
}

/// A sphere of radius 1 by latitude and longitude, for an equirectangular map: u runs once around
/// eastwards, v from the north pole to the south pole. The seam's vertices are there twice.
#[must_use]
pub fn sphere(columns: u16, rows: u16, picture: &Arc<Picture>) -> Part {
    use std::f64::consts::{PI, TAU};
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for j in 0..=rows {
        let v = f64::from(j) / f64::from(rows);
        let (ring, y) = (PI * v).sin_cos();
        for i in 0..=columns {
            let u = f64::from(i) / f64::from(columns);
            let (x, z) = (TAU * u).sin_cos();
            let position = [ring * -x, y, ring * -z].map(|c| c as f32);
            vertices.push(vertex(position, [u as f32, v as f32]));
        }
    }
    for j in 0..rows {
        for i in 0..columns {
            let a = j * (columns + 1) + i;
            let b = a + columns + 1;
            // The first and the last ring are triangles only.
            if j > 0 {
                triangles.push([a, b, a + 1]);
            }
            if j + 1 < rows {
                triangles.push([a + 1, b, b + 1]);
            }
        }
    }
    Part {
        vertices,
        triangles,
        picture: Arc::clone(picture),
    }
}
