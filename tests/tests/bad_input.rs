//! Bad input gives an error value or draws nothing: never a panic (overflow checks are on in this
//! profile), never a write outside the band, never an endless loop.

use std::cell::Cell;

use multum::camera::{Camera, MIN_NEAR, Perspective};
use multum::clip::{ClipVertex, ClipVolume, transform};
use multum::depth::{NoDepth, Z16};
use multum::draw::Pipeline;
use multum::error::Error;
use multum::fixed::types::{I8F24, I16F16, I24F8};
use multum::geometry::{MAX_POSITION, MAX_UV, Mesh, Vertex};
use multum::perspective::{
    Adaptive, Affine, AffineWithin, ConstantZ, ConstantZColumns, Every, Extrapolated, PerPixel,
    Quadratic, Strategy as Perspectives, Subdivided,
};
use multum::project::ScreenVertex;
use multum::sample::Nearest;
use multum::setup::Cull;
use multum::sink::Band;
use multum::texture::{Clamp, Mirror, Repeat, Texture, Wrap};
use multum::transform::Transform;
use multum::viewport::Viewport;
use proptest::prelude::*;

/// What nothing writes.
const GUARD_CELL: u16 = 0xbeef;

fn number(n: f32) -> I16F16 {
    I16F16::from_num(n)
}

fn lens() -> Perspective {
    Perspective::from_scales(number(1.0), number(1.0), number(0.5)).expect("a lens")
}

#[test]
fn meshes() {
    let vertex = |x: i32, u: i32| Vertex::from_bits([x, 0, 0], [u, 0]);
    let (far, wide) = (MAX_POSITION << 16, MAX_UV << 16);
    let good = [vertex(0, 0), vertex(far, wide), vertex(-far, 65_536)];
    assert!(Mesh::new(&good, &[[0, 1, 2]]).is_ok());
    assert!(Mesh::new(&[], &[]).is_ok());

    for triangle in [[0, 1, 3], [3, 1, 2], [0, u16::MAX, 2]] {
        assert_eq!(
            Mesh::new(&good, &[[0, 1, 2], triangle]).err(),
            Some(Error::IndexOutOfRange { triangle: 1 })
        );
    }
    assert_eq!(
        Mesh::new(&[], &[[0, 0, 0]]).err(),
        Some(Error::IndexOutOfRange { triangle: 0 })
    );
    for x in [far + 1, -far - 1, i32::MIN, i32::MAX] {
        for axis in 0..3 {
            let mut position = [0; 3];
            position[axis] = x;
            assert_eq!(
                Mesh::new(&[vertex(0, 0), Vertex::from_bits(position, [0; 2])], &[]).err(),
                Some(Error::PositionOutOfRange { vertex: 1 })
            );
        }
    }
    for u in [wide + 1, -wide - 1, i32::MIN, i32::MAX] {
        for uv in [[u, 0], [0, u]] {
            assert_eq!(
                Mesh::new(&[vertex(0, 0), Vertex::from_bits([0; 3], uv)], &[]).err(),
                Some(Error::UvOutOfRange { vertex: 1 })
            );
        }
    }
    // 128 repeats are too many, one unit less is not.
    for (low, high, fits) in [(-64, 64, false), (-127, 127, false), (-64, 63, true)] {
        let vertices = [
            vertex(0, low << 16),
            vertex(0, 0),
            vertex(0, (high << 16) + if fits { 65_535 } else { 0 }),
        ];
        let error = (!fits).then_some(Error::UvSpanTooLarge { triangle: 0 });
        assert_eq!(Mesh::new(&vertices, &[[0, 1, 2]]).err(), error);
        assert_eq!(Mesh::new(&vertices, &[[2, 1, 0]]).err(), error);
    }
}

#[test]
fn textures() {
    let texels = vec![0u16; 64];
    assert!(Texture::new(&texels, 8, 8).is_ok());
    assert!(Texture::new(&texels, 64, 1).is_ok());
    for (width, height) in [
        (0, 0),
        (0, 8),
        (8, 0),
        (3, 8),
        (8, 12),
        (8_192, 1),
        (1, 8_192),
        (20_000, 20_000),
        (u32::MAX, u32::MAX),
        (1 << 31, 1 << 31),
    ] {
        assert_eq!(
            Texture::new(&texels, width, height).err(),
            Some(Error::TextureSize { width, height })
        );
    }
    for (width, height, needed) in [(8, 4, 32), (16, 8, 128), (4_096, 4_096, 1 << 24)] {
        assert_eq!(
            Texture::new(&texels, width, height).err(),
            Some(Error::BufferLength { needed, given: 64 })
        );
    }
}

#[test]
fn viewports_and_bands() {
    for (width, height) in [
        (0, 0),
        (0, 1),
        (1, 0),
        (1_025, 1),
        (1, 1_025),
        (u32::MAX, u32::MAX),
    ] {
        assert_eq!(
            Viewport::new(width, height),
            Err(Error::FrameSize { width, height })
        );
    }
    assert!(Viewport::new(1, 1).is_ok() && Viewport::new(1_024, 1_024).is_ok());

    let mut pixels = [0u16; 100];
    let mut error =
        |width, height, stride, top| Band::new(&mut pixels, width, height, stride, top).err();
    assert_eq!(error(10, 10, 10, 0), None);
    assert_eq!(error(10, 10, 10, 1_014), None);
    // The last row needs no more than its pixels.
    assert_eq!(error(10, 7, 15, 0), None);
    for (width, height, stride, top) in [
        (0, 10, 10, 0),
        (10, 0, 10, 0),
        (10, 10, 9, 0),
        (10, 10, 0, 0),
        (10, 10, 10, 1_015),
        (10, 10, 10, u32::MAX),
        (10, u32::MAX, 10, 10),
        (1_025, 1, 1_025, 0),
        (u32::MAX, 1, usize::MAX, 0),
    ] {
        assert_eq!(
            error(width, height, stride, top),
            Some(Error::FrameSize {
                width,
                height: height.saturating_add(top)
            })
        );
    }
    for (height, stride, needed) in [
        (11, 10, 110),
        (10, 11, 109),
        (2, usize::MAX, usize::MAX),
        (1_000, usize::MAX / 2, usize::MAX),
    ] {
        assert_eq!(
            error(10, height, stride, 0),
            Some(Error::BufferLength { needed, given: 100 })
        );
    }
}

/// Numbers that are not, or not sensible.
const BAD: [f32; 5] = [
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::MAX,
    f32::MIN,
];

#[test]
fn lenses() {
    assert!(Perspective::new(1.0, 1.5, 0.1).is_ok());
    for fov in [0.0, -1.0, 3.15, 100.0].into_iter().chain(BAD) {
        assert_eq!(
            Perspective::new(fov, 1.5, 0.1),
            Err(Error::DegenerateCamera)
        );
    }
    for aspect in [
        0.0,
        -1.0,
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
    ] {
        assert_eq!(
            Perspective::new(1.0, aspect, 0.1),
            Err(Error::DegenerateCamera)
        );
    }
    for near in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(
            Perspective::new(1.0, 1.5, near),
            Err(Error::DegenerateCamera)
        );
    }
    for near in [0.0, -1.0, 1.0 / 257.0] {
        assert_eq!(Perspective::new(1.0, 1.5, near), Err(Error::NearTooSmall));
    }
    assert_eq!(Perspective::new(1.0, 1.5, 40_000.0), Err(Error::Overflow));
    // A lens that narrow, or an image that narrow, has a scale beyond 16.16.
    assert_eq!(Perspective::new(1e-6, 1.5, 0.1), Err(Error::Overflow));
    assert_eq!(
        Perspective::new(f32::MIN_POSITIVE, 1.5, 0.1),
        Err(Error::Overflow)
    );
    assert_eq!(Perspective::new(1.0, 1e-6, 0.1), Err(Error::Overflow));

    let one = number(1.0);
    assert_eq!(
        Perspective::from_scales(one, one, MIN_NEAR - I16F16::DELTA),
        Err(Error::NearTooSmall)
    );
    for scale in [I16F16::ZERO, -I16F16::DELTA, I16F16::MIN] {
        for (x, y) in [(scale, one), (one, scale)] {
            assert_eq!(
                Perspective::from_scales(x, y, one),
                Err(Error::DegenerateCamera)
            );
        }
    }
}

#[test]
fn cameras() {
    let (eye, target, up) = ([1.0, 2.0, 3.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    assert!(Camera::look_at(eye, target, up, lens()).is_ok());
    for bad in BAD {
        for axis in 0..3 {
            let spoilt = |mut v: [f32; 3]| {
                v[axis] = bad;
                v
            };
            for result in [
                Camera::look_at(spoilt(eye), target, up, lens()),
                Camera::look_at(eye, spoilt(target), up, lens()),
                Camera::look_at(eye, target, spoilt(up), lens()),
            ] {
                assert_eq!(result, Err(Error::DegenerateCamera));
            }
        }
    }
    // No direction: eye at the target, no up, up along the view.
    for (target, up) in [
        (eye, up),
        (target, [0.0; 3]),
        (target, eye),
        (target, eye.map(|c| -c)),
    ] {
        assert_eq!(
            Camera::look_at(eye, target, up, lens()),
            Err(Error::DegenerateCamera)
        );
    }
    assert_eq!(
        Camera::look_at([40_000.0, 0.0, 0.0], target, up, lens()),
        Err(Error::Overflow)
    );
}

#[test]
fn rotations() {
    let axis = [0.0, 1.0, 0.0];
    assert!(Transform::rotation(axis, 1.0).is_ok());
    for angle in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(
            Transform::rotation(axis, angle),
            Err(Error::DegenerateCamera)
        );
    }
    assert_eq!(
        Transform::rotation([0.0; 3], 1.0),
        Err(Error::DegenerateCamera)
    );
    for bad in BAD {
        for i in 0..3 {
            let mut axis = axis;
            axis[i] = bad;
            assert_eq!(Transform::rotation(axis, 1.0), Err(Error::DegenerateCamera));
        }
    }
}

/// Maps whose product, or whose image of a vertex, leaves its format.
#[test]
fn overflowing_transforms() {
    let large = Transform::scale([I8F24::from_num(100); 3]);
    assert_eq!(large.after(&large), Err(Error::Overflow));
    let far = Transform::translation([number(32_000.0); 3]);
    assert_eq!(far.after(&far), Err(Error::Overflow));
    assert_eq!(large.after(&far), Err(Error::Overflow));
    let everything = Transform {
        rows: [[I8F24::MIN; 3]; 3],
        translation: [I16F16::MIN; 3],
    };
    assert_eq!(everything.after(&everything), Err(Error::Overflow));

    let camera = Camera {
        view: Transform::IDENTITY,
        lens: lens(),
    };
    assert_eq!(camera.to_clip(&everything), Err(Error::Overflow));
    let to_clip = camera.to_clip(&large).expect("a matrix");
    let corner = MAX_POSITION << 16;
    for position in [[corner, 0, 0], [-corner; 3]] {
        let vertex = Vertex::from_bits(position, [0; 2]);
        assert_eq!(ClipVertex::new(&vertex, &to_clip), Err(Error::Overflow));
    }
}

#[test]
fn short_buffers_for_clip_vertices() {
    let vertices = [Vertex::from_bits([0, 0, -65_536], [0, 0]); 5];
    let mesh = Mesh::new(&vertices, &[]).expect("a mesh");
    let camera = Camera {
        view: Transform::IDENTITY,
        lens: lens(),
    };
    let to_clip = camera.to_clip(&Transform::IDENTITY).expect("a matrix");
    let mut out = [ClipVertex::default(); 7];
    for given in 0..5 {
        assert_eq!(
            transform(&mesh, &to_clip, &mut out[..given]),
            Err(Error::BufferLength { needed: 5, given })
        );
    }
    assert_eq!(out, [ClipVertex::default(); 7]);
    // A longer one is filled as far as needed.
    assert_eq!(transform(&mesh, &to_clip, &mut out).map(<[_]>::len), Ok(5));
    assert_eq!(out[5..], [ClipVertex::default(); 2]);
}

const WIDTH: u32 = 31;
const STRIDE: usize = 37;
const ROWS: u32 = 9;
const TOP: u32 = 5;

/// Draws into a band in the middle of a buffer and checks that nothing else was touched.
fn guarded(draw: impl FnOnce(&mut Band<'_, u16>)) -> bool {
    const BEFORE: usize = 50;
    let mut buffer = vec![GUARD_CELL; BEFORE + STRIDE * ROWS as usize + 50];
    let mut band = Band::new(&mut buffer[BEFORE..], WIDTH, ROWS, STRIDE, TOP).expect("a band");
    band.clear(0);
    draw(&mut band);
    let drawn = band.rows().flatten().any(|&c| c != 0);
    for (i, &cell) in buffer.iter().enumerate() {
        let inside = i
            .checked_sub(BEFORE)
            .is_some_and(|i| i / STRIDE < ROWS as usize && i % STRIDE < WIDTH as usize);
        // Texels are small numbers.
        assert_eq!(cell == GUARD_CELL, !inside, "cell {i}");
    }
    drawn
}

fn pipeline<'t, P: Perspectives, W: Wrap, D>(
    strategy: P,
    _: W,
    texels: &'t [u16],
    depth: D,
) -> Pipeline<P, Nearest<Texture<'t, u16>, W>, D> {
    let texture = Texture::new(texels, 8, 4).expect("a texture");
    Pipeline {
        strategy,
        sampler: Nearest::new(texture),
        depth,
        cull: Cull::Off,
    }
}

/// The number of a texel, from 1.
fn texels() -> Vec<u16> {
    (1..=32).collect()
}

#[test]
fn indices_beyond_the_vertices() {
    let near = 65_536;
    let vertex = |x: i32, y: i32| ClipVertex {
        x: I16F16::from_bits(x * near),
        y: I16F16::from_bits(y * near),
        w: I16F16::from_bits(near),
        ..ClipVertex::default()
    };
    let vertices = [vertex(-1, -1), vertex(3, -1), vertex(-1, 3)];
    let viewport = Viewport::new(WIDTH, TOP + ROWS).expect("a viewport");
    let volume = ClipVolume::new(viewport, number(0.5));
    let texels = texels();
    let mut pipeline = pipeline(PerPixel, Repeat, &texels, NoDepth);
    // The triangles before the bad one are drawn.
    let drawn = guarded(|band| {
        let triangles = [[0, 1, 2], [0, 1, 3], [0, 1, 2]];
        assert_eq!(
            pipeline.draw(band, &volume, &vertices, &triangles),
            Err(Error::IndexOutOfRange { triangle: 1 })
        );
    });
    assert!(drawn);
    let drawn = guarded(|band| {
        assert_eq!(
            pipeline.draw(band, &volume, &[] as &[ClipVertex], &[[0, 0, 0]]),
            Err(Error::IndexOutOfRange { triangle: 0 })
        );
        assert_eq!(
            pipeline.draw(band, &volume, &vertices, &[[0, 1, u16::MAX]]),
            Err(Error::IndexOutOfRange { triangle: 0 })
        );
    });
    assert!(!drawn);
}

#[test]
fn screen_vertices_out_of_range() {
    let one = I16F16::ONE;
    let new = |x: i32, y: i32, w: i32, u: i32, v: i32| {
        let position = [x, y].map(I24F8::from_bits);
        let [w, u, v] = [w, u, v].map(I16F16::from_bits);
        ScreenVertex::new(position[0], position[1], w, [u, v])
    };
    let (rim, w, repeats) = (1024 * 256, one.to_bits(), MAX_UV << 16);
    for side in [rim, -rim] {
        assert!(new(side, side, w, repeats, -repeats).is_some());
    }
    for beyond in [rim + 1, -rim - 1, i32::MIN, i32::MAX] {
        assert!(new(beyond, 0, w, 0, 0).is_none());
        assert!(new(0, beyond, w, 0, 0).is_none());
    }
    for w in [0, -1, i32::MIN] {
        assert!(new(0, 0, w, 0, 0).is_none());
    }
    for beyond in [repeats + 1, -repeats - 1, i32::MIN, i32::MAX] {
        assert!(new(0, 0, w, beyond, 0).is_none());
        assert!(new(0, 0, w, 0, beyond).is_none());
    }
}

/// Legal corners that span too many repeats: nothing is drawn, by any strategy.
#[test]
fn triangles_that_span_too_many_repeats() {
    let corner = |x: i32, y: i32, u: i32| {
        let [x, y] = [x, y].map(|c| I24F8::from_num(c));
        let uv = [I16F16::from_num(u), I16F16::ZERO];
        ScreenVertex::new(x, y, I16F16::ONE, uv).expect("a vertex")
    };
    let texels = texels();
    for (u, draws) in [
        ([-64, 0, 63], true),
        ([-64, 0, 64], false),
        ([-127, 0, 127], false),
    ] {
        let corners = [
            corner(-10, -10, u[0]),
            corner(100, -10, u[1]),
            corner(-10, 100, u[2]),
        ];
        let all = [
            guarded(|band| {
                pipeline(Affine, Repeat, &texels, NoDepth).draw_triangle(band, &corners);
            }),
            guarded(|band| {
                pipeline(Every::<16>, Repeat, &texels, NoDepth).draw_triangle(band, &corners);
            }),
            guarded(|band| {
                pipeline(PerPixel, Repeat, &texels, NoDepth).draw_triangle(band, &corners);
            }),
        ];
        assert_eq!(all, [draws; 3]);
    }
}

/// Depth buffers of other sizes than the picture: what they do not cover is not drawn, and
/// nothing beside them is written.
#[test]
fn depth_buffers_of_the_wrong_size() {
    let corner = |x: i32, y: i32| {
        let [x, y] = [x, y].map(|c| I24F8::from_num(c));
        ScreenVertex::new(x, y, I16F16::ONE, [I16F16::ZERO; 2]).expect("a vertex")
    };
    let corners = [corner(-10, -10), corner(100, -10), corner(-10, 100)];
    let texels = texels();
    for (width, rows, stride, top, draws) in [
        (WIDTH, ROWS, STRIDE, TOP, true),
        (WIDTH, 1, STRIDE, TOP, true),
        (WIDTH, 1_024, STRIDE, 0, true),
        (1_024, ROWS, 1_024, TOP, true),
        (WIDTH - 1, ROWS, STRIDE, TOP, false),
        (1, 1, 1, TOP, false),
        (WIDTH, TOP, STRIDE, 0, false),
        (WIDTH, ROWS, STRIDE, TOP + ROWS, false),
    ] {
        let size = stride * rows as usize;
        let mut depths = vec![GUARD_CELL; size + 20];
        let depth = Band::new(&mut depths[..size], width, rows, stride, top).expect("a band");
        let mut depth = Z16::new(depth, I16F16::ONE);
        depth.clear();
        let drawn = guarded(|band| {
            pipeline(PerPixel, Repeat, &texels, depth).draw_triangle(band, &corners);
        });
        assert_eq!(drawn, draws, "depths of {width}x{rows} from row {top}");
        for (i, &cell) in depths.iter().enumerate() {
            let inside = i < size && i % stride < width as usize;
            assert_eq!(cell == GUARD_CELL, !inside, "cell {i}");
        }
    }
}

/// Any number, and often one of the worst: ends of the range, zero, one unit, and near powers of
/// two.
fn raw() -> impl Strategy<Value = i32> {
    prop_oneof![
        2 => any::<i32>(),
        2 => prop::sample::select(vec![
            i32::MIN, i32::MIN + 1, i32::MAX, i32::MAX - 1, 0, 1, -1, 65_536, -65_536,
        ]),
        1 => (0..31u32, -2..=2i32).prop_map(|(bit, off)| (1i32 << bit).saturating_add(off)),
        1 => (0..31u32, -2..=2i32).prop_map(|(bit, off)| (-1i32 << bit).saturating_add(off)),
        2 => -8 * 65_536..8 * 65_536i32,
    ]
}

fn clip_vertex() -> impl Strategy<Value = ClipVertex> {
    let uv = prop_oneof![raw(), -100 * 65_536..100 * 65_536i32];
    ([raw(), raw(), raw()], [uv.clone(), uv]).prop_map(|([x, y, w], [u, v])| {
        let [x, y, w, u, v] = [x, y, w, u, v].map(I16F16::from_bits);
        ClipVertex { x, y, w, u, v }
    })
}

/// The largest and the worst of what can come out of projection, too.
fn screen_vertex() -> impl Strategy<Value = ScreenVertex> {
    const RIM: i32 = 1024 * 256;
    let coordinate = || {
        prop_oneof![
            -RIM..=RIM,
            -2_560..=10_000i32,
            prop::sample::select(vec![-RIM, RIM, 0, 128, 1_280, 3_584]),
        ]
    };
    let repeats = || -MAX_UV << 16..=MAX_UV << 16;
    let small = || -40 << 16..=40 << 16;
    let w = prop_oneof![
        1..=i32::MAX,
        prop::sample::select(vec![1, 2, 255, 65_536, i32::MAX]),
        (0..31u32).prop_map(|bit| 1i32 << bit),
    ];
    let uv = || prop_oneof![repeats(), small(), Just(0)];
    ([coordinate(), coordinate()], w, [uv(), uv()]).prop_map(|(position, w, uv)| {
        let [x, y] = position.map(I24F8::from_bits);
        let uv = uv.map(I16F16::from_bits);
        ScreenVertex::new(x, y, I16F16::from_bits(w), uv).expect("a vertex")
    })
}

/// What is drawn.
#[derive(Clone, Copy)]
enum Call<'a> {
    Clip(&'a ClipVolume, &'a [ClipVertex; 3]),
    Screen(&'a [ScreenVertex; 3]),
}

impl Call<'_> {
    fn run<P, W, D>(
        self,
        band: &mut Band<'_, u16>,
        pipeline: &mut Pipeline<P, Nearest<Texture<'_, u16>, W>, D>,
    ) where
        P: Perspectives,
        W: Wrap,
        D: multum::depth::Depth,
    {
        match self {
            Self::Clip(volume, corners) => {
                let result = pipeline.draw(band, volume, corners, &[[0, 1, 2]]);
                assert_eq!(result, Ok(()));
            }
            Self::Screen(corners) => pipeline.draw_triangle(band, corners),
        }
    }
}

/// Draws by every strategy and wrap mode, without and with depths.
fn check_all(near: I16F16, call: Call<'_>) {
    let texels = texels();
    let mut depths = vec![0; STRIDE * ROWS as usize];
    macro_rules! with {
        ($strategy:expr, $wrap:expr) => {
            guarded(|band| call.run(band, &mut pipeline($strategy, $wrap, &texels, NoDepth)));
            guarded(|band| {
                let depth = Band::new(&mut depths, WIDTH, ROWS, STRIDE, TOP).expect("a band");
                let mut depth = Z16::new(depth, near);
                depth.clear();
                call.run(band, &mut pipeline($strategy, $wrap, &texels, depth));
            });
        };
    }
    with!(Affine, Repeat);
    with!(AffineWithin::new(Every::<16>, near), Repeat);
    with!(Every::<4>, Clamp);
    with!(Every::<16>, Mirror);
    with!(Every::<64>, Repeat);
    with!(PerPixel, Clamp);
    with!(Adaptive::new(Adaptive::DEFAULT_BOUND, (3, 2)), Repeat);
    with!(Adaptive::new(near, (12, 40)), Clamp);
    with!(ConstantZ, Mirror);
    let columns = [const { Cell::new(0) }; WIDTH as usize];
    with!(ConstantZColumns::new(&columns), Repeat);
    // Too few columns, and what another frame left in them.
    columns.iter().for_each(|c| c.set(u32::MAX));
    with!(ConstantZColumns::new(&columns[..20]), Repeat);
    with!(Quadratic::<16>, Clamp);
    with!(Quadratic::<32>, Mirror);
    with!(Extrapolated, Repeat);
    with!(Subdivided::new(Subdivided::DEFAULT_BOUND, (3, 2)), Clamp);
    with!(Subdivided::new(near, (12, 12)), Mirror);
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 20_000,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(81),
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_clip_vertices(
        corners in [clip_vertex(), clip_vertex(), clip_vertex()],
        near in raw(),
        width in 1..=1024u32,
        height in 1..=1024u32,
    ) {
        let near = I16F16::from_bits(near);
        for (width, height) in [(width, height), (WIDTH, TOP + ROWS)] {
            let viewport = Viewport::new(width, height).expect("a size");
            check_all(near, Call::Clip(&ClipVolume::new(viewport, near), &corners));
        }
    }

    #[test]
    fn any_screen_vertices(
        corners in [screen_vertex(), screen_vertex(), screen_vertex()],
        near in raw(),
    ) {
        check_all(I16F16::from_bits(near), Call::Screen(&corners));
    }

    #[test]
    fn any_camera(
        numbers in prop::array::uniform9(any::<f32>()),
        angles in prop::array::uniform4(any::<f32>()),
        model in prop::array::uniform12(raw()),
        position in prop::array::uniform3(-MAX_POSITION << 16..=MAX_POSITION << 16),
    ) {
        let [a, b, c, d, e, f, g, h, i] = numbers;
        let [fov, aspect, near, angle] = angles;
        _ = Perspective::new(fov, aspect, near);
        _ = Perspective::new(fov.abs() % 4.0, aspect.abs() % 4.0, near.abs() % 4.0);
        _ = Transform::rotation([a, b, c], angle);
        _ = Transform::rotation([0.0, 1.0, 0.0], angle);
        _ = Camera::look_at([a, b, c], [d, e, f], [g, h, i], lens());
        let small = numbers.map(|n| n % 100.0);
        let [a, b, c, d, e, f, g, h, i] = small;
        let [r0, r1, r2, r3, r4, r5, r6, r7, r8, t0, t1, t2] = model;
        let rows = [[r0, r1, r2], [r3, r4, r5], [r6, r7, r8]].map(|r| r.map(I8F24::from_bits));
        let model = Transform { rows, translation: [t0, t1, t2].map(I16F16::from_bits) };
        _ = model.after(&model);
        if let Ok(camera) = Camera::look_at([a, b, c], [d, e, f], [g, h, i], lens()) {
            for model in [model, Transform::IDENTITY] {
                if let Ok(to_clip) = camera.to_clip(&model) {
                    _ = ClipVertex::new(&Vertex::from_bits(position, [0; 2]), &to_clip);
                }
            }
        }
    }
}
