//! Texture filters through the pipeline against the float64 reference, pixel by pixel: every pair
//! of filters within a level, every choice of levels, both rules, and rows of samples.
//!
//! [`Case::allowed`] adds up the bounds that the core's documentation gives. With weights of 11 bits
//! the core's unrounded colour is less than 2 from the reference's, in units of the channel; with
//! those of 5 bits, further.

use std::ops::AddAssign;

use host_sim::any::AnyImage;
use host_sim::bound;
use host_sim::filtering::Within;
use host_sim::reference::filter::{Filter, Image, Level};
use host_sim::reference::lod::{self, Choice as Choices, Chosen, Rule as Rules};
use host_sim::reference::{Beyond, Corners, Planes, Sample};
use multum::colour::{Rgba5551, Rgba8888};
use multum::depth::NoDepth;
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::{Gray8, Rgb565, Rgb888};
use multum::filter::{ImageFilter, LinearTexels, LinearTexels5, NearestTexel};
use multum::fixed::types::{I16F16, I24F8};
use multum::lod::{
    Choice, EachPixel, Euclidean, FinestLevel, LinearLevels, Lod, LongestAxis, NearestLevel, Rule,
    SafestLevel,
};
use multum::mipmap::{Anisotropic, Mipmapped};
use multum::perspective::PerPixel;
use multum::project::ScreenVertex;
use multum::pyramid::average::Average;
use multum::pyramid::build::build;
use multum::pyramid::{self, Pyramid};
use multum::sample::{Bilinear, Sampler as _};
use multum::setup::{Cull, TriangleSetup};
use multum::shade::Shader;
use multum::texture::{Clamp, Mirror, Repeat, Texture, Wrap};
use multum::uv::Uv;
use rand::Rng as _;
use tests::colours::Split;
use tests::frame::{Frame, Overdraw};
use tests::random::{Rng, seeded};

const SIDE: i32 = 64;

/// A wrap mode, as the reference calls it.
trait Named: Wrap + Copy {
    const NAME: Beyond;
}

impl Named for Repeat {
    const NAME: Beyond = Beyond::Repeat;
}

impl Named for Clamp {
    const NAME: Beyond = Beyond::Clamp;
}

impl Named for Mirror {
    const NAME: Beyond = Beyond::Mirror;
}

/// A filter within a level by its name.
trait NamedImage: ImageFilter {
    const NAME: Within;
}

impl NamedImage for NearestTexel {
    const NAME: Within = Within::Nearest;
}

impl NamedImage for LinearTexels {
    const NAME: Within = Within::Linear;
}

impl NamedImage for LinearTexels5 {
    const NAME: Within = Within::Linear5;
}

/// A choice of levels, as the reference calls it.
trait NamedChoice: Choice + Default {
    const NAME: Choices;
}

impl NamedChoice for FinestLevel {
    const NAME: Choices = Choices::Base;
}

impl NamedChoice for NearestLevel {
    const NAME: Choices = Choices::Nearest;
}

impl NamedChoice for SafestLevel {
    const NAME: Choices = Choices::Safest;
}

impl NamedChoice for LinearLevels {
    const NAME: Choices = Choices::Linear;
}

/// Any choice of levels.
#[derive(Clone, Copy)]
struct AnyChoice(Choices);

impl Choice for AnyChoice {
    const BLENDS: bool = true;

    fn level(&self, lambda: i32) -> (u32, u32) {
        match self.0 {
            Choices::Base => FinestLevel.level(lambda),
            Choices::Nearest => NearestLevel.level(lambda),
            Choices::Safest => SafestLevel.level(lambda),
            Choices::Linear => LinearLevels.level(lambda),
        }
    }
}

/// Either rule.
#[derive(Clone, Copy)]
struct AnyRule(Rules);

impl Rule for AnyRule {
    type Length = i32;

    fn length(&self, step: [i64; 2]) -> i32 {
        match self.0 {
            Rules::LongestAxis => LongestAxis.log2(LongestAxis.length(step)),
            Rules::Euclidean => Euclidean.log2(Euclidean.length(step)),
        }
    }

    fn log2(&self, length: i32) -> i32 {
        length
    }

    type Word = i32;

    fn length_of_words(&self, step: [i32; 2]) -> i32 {
        match self.0 {
            Rules::LongestAxis => LongestAxis.log2_of_word(LongestAxis.length_of_words(step)),
            Rules::Euclidean => Euclidean.log2_of_word(Euclidean.length_of_words(step)),
        }
    }

    fn log2_of_word(&self, length: i32) -> i32 {
        length
    }
}

/// A filter of the core's, and the reference's of which it is an approximation.
#[derive(Clone, Copy, Debug)]
struct Filtering {
    ideal: Filter,
    /// Within a level.
    min: Within,
    mag: Within,
}

impl Filtering {
    fn new(min: Within, mag: Within, rule: Rules, choice: Choices, taps: u32) -> Self {
        let lod = lod::Lod {
            rule,
            choice,
            ..lod::Lod::default()
        };
        let ideal = Filter {
            min: min.reference(),
            mag: mag.reference(),
            lod,
            taps,
        };
        Self { ideal, min, mag }
    }
}

/// All filters that one pipeline serves for.
fn all_filters(taps: u32) -> impl Iterator<Item = Filtering> {
    const IMAGES: [Within; 3] = [Within::Nearest, Within::Linear, Within::Linear5];
    const CHOICES: [Choices; 4] = [
        Choices::Base,
        Choices::Nearest,
        Choices::Safest,
        Choices::Linear,
    ];
    // Anisotropic filters measure distances whatever the rule.
    let rules = &[Rules::LongestAxis, Rules::Euclidean][usize::from(taps > 1)..];
    let pairs = IMAGES
        .into_iter()
        .flat_map(|min| IMAGES.map(|mag| (min, mag)));
    pairs.flat_map(move |(min, mag)| {
        CHOICES.into_iter().flat_map(move |choice| {
            rules
                .iter()
                .map(move |&rule| Filtering::new(min, mag, rule, choice, taps))
        })
    })
}

/// A pyramid for the core and the same for the reference.
struct Picture<C> {
    texels: Vec<C>,
    size: (u32, u32),
    levels: Vec<Level>,
}

impl<C: Split> Picture<C> {
    fn new(random: &mut Rng, width: u32, height: u32) -> Self {
        let mut texels: Vec<C> = (0..pyramid::texels(width, height))
            .map(|_| C::random(random))
            .collect();
        // Coarser levels keep their noise: means of noise are all alike, and hide errors.
        if random.random() {
            build(&mut texels, width, height, Average::Stored).expect("all levels");
        }
        let core = Pyramid::<Texture<'_, C>>::new(&texels, width, height).expect("all levels");
        let levels = core
            .iter()
            .map(|level| {
                let texels = level.texels().iter().map(|t| t.split().map(f64::from));
                Level::new(level.width(), level.height(), texels.collect()).expect("all texels")
            })
            .collect();
        Self {
            texels,
            size: (width, height),
            levels,
        }
    }

    fn pyramid(&self) -> Pyramid<Texture<'_, C>> {
        Pyramid::<Texture<'_, C>>::new(&self.texels, self.size.0, self.size.1).expect("all levels")
    }
}

/// Pixels that were compared, those of them that are magnified, and those that lie at a tie.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    compared: u32,
    ties: u32,
    magnified: u32,
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.compared += other.compared;
        self.ties += other.ties;
        self.magnified += other.magnified;
    }
}

/// Lambda and logarithms of ratios are off by less (`FootprintRow::lambda`).
const LAMBDA: f64 = 1.0 / 4096.0;

/// A triangle, the reference's mapping, and how far the core's may be from it.
struct Case<'a> {
    vertices: &'a [ScreenVertex; 3],
    planes: Planes,
    corners: Corners,
    wrap: [Beyond; 2],
}

impl<'a> Case<'a> {
    fn new(vertices: &'a [ScreenVertex; 3], wrap: [Beyond; 2]) -> Option<Self> {
        let corners = Corners {
            position: vertices.map(|v| [v.x().to_num(), v.y().to_num()]),
            w: vertices.map(|v| v.w().to_num()),
            uv: vertices.map(|v| v.uv().map(I16F16::to_num)),
        };
        Some(Self {
            vertices,
            planes: Planes::new(&corners)?,
            corners,
            wrap,
        })
    }

    /// Levels that are read for a lambda, and with which filter.
    fn reads(filter: &Filter, lambda: f64, count: usize) -> (Image, Chosen) {
        let chosen = filter.lod.levels(lambda, count);
        let image = if matches!(chosen, Chosen::Magnified(_)) {
            filter.mag
        } else {
            filter.min
        };
        (image, chosen)
    }

    /// Whether a small error of lambda leads to another filter or another level. Between two levels
    /// nothing jumps.
    fn switches(filter: &Filter, lambda: f64, count: usize) -> bool {
        let [below, above] =
            [lambda - LAMBDA, lambda + LAMBDA].map(|lambda| Self::reads(filter, lambda, count));
        match (below, above) {
            ((image, Chosen::Magnified(a)), (other, Chosen::One(b))) => image != other || a != b,
            // From level 0 alone to level 0 and a little of the next.
            ((image, Chosen::Magnified(a)), (other, Chosen::Two { finer, .. })) => {
                image != other || a != finer
            }
            ((_, a), (_, b)) => filter.lod.choice != Choices::Linear && a != b,
        }
    }

    /// The samples of a pixel with lambda, as the reference takes them; `None` where a small error
    /// changes their number or the axis that they lie on.
    fn taps(
        &self,
        filter: &Filter,
        sample: &Sample,
        size: [f64; 2],
    ) -> Option<(Vec<[f64; 2]>, f64)> {
        let lod = &filter.lod;
        if filter.taps == 1 {
            return Some((vec![sample.uv], lod.rule.rho(sample, size).log2()));
        }
        let length = |d: [f64; 2]| (d[0] * size[0]).hypot(d[1] * size[1]);
        let (right, down) = (length(sample.dx), length(sample.dy));
        let excess = (right / down).log2().abs();
        // More samples than there may be are as many as there may be.
        let most = f64::from(filter.taps.ilog2());
        if excess < most + LAMBDA && (excess - excess.round()).abs() < LAMBDA {
            return None;
        }
        let octaves = excess.ceil().min(most);
        let (axis, long) = if right > down {
            (sample.dx, right)
        } else {
            (sample.dy, down)
        };
        let n = octaves.exp2();
        let places = (0..n as u32).map(|i| (f64::from(i) + 0.5) / n - 0.5);
        let at = places.map(|p| [0, 1].map(|k| sample.uv[k] + p * axis[k]));
        Some((at.collect(), long.log2() - octaves))
    }

    /// How far the places of samples may be off, in repeats.
    ///
    /// The step to the next sample is the quotient of a numerator and D Q^2: it is off by what
    /// lambda's rounding is, 2^-19 of its length where ratios of depths keep to 1:256
    /// (`FootprintRow::lambda`), and by 2^-24 repeats when it is cut; the outermost sample is half of
    /// 7 steps away.
    fn sample_error(&self, sample: &Sample, filter: &Filter, size: [f64; 2]) -> [f64; 2] {
        let exact = [0, 1].map(|axis| bound::every_pixel_at(&self.corners, axis, sample.w));
        if filter.taps == 1 {
            return exact;
        }
        [0, 1].map(|k| {
            let relative = 0.5 * sample.footprint(size) / size[k] / f64::from(1 << 19);
            exact[k] + relative + 5.0 / f64::from(1 << 24)
        })
    }

    /// Whether an error of the coordinate leads to another texel of a level.
    fn at_an_edge(uv: [f64; 2], error: [f64; 2], level: &Level) -> bool {
        let size = level.size();
        // Of one texel there is no other.
        (0..2).any(|k| {
            let off = uv[k] * size[k] - (uv[k] * size[k]).round();
            size[k] > 1.0 && off.abs() <= error[k] * size[k]
        })
    }

    /// How far the core's unrounded colour may be from the reference's, in units of the channel,
    /// if texels span `c`.
    ///
    /// | term | bound | from |
    /// |---|---|---|
    /// | weights of four texels | c 2^-9 | `Mipmapped` |
    /// | weight of a level, and lambda | c 2^-12 each | `Mipmapped` |
    /// | coordinates | c texels of error, along both axes | a bilinear surface is no steeper |
    /// | the mix, and the sum of samples | 2^-11 each | `Wide` |
    fn allowed(c: f64, error: [f64; 2], size: [f64; 2]) -> f64 {
        let coordinates = error[0] * size[0] + error[1] * size[1];
        c * (1.0 / 512.0 + 2.0 / 4096.0 + coordinates) + 2.0 / 2048.0
    }

    /// What 5 bits of subtexel precision add to it.
    ///
    /// | term | bound | from |
    /// |---|---|---|
    /// | coordinates to 1/32 texel | c 2^-6 along each axis | `LinearTexels5` |
    /// | the mix along v (that along u is the rounding of all filters) | 1/2 | `Lanes` |
    /// | of two levels: the weight, and the mix | c 2^-6 and 1/2 | `Wide` |
    /// | the mean of samples | 1/2 | `Wide` |
    fn allowed_more(c: f64, levels: usize, taps: usize) -> f64 {
        let mut more = c / 32.0 + 0.5;
        if levels > 1 {
            more += c / 64.0 + 0.5;
        }
        if taps > 1 {
            more += 0.5;
        }
        more
    }

    /// Compares what a shader draws with a filter of the reference.
    fn check<C, S>(&self, shader: S, filtering: &Filtering, levels: &[Level]) -> Tally
    where
        C: Split,
        S: Shader<Texel = C>,
    {
        let filter = &filtering.ideal;
        let mut frame = Frame::new(SIDE, SIDE, C::default(), Overdraw::Panics);
        let mut pipeline = Pipeline {
            strategy: PerPixel,
            sampler: shader,
            depth: NoDepth,
            cull: Cull::Off,
        };
        pipeline.draw_triangle(&mut frame, self.vertices);
        let mut tally = Tally::default();
        let size = levels[0].size();
        for (x, y) in frame.positions().filter(|&(x, y)| frame.count(x, y) > 0) {
            let sample = self.planes.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let error = self.sample_error(&sample, filter, size);
            let Some((taps, lambda)) = self.taps(filter, &sample, size) else {
                tally.ties += 1;
                continue;
            };
            let (image, chosen) = Self::reads(filter, lambda, levels.len());
            let read = match chosen {
                Chosen::Magnified(level) | Chosen::One(level) => level..=level,
                Chosen::Two { finer, coarser, .. } => finer..=coarser,
            };
            let read = || read.clone().map(|level| &levels[level as usize]);
            let jumps = Self::switches(filter, lambda, levels.len())
                || image == Image::Nearest
                    && read().any(|l| taps.iter().any(|&uv| Self::at_an_edge(uv, error, l)));
            if jumps {
                tally.ties += 1;
                continue;
            }
            let within = match chosen {
                Chosen::Magnified(_) => filtering.mag,
                _ => filtering.min,
            };
            let expected = filter.at(levels, self.wrap, &sample);
            let found = frame.pixel(x, y);
            for (k, bits) in C::BITS.into_iter().enumerate() {
                let most = f64::from((1u32 << bits) - 1);
                let allowed = Self::allowed(most, error, size);
                // Less than two steps between neighbours that differ by all there are.
                assert!(allowed < 2.0, "the coordinates are too far off: {allowed}");
                let more = match within {
                    Within::Linear5 => Self::allowed_more(most, read().count(), taps.len()),
                    _ => 0.0,
                };
                let off = f64::from(found.split()[k]) - expected[k];
                // Rounding the core's colour adds one half.
                assert!(
                    off.abs() <= allowed + more + 0.5,
                    "{x}, {y}: channel {k} is {}, not {}, lambda {lambda}, {filtering:?} {:?} of \
                     {size:?}: {:?}",
                    found.split()[k],
                    expected[k],
                    self.wrap,
                    self.vertices
                );
            }
            tally.compared += 1;
            tally.magnified += u32::from(matches!(chosen, Chosen::Magnified(_)));
        }
        tally
    }
}

fn vertex([x, y]: [f64; 2], w: f64, [u, v]: [f64; 2]) -> ScreenVertex {
    let [x, y] = [x, y].map(|c| I24F8::from_num(c));
    let uv = [u, v].map(|c| I16F16::from_num(c));
    ScreenVertex::new(x, y, I16F16::from_num(w), uv).expect("a vertex in range")
}

/// One texture mapped by some texels a pixel in x and in y, turned, from somewhere.
fn flat(texels: [f64; 2], turn: f64, size: [f64; 2]) -> [ScreenVertex; 3] {
    [[1.3, 2.6], [61.2, 5.4], [9.8, 62.1]].map(|[x, y]| {
        let (sin, cos) = turn.sin_cos();
        let turned = [cos * x - sin * y, sin * x + cos * y];
        let uv = [0, 1].map(|k| (turned[k] * texels[k] / size[k] + 0.37).clamp(-60.0, 60.0));
        vertex([x, y], 1.5, uv)
    })
}

/// The families of the conformance set (tests/conformance/filter), and triangles of all kinds.
fn shapes(random: &mut Rng, size: (u32, u32)) -> Vec<[ScreenVertex; 3]> {
    let size = [size.0, size.1].map(f64::from);
    let mut all = vec![
        // Magnified.
        flat([0.11, 0.07], 0.0, size),
        flat([0.31, 0.24], 0.7, size),
        // Minified, along the axes.
        flat([1.1, 1.23], 0.0, size),
        flat([3.4, 1.9], 0.0, size),
        flat([15.7, 11.0], 0.0, size),
        flat([1.3, 7.9], 0.0, size),
        // Turned.
        flat([1.7, 2.1], 0.5, size),
        flat([5.9, 6.8], 2.2, size),
        flat([2.3, 14.8], 3.9, size),
    ];
    // Floors: depth grows upwards, from less than a texel a pixel to many.
    for (far, repeats) in [(4.0, 2.0), (20.0, 5.0), (60.0, 9.0)] {
        let texels = |across: f64, deep: f64| {
            [across * 32.0 / size[0], deep * 32.0 / size[1]].map(|c| c.min(60.0))
        };
        all.push([
            vertex([-20.0, 63.7], 1.0, texels(0.1, 0.2)),
            vertex([90.2, 63.7], 1.0, texels(2.3, 0.2)),
            vertex([33.4, 1.2], far, texels(0.9, repeats)),
        ]);
    }
    while all.len() < 16 {
        let ratio: f64 = random.random_range(1.0..64.0);
        let texels: f64 = random.random_range(0.0..=9.0f64).exp2() * 0.5;
        let away = [0; 2].map(|_| random.random_range(-2.0..2.0));
        let corners = [0; 3].map(|_| {
            let position = [0; 2].map(|_| random.random_range(-30.0..94.0));
            let w = random.random_range(0.0..=ratio.ln()).exp();
            let uv = [0, 1].map(|k| {
                let c: f64 = away[k] + random.random_range(-1.0..1.0) * texels / size[k];
                c.clamp(-60.0, 60.0)
            });
            vertex(position, w, uv)
        });
        // Slivers, in which lambda is less exact, have a test of their own.
        let setup = TriangleSetup::new(&corners, Cull::Off);
        if setup.is_some_and(|s| s.twice_area() > 400 << 16) {
            all.push(corners);
        }
    }
    all
}

/// Draws the shapes of a size with one shader.
fn check_shapes<C, S>(
    picture: &Picture<C>,
    shapes: &[[ScreenVertex; 3]],
    wrap: [Beyond; 2],
    filtering: &Filtering,
    shader: S,
) -> Tally
where
    C: Split,
    S: Shader<Texel = C> + Copy,
{
    let mut tally = Tally::default();
    for vertices in shapes {
        let case = Case::new(vertices, wrap).expect("an area");
        tally += case.check(shader, filtering, &picture.levels);
    }
    tally
}

/// Every filter on a picture of each size.
fn check_all<C: Split, U: Named, V: Named>(seed: u64, sizes: &[(u32, u32)]) -> Tally {
    let mut random = seeded(seed);
    let mut tally = Tally::default();
    for &(width, height) in sizes {
        let picture = Picture::<C>::new(&mut random, width, height);
        let pyramid = picture.pyramid();
        let shapes = shapes(&mut random, picture.size);
        for filter in all_filters(1) {
            let of_levels = filter.ideal.lod;
            let (choice, rule) = (AnyChoice(of_levels.choice), AnyRule(of_levels.rule));
            let lod = Lod::new(choice, rule, EachPixel);
            let [min, mag] = [filter.min, filter.mag].map(AnyImage);
            let shader = Mipmapped::<_, _, _, _, U, V>::new(&pyramid, min, mag, lod);
            tally += check_shapes(&picture, &shapes, [U::NAME, V::NAME], &filter, shader);
        }
    }
    tally
}

/// Every filter with up to `N` samples on a picture of each size.
fn check_samples<const N: u32, C: Split, U: Named, V: Named>(
    seed: u64,
    sizes: &[(u32, u32)],
) -> Tally {
    let mut random = seeded(seed);
    let mut tally = Tally::default();
    for &(width, height) in sizes {
        let picture = Picture::<C>::new(&mut random, width, height);
        let pyramid = picture.pyramid();
        let shapes = shapes(&mut random, picture.size);
        for filter in all_filters(N) {
            let choice = AnyChoice(filter.ideal.lod.choice);
            let lod = Lod::new(choice, LongestAxis, EachPixel);
            let [min, mag] = [filter.min, filter.mag].map(AnyImage);
            let shader = Mipmapped::<_, _, _, _, U, V>::new(&pyramid, min, mag, lod);
            let shader = Anisotropic::<N, _>::new(shader);
            tally += check_shapes(&picture, &shapes, [U::NAME, V::NAME], &filter, shader);
        }
    }
    tally
}

/// Enough was compared, of both kinds, and little left out: lambda is within 2^-12 of a place
/// where the level switches at 1 of 2048 pixels if it is spread evenly, and of one of few if not; and
/// coordinates within 2^-14 texel of an edge are rarer still.
fn assert_most_was_compared(tally: Tally) {
    let Tally {
        compared,
        ties,
        magnified,
    } = tally;
    assert!(compared > 100_000, "{tally:?}");
    assert!(magnified > compared / 20, "{tally:?}");
    assert!(compared - magnified > compared / 5, "{tally:?}");
    assert!(ties < compared / 1_000, "{tally:?}");
}

const SQUARE: &[(u32, u32)] = &[(64, 64)];

/// The types themselves, as a user writes them.
#[test]
fn every_combination_of_types() {
    let mut random = seeded(801);
    let picture = Picture::<Rgb888>::new(&mut random, 64, 64);
    let shapes = shapes(&mut random, picture.size);
    let tally = std::cell::Cell::new(Tally::default());
    fn one<Min, Mag, C, R>(
        picture: &Picture<Rgb888>,
        shapes: &[[ScreenVertex; 3]],
        (min, mag, rule): (Min, Mag, R),
        rules: Rules,
    ) -> Tally
    where
        Min: NamedImage,
        Mag: NamedImage,
        C: NamedChoice,
        R: Rule,
    {
        let filter = Filtering::new(Min::NAME, Mag::NAME, rules, C::NAME, 1);
        let pyramid = picture.pyramid();
        let lod = Lod::new(C::default(), rule, EachPixel);
        let shader: Mipmapped<'_, _, Min, Mag, _> = Mipmapped::new(&pyramid, min, mag, lod);
        check_shapes(picture, shapes, [Beyond::Repeat; 2], &filter, shader)
    }
    macro_rules! all {
        ([$($choice:ty),+]) => {
            $(
                all!($choice, NearestTexel, NearestTexel);
                all!($choice, NearestTexel, LinearTexels);
                all!($choice, LinearTexels, NearestTexel);
                all!($choice, LinearTexels, LinearTexels);
                all!($choice, LinearTexels5, LinearTexels);
                all!($choice, NearestTexel, LinearTexels5);
                all!($choice, LinearTexels5, LinearTexels5);
            )+
        };
        ($choice:ty, $min:ident, $mag:ident) => {
            let mut sum = tally.get();
            let types = ($min, $mag, LongestAxis);
            sum += one::<_, _, $choice, _>(&picture, &shapes, types, Rules::LongestAxis);
            let types = ($min, $mag, Euclidean);
            sum += one::<_, _, $choice, _>(&picture, &shapes, types, Rules::Euclidean);
            tally.set(sum);
        };
    }
    all!([FinestLevel, NearestLevel, SafestLevel, LinearLevels]);
    assert_most_was_compared(tally.get());
}

#[test]
fn every_filter_in_every_colour() {
    assert_most_was_compared(check_all::<Rgb888, Repeat, Repeat>(811, SQUARE));
    assert_most_was_compared(check_all::<Rgb565, Repeat, Repeat>(812, SQUARE));
    assert_most_was_compared(check_all::<Gray8, Repeat, Repeat>(813, SQUARE));
    assert_most_was_compared(check_all::<Rgba5551, Repeat, Repeat>(814, SQUARE));
    assert_most_was_compared(check_all::<Rgba8888, Repeat, Repeat>(815, SQUARE));
}

#[test]
fn every_filter_with_every_wrap_mode() {
    assert_most_was_compared(check_all::<Rgb565, Clamp, Clamp>(821, SQUARE));
    assert_most_was_compared(check_all::<Rgb565, Mirror, Mirror>(822, SQUARE));
    assert_most_was_compared(check_all::<Rgb565, Repeat, Mirror>(823, SQUARE));
    assert_most_was_compared(check_all::<Rgb565, Clamp, Repeat>(824, SQUARE));
}

#[test]
fn every_filter_on_textures_of_every_shape() {
    let sizes = [(128, 16), (1, 64), (2, 1), (4, 4)];
    assert_most_was_compared(check_all::<Gray8, Repeat, Repeat>(831, &sizes));
    let sizes = [(8, 256), (256, 1), (1, 1)];
    assert_most_was_compared(check_all::<Gray8, Mirror, Clamp>(832, &sizes));
}

#[test]
fn rows_of_samples() {
    let sizes = [(64, 64), (1, 64)];
    assert_most_was_compared(check_samples::<2, Rgb888, Repeat, Repeat>(841, SQUARE));
    assert_most_was_compared(check_samples::<4, Rgb888, Repeat, Repeat>(842, SQUARE));
    assert_most_was_compared(check_samples::<8, Rgb888, Repeat, Repeat>(843, &sizes));
    assert_most_was_compared(check_samples::<8, Rgb565, Mirror, Clamp>(844, &[(128, 16)]));
    assert_most_was_compared(check_samples::<8, Rgba8888, Clamp, Repeat>(845, SQUARE));
}

/// The sampler without levels is the filter of the finest level.
#[test]
fn bilinear_is_linear_at_the_finest_level() {
    fn check<C, U, V, F>(seed: u64)
    where
        C: Split,
        U: Named,
        V: Named,
        F: NamedImage + Default,
    {
        let mut random = seeded(seed);
        let filter = Filtering::new(F::NAME, F::NAME, Rules::LongestAxis, Choices::Base, 1);
        for (width, height) in [(64, 64), (16, 128), (1, 1), (1, 32)] {
            let picture = Picture::<C>::new(&mut random, width, height);
            let count = (width * height) as usize;
            let texture = Texture::new(&picture.texels[..count], width, height).expect("a size");
            let shapes = shapes(&mut random, picture.size);
            let shader = Bilinear::<_, U, V, F>::new(texture);
            let tally = check_shapes(&picture, &shapes, [U::NAME, V::NAME], &filter, shader);
            // Nothing switches.
            assert!(tally.compared > 5_000 && tally.ties == 0, "{tally:?}");
        }
    }
    check::<Rgb888, Repeat, Repeat, LinearTexels>(851);
    check::<Rgb565, Clamp, Mirror, LinearTexels>(852);
    check::<Gray8, Mirror, Repeat, LinearTexels>(853);
    check::<Rgb888, Repeat, Repeat, LinearTexels5>(854);
    check::<Rgb565, Clamp, Mirror, LinearTexels5>(855);
    check::<Rgba8888, Mirror, Repeat, LinearTexels5>(856);
}

/// What 5 bits of subtexel precision are, to the last bit: the coordinate to the nearest 1/32 of a
/// texel, then the means along v, then along u, each to the nearest value.
#[test]
fn five_bits_as_they_are_defined() {
    fn check<C: Split>(seed: u64, width: u32, height: u32) {
        let mut random = seeded(seed);
        let texels: Vec<C> = (0..width * height)
            .map(|_| C::random(&mut random))
            .collect();
        let texture = Texture::new(&texels, width, height).expect("a size");
        let bilinear = Bilinear::<_, Repeat, Clamp, LinearTexels5>::new(texture);
        let mix = |a: f64, b: f64, weight: f64| (a + (b - a) * weight + 0.5).floor();
        for _ in 0..20_000 {
            let bits = [0; 2].map(|_| random.random_range(-(3 << 24)..3 << 24));
            let place = |bits: i32, side: u32| {
                let texels = f64::from(bits) / f64::from(1 << 24) * f64::from(side) - 0.5;
                let nearest = (32.0 * texels + 0.5).floor() / 32.0;
                (nearest.floor(), nearest - nearest.floor())
            };
            let (left, u) = place(bits[0], width);
            let (upper, v) = place(bits[1], height);
            let texel = |i: f64, j: f64| {
                let column = Beyond::Repeat.texel((i + 0.5) / f64::from(width), width);
                let row = Beyond::Clamp.texel((j + 0.5) / f64::from(height), height);
                texels[(row * width + column) as usize]
                    .split()
                    .map(f64::from)
            };
            let [a, b] = [left, left + 1.0].map(|i| texel(i, upper));
            let [c, d] = [left, left + 1.0].map(|i| texel(i, upper + 1.0));
            let found = bilinear.sample(Uv::from_bits(bits[0], bits[1])).split();
            for k in 0..4 {
                let expected = mix(mix(a[k], c[k], v), mix(b[k], d[k], v), u);
                assert!(f64::from(found[k]) == expected, "{bits:?}: {found:?}, {k}");
            }
        }
    }
    check::<Rgb565>(861, 64, 32);
    check::<Rgb565>(862, 4096, 1);
    check::<Rgb888>(863, 16, 128);
    check::<Gray8>(864, 2, 4);
    check::<Rgba5551>(865, 1, 8);
    check::<Rgba8888>(866, 32, 32);
}
