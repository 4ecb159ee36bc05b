//! With a division at every pixel, textures that take several pixels at a time give what sampling them one by one
//! gives, with a depth test and without.

use multum::depth::{Depth, NoDepth, Z16};
use multum::draw::Pipeline;
use multum::fixed::types::{I16F16, I24F8};
use multum::perspective::PerPixel;
use multum::project::ScreenVertex;
use multum::sample::{Nearest, Sampler};
use multum::setup::Cull;
use multum::sink::Band;
use multum::texture::{SizedTexture, Texels, Texture};
use multum::uv::Uv;
use rand::Rng as _;
use tests::random::{Rng, seeded};

/// So wide that a span is more than the points that are stepped from one.
const WIDTH: u32 = 400;
const HEIGHT: u32 = 40;
const PIXELS: usize = (WIDTH * HEIGHT) as usize;

/// Asks a sampler for one pixel after the other.
struct OneByOne<S>(S);

impl<S: Sampler> Sampler for OneByOne<S> {
    type Texel = S::Texel;

    fn sample(&self, uv: Uv) -> S::Texel {
        self.0.sample(uv)
    }
}

/// Of any size, in depths of up to 1:60.
fn triangle(random: &mut Rng) -> [ScreenVertex; 3] {
    let size = [40, 400, 1200][random.random_range(0..3)] * 256;
    let repeats = [1, 4, 28][random.random_range(0..3)] * 65_536;
    let nearest = random.random_range(1.0..4.0);
    let farther = [1.0f64, 4.0, 60.0][random.random_range(0..3)];
    [0; 3].map(|_| {
        let [x, y] = [WIDTH, HEIGHT].map(|side| {
            let middle = side.cast_signed() * 128;
            I24F8::from_bits(middle + random.random_range(-size / 2..=size / 2))
        });
        let w = nearest * random.random_range(0.0..=farther.ln()).exp();
        let uv = [0; 2].map(|_| I16F16::from_bits(random.random_range(-repeats..=repeats)));
        ScreenVertex::new(x, y, I16F16::from_num(w), uv).expect("a vertex in range")
    })
}

fn band<P: Copy>(pixels: &mut [P]) -> Band<'_, P> {
    Band::new(pixels, WIDTH, HEIGHT, WIDTH as usize, 0).expect("a band")
}

/// One triangle; how many pixels it covers.
fn draw<S, D>(sampler: S, depth: D, triangle: &[ScreenVertex; 3]) -> (Vec<Option<u32>>, usize)
where
    S: Sampler<Texel = u32>,
    D: Depth,
{
    let mut frame = vec![None; PIXELS];
    Pipeline {
        strategy: PerPixel,
        sampler,
        depth,
        cull: Cull::Off,
    }
    .draw_triangle(&mut band(&mut frame), triangle);
    let drawn = frame.iter().flatten().count();
    (frame, drawn)
}

fn check<T: Texels<Colour = u32>>(texture: T) {
    let mut random = seeded(17);
    let (mut all, mut seen) = (0, 0);
    for _ in 0..600 {
        let triangle = triangle(&mut random);
        let found = draw(Nearest::<_>::new(texture), NoDepth, &triangle);
        let expected = draw(OneByOne(Nearest::<_>::new(texture)), NoDepth, &triangle);
        assert!(found == expected, "{triangle:?}");
        all += found.1;
        // What hides it begins and ends anywhere, and often not for eight pixels.
        let mut depths = vec![Z16::EMPTY; PIXELS];
        let mut at = 0;
        while at < PIXELS {
            let end = PIXELS.min(at + random.random_range(1..40));
            let hides = random.random_ratio(1, 3);
            depths[at..end].fill(if hides { u16::MAX } else { Z16::EMPTY });
            at = end;
        }
        let mut same = depths.clone();
        let z16 = |depths| Z16::new(band(depths), I16F16::ONE);
        let found = draw(Nearest::<_>::new(texture), z16(&mut depths), &triangle);
        let one_by_one = OneByOne(Nearest::<_>::new(texture));
        let expected = draw(one_by_one, z16(&mut same), &triangle);
        assert!(found == expected && depths == same, "{triangle:?}");
        seen += found.1;
    }
    assert!(
        all > 800_000 && (all / 3..all).contains(&seen),
        "{all} {seen}"
    );
}

/// Each texel is its own number.
#[test]
fn pixels_are_those_one_by_one() {
    let texels: Vec<u32> = (0..1 << 18).collect();
    let of_size = |width: u32, height: u32| {
        let texels = &texels[..(width * height) as usize];
        check(Texture::new(texels, width, height).expect("powers of two"));
    };
    for (width, height) in [(256, 256), (64, 16), (1, 256), (4096, 16), (512, 512)] {
        of_size(width, height);
    }
    let sized = texels.first_chunk().expect("as many");
    check(SizedTexture::<_, 256, 65_536>::new(sized));
    let sized = texels.first_chunk().expect("as many");
    check(SizedTexture::<_, 32, 512>::new(sized));
    let sized = texels.first_chunk().expect("as many");
    check(SizedTexture::<_, 512, 131_072>::new(sized));
}
