//! Meshes: every pixel whose centre is inside the outline is drawn exactly once, every other one
//! never, however the inside is cut into triangles.

use std::f64::consts::TAU;

use rand::Rng as _;
use tests::exact::{edge, outline_covers};
use tests::frame::{Frame, Overdraw};
use tests::random::{Rng, seeded};
use tests::{Point, at, flat};

/// Draws triangles and compares with their outline.
fn check(size: (i32, i32), triangles: &[[Point; 3]], outline: &[Point]) {
    let mut frame = Frame::new(size.0, size.1, 0, Overdraw::Panics);
    for triangle in triangles {
        flat(1).draw_triangle(&mut frame, &triangle.map(at));
    }
    for (x, y) in frame.positions() {
        let inside = outline_covers(outline, x, y);
        assert_eq!(frame.count(x, y), u32::from(inside), "column {x}, row {y}");
        // What the sink handed out was also written, all of it.
        assert_eq!(frame.pixel(x, y), u8::from(inside), "column {x}, row {y}");
    }
}

/// The corners of a rectangle, counter-clockwise as seen.
fn rectangle(low: Point, high: Point) -> [Point; 4] {
    [low, [low[0], high[1]], high, [high[0], low[1]]]
}

/// Quads over a rectangle, each cut along one of its diagonals.
fn grid(
    (columns, rows): (i32, i32),
    corner: impl Fn(i32, i32) -> Point,
    falling: impl Fn(i32, i32) -> bool,
) -> Vec<[Point; 3]> {
    (0..rows)
        .flat_map(|j| (0..columns).map(move |i| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b, c, d] =
                [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)].map(|(i, j)| corner(i, j));
            if falling(i, j) {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [d, b, c]]
            }
        })
        .collect()
}

/// A grid from `low` to `high` whose inner corners are moved about by less than a quarter of a
/// cell, so that no corner crosses a diagonal beside it.
fn jittered(
    random: &mut Rng,
    low: Point,
    high: Point,
    (columns, rows): (i32, i32),
) -> Vec<[Point; 3]> {
    let cell = [(high[0] - low[0]) / columns, (high[1] - low[1]) / rows];
    let corners: Vec<Point> = (0..=rows)
        .flat_map(|j| (0..=columns).map(move |i| (i, j)))
        .map(|(i, j)| {
            let mut coordinate = |axis: usize, k: i32, n: i32| {
                let jitter = cell[axis] / 4 - 1;
                if k == 0 {
                    low[axis]
                } else if k == n {
                    high[axis]
                } else {
                    low[axis] + k * cell[axis] + random.random_range(-jitter..=jitter)
                }
            };
            [coordinate(0, i, columns), coordinate(1, j, rows)]
        })
        .collect();
    let falling: Vec<bool> = corners.iter().map(|_| random.random()).collect();
    let index = |i: i32, j: i32| (j * (columns + 1) + i) as usize;
    let triangles = grid(
        (columns, rows),
        |i, j| corners[index(i, j)],
        |i, j| falling[index(i, j)],
    );
    for &[a, b, c] in &triangles {
        assert!(edge(a, b, c) < 0, "a triangle of the test folds over");
    }
    triangles
}

#[test]
fn jittered_grids() {
    let mut random = seeded(31);
    for _ in 0..40 {
        let low = [0; 2].map(|_| random.random_range(-2_000..5_000));
        let high = [0; 2].map(|_| random.random_range(15_000..40_000));
        let cells = (random.random_range(1..60), random.random_range(1..60));
        let triangles = jittered(&mut random, low, high, cells);
        check((128, 120), &triangles, &rectangle(low, high));
    }
}

/// Cells of a pixel and less: hardly any triangle has a pixel, and none may be lost.
#[test]
fn grids_finer_than_pixels() {
    let mut random = seeded(32);
    for cell in [16, 47, 128, 256, 300] {
        let low = [-100, -50];
        let n = 8_000 / cell;
        let high = low.map(|c| c + n * cell);
        let triangles = jittered(&mut random, low, high, (n, n));
        check((36, 36), &triangles, &rectangle(low, high));
    }
}

/// Triangles around an inner point, in every second case a pixel centre, out to a star.
#[test]
fn fans() {
    let mut random = seeded(33);
    let mut folded = 0;
    for round in 0..2_000 {
        let mut middle = [0; 2].map(|_| random.random_range(4_000..12_000));
        if round % 2 == 0 {
            middle = middle.map(|c| (c & !255) + 128);
        }
        let n = random.random_range(4..40);
        // In order, and less than 1.45 / 4 of a turn apart: the star does not fold.
        let outline: Vec<Point> = (0..n)
            .map(|i| {
                let angle = TAU * (f64::from(i) + random.random_range(0.0..0.45)) / f64::from(n);
                let radius = random.random_range(300.0..12_000.0);
                let (sin, cos) = angle.sin_cos();
                [
                    middle[0] + (radius * cos).round() as i32,
                    middle[1] + (radius * sin).round() as i32,
                ]
            })
            .collect();
        let next = outline.iter().cycle().skip(1);
        let triangles: Vec<_> = outline
            .iter()
            .zip(next)
            .map(|(&a, &b)| [middle, a, b])
            .collect();
        // Neighbours are at least 0.55 / 40 of a turn apart, 26 subpixels at the smallest
        // radius: rounding to the grid does not fold a triangle over.
        folded += triangles
            .iter()
            .filter(|&&[a, b, c]| edge(a, b, c) <= 0)
            .count();
        check((64, 64), &triangles, &outline);
    }
    assert_eq!(folded, 0);
}

/// A zigzag between an upper and a lower line, thick and thin, in alternating winding.
#[test]
fn strips() {
    let mut random = seeded(34);
    for round in 0..1_000 {
        let n = random.random_range(2..60);
        let thickness = if round % 2 == 0 { 4_000 } else { 40 };
        let mut x = random.random_range(-3_000..3_000);
        let points: Vec<Point> = (0..2 * n)
            .map(|i| {
                x += random.random_range(1..1_000);
                let side = random.random_range(1..thickness);
                [
                    x,
                    if i % 2 == 0 {
                        8_000 - side
                    } else {
                        8_000 + side
                    },
                ]
            })
            .collect();
        let upper = points.iter().step_by(2).copied();
        let lower = points.iter().skip(1).step_by(2).rev().copied();
        let outline: Vec<Point> = upper.chain(lower).collect();
        let triangles: Vec<_> = points.windows(3).map(|w| [w[0], w[1], w[2]]).collect();
        check((96, 64), &triangles, &outline);
    }
}

/// The benchmark mesh: 64 x 64 cells over a frame of 320 x 240, inner corners moved by a linear
/// congruential generator and snapped to the subpixel grid.
#[test]
fn benchmark_mesh() {
    let mut state: u32 = 12_345;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24)
    };
    let corners: Vec<Point> = (0..=64)
        .flat_map(|j| (0..=64).map(move |i| (i, j)))
        .map(|(i, j)| {
            let (mut x, mut y) = (5.0 * f64::from(i), 3.75 * f64::from(j));
            if (1..64).contains(&i) && (1..64).contains(&j) {
                x += (next() - 0.5) * 2.4;
                y += (next() - 0.5) * 1.8;
            }
            [x, y].map(|c| (c * 256.0).round() as i32)
        })
        .collect();
    // Triangles (a, a + 65, a + 66) and (a, a + 66, a + 1).
    let triangles = grid((64, 64), |i, j| corners[(j * 65 + i) as usize], |_, _| true);
    assert_eq!(triangles.len(), 8_192);
    let outline = rectangle([0, 0], [320 * 256, 240 * 256]);
    check((320, 240), &triangles, &outline);
}
