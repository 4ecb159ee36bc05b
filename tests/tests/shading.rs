//! Shaders: runs are their pixels one by one, a depth buffer and bands change no colour, and what is
//! cut out leaves pixel and depth as they were.

use multum::colour::{Colour, Opacity as _, Rgba5551, Rgba8888};
use multum::cutout::{AlphaTest, ColourKey, CutOut};
use multum::depth::{NoDepth, Z16};
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::{Rgb565, Rgb888};
use multum::filter::{LinearTexels, LinearTexels5, NearestTexel};
use multum::fixed::types::{I16F16, I24F8};
use multum::lod::{
    EachPiece, EachPixel, EachSpan, EachTriangle, Euclidean, FinestLevel, LinearLevels, Lod,
    LongestAxis, NearestLevel, SafestLevel,
};
use multum::mipmap::{Anisotropic, Mipmapped};
use multum::perspective::{Adaptive, Affine, Every, PerPixel, Run, Strategy};
use multum::project::ScreenVertex;
use multum::pyramid::average::Average;
use multum::pyramid::build::build;
use multum::pyramid::{self, Pyramid};
use multum::sample::{Bilinear, Nearest};
use multum::setup::{Cull, TriangleSetup};
use multum::shade::{Shader, ShaderRow};
use multum::sink::Band;
use multum::span::{Area, Span, for_each_span};
use multum::texture::{Clamp, Indexed4, Indexed8, Mirror, Repeat, SizedTexture, Texture};
use multum::uv::Uv;
use rand::Rng as _;
use tests::colours::Split;
use tests::random::{Rng, seeded};
use tests::{Flat, GUARD};

const WIDTH: u32 = 150;
const HEIGHT: u32 = 70;

/// The whole frame.
const SCREEN: Area = Area {
    width: WIDTH as i32,
    top: 0,
    bottom: HEIGHT as i32,
};

type Triangle = [ScreenVertex; 3];

/// From small ones to some larger than the screen, in depths of up to 1:30, from magnified to far
/// minified.
fn triangle(random: &mut Rng) -> Triangle {
    let size = [12, 60, 200, 900][random.random_range(0..4)] * 256;
    let middle = [WIDTH, HEIGHT].map(|side| random.random_range(0..256 * side as i32));
    let repeats = [0, 8_000, 65_536, 20 * 65_536][random.random_range(0..4)];
    [0; 3].map(|_| {
        let [x, y] = middle.map(|c| {
            let c = c + random.random_range(-size / 2..=size / 2);
            I24F8::from_bits(c.clamp(-GUARD, GUARD))
        });
        let w = random.random_range(0.0f64..30.0f64.ln()).exp();
        let uv = [0; 2].map(|_| I16F16::from_bits(random.random_range(-repeats..=repeats)));
        ScreenVertex::new(x, y, I16F16::from_num(w), uv).expect("a vertex in range")
    })
}

fn texels<C: Split>(seed: u64, width: u32, height: u32) -> Vec<C> {
    let mut random = seeded(seed);
    let mut texels: Vec<C> = (0..pyramid::texels(width, height))
        .map(|_| C::random(&mut random))
        .collect();
    build(&mut texels, width, height, Average::Stored).expect("all levels");
    texels
}

/// What is done with each of the shaders.
trait Check<C> {
    fn check<S: Shader<Texel = C>>(&mut self, name: &str, shader: &S);
}

/// Every kind of shader, with every rate and every choice of levels, in all wrap modes.
fn for_each_shader<C: Colour + Split>(check: &mut impl Check<C>) {
    let (width, height) = (64, 32);
    let texels = texels::<C>(901, width, height);
    let finest = &texels[..(width * height) as usize];
    let texture = Texture::new(finest, width, height).expect("all texels");
    let pyramid = Pyramid::<Texture<'_, C>>::new(&texels, width, height).expect("all levels");
    let sized = finest.try_into().expect("all texels");
    let sized = SizedTexture::<C, 64, 2048>::new(sized);

    check.check("nearest, sized", &Nearest::<_, Repeat>::new(sized));
    check.check(
        "nearest, sized, clamped",
        &Nearest::<_, Clamp, Repeat>::new(sized),
    );
    check.check("bilinear, sized", &Bilinear::<_, Repeat>::new(sized));
    check.check("nearest", &Nearest::<_, Repeat>::new(texture));
    check.check(
        "nearest, clamped",
        &Nearest::<_, Clamp, Mirror>::new(texture),
    );
    let mut random = seeded(906);
    let indices: Vec<u8> = finest.iter().map(|_| random.random()).collect();
    let indexed = Indexed8::new(&indices, &texels[..256], width, height).expect("256 colours");
    check.check("nearest, indexed", &Nearest::<_, Repeat>::new(indexed));
    let indexed =
        Indexed4::new(&indices[..1024], &texels[..16], width, height).expect("16 colours");
    check.check("nearest, two a byte", &Nearest::<_, Repeat>::new(indexed));
    check.check("bilinear", &Bilinear::<_, Repeat>::new(texture));
    check.check(
        "bilinear, mirrored",
        &Bilinear::<_, Mirror, Clamp>::new(texture),
    );
    check.check(
        "bilinear, 5 bits",
        &Bilinear::<_, Repeat, Repeat, LinearTexels5>::new(texture),
    );
    check.check(
        "bilinear, 5 bits, clamped",
        &Bilinear::<_, Clamp, Repeat, LinearTexels5>::new(texture),
    );
    macro_rules! mipmapped {
        ($name:literal, $min:expr, $mag:expr, $choice:expr, $rate:expr, $u:ty, $v:ty) => {
            let lod = Lod::new($choice, LongestAxis, $rate);
            let shader = Mipmapped::<_, _, _, _, $u, $v>::new(&pyramid, $min, $mag, lod);
            check.check($name, &shader);
        };
    }
    use {LinearTexels as L, LinearTexels5 as L5, NearestTexel as N};
    mipmapped!(
        "one level a pixel",
        N,
        L,
        NearestLevel,
        EachPixel,
        Repeat,
        Repeat
    );
    mipmapped!(
        "one level a piece",
        N,
        N,
        NearestLevel,
        EachPiece,
        Repeat,
        Repeat
    );
    mipmapped!(
        "one level a span",
        L,
        N,
        SafestLevel,
        EachSpan,
        Mirror,
        Repeat
    );
    mipmapped!(
        "one level a triangle",
        N,
        L,
        FinestLevel,
        EachTriangle,
        Clamp,
        Clamp
    );
    mipmapped!(
        "trilinear a pixel",
        L,
        L,
        LinearLevels,
        EachPixel,
        Repeat,
        Repeat
    );
    mipmapped!(
        "trilinear a piece",
        L,
        L,
        LinearLevels,
        EachPiece,
        Clamp,
        Mirror
    );
    mipmapped!(
        "trilinear a piece, 5 bits",
        L5,
        L5,
        LinearLevels,
        EachPiece,
        Repeat,
        Repeat
    );
    mipmapped!(
        "one level a piece, 5 bits",
        L5,
        N,
        NearestLevel,
        EachPiece,
        Repeat,
        Mirror
    );
    mipmapped!(
        "two levels a span",
        N,
        L,
        LinearLevels,
        EachSpan,
        Repeat,
        Clamp
    );
    mipmapped!(
        "trilinear a triangle",
        L,
        N,
        LinearLevels,
        EachTriangle,
        Repeat,
        Repeat
    );

    let lod = Lod::new(LinearLevels, Euclidean, EachPixel)
        .with_bias(I16F16::from_num(-0.3))
        .within(I16F16::from_num(0.2), I16F16::from_num(4.4))
        .resident(1);
    let shader: Mipmapped<'_, _, _, _, _> = Mipmapped::new(&pyramid, L, N, lod);
    check.check("with limits", &shader);
    check.check("8 samples a pixel", &Anisotropic::<8, _>::new(shader));
    let lod = Lod::new(NearestLevel, Euclidean, EachPiece);
    let shader: Mipmapped<'_, _, _, _, _> = Mipmapped::new(&pyramid, N, L, lod);
    check.check("4 samples a piece", &Anisotropic::<4, _>::new(shader));
    let lod = Lod::new(LinearLevels, Euclidean, EachSpan);
    let shader = Mipmapped::<_, _, _, _, Mirror>::new(&pyramid, L, L, lod);
    check.check("2 samples a span", &Anisotropic::<2, _>::new(shader));
    let shader = Mipmapped::<_, _, _, _, Repeat>::new(&pyramid, L5, L5, lod);
    check.check(
        "4 samples a span, 5 bits",
        &Anisotropic::<4, _>::new(shader),
    );
    let lod = Lod::new(NearestLevel, Euclidean, EachTriangle);
    let shader: Mipmapped<'_, _, _, _, _> = Mipmapped::new(&pyramid, L, L, lod);
    check.check("8 samples a triangle", &Anisotropic::<8, _>::new(shader));
}

/// Runs against their pixels.
struct Runs {
    triangles: Vec<Triangle>,
    random: Rng,
    pixels: usize,
}

impl Runs {
    /// One span, in these runs from left to right.
    fn span<S: Shader<Texel: Split>>(
        &mut self,
        name: &str,
        shader: &S,
        triangle: &S::Triangle,
        span: Span,
        runs: &[Run],
    ) {
        let mark = S::Texel::join([1, 0, 0, 0]);
        let length = span.right.abs_diff(span.left) as usize;
        let mut filled = vec![mark; length];
        let mut row = shader.row(triangle, span);
        for &run in runs {
            row.fill(run, &mut filled[run.offset..run.offset + run.len]);
        }
        let mut row = shader.row(triangle, span);
        for run in runs {
            let mut uv = run.uv;
            for (offset, &pixel) in (run.offset..).zip(&filled[run.offset..run.offset + run.len]) {
                let texel = row.texel(offset, uv);
                assert_eq!(pixel, texel, "{name}, {offset} of {span:?} in {run:?}");
                // Nor does it matter which pixels were asked for before.
                let alone = shader.row(triangle, span).texel(offset, uv);
                assert_eq!(alone, texel, "{name}, {offset} of {span:?} alone");
                let mut written = mark;
                assert!(row.write(offset, uv, &mut written));
                assert_eq!(written, texel, "{name}, {offset} of {span:?} written");
                uv = uv + run.step;
                self.pixels += 1;
            }
        }
    }

    /// The runs of a strategy.
    fn strategy<S: Shader<Texel: Split>>(
        &mut self,
        name: &str,
        shader: &S,
        vertices: &Triangle,
        strategy: &impl Strategy,
    ) {
        let Some(setup) = TriangleSetup::new(vertices, Cull::Off) else {
            return;
        };
        let planes = strategy.planes(&setup).expect("few repeats");
        let triangle = shader.triangle(&setup);
        let mut spans = Vec::new();
        for_each_span(&setup, SCREEN, |span| spans.push(span));
        for span in spans.into_iter().step_by(5) {
            let mut runs = Vec::new();
            strategy.runs(&planes, span, |run: Run| runs.push(run));
            self.span(name, shader, &triangle, span, &runs);
        }
    }
}

impl<C: Split> Check<C> for Runs {
    fn check<S: Shader<Texel = C>>(&mut self, name: &str, shader: &S) {
        let triangles = self.triangles.clone();
        for vertices in &triangles {
            self.strategy(name, shader, vertices, &Affine);
            self.strategy(name, shader, vertices, &Every::<16>);
            self.strategy(name, shader, vertices, &PerPixel);
        }
        // Runs of every length, from any offset, along any line through the texture.
        let setups = triangles
            .iter()
            .filter_map(|vertices| TriangleSetup::new(vertices, Cull::Off));
        for (setup, length) in setups.cycle().zip(1..=WIDTH as usize) {
            let triangle = shader.triangle(&setup);
            let mut spans = Vec::new();
            for_each_span(&setup, SCREEN, |span| spans.push(span));
            let Some(&span) = spans.get(spans.len() / 2) else {
                continue;
            };
            let room = span.right.abs_diff(span.left) as usize;
            let len = 1 + (length - 1) % room;
            let offset = self.random.random_range(0..=room - len);
            let [u, v, du, dv] = [0; 4].map(|_| {
                let bits: i32 = self.random.random();
                bits >> self.random.random_range(0..20)
            });
            let run = Run {
                offset,
                len,
                uv: Uv::from_bits(u, v),
                step: Uv::from_bits(du, dv),
            };
            self.span(name, shader, &triangle, span, &[run]);
        }
    }
}

#[test]
fn runs_are_their_pixels_one_by_one() {
    let mut random = seeded(902);
    let triangles = (0..24).map(|_| triangle(&mut random)).collect();
    let mut runs = Runs {
        triangles,
        random,
        pixels: 0,
    };
    for_each_shader::<Rgb565>(&mut runs);
    for_each_shader::<Rgba8888>(&mut runs);
    assert!(runs.pixels > 500_000, "{}", runs.pixels);
}

/// Draws triangles, band by band of so many rows, with or without depths.
fn frame<C, S, P>(
    shader: &S,
    strategy: P,
    triangles: &[Triangle],
    rows: u32,
    with_depth: bool,
) -> (Vec<Option<C>>, Vec<u16>)
where
    C: Split,
    P: Strategy + Copy,
    S: Shader<Texel = C>,
{
    let (mut frame, mut all_depths) = (Vec::new(), Vec::new());
    let mut top = 0;
    while top < HEIGHT {
        let rows = rows.min(HEIGHT - top);
        let count = (WIDTH * rows) as usize;
        let mut pixels: Vec<Option<C>> = vec![None; count];
        let mut depths = vec![0u16; count];
        let stride = WIDTH as usize;
        let mut band = Band::new(&mut pixels, WIDTH, rows, stride, top).expect("a band");
        let sampler = ByReference(shader);
        let cull = Cull::Off;
        if with_depth {
            let depth = Band::new(&mut depths, WIDTH, rows, stride, top).expect("a band");
            let mut depth = Z16::new(depth, I16F16::ONE);
            depth.clear();
            let mut pipeline = Pipeline {
                strategy,
                sampler,
                depth,
                cull,
            };
            for triangle in triangles {
                pipeline.draw_triangle(&mut band, triangle);
            }
        } else {
            let mut pipeline = Pipeline {
                strategy,
                sampler,
                depth: NoDepth,
                cull,
            };
            for triangle in triangles {
                pipeline.draw_triangle(&mut band, triangle);
            }
        }
        frame.extend(pixels);
        all_depths.extend(depths);
        top += rows;
    }
    (frame, all_depths)
}

/// A borrowed shader.
struct ByReference<'s, S>(&'s S);

impl<S: Shader> Shader for ByReference<'_, S> {
    type Texel = S::Texel;
    type Triangle = S::Triangle;
    type Row<'r>
        = S::Row<'r>
    where
        Self: 'r;

    fn triangle(&self, triangle: &TriangleSetup<'_>) -> S::Triangle {
        self.0.triangle(triangle)
    }

    fn row<'r>(&'r self, triangle: &'r S::Triangle, span: Span) -> S::Row<'r> {
        self.0.row(triangle, span)
    }
}

/// Which triangle is seen where, by a depth buffer alone.
fn seen(strategy: impl Strategy + Copy, triangles: &[Triangle]) -> Vec<u8> {
    let count = (WIDTH * HEIGHT) as usize;
    let (mut pixels, mut depths) = (vec![0u8; count], vec![0u16; count]);
    let stride = WIDTH as usize;
    let mut band = Band::new(&mut pixels, WIDTH, HEIGHT, stride, 0).expect("a frame");
    let depth = Band::new(&mut depths, WIDTH, HEIGHT, stride, 0).expect("a frame");
    let mut depth = Z16::new(depth, I16F16::ONE);
    depth.clear();
    for (number, triangle) in (1..).zip(triangles) {
        let mut pipeline = Pipeline {
            strategy,
            sampler: Flat(number),
            depth: &mut depth,
            cull: Cull::Off,
        };
        pipeline.draw_triangle(&mut band, triangle);
    }
    pixels
}

/// Scenes of several triangles in each other's way.
fn scenes(seed: u64, count: usize) -> Vec<Vec<Triangle>> {
    let mut random = seeded(seed);
    (0..count)
        .map(|_| (0..6).map(|_| triangle(&mut random)).collect())
        .collect()
}

/// With depths a pixel has the colour that its triangle has without.
struct Depths {
    scenes: Vec<Vec<Triangle>>,
    hidden: usize,
}

impl Depths {
    fn strategy<C: Split, S: Shader<Texel = C>>(
        &mut self,
        name: &str,
        shader: &S,
        strategy: impl Strategy + Copy,
    ) {
        for triangles in &self.scenes {
            let (found, _) = frame(shader, strategy, triangles, HEIGHT, true);
            let seen = seen(strategy, triangles);
            let alone: Vec<_> = triangles
                .iter()
                .map(|&t| frame(shader, strategy, &[t], HEIGHT, false).0)
                .collect();
            for (i, &number) in seen.iter().enumerate() {
                let expected = match number {
                    0 => None,
                    _ => alone[usize::from(number) - 1][i],
                };
                assert_eq!(found[i], expected, "{name}, pixel {i} of {triangles:?}");
                let covered = alone.iter().filter(|frame| frame[i].is_some()).count();
                self.hidden += covered.saturating_sub(1);
            }
        }
    }
}

impl<C: Split> Check<C> for Depths {
    fn check<S: Shader<Texel = C>>(&mut self, name: &str, shader: &S) {
        self.strategy(name, shader, Affine);
        self.strategy(name, shader, Every::<4>);
        self.strategy(name, shader, Every::<8>);
        self.strategy(name, shader, Every::<16>);
        self.strategy(name, shader, Every::<64>);
        self.strategy(name, shader, Adaptive::new(Adaptive::DEFAULT_BOUND, (6, 5)));
        self.strategy(name, shader, PerPixel);
    }
}

#[test]
fn a_depth_buffer_changes_no_colour() {
    let mut depths = Depths {
        scenes: scenes(903, 4),
        hidden: 0,
    };
    for_each_shader::<Rgb888>(&mut depths);
    assert!(depths.hidden > 100_000, "{}", depths.hidden);
}

/// A frame in bands is the frame at once.
struct Bands(Vec<Vec<Triangle>>);

impl<C: Split> Check<C> for Bands {
    fn check<S: Shader<Texel = C>>(&mut self, name: &str, shader: &S) {
        for triangles in &self.0 {
            for with_depth in [false, true] {
                let whole = frame(shader, Every::<16>, triangles, HEIGHT, with_depth);
                assert!(whole.0.iter().any(Option::is_some));
                for rows in [1, 7, 16] {
                    let found = frame(shader, Every::<16>, triangles, rows, with_depth);
                    let first = (whole.0.iter().zip(&found.0)).position(|(a, b)| a != b);
                    assert_eq!(first, None, "{name} in bands of {rows}: {triangles:?}");
                    assert_eq!(found.1, whole.1, "{name}, depths in bands of {rows}");
                }
            }
        }
    }
}

#[test]
fn bands_are_the_frame_at_once() {
    for_each_shader::<Rgb565>(&mut Bands(scenes(904, 5)));
}

/// Draws a scene over another one, cut out or not; what is not shown must stay, and what is shown
/// must be as if nothing were cut.
fn check_cut_out<C, S, K>(
    shader: S,
    key: K,
    is_shown: impl Fn(C) -> bool,
    strategy: impl Strategy + Copy,
) -> [usize; 2]
where
    C: Split,
    S: Shader<Texel = C> + Copy,
    K: multum::cutout::Cutout<C>,
{
    let cut = CutOut {
        shader,
        cutout: key,
    };
    let mut counts = [0; 2];
    for triangles in scenes(905, 40) {
        for triangle in &triangles {
            for with_depth in [false, true] {
                let full = frame(&shader, strategy, &[*triangle], HEIGHT, with_depth);
                let found = frame(&cut, strategy, &[*triangle], HEIGHT, with_depth);
                for (i, full_pixel) in full.0.iter().enumerate() {
                    let shown = full_pixel.is_some_and(&is_shown);
                    let expected = if shown { *full_pixel } else { None };
                    assert_eq!(found.0[i], expected, "pixel {i} of {triangle:?}");
                    let depth = if shown { full.1[i] } else { Z16::EMPTY };
                    assert_eq!(found.1[i], depth, "depth {i} of {triangle:?}");
                    counts[usize::from(shown)] += usize::from(full_pixel.is_some());
                }
            }
        }
        // Behind what is cut out something else is seen, as if the hole were not there.
        let [front, back, ..] = &triangles[..] else {
            unreachable!("six triangles");
        };
        let (both, _) = frame(&cut, strategy, &[*front, *back], HEIGHT, true);
        let (only, _) = frame(&cut, strategy, &[*back], HEIGHT, true);
        let (first, _) = frame(&shader, strategy, &[*front], HEIGHT, true);
        for i in 0..both.len() {
            if !first[i].is_some_and(&is_shown) {
                assert_eq!(both[i], only[i], "pixel {i} behind {front:?}");
            }
        }
    }
    counts
}

fn check_cut_outs(strategy: impl Strategy + Copy) {
    // A colour of every fourth texel.
    let key = Rgb565::new(31, 0, 31);
    let mut keyed = texels::<Rgb565>(906, 32, 32);
    keyed.iter_mut().step_by(4).for_each(|t| *t = key);
    let texture = Texture::new(&keyed[..1024], 32, 32).expect("all texels");
    let is_shown = |c: Rgb565| c != key;
    let shader = Nearest::<_, Repeat>::new(texture);
    let keyed_counts = check_cut_out(shader, ColourKey(key), is_shown, strategy);

    let alpha = texels::<Rgba8888>(907, 32, 32);
    let pyramid = Pyramid::<Texture<'_, _>>::new(&alpha, 32, 32).expect("all levels");
    let lod = Lod::new(LinearLevels, LongestAxis, EachPiece);
    let shader =
        Mipmapped::<_, _, _, _, Repeat, Repeat>::new(&pyramid, LinearTexels, NearestTexel, lod);
    let is_shown = |c: Rgba8888| c.0[3] >= 128;
    let mipmapped_counts = check_cut_out(shader, AlphaTest, is_shown, strategy);

    let one_bit = texels::<Rgba5551>(908, 32, 32);
    let texture = Texture::new(&one_bit[..1024], 32, 32).expect("all texels");
    let shader = Bilinear::<_, Repeat, Repeat>::new(texture);
    let is_shown = |c: Rgba5551| c.0 % 2 == 1;
    let bilinear_counts = check_cut_out(shader, AlphaTest, is_shown, strategy);
    for [left_out, shown] in [keyed_counts, mipmapped_counts, bilinear_counts] {
        assert!(left_out > 20_000 && shown > 20_000, "{left_out} {shown}");
    }
}

#[test]
fn what_is_cut_out_leaves_pixel_and_depth() {
    check_cut_outs(Affine);
    check_cut_outs(Every::<16>);
    check_cut_outs(PerPixel);
}

#[test]
fn one_half_is_opaque() {
    for (alpha, opaque) in [(0, false), (127, false), (128, true), (255, true)] {
        assert_eq!(Rgba8888([255, 255, 255, alpha]).is_opaque(), opaque);
    }
    for (bits, opaque) in [(0xfffe, false), (0x0001, true), (0xffff, true), (0, false)] {
        assert_eq!(Rgba5551(bits).is_opaque(), opaque);
    }
}
