//! Texture filters in float64. Mip levels and a sample enter; an unrounded colour leaves. A filter
//! inside a level, a choice of levels and a row of taps are independent of each other, and all
//! combinations are weighted means of texels.

use super::lod::{Chosen, Lod};
use super::{Beyond, Sample};

/// The filter inside one mip level.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Image {
    /// The texel that the coordinate falls into.
    #[default]
    Nearest,
    /// Bilinear between the four texels whose centres, at (i + 0.5) / n, enclose the coordinate.
    Linear,
}

/// One mip level.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    width: u32,
    height: u32,
    texels: Vec<[f64; 4]>,
}

impl Level {
    /// A level of `width * height` texels, row by row from the top, with channels in any unit.
    /// `None` if a side is 0 or the number of texels is another one.
    #[must_use]
    pub fn new(width: u32, height: u32, texels: Vec<[f64; 4]>) -> Option<Self> {
        let fits =
            width > 0 && height > 0 && texels.len() as u64 == u64::from(width) * u64::from(height);
        fits.then_some(Self {
            width,
            height,
            texels,
        })
    }

    /// Texels in a row.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All texels, row by row from the top.
    #[must_use]
    pub fn texels(&self) -> &[[f64; 4]] {
        &self.texels
    }

    /// Width and height in texels.
    #[must_use]
    pub fn size(&self) -> [f64; 2] {
        [self.width, self.height].map(f64::from)
    }

    /// The colour at u and v in repeats.
    #[must_use]
    pub fn at(&self, image: Image, wrap: [Beyond; 2], uv: [f64; 2]) -> [f64; 4] {
        match image {
            Image::Nearest => self.texel(
                wrap[0].texel(uv[0], self.width),
                wrap[1].texel(uv[1], self.height),
            ),
            Image::Linear => {
                let ([left, right], across) = neighbours(wrap[0], uv[0], self.width);
                let ([above, below], down) = neighbours(wrap[1], uv[1], self.height);
                let row = |y| mix(self.texel(left, y), self.texel(right, y), across);
                mix(row(above), row(below), down)
            }
        }
    }

    fn texel(&self, x: u32, y: u32) -> [f64; 4] {
        self.texels[y as usize * self.width as usize + x as usize]
    }
}

/// The two texels of an axis whose centres enclose a coordinate in repeats, wrapped, and the part
/// of the second: 0 or more, less than 1.
fn neighbours(wrap: Beyond, coordinate: f64, size: u32) -> ([u32; 2], f64) {
    let x = coordinate * f64::from(size) - 0.5;
    let first = x.floor() as i64;
    // Infinite coordinates have no fraction.
    let fraction = x - x.floor();
    let fraction = if fraction.is_nan() { 0.0 } else { fraction };
    let texels = [first, first.saturating_add(1)].map(|i| wrap.wrapped(i, size));
    (texels, fraction)
}

/// `a` and `b` in the proportion (1 - weight) : weight.
fn mix(a: [f64; 4], b: [f64; 4], weight: f64) -> [f64; 4] {
    std::array::from_fn(|i| a[i] * (1.0 - weight) + b[i] * weight)
}

/// A texture filter, as a sampler state of a graphics API describes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filter {
    /// Inside a level, where lambda > 0.
    pub min: Image,
    /// Inside a level, where lambda <= 0: at most one texel a pixel.
    pub mag: Image,
    /// Makes lambda, and levels from it.
    pub lod: Lod,
    /// Most samples along the longer axis of a pixel's footprint: 1 is isotropic, 2, 4 or 8
    /// anisotropic. Other numbers count as the next lower power of two, 0 as 1.
    pub taps: u32,
}

impl Filter {
    /// The unrounded colour of a pixel, in the unit of the texels. `levels` begins with level 0;
    /// without any the colour is all zeros.
    ///
    /// An anisotropic filter takes the footprint's axes to be the steps of one pixel to the right
    /// and of one down, with Euclidean lengths whatever [`Lod::rule`] says. It spreads
    /// n = 2^k >= long / short taps evenly along the longer axis, tap i at (i + 0.5) / n - 0.5 of
    /// it, each filtered for the n-th part: rho = long / n. The idea is that of
    /// `EXT_texture_filter_anisotropic`, which leaves the places of the taps open.
    #[must_use]
    pub fn at(&self, levels: &[Level], wrap: [Beyond; 2], sample: &Sample) -> [f64; 4] {
        let Some(level0) = levels.first() else {
            return [0.0; 4];
        };
        let size = level0.size();
        if self.taps <= 1 {
            let lambda = self.lod.lambda(sample, size);
            return self.with_lambda(levels, wrap, sample.uv, lambda);
        }
        let footprint = Footprint::new(sample, size, self.taps);
        let lambda = self.lod.lambda_of(footprint.rho);
        let n = f64::from(footprint.taps);
        let mut mean = [0.0; 4];
        for i in 0..footprint.taps {
            let place = (f64::from(i) + 0.5) / n - 0.5;
            let uv = [0, 1].map(|k| sample.uv[k] + place * footprint.axis[k]);
            let tap = self.with_lambda(levels, wrap, uv, lambda);
            mean = std::array::from_fn(|k| mean[k] + tap[k] / n);
        }
        mean
    }

    /// The unrounded colour at u and v in repeats, isotropic, for a lambda from elsewhere: one of a
    /// whole span or triangle, say. It is used as it is, without bias and limits.
    #[must_use]
    pub fn with_lambda(
        &self,
        levels: &[Level],
        wrap: [Beyond; 2],
        uv: [f64; 2],
        lambda: f64,
    ) -> [f64; 4] {
        if levels.is_empty() {
            return [0.0; 4];
        }
        let at = |image, level: u32| levels[level as usize].at(image, wrap, uv);
        match self.lod.levels(lambda, levels.len()) {
            Chosen::Magnified(level) => at(self.mag, level),
            Chosen::One(level) => at(self.min, level),
            Chosen::Two {
                finer,
                coarser,
                weight,
            } => mix(at(self.min, finer), at(self.min, coarser), weight),
        }
    }
}

/// A pixel's footprint as a row of taps.
struct Footprint {
    /// Taps in the row; a power of two.
    taps: u32,
    /// The whole row, in repeats.
    axis: [f64; 2],
    /// The level-0 texels that one tap stands for.
    rho: f64,
}

impl Footprint {
    /// Of a texture of this size in texels, with at most `most` taps; `most` is not 0.
    fn new(sample: &Sample, size: [f64; 2], most: u32) -> Self {
        let length = |d: [f64; 2]| (d[0] * size[0]).hypot(d[1] * size[1]);
        let (right, down) = (length(sample.dx), length(sample.dy));
        let (long, short, axis) = if down > right {
            (down, right, sample.dy)
        } else {
            (right, down, sample.dx)
        };
        // A footprint without width takes all taps, one without length too makes this NaN: one.
        let ratio = long / short;
        let mut taps = 1;
        while taps <= most / 2 && f64::from(taps) < ratio {
            taps *= 2;
        }
        Self {
            taps,
            axis,
            rho: long / f64::from(taps),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::lod::{Choice, Rule};
    use super::*;

    const WRAPS: [Beyond; 3] = [Beyond::Repeat, Beyond::Clamp, Beyond::Mirror];

    /// A level of grey texels.
    fn grey(width: u32, height: u32, values: &[f64]) -> Level {
        let texels = values.iter().map(|&g| [g; 4]).collect();
        Level::new(width, height, texels).expect("that many texels")
    }

    fn sample(uv: [f64; 2], dx: [f64; 2], dy: [f64; 2]) -> Sample {
        Sample { uv, w: 1.0, dx, dy }
    }

    fn filter(min: Image, mag: Image, choice: Choice, taps: u32) -> Filter {
        let lod = Lod {
            choice,
            ..Lod::default()
        };
        Filter {
            min,
            mag,
            lod,
            taps,
        }
    }

    fn all_filters() -> Vec<Filter> {
        let mut all = Vec::new();
        for min in [Image::Nearest, Image::Linear] {
            for mag in [Image::Nearest, Image::Linear] {
                for choice in [
                    Choice::Base,
                    Choice::Nearest,
                    Choice::Safest,
                    Choice::Linear,
                ] {
                    for taps in [1, 2, 4, 8] {
                        all.push(filter(min, mag, choice, taps));
                    }
                }
            }
        }
        all
    }

    #[test]
    fn a_level_has_as_many_texels_as_its_sides_say() {
        assert!(Level::new(2, 3, vec![[0.0; 4]; 6]).is_some());
        assert!(Level::new(2, 3, vec![[0.0; 4]; 5]).is_none());
        assert!(Level::new(2, 3, vec![[0.0; 4]; 7]).is_none());
        assert!(Level::new(0, 3, Vec::new()).is_none());
        assert!(Level::new(3, 0, Vec::new()).is_none());
    }

    #[test]
    fn bilinear_is_the_texel_at_its_centre_and_the_mean_half_way() {
        let level = grey(4, 2, &[10.0, 20.0, 40.0, 80.0, 110.0, 120.0, 140.0, 180.0]);
        let at = |u, v| level.at(Image::Linear, [Beyond::Clamp; 2], [u, v])[0];
        for y in 0..2 {
            for x in 0..4 {
                let [u, v] = [f64::from(x), f64::from(y)].map(|c| c + 0.5);
                let wanted = level.texel(x, y)[0];
                assert_eq!(at(u / 4.0, v / 2.0), wanted, "{x} {y}");
            }
        }
        assert_eq!(at(1.0 / 4.0, 0.25), 15.0);
        assert_eq!(at(2.0 / 4.0, 0.75), 130.0);
        assert_eq!(at(0.375, 0.5), 70.0);
        // A quarter of the way right and three quarters down: 10, 20 over 110, 120.
        assert_eq!(at(0.75 / 4.0, 1.25 / 2.0), 12.5 * 0.25 + 112.5 * 0.75);
        // Nearest changes there, and only there.
        let nearest = |u| level.at(Image::Nearest, [Beyond::Clamp; 2], [u, 0.25])[0];
        assert_eq!([nearest(0.2499), nearest(0.25)], [10.0, 20.0]);
    }

    #[test]
    fn each_channel_is_filtered_by_itself() {
        let texels = vec![[1.0, 10.0, 100.0, 0.0], [3.0, 30.0, 200.0, 1.0]];
        let level = Level::new(2, 1, texels).expect("two texels");
        let half = level.at(Image::Linear, [Beyond::Clamp; 2], [0.5, 0.5]);
        assert_eq!(half, [2.0, 20.0, 150.0, 0.5]);
    }

    #[test]
    fn bilinear_wraps_its_neighbours_at_the_edges() {
        let level = grey(4, 1, &[10.0, 20.0, 40.0, 80.0]);
        let at = |wrap, x: f64| level.at(Image::Linear, [wrap; 2], [x / 4.0, 0.5])[0];
        // Left edge: between texel -1 and 0; right edge: between texel 3 and 4.
        for (wrap, left, right, before, beyond) in [
            (Beyond::Repeat, 45.0, 45.0, 80.0, 10.0),
            (Beyond::Clamp, 10.0, 80.0, 10.0, 80.0),
            (Beyond::Mirror, 10.0, 80.0, 10.0, 80.0),
        ] {
            assert_eq!(at(wrap, 0.0), left, "{wrap:?}");
            assert_eq!(at(wrap, 4.0), right, "{wrap:?}");
            assert_eq!(at(wrap, -0.5), before, "{wrap:?}");
            assert_eq!(at(wrap, 4.5), beyond, "{wrap:?}");
        }
        // One texel further out the mirror runs backwards and the clamp stands still.
        assert_eq!(at(Beyond::Mirror, -1.0), 15.0);
        assert_eq!(at(Beyond::Clamp, -1.0), 10.0);
        assert_eq!(at(Beyond::Repeat, -1.0), 60.0);
        // The axes wrap by their own rules.
        let square = grey(2, 2, &[0.0, 100.0, 40.0, 140.0]);
        let corner = square.at(Image::Linear, [Beyond::Repeat, Beyond::Clamp], [0.0, 0.0]);
        assert_eq!(corner[0], 50.0);
        let corner = square.at(Image::Linear, [Beyond::Clamp, Beyond::Repeat], [0.0, 0.0]);
        assert_eq!(corner[0], 20.0);
    }

    #[test]
    fn an_axis_of_one_texel_is_constant() {
        let row = grey(1, 4, &[10.0, 20.0, 40.0, 80.0]);
        for wrap in WRAPS {
            for u in [-7.3, -0.5, 0.0, 0.25, 0.5, 1.0, 1.75, 1e9] {
                let at = |image, v| row.at(image, [wrap; 2], [u, v])[0];
                assert_eq!(at(Image::Linear, 0.375), 20.0, "{wrap:?} {u}");
                assert_eq!(at(Image::Linear, 0.5), 30.0, "{wrap:?} {u}");
                assert_eq!(at(Image::Nearest, 0.5), 40.0, "{wrap:?} {u}");
            }
        }
    }

    /// Level k is flat with the value 100 k.
    fn numbered(levels: u32) -> Vec<Level> {
        (0..levels)
            .map(|k| {
                let side = 1 << (levels - 1 - k);
                grey(
                    side,
                    side,
                    &vec![f64::from(100 * k); (side * side) as usize],
                )
            })
            .collect()
    }

    #[test]
    fn the_level_that_is_read_is_the_chosen_one() {
        let levels = numbered(4);
        let wrap = [Beyond::Repeat; 2];
        let at = |choice, texels: f64| {
            let s = sample([0.3; 2], [texels / 8.0, 0.0], [0.0, texels / 8.0]);
            filter(Image::Nearest, Image::Nearest, choice, 1).at(&levels, wrap, &s)[0]
        };
        let rho = 2.0f64.powf(1.25);
        assert_eq!(at(Choice::Base, rho), 0.0);
        assert_eq!(at(Choice::Nearest, rho), 100.0);
        assert_eq!(at(Choice::Safest, rho), 300.0);
        assert!((at(Choice::Linear, rho) - 125.0).abs() < 1e-9);
        assert_eq!(at(Choice::Linear, 100.0), 300.0);
        assert_eq!(at(Choice::Linear, 0.5), 0.0);
        // A lambda from outside is taken as it is, whatever the bias and the limits.
        let mut lod = Lod {
            choice: Choice::Linear,
            bias: 3.0,
            max: 0.0,
            ..Lod::default()
        };
        lod.rule = Rule::Euclidean;
        let filter = Filter {
            lod,
            ..filter(Image::Nearest, Image::Nearest, Choice::Base, 1)
        };
        let colour = filter.with_lambda(&levels, wrap, [0.3; 2], 1.75);
        assert_eq!(colour[0], 175.0);
    }

    #[test]
    fn magnification_has_its_own_filter() {
        let levels = [grey(2, 1, &[0.0, 100.0]), grey(1, 1, &[50.0])];
        let at = |min, mag, lambda| {
            filter(min, mag, Choice::Base, 1).with_lambda(
                &levels,
                [Beyond::Clamp; 2],
                [0.375, 0.5],
                lambda,
            )[0]
        };
        // A quarter of the way from the first centre to the second.
        assert_eq!(at(Image::Nearest, Image::Linear, 0.0), 25.0);
        assert_eq!(at(Image::Nearest, Image::Linear, 1e-9), 0.0);
        assert_eq!(at(Image::Linear, Image::Nearest, 0.0), 0.0);
        assert_eq!(at(Image::Linear, Image::Nearest, 1e-9), 25.0);
    }

    #[test]
    fn eight_to_one_is_the_mean_of_eight_taps() {
        // 8 texels across and 1 down: 8 taps of one texel each, at 9.5 to 16.5 texels.
        let values: Vec<_> = (0..32).map(|i| f64::from(i * i)).collect();
        let levels = [grey(32, 1, &values), grey(16, 1, &[1e6; 16])];
        let s = sample([13.0 / 32.0, 0.5], [8.0 / 32.0, 0.0], [0.0, 1.0]);
        let wanted = (9..17).map(|i| f64::from(i * i)).sum::<f64>() / 8.0;
        for image in [Image::Nearest, Image::Linear] {
            let filter = filter(image, image, Choice::Nearest, 8);
            let colour = filter.at(&levels, [Beyond::Repeat; 2], &s);
            assert_eq!(colour[0], wanted, "{image:?}");
        }
        // The same turned by 90 degrees: the longer axis is the one down.
        let levels = [grey(1, 32, &values), grey(1, 16, &[1e6; 16])];
        let s = sample([0.5, 13.0 / 32.0], [1.0, 0.0], [0.0, 8.0 / 32.0]);
        let filter = filter(Image::Nearest, Image::Nearest, Choice::Nearest, 8);
        assert_eq!(filter.at(&levels, [Beyond::Repeat; 2], &s)[0], wanted);
    }

    #[test]
    fn taps_are_a_power_of_two_and_share_the_longer_axis() {
        // Texels right and down, most taps; taps, texels that each stands for.
        for (right, down, most, taps, rho) in [
            (8.0, 1.0, 8, 8, 1.0),
            (8.0, 1.0, 4, 4, 2.0),
            (1.0, 8.0, 2, 2, 4.0),
            (8.0, 4.0, 8, 2, 4.0),
            (8.0, 3.9, 8, 4, 2.0),
            (3.0, 3.0, 8, 1, 3.0),
            (3.0, 0.0, 8, 8, 0.375),
            (0.0, 0.0, 8, 1, 0.0),
            (100.0, 1.0, 8, 8, 12.5),
            (8.0, 1.0, 1, 1, 8.0),
            (8.0, 1.0, 7, 4, 2.0),
        ] {
            let s = sample([0.0; 2], [right / 64.0, 0.0], [0.0, down / 32.0]);
            let row = Footprint::new(&s, [64.0, 32.0], most);
            assert_eq!((row.taps, row.rho), (taps, rho), "{right} {down} {most}");
            let axis = if down > right { s.dy } else { s.dx };
            assert_eq!(row.axis, axis, "{right} {down}");
        }
        // Equal lengths: the axis to the right. And lengths are Euclidean.
        let s = sample([0.0; 2], [0.0, 3.0 / 32.0], [3.0 / 64.0, 0.0]);
        assert_eq!(Footprint::new(&s, [64.0, 32.0], 8).axis, s.dx);
        let s = sample([0.0; 2], [3.0 / 64.0, 4.0 / 32.0], [0.0, 4.9 / 32.0]);
        let row = Footprint::new(&s, [64.0, 32.0], 8);
        assert_eq!((row.taps, row.axis), (2, s.dx));
    }

    #[test]
    fn the_level_of_a_tap_is_that_of_its_share() {
        let levels = numbered(7);
        let s = sample([0.3; 2], [32.0 / 64.0, 0.0], [0.0, 2.0 / 64.0]);
        for (taps, level) in [(1, 5), (2, 4), (4, 3), (8, 2)] {
            let filter = filter(Image::Linear, Image::Linear, Choice::Nearest, taps);
            let colour = filter.at(&levels, [Beyond::Mirror; 2], &s);
            assert_eq!(colour[0], f64::from(100 * level), "{taps} taps");
        }
        let mut biased = filter(Image::Linear, Image::Linear, Choice::Nearest, 8);
        biased.lod.bias = 1.0;
        biased.lod.max = 2.5;
        assert_eq!(biased.at(&levels, [Beyond::Mirror; 2], &s)[0], 200.0);
        biased.lod.max = 12.0;
        assert_eq!(biased.at(&levels, [Beyond::Mirror; 2], &s)[0], 300.0);
    }

    #[test]
    fn a_constant_texture_stays_constant() {
        let colour = [7.0, 31.0, 200.0, 255.0];
        let levels: Vec<_> = [(8, 4), (4, 2), (2, 1), (1, 1)]
            .map(|(w, h)| Level::new(w, h, vec![colour; (w * h) as usize]).expect("full"))
            .into();
        let samples = [
            sample([0.1, 0.9], [0.01, 0.0], [0.0, 0.01]),
            sample([-3.3, 7.7], [0.3, -0.1], [0.02, 0.05]),
            sample([0.5, 0.5], [0.0, 5.0], [0.0, 0.0]),
            sample([1.0, 0.0], [0.0; 2], [0.0; 2]),
        ];
        for filter in all_filters() {
            for wrap in WRAPS {
                for s in &samples {
                    let got = filter.at(&levels, [wrap; 2], s);
                    for k in 0..4 {
                        // Weights sum to 1 but for rounding.
                        let off = (got[k] - colour[k]).abs();
                        assert!(off < 1e-10, "{filter:?} {wrap:?} {s:?}: {got:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_filter_never_leaves_the_range_of_the_texels() {
        let levels = [
            grey(4, 2, &[3.0, 9.0, 4.0, 7.0, 5.0, 3.0, 9.0, 8.0]),
            grey(2, 1, &[5.0, 7.0]),
            grey(1, 1, &[6.0]),
        ];
        let values = [0.0, -0.0, 0.3, -1.7, 1e30, -1e30, f64::INFINITY, f64::NAN];
        for filter in all_filters() {
            for wrap in WRAPS {
                for a in values {
                    for b in values {
                        let s = sample([a, b], [b, a], [a, b]);
                        let got = filter.at(&levels, [wrap; 2], &s)[0];
                        let inside = (3.0 - 1e-9..=9.0 + 1e-9).contains(&got);
                        assert!(inside, "{filter:?} {wrap:?} {s:?}: {got}");
                    }
                }
            }
            let s = sample([0.0; 2], [0.0; 2], [0.0; 2]);
            let wrap = [Beyond::Clamp; 2];
            assert_eq!(filter.at(&[], wrap, &s), [0.0; 4]);
            assert_eq!(filter.with_lambda(&[], wrap, s.uv, 1.0), [0.0; 4]);
        }
    }
}
