//! What a texture filter strives for, and how far one stays from it. The ideal colour of a pixel is
//! the mean of the texture over its whole square, here by many samples. An error is energy, and
//! splits without remainder into detail that the filter lost, detail that it made up, and brightness.

use super::filter::{Image, Level};
use super::{Beyond, Planes};

/// Samples in a pixel that make an ideal.
pub const SAMPLES: u32 = 512;

/// Where in the unit square the n-th sample lies: the R2 sequence of M. Roberts, "The unreasonable
/// effectiveness of quasirandom sequences" (2018). The step is (1/g, 1/g^2), where g is the plastic
/// number, g^3 = g + 1.
#[must_use]
pub fn place(n: u32) -> [f64; 2] {
    const PLASTIC: f64 = 1.324_717_957_244_746;
    [1.0 / PLASTIC, 1.0 / (PLASTIC * PLASTIC)].map(|step| (0.5 + f64::from(n) * step).fract())
}

/// The mean of the texture over the square of a pixel, all of it on the plane of the triangle, as if
/// the triangle had no edges: coverage is another matter. In the unit of the texels.
///
/// It is the mean of `samples` texels of level 0, none of them filtered, at the same places in every
/// pixel. With [`SAMPLES`] its error (root mean square, measured with turned checkerboards and
/// random texels of two values) is 0.7 % of the contrast at 2 texels a pixel, 1 % at 8 and 2 % from
/// 16 on, where some texels go without a sample; checkerboards at an unlucky angle reach 12 %.
/// Where a pixel spans less than a texel, the ideal is sharp texels with smooth edges, and a
/// bilinear filter counts as blurred.
///
/// Samples beyond the horizon, where 1/w is not positive, do not count. All zeros if none does.
#[must_use]
pub fn supersampled(
    planes: &Planes,
    x: u32,
    y: u32,
    level0: &Level,
    wrap: [Beyond; 2],
    samples: u32,
) -> [f64; 4] {
    let mut sum = [0.0; 4];
    let mut count = 0.0;
    for n in 0..samples {
        let [dx, dy] = place(n);
        let sample = planes.at(f64::from(x) + dx, f64::from(y) + dy);
        if sample.w > 0.0 && sample.w.is_finite() {
            let texel = level0.at(Image::Nearest, wrap, sample.uv);
            sum = std::array::from_fn(|k| sum[k] + texel[k]);
            count += 1.0;
        }
    }
    if count > 0.0 {
        sum.map(|c| c / count)
    } else {
        sum
    }
}

/// Side of the blocks in which [`Energy`] looks at a picture, in pixels.
pub const BLOCK: usize = 8;

/// How far a picture is from its ideal, as energy: means of squares over pixels and over red, green
/// and blue, in squared 8-bit units. `error` is `shift + blur + aliasing`, exactly.
///
/// In blocks of [`BLOCK`] x [`BLOCK`] pixels, the detail of a picture is what remains without the
/// block's mean colour. A least-squares fit finds the gain with which the ideal's detail is in the
/// filtered one: filtered = gain * ideal + rest, where the rest does not correlate with the ideal.
/// A filter that blurs has a gain below 1; what a filter adds, by texels that it skips, is the rest.
/// Since both parts are orthogonal, their energies add up.
///
/// What the split cannot tell: waves longer than a block count as `shift`; detail displaced by
/// a good part of its wavelength counts as lost and as made up; rounding of colours is `aliasing`,
/// about 4 units for RGB565. The error of the ideal itself, about (contrast / 100)^2, is mostly in
/// `aliasing`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Of the ideal's detail: what a picture of flat blocks would lose.
    pub signal: f64,
    /// Of the difference: the mean squared error.
    pub error: f64,
    /// Of the difference of the blocks' mean colours.
    pub shift: f64,
    /// Of the ideal's detail that is missing: at most `signal`.
    pub blur: f64,
    /// Of detail that the ideal does not have: moire, jagged and sparkling texels; and of
    /// its own detail where it is too strong or inverted.
    pub aliasing: f64,
}

impl Energy {
    /// Compares two pictures of `width` pixels a row, with channels of 8 bits, at the pixels that
    /// both have. `None` if there are none, or the pictures differ in size.
    #[must_use]
    pub fn between(
        filtered: &[Option<[f64; 4]>],
        ideal: &[Option<[f64; 4]>],
        width: usize,
    ) -> Option<Self> {
        if width == 0 || filtered.len() != ideal.len() {
            return None;
        }
        let blocks_in_row = width.div_ceil(BLOCK);
        let rows = filtered.len().div_ceil(width);
        let mut blocks = vec![Vec::new(); blocks_in_row * rows.div_ceil(BLOCK)];
        for (i, pair) in filtered.iter().zip(ideal).enumerate() {
            if let (Some(filtered), Some(ideal)) = pair {
                let (x, y) = (i % width / BLOCK, i / width / BLOCK);
                blocks[y * blocks_in_row + x].push([*filtered, *ideal]);
            }
        }
        let mut sum = Self::default();
        let mut pixels = 0;
        for block in &blocks {
            sum.add_block(block);
            pixels += block.len();
        }
        let mean = |energy: f64| energy / (3 * pixels) as f64;
        (pixels > 0).then(|| Self {
            signal: mean(sum.signal),
            error: mean(sum.error),
            shift: mean(sum.shift),
            blur: mean(sum.blur),
            aliasing: mean(sum.aliasing),
        })
    }

    /// Adds the sums of squares of one block of pairs, filtered and ideal.
    fn add_block(&mut self, block: &[[[f64; 4]; 2]]) {
        let count = block.len().max(1) as f64;
        // Of the details of the ideal, of both, and of the filtered, over the three channels.
        let (mut ideal_square, mut product, mut filtered_square) = (0.0, 0.0, 0.0);
        for k in 0..3 {
            let mean =
                |picture: usize| block.iter().map(|pair| pair[picture][k]).sum::<f64>() / count;
            let (filtered_mean, ideal_mean) = (mean(0), mean(1));
            self.shift += count * (filtered_mean - ideal_mean).powi(2);
            for [filtered, ideal] in block {
                let (f, i) = (filtered[k] - filtered_mean, ideal[k] - ideal_mean);
                self.error += (filtered[k] - ideal[k]).powi(2);
                ideal_square += i * i;
                product += f * i;
                filtered_square += f * f;
            }
        }
        self.signal += ideal_square;
        // A block without detail has none to lose.
        let gain = if ideal_square > 0.0 {
            product / ideal_square
        } else {
            1.0
        };
        // Nothing is lost above 1, and no more than all below 0: what goes further is added.
        let kept = gain.clamp(0.0, 1.0);
        self.blur += (1.0 - kept).powi(2) * ideal_square;
        let rest = (filtered_square - gain * product).max(0.0);
        let beyond = ((1.0 - gain).powi(2) - (1.0 - kept).powi(2)) * ideal_square;
        self.aliasing += rest + beyond;
    }
}

#[cfg(test)]
mod tests {
    use super::super::Corners;
    use super::*;

    #[test]
    fn the_samples_fill_the_pixel_evenly() {
        // Of boxes from a corner of the pixel, the part of the samples inside is the area to 1 %.
        // Random samples would be off by up to 1/sqrt(512), 4 %.
        let mut worst = 0.0f64;
        for i in 1..=40 {
            for j in 1..=40 {
                let corner = [f64::from(i) / 40.0, f64::from(j) / 40.0];
                let inside = (0..SAMPLES).map(place).filter(|p| {
                    let within = |k: usize| (0.0..corner[k]).contains(&p[k]);
                    within(0) && within(1)
                });
                let part = inside.count() as f64 / f64::from(SAMPLES);
                worst = worst.max((part - corner[0] * corner[1]).abs());
            }
        }
        assert!(worst < 0.01, "{worst}");
    }

    /// A triangle over the pixels from 0, 0 to 8, 8 and beyond, with u = x / 8 and v = y / 8.
    fn flat() -> Planes {
        let corners = Corners {
            position: [[0.0, 0.0], [0.0, 16.0], [16.0, 0.0]],
            w: [1.0; 3],
            uv: [[0.0, 0.0], [0.0, 2.0], [2.0, 0.0]],
        };
        Planes::new(&corners).expect("an area")
    }

    fn grey(width: u32, height: u32, value: impl Fn(u32, u32) -> f64) -> Level {
        let texels = (0..height)
            .flat_map(|y| (0..width).map(move |x| (x, y)))
            .map(|(x, y)| [value(x, y); 4]);
        Level::new(width, height, texels.collect()).expect("that many texels")
    }

    #[test]
    fn an_ideal_pixel_is_the_mean_of_its_texels() {
        // 4 x 4 texels a pixel, half of them white: random samples would be off by 2.2 % (their
        // standard deviation, 1/2 / sqrt(512)), these must be better than 1 %.
        let level = grey(32, 32, |x, y| f64::from(255 * ((x ^ y) & 1)));
        let wrap = [Beyond::Repeat; 2];
        let got = supersampled(&flat(), 3, 5, &level, wrap, SAMPLES);
        assert!((got[0] - 127.5).abs() < 255.0 * 0.01, "{got:?}");
        // One texel of sixteen, in each corner of the pixel 2, 1; and none of the pixel beside it.
        for (dx, dy) in [(0, 0), (3, 0), (0, 3), (3, 3)] {
            let level = grey(32, 32, |x, y| {
                f64::from(255 * u32::from((x, y) == (8 + dx, 4 + dy)))
            });
            let got = supersampled(&flat(), 2, 1, &level, wrap, SAMPLES);
            assert!((got[0] - 255.0 / 16.0).abs() < 255.0 * 0.01, "{got:?}");
            let aside = supersampled(&flat(), 3, 1, &level, wrap, SAMPLES);
            assert_eq!(aside[0], 0.0);
        }
        // A texel's edge that cuts a pixel at a quarter of its width.
        let level = grey(2, 1, |x, _| f64::from(100 * x));
        let corners = Corners {
            position: [[0.25, 0.0], [0.25, 2.0], [2.25, 0.0]],
            w: [1.0; 3],
            uv: [[0.5, 0.0], [0.5, 1.0], [1.5, 0.0]],
        };
        let planes = Planes::new(&corners).expect("an area");
        let got = supersampled(&planes, 0, 0, &level, [Beyond::Clamp; 2], SAMPLES);
        assert!((got[0] - 75.0).abs() < 1.0, "{got:?}");
    }

    #[test]
    fn an_ideal_ends_at_the_horizon() {
        // 1/w falls from 1 at y = 0 to 1/8 at 7, and is 0 at y = 8: the sky begins there.
        let corners = Corners {
            position: [[0.0, 0.0], [0.0, 7.0], [8.0, 0.0]],
            w: [1.0, 8.0, 1.0],
            uv: [[0.0, 0.0], [0.0, 8.0], [1.0, 0.0]],
        };
        let planes = Planes::new(&corners).expect("an area");
        let level = grey(1, 1, |_, _| 40.0);
        let at = |y| supersampled(&planes, 0, y, &level, [Beyond::Repeat; 2], SAMPLES)[0];
        assert_eq!([at(0), at(7), at(8), at(20)], [40.0, 40.0, 0.0, 0.0]);
        assert_eq!(
            supersampled(&planes, 0, 0, &level, [Beyond::Repeat; 2], 0),
            [0.0; 4]
        );
    }

    const SIDE: usize = 16;

    fn picture(value: impl Fn(f64, f64) -> f64) -> Vec<Option<[f64; 4]>> {
        (0..SIDE * SIDE)
            .map(|i| Some([value((i % SIDE) as f64, (i / SIDE) as f64); 4]))
            .collect()
    }

    fn between(filtered: impl Fn(f64, f64) -> f64, ideal: impl Fn(f64, f64) -> f64) -> Energy {
        let (filtered, ideal) = (picture(filtered), picture(ideal));
        let energy = Energy::between(&filtered, &ideal, SIDE).expect("pixels");
        let sum = energy.shift + energy.blur + energy.aliasing;
        assert!((sum - energy.error).abs() < 1e-9, "{energy:?}");
        energy
    }

    fn check(got: Energy, [signal, shift, blur, aliasing]: [f64; 4]) {
        let error = shift + blur + aliasing;
        for (got, wanted) in [
            (got.signal, signal),
            (got.error, error),
            (got.shift, shift),
            (got.blur, blur),
            (got.aliasing, aliasing),
        ] {
            assert!((got - wanted).abs() < 1e-9, "{got} is not {wanted}");
        }
    }

    /// Stripes of +-1 that alternate every `half` pixels.
    fn stripes(c: f64, half: f64) -> f64 {
        1.0 - 2.0 * (c / half).floor().rem_euclid(2.0)
    }

    #[test]
    fn energy_splits_by_what_was_done_to_the_ideal() {
        let ideal = |x: f64, _: f64| 100.0 + 20.0 * stripes(x, 2.0);
        // Signal: 20^2. Nothing done: no error.
        check(between(ideal, ideal), [400.0, 0.0, 0.0, 0.0]);
        // 3 brighter.
        check(
            between(|x, y| ideal(x, y) + 3.0, ideal),
            [400.0, 9.0, 0.0, 0.0],
        );
        // All detail lost; half of it.
        check(between(|_, _| 100.0, ideal), [400.0, 0.0, 400.0, 0.0]);
        let half = |x: f64, _: f64| 100.0 + 10.0 * stripes(x, 2.0);
        check(between(half, ideal), [400.0, 0.0, 100.0, 0.0]);
        // Other stripes on top, and where nothing should be.
        let moire = |x: f64, y: f64| ideal(x, y) + 5.0 * stripes(y, 1.0);
        check(between(moire, ideal), [400.0, 0.0, 0.0, 25.0]);
        check(between(moire, |_, _| 100.0), [0.0, 0.0, 0.0, 425.0]);
        // Detail too strong, by a half; and inverted: all of it lost, and 3 times as much made up.
        let strong = |x: f64, _: f64| 100.0 + 30.0 * stripes(x, 2.0);
        check(between(strong, ideal), [400.0, 0.0, 0.0, 100.0]);
        let inverted = |x: f64, _: f64| 100.0 - 20.0 * stripes(x, 2.0);
        check(between(inverted, ideal), [400.0, 0.0, 400.0, 1200.0]);
        // All at once.
        let all = |x: f64, y: f64| half(x, y) - 3.0 + 5.0 * stripes(y, 1.0);
        check(between(all, ideal), [400.0, 9.0, 100.0, 25.0]);
    }

    #[test]
    fn each_block_has_its_own_gain_and_mean() {
        // The left half blurred away, the right one 4 darker.
        let ideal = |x: f64, _: f64| 100.0 + 20.0 * stripes(x, 2.0);
        let mixed = |x: f64, y: f64| {
            if x < 8.0 { 100.0 } else { ideal(x, y) - 4.0 }
        };
        check(between(mixed, ideal), [400.0, 8.0, 200.0, 0.0]);
    }

    #[test]
    fn only_red_green_and_blue_of_pixels_in_both_pictures_count() {
        let colour = |r: f64, a: f64| Some([r, 50.0, 50.0, a]);
        let filtered = [colour(10.0, 0.0), None, colour(4.0, 9.0)];
        let ideal = [colour(16.0, 99.0), colour(1.0, 0.0), None];
        let energy = Energy::between(&filtered, &ideal, 3).expect("a pixel");
        // One pixel is its block's mean: 6^2 over three channels.
        check(energy, [0.0, 12.0, 0.0, 0.0]);
        assert_eq!(Energy::between(&filtered, &ideal[..2], 3), None);
        assert_eq!(Energy::between(&filtered, &ideal, 0), None);
        assert_eq!(Energy::between(&[], &[], 3), None);
        assert_eq!(Energy::between(&[None], &[colour(1.0, 1.0)], 1), None);
    }
}
