//! Pixels that a depth test lets through are those that are drawn without one, with every strategy and filter: textures
//! find their texels in other loops there. The others stay as they are.

use std::fmt::Debug;

use multum::depth::{NoDepth, Z16};
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::embedded_graphics::pixelcolor::raw::RawU16;
use multum::filter::{LinearTexels, LinearTexels5, NearestTexel};
use multum::fixed::types::{I16F16, I24F8};
use multum::lod::{
    EachPiece, EachPixel, EachSpan, EachTriangle, LinearLevels, Lod, LongestAxis, NearestLevel,
};
use multum::mipmap::{Anisotropic, Mipmapped};
use multum::perspective::{
    Adaptive, Affine, AffineWithin, ConstantZ, Every, Extrapolated, PerPixel, Quadratic, RunSink,
    Strategy,
};
use multum::project::ScreenVertex;
use multum::pyramid::{Pyramid, texels};
use multum::sample::{Bilinear, Nearest};
use multum::setup::{Cull, TriangleSetup};
use multum::shade::Shader;
use multum::sink::Band;
use multum::span::Span;
use multum::texture::{Clamp, Indexed4, Indexed8, Mirror, Morton, Repeat, SizedTexture, Texture};
use multum::uv::{Curve, Uv};
use rand::Rng as _;
use tests::random::{Rng, seeded};

const WIDTH: u32 = 97;
const HEIGHT: u32 = 61;
const PIXELS: usize = (WIDTH * HEIGHT) as usize;

/// A frame's pixel: nothing where no triangle wrote.
type Pixel<C> = Option<C>;

/// Of any size on the screen and beyond it, in depths of up to 1:30.
fn triangle(random: &mut Rng) -> [ScreenVertex; 3] {
    let size = [20, 60, 300][random.random_range(0..3)] * 256;
    let repeats = [1, 4, 40][random.random_range(0..3)] * 65_536;
    [0; 3].map(|_| {
        let [x, y] = [WIDTH, HEIGHT].map(|side| {
            let middle = side.cast_signed() * 128;
            I24F8::from_bits(middle + random.random_range(-size / 2..=size / 2))
        });
        let w = random.random_range(0.0f64..30.0f64.ln()).exp();
        let uv = [0; 2].map(|_| I16F16::from_bits(random.random_range(0..=repeats)));
        ScreenVertex::new(x, y, I16F16::from_num(w), uv).expect("a vertex in range")
    })
}

fn band<P: Copy>(pixels: &mut [P]) -> Band<'_, P> {
    Band::new(pixels, WIDTH, HEIGHT, WIDTH as usize, 0).expect("a band")
}

/// With a depth buffer that holds these; what it holds then.
fn draw_tested<P: Strategy, S: Shader>(
    strategy: P,
    sampler: S,
    pixels: &mut [Pixel<S::Texel>],
    depths: &[u16],
    triangle: &[ScreenVertex; 3],
) -> Vec<u16>
where
    S::Texel: Copy,
{
    let mut depths = depths.to_vec();
    Pipeline {
        strategy,
        sampler,
        depth: Z16::new(band(&mut depths), I16F16::ONE),
        cull: Cull::Off,
    }
    .draw_triangle(&mut band(pixels), triangle);
    depths
}

/// One parabola over all of a span, of any length.
#[derive(Clone, Copy)]
struct OneCurve;

impl Strategy for OneCurve {
    type Planes = ();

    fn planes(&self, _: &TriangleSetup<'_>) -> Option<()> {
        Some(())
    }

    fn runs(&self, (): &(), span: Span, mut to: impl RunSink) {
        let curve = Curve {
            uv: Uv::from_bits(span.y << 18, span.left << 16),
            step: Uv::from_bits(-(1 << 18), 1 << 17),
            change: Uv::from_bits(1 << 12, 1 << 11),
        };
        to.curve(0, span.left.abs_diff(span.right) as usize, curve);
    }
}

/// For each pixel of a frame one of two, the same for up to so many.
fn in_runs(random: &mut Rng, most: usize) -> Vec<bool> {
    let mut all = Vec::new();
    while all.len() < PIXELS {
        let one: bool = random.random();
        all.extend(vec![one; random.random_range(1..=most)]);
    }
    all.truncate(PIXELS);
    all
}

fn check<P, S>(name: &str, strategy: P, sampler: S)
where
    P: Strategy + Copy,
    S: Shader<Texel: Copy + PartialEq + Debug> + Copy,
{
    let mut random = seeded(91);
    let (mut seen, mut hidden) = (0, 0);
    for _ in 0..100 {
        let triangle = triangle(&mut random);
        let mut all = vec![None; PIXELS];
        Pipeline {
            strategy,
            sampler,
            depth: NoDepth,
            cull: Cull::Off,
        }
        .draw_triangle(&mut band(&mut all), &triangle);
        let mut behind = |hidden_there: &[bool], depths: &[u16]| {
            let mut tested = vec![None; PIXELS];
            let after = draw_tested(strategy, sampler, &mut tested, depths, &triangle);
            let mut others = vec![None; PIXELS];
            let expected = draw_tested(Affine, sampler, &mut others, depths, &triangle);
            assert!(after == expected, "{name}, depths: {triangle:?}");
            for (i, (&found, &drawn)) in tested.iter().zip(&all).enumerate() {
                let expected = if hidden_there[i] { None } else { drawn };
                assert_eq!(found, expected, "{name}, pixel {i}: {triangle:?}");
                seen += usize::from(!hidden_there[i] && drawn.is_some());
                hidden += usize::from(hidden_there[i] && drawn.is_some());
            }
            after
        };
        // Of up to eight pixels, or of up to more than a row.
        let most = [8, 120][random.random_range(0..2)];
        let in_front = in_runs(&mut random, most);
        let depths: Vec<u16> = (in_front.iter())
            .map(|&is_in_front| if is_in_front { u16::MAX } else { Z16::EMPTY })
            .collect();
        let depths = behind(&in_front, &depths);
        // Behind itself, too: of equal depths the first stays.
        let in_front = in_runs(&mut random, most);
        let depths: Vec<u16> = (in_front.iter().zip(depths))
            .map(|(&stays, depth)| if stays { depth } else { Z16::EMPTY })
            .collect();
        behind(&in_front, &depths);
    }
    assert!(seen > 10_000 && hidden > 10_000, "{name}: {seen} {hidden}");
}

/// With every strategy.
fn check_all<S>(sampler: S)
where
    S: Shader<Texel: Copy + PartialEq + Debug> + Copy,
{
    check("affine", Affine, sampler);
    let within = AffineWithin::new(Every::<16>, AffineWithin::DEFAULT_BOUND);
    check("affine-within", within, sampler);
    check("every:4", Every::<4>, sampler);
    check("every:16", Every::<16>, sampler);
    check("every:64", Every::<64>, sampler);
    check("exact", PerPixel, sampler);
    let adaptive = Adaptive::new(Adaptive::DEFAULT_BOUND, (6, 5));
    check("adaptive", adaptive, sampler);
    check("constant-z", ConstantZ, sampler);
    check("quadratic:16", Quadratic::<16>, sampler);
    check("quadratic:32", Quadratic::<32>, sampler);
    check("extrapolated", Extrapolated, sampler);
    check("one curve", OneCurve, sampler);
}

#[test]
fn seen_pixels_are_those_without_a_test() {
    let texels: [u16; 64 * 32] = core::array::from_fn(|i| i as u16);
    let texture = Texture::new(&texels, 64, 32).expect("powers of two");
    check_all(Nearest::<_, Repeat>::new(texture));
    check_all(Nearest::<_, Clamp, Mirror>::new(texture));
    let sized = SizedTexture::<_, 64, { 64 * 32 }>::new(&texels);
    check_all(Nearest::<_, Repeat>::new(sized));
    let mut random = seeded(92);
    let indices: Vec<u8> = texels.map(|_| random.random()).to_vec();
    let indexed = Indexed8::new(&indices, &texels[..256], 64, 32).expect("256 colours");
    check_all(Nearest::<_, Repeat>::new(indexed));
    let indexed = Indexed4::new(&indices[..1024], &texels[..16], 64, 32).expect("16 colours");
    check_all(Nearest::<_, Repeat>::new(indexed));
    let morton = Morton::new(&texels[..1024], 32, 32).expect("powers of two");
    check_all(Nearest::<_, Repeat>::new(morton));
}

#[test]
fn the_same_with_filters_and_levels() {
    let mut random = seeded(93);
    let texels: Vec<Rgb565> = (0..texels(64, 32))
        .map(|_| RawU16::new(random.random()).into())
        .collect();
    let texture = Texture::new(&texels[..64 * 32], 64, 32).expect("powers of two");
    check_all(Bilinear::<_, Repeat>::new(texture));
    check_all(Bilinear::<_, Clamp, Mirror, LinearTexels5>::new(texture));
    check_all(Bilinear::<_, Repeat, Repeat, LinearTexels5>::new(texture));
    let pyramid = Pyramid::<Texture<'_, _>>::new(&texels, 64, 32).expect("all levels");
    macro_rules! mipmapped {
        ($min:expr, $mag:expr, $choice:expr, $rate:expr, $wrap:ty) => {
            let lod = Lod::new($choice, LongestAxis, $rate);
            check_all(Mipmapped::<_, _, _, _, $wrap>::new(
                &pyramid, $min, $mag, lod,
            ));
        };
    }
    use {LinearTexels as L, LinearTexels5 as L5, NearestTexel as N};
    mipmapped!(N, N, NearestLevel, EachTriangle, Repeat);
    mipmapped!(N, N, NearestLevel, EachSpan, Repeat);
    mipmapped!(N, L, NearestLevel, EachPiece, Mirror);
    mipmapped!(N, N, NearestLevel, EachPixel, Repeat);
    mipmapped!(L, L5, NearestLevel, EachPiece, Repeat);
    mipmapped!(L, N, LinearLevels, EachPiece, Repeat);
    mipmapped!(L5, L5, LinearLevels, EachSpan, Repeat);
    mipmapped!(N, N, LinearLevels, EachPixel, Clamp);
    let lod = Lod::new(NearestLevel, LongestAxis, EachPiece);
    let shader: Mipmapped<'_, _, _, _, _> = Mipmapped::new(&pyramid, N, N, lod);
    check_all(Anisotropic::<4, _>::new(shader));
}
