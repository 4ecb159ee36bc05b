//! The near plane and the guard band: what is left of a triangle covers the same pixels, with the
//! same texture coordinates, as a rasterizer that does not clip.
//!
//! All bounds follow from three roundings, per axis and in the order in which they happen:
//!
//! - A cut rounds each coordinate to 2^-16, hence moves it by up to h = 2^-17. A cut vertex may be
//!   an end of the next cut, which passes the error on and adds its own: h for the near plane
//!   alone, 5 h at most with the guard band. On the screen that is
//!   `|dx - (x/w) dw| / w * size / 2`, with dw = 0 at the near plane, where w is an integer, and
//!   `|x/w| size / 2 <= 1024 + size / 2` at the guard band, where moving what is left outside onto
//!   the rim may double it.
//! - Snapping moves a vertex by up to 1/512 px.
//! - The planes' evaluation moves the sample position by less than 2^-18 px (see `setup::Plane`).
//!
//! An edge moves by no more than its ends do, so a centre that is farther from all bounding lines
//! is in or out for certain. The rest are left out, and counted.

use multum::camera::{Camera, Perspective};
use multum::clip::{ClipVertex, ClipVolume, fan, transform};
use multum::depth::NoDepth;
use multum::draw::Pipeline;
use multum::fixed::types::I16F16;
use multum::geometry::{Mesh, Vertex};
use multum::perspective::PerPixel;
use multum::project::ScreenVertex;
use multum::setup::Cull;
use multum::transform::Transform;
use multum::uv::Uv;
use multum::viewport::Viewport;
use rand::Rng as _;
use tests::Coordinates;
use tests::exact::Triangle;
use tests::frame::{Frame, Overdraw};
use tests::homogeneous::Homogeneous;
use tests::random::{Rng, seeded};

/// Half a unit of a clip coordinate.
const HALF: f64 = 1.0 / 131_072.0;

/// What the tests draw: texture coordinates, per pixel, both sides.
const PIPELINE: Pipeline<PerPixel, Coordinates, NoDepth> = Pipeline {
    strategy: PerPixel,
    sampler: Coordinates,
    depth: NoDepth,
    cull: Cull::Off,
};

/// A frame and a near plane.
#[derive(Clone, Copy)]
struct View {
    size: (u32, u32),
    /// In units.
    near: f64,
}

impl View {
    fn volume(self) -> ClipVolume {
        let viewport = Viewport::new(self.size.0, self.size.1).expect("a size");
        ClipVolume::new(viewport, I16F16::from_num(self.near))
    }

    fn near_bits(self) -> i32 {
        I16F16::from_num(self.near).to_bits()
    }

    fn largest(self) -> f64 {
        f64::from(self.size.0.max(self.size.1))
    }

    fn diagonal(self) -> f64 {
        f64::from(self.size.0).hypot(f64::from(self.size.1))
    }

    fn draw(self, vertices: &[ClipVertex], triangles: &[[u16; 3]]) -> Frame<Uv> {
        let (width, height) = (self.size.0 as i32, self.size.1 as i32);
        let mut frame = Frame::new(width, height, Uv::default(), Overdraw::Counts);
        let result = { PIPELINE }.draw(&mut frame, &self.volume(), vertices, triangles);
        assert_eq!(result, Ok(()));
        frame
    }
}

/// What clipping a triangle may change.
struct Bounds {
    /// How far a vertex may move on the screen, in pixels on each axis.
    shift: f64,
    /// How far u and v of a cut vertex may be off, in repeats.
    uv: f64,
    /// How far its depth may be off, relatively.
    w: f64,
    /// Least depth of what is visible.
    least_w: f64,
}

impl Bounds {
    fn new(view: View, corners: &[ClipVertex; 3]) -> Self {
        let near = view.near;
        let homogeneous = corners.map(|v| [v.x, v.y, v.w].map(|c| c.to_num::<f64>()));
        let least_w = homogeneous.iter().map(|v| v[2]).fold(f64::MAX, f64::min);
        let near_cut = least_w < near;
        let least_w = least_w.max(near);
        // What is in front of the near plane, in float64: does it leave the guard band?
        let next = homogeneous.iter().cycle().skip(1);
        let guard_cut = homogeneous.iter().zip(next).any(|(a, b)| {
            let ends = [(a, b), (b, a)].map(|(from, to)| {
                if from[2] >= near {
                    Some(*from)
                } else if to[2] >= near {
                    let t = (near - from[2]) / (to[2] - from[2]);
                    Some([0, 1, 2].map(|i| from[i] + t * (to[i] - from[i])))
                } else {
                    None
                }
            });
            ends.into_iter().flatten().any(|[x, y, w]| {
                let off = |c: f64, size: u32| {
                    let half = f64::from(size) / 2.0;
                    (c / w * half).abs() + half > 1023.0
                };
                off(x, view.size.0) || off(y, view.size.1)
            })
        });
        let half = view.largest() / 2.0;
        let snap = 1.0 / 512.0;
        // The depth of a vertex that has been moved may be less than the least by its error,
        // 2^-10 of it at most for near distances from 1/16 on.
        let slack = 1.0 + 1.0 / 1024.0;
        let (shift, roundings, w) = if guard_cut {
            let w = 5.0 * HALF / least_w * slack;
            (2.0 * w * (half + 1024.0 + half) + snap, 5.0, w)
        } else if near_cut {
            (HALF / near * half * slack + snap, 1.0, 0.0)
        } else {
            (snap, 0.0, 0.0)
        };
        Self {
            shift,
            uv: roundings * HALF,
            w,
            least_w,
        }
    }

    /// How far an edge may move.
    fn margin(&self) -> f64 {
        self.shift * 2.0_f64.sqrt()
    }

    /// How far a coordinate may be off at a sample, beyond the move of its position, in repeats.
    /// It spans `range` over the triangle.
    fn coordinate(&self, range: f64, w: f64) -> f64 {
        // Weights that are off by a factor 1 +- e move a mean by up to 2 e of what it spans:
        // e has the depths' error and 2^-28 for their reciprocals (2^-29, and slack).
        let weights = 2.0 * (self.w + (-28.0f64).exp2()) * range;
        // The power of two of repeats that the range fits in.
        let scale = 2.0 * range + (-16.0f64).exp2();
        // 1/w and u/w at the corners are rounded to units of which the nearest corner has at
        // least 2^30, and the planes add 2^-11 unit each: at depth w they are off by
        // 1 + 2^-10 units of 2^30 least_w / w.
        let planes = (1.0 + (-10.0f64).exp2()) * (-30.0f64).exp2() * w / self.least_w * scale;
        // The division, see `Homogeneous::divide`.
        let division = (-27.0f64).exp2() * scale + (-25.0f64).exp2();
        self.uv + weights + planes + division
    }
}

fn vertex([x, y, w]: [i32; 3], [u, v]: [i32; 2]) -> ClipVertex {
    let [x, y, w, u, v] = [x, y, w, u, v].map(I16F16::from_bits);
    ClipVertex { x, y, w, u, v }
}

/// Up to `limit` units to any side.
fn units(random: &mut Rng, limit: i32) -> i32 {
    random.random_range(-limit * 65_536..=limit * 65_536)
}

fn uv(random: &mut Rng) -> [i32; 2] {
    [0; 2].map(|_| units(random, 20))
}

/// A corner somewhere around the eye.
fn around(random: &mut Rng, limit: i32) -> ClipVertex {
    let position = [0; 3].map(|_| units(random, limit));
    vertex(position, uv(random))
}

/// What became of the pixels of a test.
#[derive(Default)]
struct Tally {
    drawn: u64,
    left_out: u64,
    /// The area within the margins of the bounding lines, in pixels.
    margins: f64,
}

impl Tally {
    /// Four lines a triangle, each no longer than the diagonal of the frame, with the margin on
    /// both sides: that many centres can be left out, give or take their grain; 10 % for that.
    fn finish(&self, least_drawn: u64) {
        println!(
            "drawn {}, left out {} of up to {:.0}",
            self.drawn, self.left_out, self.margins
        );
        assert!(self.left_out as f64 <= 1.1 * self.margins);
        assert!(self.drawn >= least_drawn);
    }
}

/// Draws a triangle and compares every pixel with the rasterizer that does not clip.
fn check(view: View, corners: &[ClipVertex; 3], tally: &mut Tally) {
    let Some(reference) = Homogeneous::new(corners, view.size, view.near_bits()) else {
        return;
    };
    let bounds = Bounds::new(view, corners);
    tally.margins += 4.0 * view.diagonal() * 2.0 * bounds.margin();
    let ranges = [|v: &ClipVertex| v.u, |v: &ClipVertex| v.v].map(|axis| {
        let [a, b, c] = corners.each_ref().map(|v| axis(v).to_num::<f64>());
        a.max(b).max(c) - a.min(b).min(c)
    });
    let frame = view.draw(corners, &[[0, 1, 2]]);
    for (x, y) in frame.positions() {
        let sample = reference.sample(x, y);
        let Some(inside) = sample.inside(bounds.margin()) else {
            tally.left_out += 1;
            continue;
        };
        assert_eq!(
            frame.count(x, y),
            u32::from(inside),
            "{corners:?} at column {x}, row {y}: {sample:?}"
        );
        if !inside {
            continue;
        }
        let Some(change) = sample.change(bounds.shift + (-18.0f64).exp2()) else {
            tally.left_out += 1;
            continue;
        };
        tally.drawn += 1;
        let drawn = frame.pixel(x, y);
        for (axis, drawn) in [drawn.u, drawn.v].into_iter().enumerate() {
            let error = (drawn.to_num::<f64>() - sample.uv[axis]).abs();
            let bound = change[axis] + bounds.coordinate(ranges[axis], sample.w);
            assert!(
                error <= bound,
                "{corners:?} at column {x}, row {y}, axis {axis}: {drawn}, off by {error}, \
                 more than {bound}; {sample:?}"
            );
        }
    }
}

/// Compares `count` triangles of a generator.
fn run(
    seed: u64,
    count: u32,
    view: View,
    least_drawn: u64,
    mut generate: impl FnMut(&mut Rng) -> [ClipVertex; 3],
) {
    let mut random = seeded(seed);
    let mut tally = Tally::default();
    for _ in 0..count {
        check(view, &generate(&mut random), &mut tally);
    }
    tally.finish(least_drawn);
}

const VIEW: View = View {
    size: (96, 72),
    near: 1.0,
};

#[test]
fn in_front_of_the_near_plane() {
    run(41, 400, VIEW, 100_000, |random| {
        let w = 65_536..10 * 65_536;
        [0; 3].map(|_| {
            let w = random.random_range(w.clone());
            let position = [random.random_range(-w..w), random.random_range(-w..w), w];
            vertex(position, uv(random))
        })
    });
}

#[test]
fn through_the_eye_plane() {
    run(42, 600, VIEW, 100_000, |random| {
        [0; 3].map(|_| around(random, 6))
    });
}

#[test]
fn near_planes_close_to_the_eye() {
    for (seed, near) in [(43, 0.25), (44, 0.0625)] {
        let view = View { near, ..VIEW };
        run(seed, 300, view, 30_000, |random| {
            [0; 3].map(|_| around(random, 3))
        });
    }
}

#[test]
fn far_beyond_the_guard_band() {
    run(45, 600, VIEW, 100_000, |random| {
        [0; 3].map(|_| around(random, 1_000))
    });
    // In front of the eye, and large.
    run(46, 500, VIEW, 100_000, |random| {
        [0; 3].map(|_| {
            let [x, y] = [0; 2].map(|_| units(random, 1_000));
            vertex([x, y, random.random_range(65_536..20 * 65_536)], uv(random))
        })
    });
}

/// Corners exactly on the near plane, in the eye plane, and within one unit of it.
#[test]
fn corners_on_the_planes() {
    run(47, 600, VIEW, 100_000, |random| {
        [0; 3].map(|_| {
            let mut corner = around(random, 6);
            corner.w = match random.random_range(0..5) {
                0 => I16F16::ONE,
                1 => I16F16::ZERO,
                2 => I16F16::DELTA,
                3 => -I16F16::DELTA,
                _ => corner.w,
            };
            corner
        })
    });
}

/// Nothing in front of the near plane: nothing drawn.
#[test]
fn behind_the_near_plane() {
    let mut random = seeded(48);
    for _ in 0..1_000 {
        let corners = [0; 3].map(|_| {
            let mut corner = around(&mut random, 10);
            corner.w = I16F16::from_bits(random.random_range(-10 * 65_536..65_536));
            corner
        });
        assert!(VIEW.volume().clip(&corners).is_empty());
        let frame = VIEW.draw(&corners, &[[0, 1, 2]]);
        assert!(frame.positions().all(|(x, y)| frame.count(x, y) == 0));
    }
}

/// A triangle on the near plane is inside, and comes out as it went in.
#[test]
fn on_the_near_plane() {
    let one = 65_536;
    let corners = [
        vertex([-one, -one, one], [0, 0]),
        vertex([one, -one, one], [one, 0]),
        vertex([one, one, one], [one, one]),
    ];
    assert_eq!(VIEW.volume().clip(&corners).as_slice(), corners);
    // One corner on it and two behind: what is left has no area.
    let mut corners = corners;
    corners[0].w = I16F16::from_bits(one - 1);
    corners[1].w = I16F16::from_bits(one - 2);
    let frame = VIEW.draw(&corners, &[[0, 1, 2]]);
    assert!(frame.positions().all(|(x, y)| frame.count(x, y) == 0));
}

/// Draws the triangles 0-1-2 and 0-2-3 of a flat convex quad and checks that every pixel inside is
/// drawn exactly once: the diagonal, wherever it was cut, shows nowhere. Gives the pixels drawn.
///
/// `shift` is how far, in pixels, the corners may be off one plane.
fn check_quad(view: View, corners: &[ClipVertex; 4], shift: f64) -> u64 {
    let [a, b, c, d] = *corners;
    let halves = [[a, b, c], [a, c, d]];
    let frame = view.draw(corners, &[[0, 1, 2], [0, 2, 3]]);

    // What is drawn is what the rule says about the snapped vertices.
    let viewport = view.volume().viewport();
    let parts: Vec<_> = halves
        .iter()
        .flat_map(|half| {
            let polygon = view.volume().clip(half);
            fan(&polygon)
                .filter_map(|part| {
                    let corners =
                        part.map(|v| ScreenVertex::project(v, viewport).expect("a clipped vertex"));
                    Triangle::new(corners.map(|v| [v.x().to_bits(), v.y().to_bits()]))
                })
                .collect::<Vec<_>>()
        })
        .collect();
    for (x, y) in frame.positions() {
        let covered = parts.iter().filter(|part| part.covers(x, y)).count();
        assert_eq!(
            frame.count(x, y) as usize,
            covered,
            "{corners:?} at column {x}, row {y}"
        );
    }

    let margin = halves
        .iter()
        .map(|half| Bounds::new(view, half).margin())
        .fold(shift, f64::max);
    let [Some(first), Some(second)] =
        halves.map(|half| Homogeneous::new(&half, view.size, view.near_bits()))
    else {
        return 0;
    };
    let mut drawn = 0;
    for (x, y) in frame.positions() {
        // Edges are numbered by the corner opposite: the diagonal is opposite b and d.
        let [bc, _, ab, near] = first.sample(x, y).distances;
        let [cd, da, _, near_too] = second.sample(x, y).distances;
        let outer = [bc, ab, near, cd, da, near_too];
        let expected = if outer.iter().all(|&d| d > margin) {
            1
        } else if outer.iter().any(|&d| d < -margin) {
            0
        } else {
            continue;
        };
        assert_eq!(
            frame.count(x, y),
            expected,
            "{corners:?} at column {x}, row {y}: {outer:?}, margin {margin}"
        );
        drawn += u64::from(expected);
    }
    drawn
}

/// Parallelograms of exact corners.
#[test]
fn triangles_that_share_a_clipped_edge_leave_no_gap() {
    let mut random = seeded(49);
    let mut drawn = 0;
    for round in 0..2_000 {
        let limit = [4, 30, 1_000][round % 3];
        let near = [1.0, 0.25][round / 3 % 2];
        let view = View { near, ..VIEW };
        let [origin, first, second] = [0; 3].map(|_| [0; 3].map(|_| units(&mut random, limit)));
        let corner = |i: i32, j: i32| {
            vertex(
                [0, 1, 2].map(|axis| origin[axis] + i * first[axis] + j * second[axis]),
                [i * 65_536, j * 65_536],
            )
        };
        let corners = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
        drawn += check_quad(view, &corners, 0.0);
    }
    println!("drawn {drawn}");
    assert!(drawn > 500_000);
}

/// What is left of a shared edge is the same in both triangles, to the bit, though they run along
/// it in opposite directions and cross other planes with their other corners. The edges end
/// behind the near plane, which they meet close to the rim of the guard band.
#[test]
fn what_is_left_of_a_shared_edge_is_the_same_in_both_triangles() {
    let mut random = seeded(53);
    let mut shared = 0;
    for _ in 0..200_000 {
        let near = random.random_range(256..2_000);
        let view = View {
            size: (random.random_range(64..=512), random.random_range(64..=512)),
            near: f64::from(near) / 65_536.0,
        };
        // On the near plane, x at the rim is -w (1 + 2048 / width).
        let rim = 1.0 + 2_048.0 / f64::from(view.size.0);
        let at_rim = (f64::from(near) * rim) as i32;
        let inside = [
            random.random_range(-50_000..50_000),
            random.random_range(-50_000..50_000),
            random.random_range(50_000..100_000),
        ];
        let aim = [
            -at_rim + random.random_range(-1..=1),
            random.random_range(-3 * near..3 * near),
            near,
        ];
        let t = 1.0 + random.random_range(0.0001..0.05);
        let outside =
            [0, 1, 2].map(|i| inside[i] + (t * f64::from(aim[i] - inside[i])).round() as i32);
        let [a, b] = [inside, outside].map(|p| vertex(p, [0, 0]));
        // One of the others is far out to the left, one is not.
        let far = vertex(
            [-4_000_000, random.random_range(-9_000..9_000), 80_000],
            [0; 2],
        );
        let close = vertex([60_000, random.random_range(-9_000..9_000), 80_000], [0; 2]);
        let [first, second] = [[a, b, far], [b, a, close]].map(|corners| {
            let viewport = view.volume().viewport();
            let polygon = view.volume().clip(&corners);
            let project = |v| ScreenVertex::project(v, viewport).expect("a clipped vertex");
            polygon.iter().map(project).collect::<Vec<_>>()
        });
        // The edge starts at the corner inside, in both; its other end is the next corner of the
        // first polygon and the one before in the second.
        let start = ScreenVertex::project(&a, view.volume().viewport()).expect("a corner");
        let place = |polygon: &[ScreenVertex]| polygon.iter().position(|v| *v == start);
        let (Some(i), Some(j)) = (place(&first), place(&second)) else {
            continue;
        };
        let end = first[(i + 1) % first.len()];
        let same = second[(j + second.len() - 1) % second.len()];
        assert_eq!(
            (end.x(), end.y(), end.w()),
            (same.x(), same.y(), same.w()),
            "{a:?}, {b:?}, {far:?}, {close:?} near {near}, {:?}",
            view.size
        );
        shared += 1;
    }
    println!("shared {shared}");
    assert!(shared > 100_000);
}

fn floor() -> [Vertex; 4] {
    let side = 1_000 * 65_536;
    let repeats = 60 * 65_536;
    [(-1, -1), (-1, 1), (1, 1), (1, -1)].map(|(x, z)| {
        // One and a half units under the eye.
        Vertex::from_bits([x * side, -98_304, z * side], [x * repeats, z * repeats])
    })
}

fn seen_by(camera: &Camera) -> [ClipVertex; 4] {
    let vertices = floor();
    let mesh = Mesh::new(&vertices, &[[0, 1, 2], [0, 2, 3]]).expect("a mesh");
    let to_clip = camera.to_clip(&Transform::IDENTITY).expect("a matrix");
    let mut out = [ClipVertex::default(); 4];
    transform(&mesh, &to_clip, &mut out).expect("clip coordinates");
    out
}

/// A level camera over a floor from -1000 to 1000: everything below the horizon is floor.
///
/// With a vertical scale of 1 and 240 rows a point of the floor at depth z is 180 / z rows below
/// the middle. The first row below it, at half a pixel, shows z = 360, to 480 units left and
/// right: inside, and a quarter of a pixel from any edge of the floor (its side is at 750 units
/// depth where it leaves the frame, at 0.24 rows). The last one shows z = 1.5, beyond the near
/// plane at 1.
#[test]
fn a_floor_covers_every_pixel_below_the_horizon() {
    let lens = Perspective::from_scales(
        I16F16::from_num(0.75),
        I16F16::from_num(1),
        I16F16::from_num(1),
    )
    .expect("a lens");
    let camera = Camera {
        view: Transform::IDENTITY,
        lens,
    };
    let view = View {
        size: (320, 240),
        near: 1.0,
    };
    let frame = view.draw(&seen_by(&camera), &[[0, 1, 2], [0, 2, 3]]);
    for (x, y) in frame.positions() {
        assert_eq!(
            frame.count(x, y),
            u32::from(y >= 120),
            "column {x}, row {y}"
        );
    }
}

/// The same floor from cameras that are turned, tilted and rolled.
#[test]
fn a_floor_seen_from_all_angles() {
    let mut random = seeded(50);
    let view = View {
        size: (96, 72),
        near: 0.5,
    };
    let lens = Perspective::from_scales(
        I16F16::from_num(0.75),
        I16F16::from_num(1),
        I16F16::from_num(view.near),
    )
    .expect("a lens");
    let mut drawn = 0;
    for _ in 0..200 {
        let mut turn = |axis: [f32; 3]| {
            let angle = random.random_range(-3.0..3.0);
            Transform::rotation(axis, angle).expect("a rotation")
        };
        let (yaw, pitch, roll) = (
            turn([0.0, 1.0, 0.0]),
            turn([1.0, 0.0, 0.0]),
            turn([0.0, 0.0, 1.0]),
        );
        let turned = pitch.after(&yaw).and_then(|t| roll.after(&t));
        let camera = Camera {
            view: turned.expect("a rotation"),
            lens,
        };
        // The corners are rounded to 2^-17 units on each axis; over a near distance of 1/2 and
        // 48 pixels a unit: 48 * 2^-16 of a pixel for each of three coordinates, twice.
        drawn += check_quad(view, &seen_by(&camera), 0.005);
    }
    println!("drawn {drawn}");
    assert!(drawn > 500_000);
}

/// A half-space of the clip volume, from its definition on the screen: the distance as an exact
/// integer.
fn distance(plane: usize, v: &ClipVertex, view: View) -> i128 {
    let [x, y, w] = [v.x, v.y, v.w].map(|c| i128::from(c.to_bits()));
    let (width, height) = (i128::from(view.size.0), i128::from(view.size.1));
    // Screen x is (x + w) width / 2w, and -1024 <= screen x <= 1024; y is turned over.
    match plane {
        0 => w - i128::from(view.near_bits()),
        1 => (x + w) * width + 2_048 * w,
        2 => 2_048 * w - (x + w) * width,
        3 => (w - y) * height + 2_048 * w,
        _ => 2_048 * w - (w - y) * height,
    }
}

/// A corner of the clipped polygon as it has to be.
#[derive(Clone, Copy, Debug)]
enum Expected {
    Corner(ClipVertex),
    /// Between a corner inside and one outside of a plane.
    Cut {
        plane: usize,
        inside: ClipVertex,
        outside: ClipVertex,
    },
}

impl Expected {
    fn is(&self, found: &ClipVertex, view: View) -> bool {
        let bits = |v: &ClipVertex| [v.x, v.y, v.w, v.u, v.v].map(|c| i128::from(c.to_bits()));
        match self {
            Self::Corner(v) => v == found,
            Self::Cut {
                plane,
                inside,
                outside,
            } => {
                let n = distance(*plane, inside, view);
                let d = n - distance(*plane, outside, view);
                let (a, b, found) = (bits(inside), bits(outside), bits(found));
                // |found - (a + (b - a) n / d)| <= 1/2: rounded to nearest.
                (0..5).all(|i| {
                    let off = (found[i] - a[i]) * d - (b[i] - a[i]) * n;
                    2 * off.abs() <= d
                })
            }
        }
    }
}

/// Triangles that cross one plane: each new corner has x, y, w, u and v of the exact intersection,
/// rounded to nearest.
#[test]
fn cuts_are_exact_to_the_format() {
    let mut random = seeded(51);
    let mut cut = [0; 5];
    for round in 0..400_000 {
        let view = View {
            size: (random.random_range(1..=1024), random.random_range(1..=1024)),
            near: f64::from(random.random_range(1..=100)) / 32.0,
        };
        let limit = [16, 24, 31][round % 3];
        let corners = [0; 3].map(|_| {
            let mut any =
                || random.random_range(i32::MIN >> (31 - limit)..=i32::MAX >> (31 - limit));
            let (wide, narrow, depth) = (any(), any() / 16, any());
            let depth = match round % 2 {
                0 => depth,
                // In front of the eye, so that the guard band gets its turn.
                _ => (depth >> 8).saturating_abs() + view.near_bits(),
            };
            let position = match round % 4 {
                0 | 1 => [wide, narrow, depth],
                _ => [narrow, wide, depth],
            };
            vertex(position, [any(), any()])
        });
        let crossed: Vec<usize> = (0..5)
            .filter(|&plane| corners.iter().any(|v| distance(plane, v, view) < 0))
            .collect();
        let [plane] = crossed[..] else {
            continue;
        };
        let mut expected = Vec::new();
        for (i, v) in corners.iter().enumerate() {
            let next = &corners[(i + 1) % 3];
            let inside = distance(plane, v, view) >= 0;
            if inside {
                expected.push(Expected::Corner(*v));
            }
            if inside != (distance(plane, next, view) >= 0) {
                let (inside, outside) = if inside { (*v, *next) } else { (*next, *v) };
                expected.push(Expected::Cut {
                    plane,
                    inside,
                    outside,
                });
            }
        }
        let found = view.volume().clip(&corners);
        let n = expected.len();
        assert_eq!(found.len(), n, "{corners:?}");
        let matches = |turn: usize| (0..n).all(|i| expected[(i + turn) % n].is(&found[i], view));
        assert!(
            n == 0 || (0..n).any(matches),
            "{corners:?} became {found:?} instead of {expected:?}"
        );
        cut[plane] += usize::from(n > 0);
    }
    println!("cut by each plane: {cut:?}");
    assert!(cut.iter().all(|&n| n > 100));
}

/// Any triangle: the polygon keeps to the volume but for the rounding, and to the ranges of the
/// triangle's coordinates, for nothing is extrapolated.
#[test]
fn polygons_keep_to_the_volume_and_to_the_triangle() {
    let mut random = seeded(52);
    let view = View {
        size: (320, 240),
        near: 0.25,
    };
    let mut corners_found = [0; 9];
    for round in 0..200_000 {
        let limit = [18, 22, 26, 31][round % 4];
        let corners = [0; 3].map(|_| {
            let mut any =
                || random.random_range(i32::MIN >> (31 - limit)..=i32::MAX >> (31 - limit));
            vertex([any(), any(), any()], [any(), any()])
        });
        let polygon = view.volume().clip(&corners);
        corners_found[polygon.len()] += 1;
        for v in &polygon {
            for plane in 0..5 {
                // Each of up to five roundings moves x (or y) and w by half a unit; in the
                // plane's scale, size and size + 2048 of these. w is exact at the near plane.
                let allowed = 5 * (320 + 320 + 2_048) / 2;
                let found = distance(plane, v, view);
                assert!(
                    found >= if plane == 0 { 0 } else { -allowed },
                    "{corners:?}: {v:?} is outside plane {plane} by {found}"
                );
            }
            for axis in [
                |v: &ClipVertex| v.x,
                |v: &ClipVertex| v.y,
                |v: &ClipVertex| v.w,
                |v: &ClipVertex| v.u,
                |v: &ClipVertex| v.v,
            ] {
                let [a, b, c] = corners.each_ref().map(axis);
                let range = a.min(b).min(c)..=a.max(b).max(c);
                assert!(range.contains(&axis(v)), "{corners:?}: {v:?}");
            }
        }
    }
    println!("polygons by corners: {corners_found:?}");
    assert!(corners_found[3..=6].iter().all(|&n| n > 100));
}
