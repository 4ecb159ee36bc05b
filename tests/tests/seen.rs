//! Pixels that a depth test lets through are those that are drawn without one, with every strategy: textures find
//! their texels in other loops there. The others stay as they are.

use multum::depth::{NoDepth, Z16};
use multum::draw::Pipeline;
use multum::fixed::types::{I16F16, I24F8};
use multum::perspective::{
    Adaptive, Affine, AffineWithin, ConstantZ, Every, Extrapolated, PerPixel, Quadratic, RunSink,
    Strategy,
};
use multum::project::ScreenVertex;
use multum::sample::{Nearest, Sampler};
use multum::setup::{Cull, TriangleSetup};
use multum::shade::Shader;
use multum::sink::Band;
use multum::span::Span;
use multum::texture::{Clamp, Mirror, Repeat, SizedTexture, Texture};
use multum::uv::{Curve, Uv};
use rand::Rng as _;
use tests::random::{Rng, seeded};

const WIDTH: u32 = 97;
const HEIGHT: u32 = 61;
const PIXELS: usize = (WIDTH * HEIGHT) as usize;

/// What no triangle writes.
const BLANK: u16 = u16::MAX;

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

fn band(pixels: &mut [u16]) -> Band<'_, u16> {
    Band::new(pixels, WIDTH, HEIGHT, WIDTH as usize, 0).expect("a band")
}

/// With a depth buffer that holds these; what it holds then.
fn draw_tested<P: Strategy, S: Shader<Texel = u16>>(
    strategy: P,
    sampler: S,
    pixels: &mut [u16],
    depths: &[u16],
    triangle: &[ScreenVertex; 3],
) -> Vec<u16> {
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

fn check<P, S>(name: &str, strategy: P, sampler: S)
where
    P: Strategy + Copy,
    S: Sampler<Texel = u16> + Shader<Texel = u16> + Copy,
{
    let mut random = seeded(91);
    let (mut seen, mut hidden) = (0, 0);
    for _ in 0..100 {
        let triangle = triangle(&mut random);
        let (mut all, mut tested) = (vec![BLANK; PIXELS], vec![BLANK; PIXELS]);
        Pipeline {
            strategy,
            sampler,
            depth: NoDepth,
            cull: Cull::Off,
        }
        .draw_triangle(&mut band(&mut all), &triangle);
        // In runs of up to eight pixels nearer than anything, or empty.
        let mut in_front = Vec::new();
        while in_front.len() < PIXELS {
            let is_in_front: bool = random.random();
            in_front.extend(vec![is_in_front; random.random_range(1..=8)]);
        }
        let depths: Vec<u16> = (in_front.iter().take(PIXELS))
            .map(|&is_in_front| if is_in_front { u16::MAX } else { Z16::EMPTY })
            .collect();
        let depths_after = draw_tested(strategy, sampler, &mut tested, &depths, &triangle);
        let mut others = vec![BLANK; PIXELS];
        let expected = draw_tested(Affine, sampler, &mut others, &depths, &triangle);
        assert!(depths_after == expected, "{name}, depths: {triangle:?}");
        for (i, (&found, &drawn)) in tested.iter().zip(&all).enumerate() {
            let expected = if in_front[i] { BLANK } else { drawn };
            assert_eq!(found, expected, "{name}, pixel {i}: {triangle:?}");
            seen += usize::from(!in_front[i] && drawn != BLANK);
            hidden += usize::from(in_front[i] && drawn != BLANK);
        }
    }
    assert!(seen > 10_000 && hidden > 10_000, "{name}: {seen} {hidden}");
}

/// With every strategy.
fn check_all<S>(sampler: S)
where
    S: Sampler<Texel = u16> + Shader<Texel = u16> + Copy,
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
}
