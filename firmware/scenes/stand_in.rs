//! Textured cubes in the place of host-sim's scenes.

use host_sim::bake::{BakedPart, BakedScene};
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::fixed::types::I16F16;
use multum::geometry::Vertex;
use multum::setup::Cull;
use multum::transform::Transform;

const SIDE: u32 = 64;

/// Hands the scene of that name to `bake`; `None` if there is none.
pub(crate) fn with_scene(name: &str, bake: impl Fn(&BakedScene<'_>) -> String) -> Option<String> {
    let (vertices, triangles) = cube();
    let texels = planks();
    let turn = Transform::rotation([0.3, 1.0, 0.2], 0.7).ok()?;
    let mut beside = Transform::rotation([1.0, 0.2, 0.5], 1.1).ok()?;
    beside.translation[0] = I16F16::from_num(0.6);
    let part = |model: Transform| BakedPart {
        vertices: &vertices,
        triangles: &triangles,
        width: SIDE,
        height: SIDE,
        texels: &texels,
        model,
    };
    let (eye, depth, cull, parts) = match name {
        "crate" => ([0.4, 1.1, 3.2], false, Cull::Back, vec![part(turn)]),
        // Two cubes that cut each other: the depth test decides.
        "spot" => (
            [0.4, 1.1, 3.2],
            true,
            Cull::Back,
            vec![part(turn), part(beside)],
        ),
        // From inside: every wall crosses the near plane.
        "room" => (
            [0.3, 0.2, 0.6],
            true,
            Cull::Front,
            vec![part(Transform::IDENTITY)],
        ),
        _ => return None,
    };
    Some(bake(&BakedScene {
        name,
        eye,
        look: [0.0, -0.1, 0.05],
        up: [0.1, 1.0, 0.0],
        fov_y: 0.9,
        near: 0.05,
        depth,
        cull,
        parts,
    }))
}

fn cube() -> (Vec<Vertex>, Vec<[u16; 3]>) {
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for sign in [-1, 1] {
            let first = vertices.len() as u16;
            for (s, t) in [(-1, -1), (1, -1), (1, 1), (-1, 1)] {
                let mut position = [0; 3];
                position[axis] = sign << 16;
                position[(axis + 1) % 3] = (s * sign) << 16;
                position[(axis + 2) % 3] = t << 16;
                vertices.push(Vertex::from_bits(position, [(s + 1) << 15, (1 - t) << 15]));
            }
            triangles.push([first, first + 1, first + 2]);
            triangles.push([first, first + 2, first + 3]);
        }
    }
    (vertices, triangles)
}

fn planks() -> Vec<Rgb565> {
    (0..SIDE * SIDE)
        .map(|i| {
            let (x, y) = (i % SIDE, i / SIDE);
            let grain = (x * 7 + (y / 8) * 13) % 8;
            if (x + y) % 16 < 2 || y % 8 == 0 {
                Rgb565::new(6, 8, 3)
            } else {
                Rgb565::new(
                    (18 + grain) as u8,
                    (26 + grain) as u8,
                    (6 + grain / 2) as u8,
                )
            }
        })
        .collect()
}
