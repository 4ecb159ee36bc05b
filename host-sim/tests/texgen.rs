//! Texture coordinates made from positions, compared with shapes that bring their own.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use host_sim::model::Part;
use host_sim::picture::Picture;
use host_sim::shape;
use host_sim::texgen::{self, Axis, Projection};
use multum::fixed::types::I16F16;
use multum::geometry::{Mesh, Vertex};

/// One step of 16.16.
const STEP: f64 = 1.0 / 65_536.0;

fn white() -> Arc<Picture> {
    Arc::new(Picture::of_colour([255; 3]))
}

fn part(positions: &[[f64; 3]], triangles: Vec<[u16; 3]>) -> Part {
    let vertex = |p: &[f64; 3]| Vertex {
        position: p.map(I16F16::from_num),
        uv: [I16F16::ZERO; 2],
    };
    Part {
        vertices: positions.iter().map(vertex).collect(),
        triangles,
        picture: white(),
    }
}

/// Applies it, and checks that triangles keep their places and their order.
fn applied(parts: &[Part], projection: Projection, repeats: [f32; 2]) -> Vec<Part> {
    let mut generated = parts.to_vec();
    texgen::apply(&mut generated, projection, repeats).expect("few repeats");
    for part in &generated {
        Mesh::new(&part.vertices, &part.triangles).expect("tables that the core takes");
    }
    let positions = |parts: &[Part]| -> Vec<[I16F16; 3]> {
        let triangles = parts.iter().flat_map(corners);
        triangles.flatten().map(|v| v.position).collect()
    };
    assert_eq!(positions(&generated), positions(parts));
    generated
}

fn corners(part: &Part) -> Vec<[Vertex; 3]> {
    let vertex = |i: u16| part.vertices[usize::from(i)];
    part.triangles.iter().map(|t| t.map(vertex)).collect()
}

fn uv(vertex: &Vertex) -> [f64; 2] {
    vertex.uv.map(|x| x.to_num())
}

fn triangle_uvs(part: &Part) -> Vec<[[f64; 2]; 3]> {
    let triangles = corners(part);
    triangles
        .iter()
        .map(|t| [0, 1, 2].map(|i| uv(&t[i])))
        .collect()
}

fn span(values: [f64; 3]) -> f64 {
    let [a, b, c] = values;
    a.max(b).max(c) - a.min(b).min(c)
}

#[test]
fn a_sphere_gets_back_its_own_coordinates() {
    // Columns in fours, so that the box is as wide as the sphere on both axes.
    for (columns, rows) in [(48, 24), (8, 6), (4, 2)] {
        let sphere = shape::sphere(columns, rows, &white());
        let generated = applied(
            std::slice::from_ref(&sphere),
            Projection::Spherical,
            [1.0, 1.0],
        );
        assert_eq!(generated.len(), 1);
        for (own, new) in corners(&sphere).iter().zip(corners(&generated[0])) {
            let is_pole = |v: &Vertex| v.position[0] == 0 && v.position[2] == 0;
            for i in 0..3 {
                let [u, v] = uv(&own[i]);
                let [new_u, new_v] = uv(&new[i]);
                // Positions are cut to 16.16, and so is the middle of the box that they give: at
                // most 1.5 steps on an axis. That turns by so much at most (an arc of the ring,
                // and of the whole sphere); the coordinates themselves are cut too.
                let moved = 1.5 * STEP * 2f64.sqrt();
                let ring = (PI * v).sin();
                assert!((new_v - v).abs() <= 3f64.sqrt() * 1.5 * STEP / PI + 1.5 * STEP);
                if is_pole(&own[i]) {
                    let others = [uv(&new[(i + 1) % 3])[0], uv(&new[(i + 2) % 3])[0]];
                    let mean = (others[0] + others[1]) / 2.0;
                    assert!((new_u - mean).abs() <= STEP, "{new_u} between {others:?}");
                } else {
                    let bound = moved / ring / TAU + 1.5 * STEP;
                    assert!((new_u - u).abs() <= bound, "u {new_u}, not {u}");
                }
            }
        }
        // The seam is there twice, and each pole once for each of its triangles.
        let (columns, rows) = (usize::from(columns), usize::from(rows));
        let vertices = (columns + 1) * (rows - 1) + 2 * columns;
        assert_eq!(generated[0].vertices.len(), vertices);
    }
}

#[test]
fn triangles_across_the_seam_stay_together() {
    // Rings of triangles that begin at odd longitudes, none around the axis.
    for shift in 0..40 {
        let corner = |turn: f64, y: f64| {
            let (x, z) = (TAU * (turn + f64::from(shift) / 41.0)).sin_cos();
            [-x, y, -z]
        };
        let positions: Vec<_> = (0..7)
            .flat_map(|i| {
                let turn = f64::from(i) / 7.0;
                [corner(turn, -0.5), corner(turn + 1.0 / 14.0, 0.5)]
            })
            .collect();
        let triangles = (0..14).map(|i| [i, (i + 2) % 14, (i + 1) % 14]).collect();
        let ring = part(&positions, triangles);
        for projection in [Projection::Cylindrical, Projection::Spherical] {
            let generated = applied(std::slice::from_ref(&ring), projection, [1.0, 1.0]);
            let mut beyond = 0;
            for us in triangle_uvs(&generated[0]).map_u() {
                // A seventh of a turn, a bit more for the middle of a box around seven corners.
                assert!(span(us) < 0.25, "{us:?}");
                assert!(us.iter().all(|u| (0.0..1.5).contains(u)), "{us:?}");
                beyond += us.iter().filter(|&&u| u >= 1.0).count();
            }
            // Two or three triangles lie across the seam, with one or two corners beyond it.
            assert!((2..=4).contains(&beyond), "{beyond} corners beyond");
        }
    }
}

/// Only the u's.
trait MapU {
    fn map_u(self) -> Vec<[f64; 3]>;
}

impl MapU for Vec<[[f64; 2]; 3]> {
    fn map_u(self) -> Vec<[f64; 3]> {
        self.into_iter().map(|t| t.map(|[u, _]| u)).collect()
    }
}

#[test]
fn a_vertex_on_the_axis_takes_the_mean_of_the_others() {
    // A pyramid with its apex on the axis; the triangle over -z crosses the seam.
    let positions = [
        [0.0, 1.0, 0.0],
        [-1.0, -1.0, -1.0],
        [-1.0, -1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, -1.0, -1.0],
    ];
    let sides = vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
    let pyramid = part(&positions, sides);
    for projection in [Projection::Cylindrical, Projection::Spherical] {
        let generated = applied(std::slice::from_ref(&pyramid), projection, [2.0, 1.0]);
        // North-west is an eighth of a turn; twice around.
        let expected = [
            [0.5, 0.25, 0.75],
            [1.0, 0.75, 1.25],
            [1.5, 1.25, 1.75],
            [2.0, 1.75, 2.25],
        ];
        assert_eq!(triangle_uvs(&generated[0]).map_u(), expected);
        assert_eq!(generated[0].vertices.len(), 9);
    }
}

#[test]
fn what_lies_on_the_axis_altogether_is_drawn_still() {
    let needle = part(
        &[
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.5, 0.0, 0.0],
            [-0.5, 0.0, 0.0],
        ],
        vec![[0, 1, 2], [0, 1, 3], [3, 4, 0]],
    );
    let generated = applied(&[needle], Projection::Spherical, [1.0, 1.0]);
    // East is three quarters.
    assert_eq!(
        triangle_uvs(&generated[0])[0],
        [[0.0, 0.0], [0.0, 0.5], [0.0, 1.0]]
    );
    assert_eq!(
        triangle_uvs(&generated[0])[1],
        [[0.75, 0.0], [0.75, 0.5], [0.75, 0.5]]
    );
    let point = part(&[[5.0, 5.0, 5.0]], vec![[0, 0, 0]]);
    for projection in Projection::ALL {
        applied(std::slice::from_ref(&point), projection, [1.0, 1.0]);
    }
}

#[test]
fn planes_show_the_texture_upright_from_the_positive_end() {
    let seen = [
        (Axis::X, [[0, 1, 1], [0, -1, 1], [0, -1, -1], [0, 1, -1]]),
        (Axis::Y, [[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]]),
        (Axis::Z, [[-1, 1, 0], [-1, -1, 0], [1, -1, 0], [1, 1, 0]]),
    ];
    for (axis, quad) in seen {
        let quad = quad.map(|p| p.map(|x| x as f32));
        // Its front faces the positive end: the first two edges turn to the left there.
        let edge = |i: usize| [0, 1, 2].map(|c| quad[i + 1][c] - quad[i][c]);
        let (a, b) = (edge(0), edge(1));
        let (j, k) = ((axis as usize + 1) % 3, (axis as usize + 2) % 3);
        assert!(a[j] * b[k] - a[k] * b[j] > 0.0, "{axis:?}");
        // The shape's own coordinates are those of a texture that is upright.
        for repeats in [[1.0, 1.0], [3.0, 0.5]] {
            let quad = shape::quad(quad, repeats, &white());
            let generated = applied(
                std::slice::from_ref(&quad),
                Projection::Planar(axis),
                repeats,
            );
            assert_eq!(triangle_uvs(&generated[0]), triangle_uvs(&quad));
        }
    }
}

#[test]
fn the_box_is_that_of_all_parts() {
    let lower = part(
        &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        vec![[0, 1, 2]],
    );
    let upper = part(
        &[[0.0, 3.0, 0.0], [4.0, 3.0, 0.0], [0.0, 4.0, 0.0]],
        vec![[0, 1, 2]],
    );
    let generated = applied(&[lower, upper], Projection::Planar(Axis::Z), [1.0, 1.0]);
    assert_eq!(
        triangle_uvs(&generated[0])[0],
        [[0.0, 1.0], [0.25, 1.0], [0.0, 0.75]]
    );
    assert_eq!(
        triangle_uvs(&generated[1])[0],
        [[0.0, 0.25], [1.0, 0.25], [0.0, 0.0]]
    );
}

#[test]
fn the_height_of_a_cylinder_runs_down() {
    let sphere = shape::sphere(16, 8, &white());
    let generated = applied(&[sphere], Projection::Cylindrical, [1.0, 2.0]);
    for vertex in &generated[0].vertices {
        let y: f64 = vertex.position[1].to_num();
        let [_, v] = uv(vertex);
        assert!((v - (1.0 - y)).abs() <= 2.0 * STEP, "{v} at height {y}");
    }
}

#[test]
fn more_vertices_than_indices_make_several_parts() {
    // A disc: 40,000 corners on the rim, and one in the middle that each triangle needs for itself.
    const RIM: u16 = 40_000;
    let rim = (0..RIM).map(|i| {
        let (x, z) = (TAU * f64::from(i) / f64::from(RIM)).sin_cos();
        [-1000.0 * x, 0.0, -1000.0 * z]
    });
    let positions: Vec<_> = rim.chain([[0.0; 3]]).collect();
    let triangles = (0..RIM).map(|i| [RIM, i, (i + 1) % RIM]).collect();
    let disc = part(&positions, triangles);
    let generated = applied(&[disc], Projection::Spherical, [1.0, 1.0]);
    let count: usize = generated.iter().map(|p| p.triangles.len()).sum();
    assert_eq!((generated.len(), count), (2, usize::from(RIM)));
}

#[test]
fn what_cannot_be_is_refused_and_nothing_changed() {
    let sphere = vec![shape::sphere(8, 4, &white())];
    let bad_repeats = [
        [1.0, 128.0],
        [f32::NAN, 1.0],
        [1.0, f32::INFINITY],
        [-127.5, 1.0],
    ];
    for repeats in bad_repeats {
        let mut parts = sphere.clone();
        let said = texgen::apply(&mut parts, Projection::Spherical, repeats)
            .expect_err("too many")
            .to_string();
        assert!(
            said.starts_with("texgen: ") && said.contains("127"),
            "{said}"
        );
        assert_eq!(parts[0].vertices, sphere[0].vertices);
    }
    let mut parts = vec![part(&[[0.0; 3]], vec![[0, 0, 1]])];
    assert!(texgen::apply(&mut parts, Projection::Spherical, [1.0, 1.0]).is_err());
}

#[test]
fn names_are_read_as_they_are_written() {
    for projection in Projection::ALL {
        assert_eq!(projection.to_string().parse(), Ok(projection));
    }
    for name in ["", "planar", "planar:w", "Spherical", "spherical:y"] {
        let said = name.parse::<Projection>().expect_err("a name");
        assert!(said.contains("planar:x"), "{said}");
    }
}
