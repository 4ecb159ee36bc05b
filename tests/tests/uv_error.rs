//! Texture coordinates against float64: every strategy keeps the bound that its arithmetic gives.

use std::sync::Arc;

use host_sim::choice::Perspective;
use host_sim::frame::{Batch, Frame, ScreenTriangle};
use host_sim::pattern;
use host_sim::reference::{Beyond, Planes, Sample};
use host_sim::render::{divisions, fragments, spans};
use host_sim::scene::Subject;
use multum::fixed::types::{I16F16, I24F8};
use multum::project::ScreenVertex;
use multum::setup::Cull;
use multum::span::Span;
use multum::viewport::Viewport;
use rand::Rng as _;
use tests::random::seeded;
use tests::tolerance;

const BENCHMARKS: [&str; 6] = ["wall", "floor", "receding", "oblique", "tilted", "mesh"];
const WORLD: [&str; 5] = ["crate", "corridor", "sidewalk", "checkers", "room"];

fn frame(name: &str) -> Frame {
    let viewport = Viewport::new(320, 240).expect("a size in range");
    let mut frame = Subject::by_name(name)
        .and_then(|s| s.frame(viewport))
        .expect("a built-in scene");
    // Without a depth buffer every triangle's own pixels can be told by its number.
    frame.depth = false;
    frame
}

/// Single triangles, seeded: small to larger than the screen, depths from 1:1 to 1:4096, and from
/// no to 64 repeats.
fn hard() -> impl Iterator<Item = Frame> {
    let mut random = seeded(303);
    (0..240).map(move |i| {
        let size = [8, 60, 300, 1_500][i % 4] * 256;
        let depths = [1.001f64, 1.1, 4.0, 64.0, 4096.0][i % 5];
        let repeats = [0, 1, 4, 60][i / 4 % 4] * 65_536;
        let vertices = [0; 3].map(|_| {
            let [x, y] = [160, 120].map(|c| {
                let c = c * 256 + random.random_range(-size / 2..=size / 2);
                I24F8::from_bits(c)
            });
            let w = random.random_range(0.0..=depths.ln()).exp();
            let uv = [0; 2].map(|_| I16F16::from_bits(random.random_range(-repeats..=repeats)));
            ScreenVertex::new(x, y, I16F16::from_num(w), uv).expect("a vertex in range")
        });
        Frame {
            viewport: Viewport::new(320, 240).expect("a size in range"),
            near: I16F16::ONE,
            cull: Cull::Off,
            depth: false,
            batches: vec![Batch {
                picture: Arc::new(pattern::coordinates()),
                wrap: Beyond::Repeat,
                triangles: vec![ScreenTriangle {
                    unsnapped: vertices.map(|v| [v.x().to_num(), v.y().to_num()]),
                    vertices,
                }],
            }],
        }
    })
}

fn scenes_and_hard_cases() -> impl Iterator<Item = (String, Frame)> {
    let scenes = BENCHMARKS.into_iter().chain(WORLD);
    let hard = hard().enumerate().map(|(i, f)| (format!("hard {i}"), f));
    scenes
        .map(|name| (name.to_owned(), frame(name)))
        .chain(hard)
}

/// Calls `check` for every visible pixel with its place in its span, what the core gave for u
/// and v, in repeats, and the triangle.
fn for_each_pixel(
    frame: &Frame,
    perspective: Perspective,
    mut check: impl FnMut(&Pixel<'_>),
) -> usize {
    let (width, height) = (frame.viewport.width(), frame.viewport.height());
    let seen = fragments(frame, perspective).expect("a frame in range");
    let mut count = 0;
    for (number, (batch, triangle)) in frame.triangles().enumerate() {
        let Some(planes) = Planes::new(&triangle.corners()) else {
            continue;
        };
        let size = [batch.picture.width(), batch.picture.height()].map(f64::from);
        for span in spans(&triangle.vertices, width, height, frame.cull) {
            for x in span.left..span.right {
                let i = span.y as usize * width as usize + x as usize;
                let Some(fragment) = seen[i].filter(|f| f.triangle as usize == number) else {
                    continue;
                };
                let uv = [fragment.uv.u, fragment.uv.v]
                    .map(|c| f64::from(c.to_bits()) / f64::from(1 << 24));
                check(&Pixel {
                    x,
                    span,
                    uv,
                    planes: &planes,
                    triangle,
                    size,
                });
                count += 1;
            }
        }
    }
    count
}

struct Pixel<'a> {
    x: i32,
    span: Span,
    uv: [f64; 2],
    planes: &'a Planes,
    triangle: &'a ScreenTriangle,
    size: [f64; 2],
}

impl Pixel<'_> {
    fn sample(&self, x: i32) -> Sample {
        self.planes
            .at(f64::from(x) + 0.5, f64::from(self.span.y) + 0.5)
    }

    /// Distance from float64 along one axis, in repeats.
    fn error(&self, axis: usize) -> f64 {
        (self.uv[axis] - self.sample(self.x).uv[axis]).abs()
    }

    /// The arithmetic's own bound along one axis, in repeats.
    fn arithmetic(&self, axis: usize) -> f64 {
        tolerance::exact(&self.triangle.corners(), axis)
    }
}

/// The farthest that a hyperbola bends away from its chord between two samples, in repeats.
fn chord(a: &Sample, b: &Sample, axis: usize) -> f64 {
    let root = (a.w.max(b.w) / a.w.min(b.w)).sqrt();
    (a.uv[axis] - b.uv[axis]).abs() * (root - 1.0) / (root + 1.0)
}

fn extremes(values: [f64; 3]) -> [f64; 2] {
    [
        values.iter().copied().fold(f64::MIN, f64::max),
        values.iter().copied().fold(f64::MAX, f64::min),
    ]
}

#[test]
fn exact_keeps_to_its_error_budget_and_to_a_64th_of_a_texel() {
    for name in BENCHMARKS.into_iter().chain(WORLD) {
        let count = for_each_pixel(&frame(name), Perspective::Exact, |p| {
            for axis in [0, 1] {
                let (error, bound) = (p.error(axis), p.arithmetic(axis));
                assert!(
                    error <= bound,
                    "{name} at {},{}: {error} > {bound}",
                    p.x,
                    p.span.y
                );
                let texels = error * p.size[axis];
                assert!(
                    texels <= 1.0 / 64.0,
                    "{name} at {},{}: {texels}",
                    p.x,
                    p.span.y
                );
            }
        });
        assert!(count > 14_000, "{name}: {count}");
    }
}

#[test]
fn every_n_keeps_to_the_chord_of_its_pieces() {
    for (name, n) in BENCHMARKS
        .into_iter()
        .chain(WORLD)
        .flat_map(|name| [4, 8, 16, 32, 64].map(|n| (name, n)))
    {
        for_each_pixel(&frame(name), Perspective::Every(n), |p| {
            // Pieces end at columns that are multiples of n and at both ends of the span.
            let n = n.cast_signed();
            let start = (p.x - p.x.rem_euclid(n)).max(p.span.left);
            let end = (p.x - p.x.rem_euclid(n) + n).min(p.span.right - 1);
            let (a, b) = (p.sample(start), p.sample(end));
            for axis in [0, 1] {
                let bound = chord(&a, &b, axis) + p.arithmetic(axis) + tolerance::stepping(n);
                let error = p.error(axis);
                assert!(
                    error <= bound,
                    "{name} at {},{}: {error} > {bound}",
                    p.x,
                    p.span.y
                );
                // What is added to the chord is below 1/32 texel, as promised to users.
                let added = (bound - chord(&a, &b, axis)) * p.size[axis];
                assert!(added < 1.0 / 32.0, "{name} every:{n}: {added}");
            }
        });
    }
}

#[test]
fn affine_keeps_to_the_chord_of_the_triangle() {
    for name in BENCHMARKS.into_iter().chain(WORLD) {
        for_each_pixel(&frame(name), Perspective::Affine, |p| {
            // A coordinate is a mean of the corners' values, with the barycentric weights for
            // the affine one and the same times 1/w for the correct one. No set of corners
            // gains more weight by that than (sqrt r - 1) / (sqrt r + 1), r being the ratio of
            // depths, so the mean moves by no more than that part of the range.
            let corners = p.triangle.corners();
            let [farthest, nearest] = extremes(corners.w);
            let root = (farthest / nearest).sqrt();
            for axis in [0, 1] {
                let [most, least] = extremes(corners.uv.map(|uv| uv[axis]));
                let bend = (most - least) * (root - 1.0) / (root + 1.0);
                let length = p.span.right - p.span.left;
                let bound = bend + p.arithmetic(axis) + tolerance::stepping(length);
                let error = p.error(axis);
                assert!(
                    error <= bound,
                    "{name} at {},{}: {error} > {bound}",
                    p.x,
                    p.span.y
                );
            }
        });
    }
}

#[test]
fn a_division_every_16_pixels_is_exact_where_depth_is_constant_along_a_line() {
    for_each_pixel(&frame("floor"), Perspective::Every(16), |p| {
        for axis in [0, 1] {
            let bound = p.arithmetic(axis) + tolerance::stepping(16);
            assert!(p.error(axis) <= bound);
        }
    });
}

#[test]
fn adaptive_keeps_its_bound_everywhere() {
    for (name, frame) in scenes_and_hard_cases() {
        for bound in [0.0, 1.0 / 16.0, 0.25, 2.0] {
            let perspective = Perspective::Adaptive(I16F16::from_num(bound));
            for_each_pixel(&frame, perspective, |p| {
                let allowed = bound * p.sample(p.x).footprint(p.size).max(1.0);
                for axis in [0, 1] {
                    // Two divisions measure the scanline, one or a mean of two gives the
                    // coordinate.
                    let arithmetic = 3.0 * p.arithmetic(axis) * p.size[axis];
                    let error = p.error(axis) * p.size[axis];
                    assert!(
                        error <= allowed + arithmetic + 1.0 / 32.0,
                        "{name} at {},{}, bound {bound}: {error} texels",
                        p.x,
                        p.span.y
                    );
                }
            });
        }
    }
}

#[test]
fn adaptive_divides_less_often_than_every_16_pixels() {
    // In the corridor, where every:16 is 3.8 footprints off, the bound takes a few more.
    for (name, most) in [("floor", 1.0), ("room", 1.0), ("corridor", 1.05)] {
        let frame = frame(name);
        let adaptive = divisions(&frame, "adaptive".parse().expect("a strategy"));
        let every = divisions(&frame, Perspective::Every(16));
        assert!(
            (adaptive as f64) < most * every as f64,
            "{name}: {adaptive} against {every}"
        );
    }
}

#[test]
fn adaptive_divides_twice_along_a_scanline_of_constant_depth() {
    let frame = frame("wall");
    let lines: usize = frame
        .triangles()
        .map(|(_, t)| spans(&t.vertices, 320, 240, frame.cull))
        .flatten()
        .map(|s| if s.right - s.left > 1 { 2 } else { 1 })
        .sum();
    let adaptive = divisions(&frame, "adaptive".parse().expect("a strategy"));
    assert_eq!(adaptive, lines as u64);
}

/// Checks every pixel of all scenes and hard cases against `bound` in repeats, to which the
/// arithmetic's own and a step's rounding over `steps` pixels are added.
fn check_bound(perspective: Perspective, share: f64, bound: impl Fn(&Pixel<'_>, usize) -> f64) {
    for (name, frame) in scenes_and_hard_cases() {
        for_each_pixel(&frame, perspective, |p| {
            for axis in [0, 1] {
                let allowed = bound(p, axis) + share * p.arithmetic(axis);
                let error = p.error(axis);
                assert!(
                    error <= allowed,
                    "{name} {perspective} at {},{}: {error} > {allowed}",
                    p.x,
                    p.span.y
                );
            }
        });
    }
}

/// The bound of a division every 16 pixels, to which others fall back.
fn every_16(p: &Pixel<'_>, axis: usize) -> f64 {
    let start = (p.x - p.x.rem_euclid(16)).max(p.span.left);
    let end = (p.x - p.x.rem_euclid(16) + 16).min(p.span.right - 1);
    chord(&p.sample(start), &p.sample(end), axis) + tolerance::stepping(16)
}

#[test]
fn constant_z_keeps_to_its_tangent() {
    check_bound(Perspective::ConstantZ, 1.0, |p, axis| {
        let (first, last) = (p.span.left, p.span.right - 1);
        let [a, b] = [first, last].map(|x| 1.0 / p.sample(x).w);
        let changes = (a - b).abs() / a.min(b);
        let (here, middle) = (p.sample(p.x), p.sample(first + (last - first) / 2));
        let tangent = (here.uv[axis] - middle.uv[axis]).abs() * (middle.w / here.w - 1.0).abs()
            + p.arithmetic(axis)
            + tolerance::stepping(last - first);
        // Near the tolerance rounding decides.
        if changes < 0.999 / 256.0 {
            tangent
        } else if changes > 1.001 / 256.0 {
            every_16(p, axis)
        } else {
            tangent.max(every_16(p, axis))
        }
    });
}

#[test]
fn constant_z_divides_once_along_a_scanline_of_constant_depth() {
    for (name, perspective, most) in [
        // Two triangles; the diagonal's columns and rows belong to both.
        ("floor", Perspective::ConstantZ, 2 * 240),
        ("receding", Perspective::ConstantZColumns, 2 * 320),
    ] {
        let frame = frame(name);
        let found = divisions(&frame, perspective);
        assert!(found <= most, "{name} {perspective}: {found}");
        for_each_pixel(&frame, perspective, |p| {
            for axis in [0, 1] {
                let length = p.span.right - p.span.left;
                let bound = 2.0 * p.arithmetic(axis) + tolerance::stepping(length);
                assert!(p.error(axis) <= bound, "{name} at {},{}", p.x, p.span.y);
            }
        });
    }
}

#[test]
fn constant_z_columns_keep_to_their_tolerance() {
    check_bound(Perspective::ConstantZColumns, 1.0, |p, axis| {
        let corners = p.triangle.corners();
        let [most, least] = extremes(corners.uv.map(|uv| uv[axis]));
        let units = ((most - least) * 65536.0).round() as u64;
        let range = (units + 1).next_power_of_two() as f64 / 65536.0;
        (range / 16384.0).max(every_16(p, axis))
    });
}

#[test]
fn quadratic_keeps_to_its_parabola() {
    for n in [16, 32] {
        check_bound(Perspective::Quadratic(n), 1.7, |p, axis| {
            let n = n.cast_signed();
            let start = (p.x - p.x.rem_euclid(n)).max(p.span.left);
            let end = (p.x - p.x.rem_euclid(n) + n).min(p.span.right - 1);
            let (steps, t) = (end - start, p.x - start);
            if steps <= 1 {
                return tolerance::stepping(1);
            }
            let middle = steps / 2;
            let [a, m, b, here] = [start, start + middle, end, p.x].map(|x| p.sample(x));
            let du = (a.uv[axis] - b.uv[axis]).abs();
            let slope = (1.0 / a.w - 1.0 / b.w) / f64::from(steps);
            let product = f64::from((t * (t - middle) * (t - steps)).abs());
            let parabola = du * slope * slope * product / f64::from(steps) * m.w * here.w;
            parabola + du / f64::from(1 << 24) + tolerance::stepping(1)
        });
    }
}

#[test]
fn extrapolated_keeps_to_its_lock() {
    check_bound(Perspective::Extrapolated, 1.0, |p, axis| {
        let corners = p.triangle.corners();
        let [most, least] = extremes(corners.uv.map(|uv| uv[axis]));
        let units = ((most - least) * 65536.0).round() as u64;
        let range = (units + 1).next_power_of_two() as f64 / 65536.0;
        range * (f64::from(-22).exp2() + f64::from(-29).exp2())
    });
}

#[test]
fn subdivided_keeps_its_bound_everywhere() {
    for bound in [0.5, 4.0] {
        let perspective = Perspective::Subdivided(I16F16::from_num(bound));
        check_bound(perspective, 2.0, |p, axis| {
            let length = p.span.right - p.span.left;
            bound / p.size[axis] + f64::from(-19).exp2() + tolerance::stepping(length)
        });
    }
}
