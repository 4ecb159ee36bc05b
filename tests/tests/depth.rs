//! The 16-bit depth buffer, against depths computed in float64 from the snapped vertices.
//!
//! At a point of depth w the buffer holds `floor(D)` with `D = 65532 near / w + 2`: near / w in
//! 16 bits, less 2^-14 of itself, plus 2. In these units D is off by at most
//!
//! - 2^-12 from the corners' values: the reciprocal's 2^-29 of at most 2^31 and two roundings
//!   down, 6 units of 2^-15;
//! - 2^-12 from the plane: 2^-29 of the range of values (4 units of 2^-15) and 2^-11 of a unit;
//! - 2^-17 from the value at the first corner's pixel, and from each column and row that a pixel is from
//!   that: changes over a pixel are rounded to nearest, to 2^-16;
//! - for corners less than 16 pixels from the first whose D are less than 2^12 from its, 2^-15 of what these span for
//!   a reciprocal of 16 bits, 2^-4 as corners' values count with 20, and as much as before for each column and row once more, since
//!   changes over a pixel are rounded down.
//!
//! Two depths compare as they should where the D differ by more than 1 and both errors.

use multum::depth::Z16;
use multum::draw::Pipeline;
use multum::fixed::types::{I16F16, I24F8};
use multum::perspective::Every;
use multum::project::ScreenVertex;
use multum::setup::Cull;
use multum::sink::Band;
use rand::Rng as _;
use tests::exact::{Triangle, edge};
use tests::random::{Rng, seeded};
use tests::{Flat, GUARD, Point};

const WIDTH: i32 = 80;
const HEIGHT: i32 = 60;

/// A triangle on the screen: positions in subpixels and w as raw 16.16 bits.
#[derive(Clone, Copy, Debug)]
struct Face {
    corners: [Point; 3],
    w: [i32; 3],
}

impl Face {
    fn vertices(&self) -> [ScreenVertex; 3] {
        [0, 1, 2].map(|i| {
            let [x, y] = self.corners[i].map(I24F8::from_bits);
            let w = I16F16::from_bits(self.w[i]);
            ScreenVertex::new(x, y, w, [I16F16::ZERO; 2]).expect("a vertex")
        })
    }

    fn covers(&self, x: i32, y: i32) -> bool {
        Triangle::new(self.corners).is_some_and(|t| t.covers(x, y))
    }

    /// By how much D may be off at any pixel of the frame.
    fn error(&self, near: i32) -> f64 {
        let [first, ..] = self.corners;
        let far = |from: i32, side: i32| (256 * side - from).abs().max(from.abs()) / 256 + 1;
        let steps = f64::from(far(first[0], WIDTH) + far(first[1], HEIGHT) + 1) / 131_072.0;
        let error = steps + 1.0 / 2_048.0;
        let range = |n: [f64; 3]| {
            n.iter().copied().fold(f64::MIN, f64::max) - n.iter().copied().fold(f64::MAX, f64::min)
        };
        let depths = range(self.w.map(|w| Self::corner(near, w)));
        let far = |corner: Point| [0, 1].map(|axis| (corner[axis] - first[axis]).abs());
        let is_near = self
            .corners
            .map(far)
            .iter()
            .flatten()
            .all(|far| *far <= 4096);
        let [of_first, ..] = self.w.map(|w| Self::corner(near, w));
        let is_near = is_near
            && self
                .w
                .iter()
                .all(|&w| (Self::corner(near, w) - of_first).abs() <= 4096.0);
        if is_near {
            error + steps + depths / 32_768.0 + 1.0 / 16.0
        } else {
            error
        }
    }

    /// D where 1/w is that of a corner: nearer than `near` counts as `near`.
    fn corner(near: i32, w: i32) -> f64 {
        65_532.0 * (f64::from(near) / f64::from(w)).min(1.0) + 2.0
    }

    /// D at the centre of a pixel: 1/w is linear on the screen.
    fn depth(&self, near: i32, x: i32, y: i32) -> f64 {
        let p = [256 * x + 128, 256 * y + 128];
        let [a, b, c] = self.corners;
        let area = edge(a, b, c) as f64;
        let shares = [edge(b, c, p), edge(c, a, p), edge(a, b, p)].map(|e| e as f64 / area);
        let corners = self.w.map(|w| Self::corner(near, w));
        shares.iter().zip(corners).map(|(s, d)| s * d).sum()
    }
}

/// What the depths of two faces must differ by to be told apart for certain.
fn separate([a, b]: &[Face; 2], near: i32) -> f64 {
    1.0 + a.error(near) + b.error(near)
}

/// A frame and its depth buffer.
struct Scene {
    pixels: Vec<u8>,
    depths: Vec<u16>,
    near: i32,
}

impl Scene {
    /// Draws faces 1, 2 .. in the order given by their numbers.
    fn draw(near: i32, faces: &[(u8, &Face)]) -> Self {
        let size = (WIDTH * HEIGHT) as usize;
        let (width, height) = (WIDTH as u32, HEIGHT as u32);
        let mut pixels = vec![0; size];
        let mut depths = vec![0xaaaa; size];
        {
            let mut band =
                Band::new(&mut pixels, width, height, width as usize, 0).expect("a band");
            let depth = Band::new(&mut depths, width, height, width as usize, 0).expect("a band");
            let mut depth = Z16::new(depth, I16F16::from_bits(near));
            depth.clear();
            let mut pipeline = Pipeline {
                // Several runs in a row: depths go on from run to run.
                strategy: Every::<16>,
                sampler: Flat(0),
                depth,
                cull: Cull::Off,
            };
            for (name, face) in faces {
                pipeline.sampler = Flat(*name);
                pipeline.draw_triangle(&mut band, &face.vertices());
            }
        }
        Self {
            pixels,
            depths,
            near,
        }
    }

    /// Name of the face that is seen, 0 for none, and the depth in the buffer.
    fn at(&self, x: i32, y: i32) -> (u8, u16) {
        let i = (y * WIDTH + x) as usize;
        (self.pixels[i], self.depths[i])
    }

    /// Checks one face alone: the buffer holds its depth.
    fn check_depth(&self, face: &Face) -> u32 {
        let (mut drawn, error) = (0, face.error(self.near));
        for (x, y) in positions() {
            let (name, found) = self.at(x, y);
            if !face.covers(x, y) {
                assert_eq!((name, found), (0, Z16::EMPTY), "column {x}, row {y}");
                continue;
            }
            drawn += 1;
            assert_eq!(name, 1, "{face:?} at column {x}, row {y}");
            let exact = face.depth(self.near, x, y);
            let range = (exact - error).floor()..=(exact + error).floor();
            assert!(
                range.contains(&f64::from(found)),
                "{face:?} at column {x}, row {y}: {found} instead of {exact}"
            );
            assert!(found > Z16::EMPTY);
        }
        drawn
    }
}

fn positions() -> impl Iterator<Item = (i32, i32)> {
    (0..WIDTH * HEIGHT).map(|i| (i % WIDTH, i / WIDTH))
}

/// A face about as large as the frame; depths from `w`.
fn face(random: &mut Rng, mut w: impl FnMut(&mut Rng) -> i32) -> Face {
    Face {
        corners: [0; 3]
            .map(|_| [WIDTH, HEIGHT].map(|side| random.random_range(-5_000..256 * side + 5_000))),
        w: [0; 3].map(|_| w(random)),
    }
}

/// From the near plane at 1 unit to 50 units, evenly in 1/w.
fn anywhere(random: &mut Rng) -> i32 {
    (65_536.0 / random.random_range(0.02..1.0)) as i32
}

#[test]
fn the_buffer_holds_near_over_w() {
    let mut random = seeded(71);
    let mut drawn = 0;
    for _ in 0..500 {
        let face = face(&mut random, anywhere);
        drawn += Scene::draw(65_536, &[(1, &face)]).check_depth(&face);
    }
    assert!(drawn > 100_000);
    // Any near distance, any depth: the smallest and the largest numbers too.
    for round in 0..1_000 {
        let near = 1i32 << random.random_range(0..31);
        let constant = 1i32 << random.random_range(0..31);
        let face = face(&mut random, |random| match round % 3 {
            0 => constant,
            1 => random.random_range(1..=i32::MAX),
            _ => random.random_range(1..=i32::MAX) >> random.random_range(0..31) | 1,
        });
        Scene::draw(near, &[(1, &face)]).check_depth(&face);
    }
}

/// Triangles of a whole guard band, and small ones.
#[test]
fn huge_and_small_triangles() {
    let mut random = seeded(72);
    for round in 0..600 {
        let mut face = face(&mut random, anywhere);
        face.corners = if round % 2 == 0 {
            [0; 3].map(|_| [0; 2].map(|_| random.random_range(-GUARD..=GUARD)))
        } else {
            [0; 3].map(|_| [0; 2].map(|_| 7_000 + random.random_range(-2_048..2_048)))
        };
        Scene::draw(65_536, &[(1, &face)]).check_depth(&face);
    }
    // Of nearly one depth too, with the first corner within the others' box and not.
    for round in 0..3_000 {
        let size = [256, 600, 1_500, 4_095][round % 4];
        let most = [1.0, 1.001, 1.02, 1.1][round / 4 % 4];
        let w = f64::from(anywhere(&mut random));
        let face = Face {
            corners: [0; 3].map(|_| [0; 2].map(|_| 6_000 + random.random_range(0..size))),
            w: [0; 3].map(|_| (w * random.random_range(1.0..=most)) as i32),
        };
        Scene::draw(65_536, &[(1, &face)]).check_depth(&face);
    }
}

/// Of two faces the nearer is seen, whichever is drawn first; they intersect in most cases. In
/// between, where the depths cannot be told apart, one of the two is seen.
#[test]
fn the_nearer_is_seen_in_either_order() {
    let mut random = seeded(73);
    let (mut compared, mut close) = (0, 0);
    for _ in 0..500 {
        let faces = [face(&mut random, anywhere), face(&mut random, anywhere)];
        let [first, second] = &faces;
        let orders = [[(1, first), (2, second)], [(2, second), (1, first)]];
        for order in orders {
            let scene = Scene::draw(65_536, &order);
            for (x, y) in positions() {
                let (seen, _) = scene.at(x, y);
                let depths = faces.map(|f| f.depth(65_536, x, y));
                match faces.map(|f| f.covers(x, y)) {
                    [false, false] => assert_eq!(seen, 0),
                    [true, false] => assert_eq!(seen, 1),
                    [false, true] => assert_eq!(seen, 2),
                    [true, true] if (depths[0] - depths[1]).abs() <= separate(&faces, 65_536) => {
                        close += 1;
                        assert!(seen == 1 || seen == 2);
                    }
                    [true, true] => {
                        compared += 1;
                        let nearer = if depths[0] > depths[1] { 1 } else { 2 };
                        assert_eq!(seen, nearer, "{order:?} at column {x}, row {y}: {depths:?}");
                    }
                }
            }
        }
    }
    println!("compared {compared}, too close {close}");
    assert!(compared > 100_000 && close < compared / 100);
}

/// Two planes that meet in a line: the picture changes at the line, and nowhere farther from it
/// than the depths need to differ by, over the gradient of the difference.
#[test]
fn intersecting_planes_switch_at_the_line() {
    let big = |w: [i32; 3]| Face {
        corners: [[-20_000, -20_000], [80_000, -20_000], [-20_000, 80_000]],
        w,
    };
    let near = 65_536;
    let mut random = seeded(74);
    let mut sharp = 0;
    for _ in 0..300 {
        let faces = [0; 2].map(|_| big([0; 3].map(|_| anywhere(&mut random))));
        let difference = |x, y| faces[0].depth(near, x, y) - faces[1].depth(near, x, y);
        let (dx, dy) = (
            difference(1, 0) - difference(0, 0),
            difference(0, 1) - difference(0, 0),
        );
        let slope = dx.hypot(dy);
        // Pixels: the resolution. Gradients of D are large, 65532 over some hundred pixels, so
        // that it is mostly a small part of a pixel.
        let resolution = separate(&faces, near) / slope;
        sharp += u32::from(resolution < 0.1);
        let [first, second] = &faces;
        for order in [[(1, first), (2, second)], [(2, second), (1, first)]] {
            let scene = Scene::draw(near, &order);
            for (x, y) in positions() {
                let distance = difference(x, y) / slope;
                let (seen, _) = scene.at(x, y);
                if distance.abs() > resolution {
                    let nearer = if distance > 0.0 { 1 } else { 2 };
                    assert_eq!(
                        seen, nearer,
                        "{order:?} at column {x}, row {y}, {distance} px from the line"
                    );
                }
            }
        }
    }
    assert!(sharp > 250);
}

/// Of equal depths the first drawn stays: the same face again, and other faces at one depth.
#[test]
fn equal_depths_keep_the_first() {
    let mut random = seeded(75);
    for round in 0..500 {
        let first = face(&mut random, anywhere);
        let second = if round % 2 == 0 {
            first
        } else {
            face(&mut random, anywhere)
        };
        let (mut first, mut second) = (first, second);
        if round % 2 == 1 {
            // One depth everywhere: planes without slope have no error at all.
            let w = anywhere(&mut random);
            (first.w, second.w) = ([w; 3], [w; 3]);
        }
        let scene = Scene::draw(65_536, &[(1, &first), (2, &second)]);
        for (x, y) in positions() {
            if first.covers(x, y) {
                assert_eq!(scene.at(x, y).0, 1, "{first:?}, {second:?}");
            } else if second.covers(x, y) {
                assert_eq!(scene.at(x, y).0, 2, "{first:?}, {second:?}");
            }
        }
    }
}

/// An empty buffer is 0, and anything is in front of it: the farthest point there is, with the
/// smallest near distance.
#[test]
fn anything_is_nearer_than_empty() {
    assert_eq!(Z16::EMPTY, 0);
    let face = Face {
        corners: [[-5_000, -5_000], [60_000, -5_000], [-5_000, 60_000]],
        w: [i32::MAX; 3],
    };
    let scene = Scene::draw(1, &[(1, &face)]);
    assert!(scene.check_depth(&face) > 1_000);
}
