//! Coverage of random and nasty triangles, pixel by pixel, against the exact rule.
//!
//! Each generator is named for what it stresses. There is no tolerance: coverage is exact in the
//! snapped positions, so one wrong pixel fails the test.

use rand::Rng as _;
use tests::exact::Triangle;
use tests::frame::Spans;
use tests::random::{Rng, seeded};
use tests::{GUARD, Point, at, flat};

type Corners = [Point; 3];

/// Draws a triangle in both windings and compares every pixel of its box with the rule.
fn check(corners: Corners, frame: &mut Spans) {
    let (width, height) = frame.size();
    let [a, b, c] = corners;
    let range = |axis: usize, size: i32| {
        let low = a[axis].min(b[axis]).min(c[axis]).div_euclid(256);
        let high = a[axis].max(b[axis]).max(c[axis]).div_euclid(256) + 1;
        low.clamp(0, size)..high.clamp(0, size)
    };
    let (columns, rows) = (range(0, width), range(1, height));
    for order in [[a, b, c], [c, b, a]] {
        frame.clear();
        flat(1).draw_triangle(frame, &order.map(at));
        let Some(triangle) = Triangle::new(order) else {
            assert_eq!(frame.drawn(), 0, "{order:?} has no area");
            continue;
        };
        let mut drawn = 0;
        for y in rows.clone() {
            let (left, right) = frame.span(y);
            if left < right {
                drawn += 1;
                assert!(
                    columns.start <= left && right <= columns.end,
                    "{order:?}: row {y} is drawn from {left} to {right}"
                );
            }
            for x in columns.clone() {
                assert_eq!(
                    left <= x && x < right,
                    triangle.covers(x, y),
                    "{order:?} at column {x}, row {y}, drawn from {left} to {right}"
                );
            }
        }
        assert_eq!(frame.drawn(), drawn, "{order:?} is drawn beyond its rows");
    }
}

/// Checks `count` triangles of a generator, which gets the frame's size in subpixels.
fn run(
    seed: u64,
    count: u32,
    (width, height): (i32, i32),
    mut generate: impl FnMut(&mut Rng, Point) -> Corners,
) {
    let mut random = seeded(seed);
    let mut frame = Spans::new(width, height);
    for _ in 0..count {
        let corners = generate(&mut random, [256 * width, 256 * height]);
        check(corners, &mut frame);
    }
}

const SMALL: (i32, i32) = (16, 12);
const LARGE: (i32, i32) = (1024, 1024);

/// Anywhere in the frame or up to `margin` subpixels beside it.
fn within(random: &mut Rng, size: Point, margin: i32) -> Point {
    size.map(|size| random.random_range((-margin).max(-GUARD)..=(size + margin).min(GUARD)))
}

/// The nearest point inside the guard band.
fn keep(p: Point) -> Point {
    p.map(|c| c.clamp(-GUARD, GUARD))
}

/// A pixel centre in the frame or up to `margin` subpixels beside it.
fn centre(random: &mut Rng, size: Point, margin: i32) -> Point {
    within(random, size, margin).map(|c| (c.min(GUARD - 1) & !255) + 128)
}

/// A vector of random scale, up to 8 px.
fn vector(random: &mut Rng) -> Point {
    let scale = 1 << random.random_range(0..12);
    [0; 2].map(|_: i32| random.random_range(-scale..=scale))
}

fn anywhere(margin: i32) -> impl FnMut(&mut Rng, Point) -> Corners {
    move |random, size| [0; 3].map(|_| within(random, size, margin))
}

#[test]
fn inside_the_frame() {
    run(1, 300_000, SMALL, anywhere(0));
}

#[test]
fn partly_off_screen() {
    run(2, 200_000, SMALL, anywhere(20 * 256));
    run(3, 100_000, SMALL, anywhere(200 * 256));
}

#[test]
fn up_to_the_guard_band() {
    run(4, 100_000, SMALL, anywhere(GUARD));
    // Corners on the rim itself: the longest edges that there are.
    run(5, 100_000, SMALL, |random, size| {
        [0; 3].map(|_| {
            within(random, size, GUARD).map(|c| match random.random_range(0..4) {
                0 => GUARD,
                1 => -GUARD,
                _ => c,
            })
        })
    });
}

/// Few different positions: many centres lie exactly on edges.
#[test]
fn on_a_coarse_grid() {
    for (seed, step) in [(6, 32), (7, 64), (8, 128), (9, 256)] {
        run(seed, 100_000, SMALL, |random, size| {
            [0; 3].map(|_| within(random, size, 1024).map(|c| c / step * step))
        });
    }
}

#[test]
fn corners_on_centres() {
    run(10, 200_000, SMALL, |random, size| {
        [0; 3].map(|_| centre(random, size, 1024))
    });
}

/// Edges that run through a centre without a corner on one.
#[test]
fn edges_through_centres() {
    run(11, 200_000, SMALL, |random, size| {
        let [x, y] = centre(random, size, 0);
        let [dx, dy] = vector(random);
        let (k, m) = (random.random_range(1..8), random.random_range(1..8));
        [
            [x - k * dx, y - k * dy],
            [x + m * dx, y + m * dy],
            within(random, size, 2048),
        ]
    });
}

/// Smaller than two pixels: most cover no centre, or one.
#[test]
fn tiny() {
    for (seed, extent) in [(12, 512), (13, 256), (14, 16), (15, 2)] {
        run(seed, 200_000, SMALL, |random, size| {
            // Around a centre, so that the smallest still have something to hit.
            let middle = centre(random, size, 512);
            [0; 3].map(|_| middle.map(|c| c + random.random_range(-extent / 2..=extent / 2)))
        });
    }
}

/// A long edge through the frame, and a third corner one subpixel from one of its ends.
fn sliver(random: &mut Rng, size: Point) -> Corners {
    let [x, y] = within(random, size, 0);
    let length = f64::from(random.random_range(256..=2000 * 256));
    let (sin, cos) = match random.random_range(0..8) {
        0 => (0.0, 1.0),
        1 => (1.0, 0.0),
        2 => (1.0 / 256.0, 1.0),
        3 => (1.0, -1.0 / 256.0),
        _ => random.random_range(0.0..std::f64::consts::TAU).sin_cos(),
    };
    let along = |t: f64| keep([x + (t * length * cos) as i32, y + (t * length * sin) as i32]);
    let t = random.random_range(0.0..1.0);
    let (a, b) = (along(-t), along(1.0 - t));
    let [dx, dy] = [[0, 1], [1, 0], [0, -1], [-1, 0]][random.random_range(0..4)];
    [a, b, keep([b[0] + dx, b[1] + dy])]
}

#[test]
fn slivers_one_subpixel_wide_and_up_to_2000_pixels_long() {
    run(16, 200_000, SMALL, sliver);
    run(17, 100, LARGE, sliver);
}

/// No area at all: nothing is drawn.
#[test]
fn degenerate() {
    run(18, 100_000, SMALL, |random, size| {
        // Multiples of one vector from one point: collinear, and often identical.
        let [x, y] = within(random, size, 256);
        let [dx, dy] = vector(random);
        [0; 3].map(|_| {
            let k = random.random_range(-3..=3);
            [x + k * dx, y + k * dy]
        })
    });
    run(19, 10_000, SMALL, |random, size| {
        [centre(random, size, 0); 3]
    });
}

/// Right angles along the axes; sides on centres, on pixel borders and between.
#[test]
fn axis_aligned() {
    run(20, 200_000, SMALL, |random, size| {
        let [[x0, y0], [x1, y1]] = [0; 2].map(|_| {
            within(random, size, 1024).map(|c| match random.random_range(0..3) {
                0 => c & !255,
                1 => (c & !255) + 128,
                _ => c,
            })
        });
        [[x0, y0], [x1, y0], [x0, y1]]
    });
}

/// Frames as large as they get, and other shapes.
#[test]
fn large_and_narrow_frames() {
    run(21, 60, LARGE, anywhere(0));
    run(22, 60, LARGE, anywhere(GUARD));
    run(23, 3_000, (1024, 3), anywhere(2048));
    run(24, 3_000, (1, 1024), anywhere(2048));
    run(25, 20_000, (1, 1), anywhere(512));
}
