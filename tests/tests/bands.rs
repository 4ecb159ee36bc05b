//! A frame drawn as bands, of any height and any stride, is bit for bit the frame drawn at once,
//! with every strategy, with and without a depth buffer.

use std::cell::Cell;

use multum::depth::{Depth, NoDepth, Z16};
use multum::draw::Pipeline;
use multum::fixed::types::{I16F16, I24F8};
use multum::perspective::{
    Adaptive, Affine, AffineWithin, ConstantZ, ConstantZColumns, Every, Extrapolated, PerPixel,
    Quadratic, Strategy, Subdivided,
};
use multum::project::ScreenVertex;
use multum::sample::Nearest;
use multum::setup::Cull;
use multum::sink::{Band, PixelSink as _};
use multum::span::Span;
use multum::texture::{Mirror, Repeat, Texture};
use rand::Rng as _;
use tests::GUARD;
use tests::random::{Rng, seeded};

const WIDTH: u32 = 97;
const HEIGHT: u32 = 83;

/// Band heights; the last is the frame at once.
const HEIGHTS: [u32; 7] = [1, 2, 3, 7, 16, 64, 240];

/// What no triangle writes.
const BLANK: u16 = 0xffff;

type Triangle = [ScreenVertex; 3];

/// From tiny ones to some far larger than the screen, in depths of up to 1:100.
fn triangle(random: &mut Rng) -> Triangle {
    let size = [2, 20, 60, 300, 2_000][random.random_range(0..5)] * 256;
    let middle = [WIDTH, HEIGHT].map(|side| random.random_range(-2_560..256 * side as i32 + 2_560));
    let repeats = [0, 1, 4, 60][random.random_range(0..4)] * 65_536;
    [0; 3].map(|_| {
        let [x, y] = middle.map(|c| {
            let c = c + random.random_range(-size / 2..=size / 2);
            I24F8::from_bits(c.clamp(-GUARD, GUARD))
        });
        let w = (random.random_range(0.0f64..100.0f64.ln())).exp();
        let uv = [0; 2].map(|_| I16F16::from_bits(random.random_range(-repeats..=repeats)));
        ScreenVertex::new(x, y, I16F16::from_num(w), uv).expect("a vertex")
    })
}

/// How a frame is cut.
#[derive(Clone, Copy, Debug)]
struct Cut {
    rows: u32,
    /// Pixels from one row to the next, for the picture and for the depths.
    strides: [usize; 2],
}

/// A depth test that a band can be given.
trait BandDepth {
    type Test<'a>: Depth;

    fn of<'a>(buffer: &'a mut [u16], rows: u32, stride: usize, top: u32) -> Self::Test<'a>;
}

struct Without;

impl BandDepth for Without {
    type Test<'a> = NoDepth;

    fn of(_: &mut [u16], _: u32, _: usize, _: u32) -> NoDepth {
        NoDepth
    }
}

struct With;

impl BandDepth for With {
    type Test<'a> = Z16<'a>;

    fn of<'a>(buffer: &'a mut [u16], rows: u32, stride: usize, top: u32) -> Z16<'a> {
        let band = Band::new(buffer, WIDTH, rows, stride, top).expect("a band");
        let mut depth = Z16::new(band, I16F16::ONE);
        depth.clear();
        depth
    }
}

/// Draws the frame band by band; gives its pixels, row by row. What lies between the rows must
/// stay as it was.
fn frame<P: Strategy + Copy, D: BandDepth>(
    strategy: P,
    texture: Texture<'_, u16>,
    triangles: &[Triangle],
    cut: Cut,
) -> Vec<u16> {
    let [stride, depth_stride] = cut.strides;
    let mut frame = Vec::new();
    let mut top = 0;
    while top < HEIGHT {
        let rows = cut.rows.min(HEIGHT - top);
        let mut pixels = vec![BLANK; stride * rows as usize];
        let mut depths = vec![BLANK; depth_stride * rows as usize];
        let mut band = Band::new(&mut pixels, WIDTH, rows, stride, top).expect("a band");
        let mut pipeline = Pipeline {
            strategy,
            sampler: Nearest::<_, Repeat, Mirror>::new(texture),
            depth: D::of(&mut depths, rows, depth_stride, top),
            cull: Cull::Off,
        };
        for triangle in triangles {
            pipeline.draw_triangle(&mut band, triangle);
        }
        drop(pipeline);
        frame.extend(band.rows().flatten());
        for (buffer, stride) in [(&pixels, stride), (&depths, depth_stride)] {
            for row in buffer.chunks(stride) {
                let gap = &row[WIDTH as usize..];
                assert!(gap.iter().all(|&c| c == BLANK), "written beside a row");
            }
        }
        top += rows;
    }
    frame
}

fn check<P: Strategy + Copy, D: BandDepth>(strategy: P) {
    let texels: Vec<u16> = (0..64 * 32).collect();
    let texture = Texture::new(&texels, 64, 32).expect("a texture");
    let mut random = seeded(61);
    for _ in 0..150 {
        let triangles: Vec<Triangle> = (0..12).map(|_| triangle(&mut random)).collect();
        let width = WIDTH as usize;
        let whole = Cut {
            rows: HEIGHT,
            strides: [width; 2],
        };
        let expected = frame::<P, D>(strategy, texture, &triangles, whole);
        assert!(expected.iter().any(|&c| c != BLANK));
        for rows in HEIGHTS {
            let strides = [0; 2].map(|_| width + random.random_range(0..40));
            let cut = Cut { rows, strides };
            let found = frame::<P, D>(strategy, texture, &triangles, cut);
            let first = expected.iter().zip(&found).position(|(a, b)| a != b);
            assert_eq!(first, None, "pixel that differs in {cut:?}: {triangles:?}");
            assert_eq!(found.len(), expected.len());
        }
    }
}

/// Without and with a depth buffer.
fn check_both<P: Strategy + Copy>(strategy: P) {
    check::<P, Without>(strategy);
    check::<P, With>(strategy);
}

#[test]
fn affine() {
    check_both(Affine);
}

#[test]
fn every_4() {
    check_both(Every::<4>);
}

#[test]
fn every_8() {
    check_both(Every::<8>);
}

#[test]
fn every_16() {
    check_both(Every::<16>);
}

#[test]
fn every_32() {
    check_both(Every::<32>);
}

#[test]
fn every_64() {
    check_both(Every::<64>);
}

#[test]
fn per_pixel() {
    check_both(PerPixel);
}

#[test]
fn affine_within() {
    for bound in [0.0, 0.25, 8.0] {
        check_both(AffineWithin::new(Every::<16>, I16F16::from_num(bound)));
    }
}

#[test]
fn adaptive() {
    for bound in [0.0, 0.25, 8.0] {
        check_both(Adaptive::new(I16F16::from_num(bound), (6, 5)));
    }
}

#[test]
fn constant_z() {
    check_both(ConstantZ);
}

#[test]
fn constant_z_columns() {
    let columns = [const { Cell::new(0) }; WIDTH as usize];
    check_both(ConstantZColumns::new(&columns));
}

#[test]
fn quadratic_16() {
    check_both(Quadratic::<16>);
}

#[test]
fn quadratic_32() {
    check_both(Quadratic::<32>);
}

#[test]
fn extrapolated() {
    check_both(Extrapolated);
}

#[test]
fn subdivided() {
    check_both(Subdivided::new(Subdivided::DEFAULT_BOUND, (6, 5)));
}

/// Spans beside a band, or none, have no pixels, also where the buffer goes on; those inside are where they
/// should be.
#[test]
fn a_band_has_its_own_spans_only() {
    const TOP: i32 = 3;
    const STRIDE: usize = 7;
    // Five columns and two rows, in a buffer of six.
    let mut pixels: [u16; 6 * STRIDE] = std::array::from_fn(|i| i as u16);
    let mut band = Band::new(&mut pixels, 5, 2, STRIDE, TOP as u32).expect("a band");
    let mut found = |y, left, right| band.span(Span { y, left, right }).map(|p| p.to_vec());
    for y in [TOP, TOP + 1] {
        for (left, right) in [(0, 5), (0, 1), (4, 5), (2, 4)] {
            let first = (y - TOP) as u16 * STRIDE as u16;
            let expected = (first + left as u16..first + right as u16).collect();
            assert_eq!(
                found(y, left, right),
                Some(expected),
                "{y}: {left} .. {right}"
            );
        }
    }
    for y in [i32::MIN, -1, 0, TOP - 1, TOP + 2, TOP + 3, i32::MAX] {
        assert_eq!(found(y, 0, 5), None, "{y}");
    }
    let beside = [
        (-1, 5),
        (0, 6),
        (4, 6),
        (5, 6),
        (2, 2),
        (3, 2),
        (i32::MIN, 5),
        (0, i32::MAX),
        (i32::MAX, i32::MIN),
    ];
    for (left, right) in beside {
        assert_eq!(found(TOP, left, right), None, "{left} .. {right}");
    }
}
