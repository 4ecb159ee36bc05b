//! How long pieces of scanlines may be, by how near they are.

use crate::arith::{
    keep_rolled, leading_zeros, leading_zeros_long, product, product_unsigned, quotient_apart,
    stepwise,
};
use crate::perspective::homogeneous::words::Words;

/// The most pieces that are made one after another before 1/w is looked at again: each may add half a unit to its
/// error.
const GROUP: u32 = 16;

/// A length of pieces.
struct Length {
    pixels: u32,
    /// Its square over that of four pixels.
    square: u32,
    /// The cube root of that, in 2^-11, rounded up.
    root: u32,
}

/// Those of which pieces are longer than a pixel; of powers of two up to 16 pixels, groups are made.
const LENGTHS: [Length; 6] = {
    const fn length(pixels: u32, root: u32) -> Length {
        Length {
            pixels,
            square: pixels * pixels / 16,
            root,
        }
    }
    [
        length(4, 2048),
        length(8, 3251),
        length(16, 5161),
        length(32, 8192),
        length(48, 10_735),
        length(64, 13_004),
    ]
};

/// What [`cross`] cuts off.
const CUT: i32 = 33;

/// The inverse of a bound in 2^-12 footprints, rounded up: `mantissa 2^(exponent - 47)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct InverseBound {
    /// `2^15 ..= 2^16`.
    mantissa: u32,
    exponent: u8,
}

impl InverseBound {
    /// Of up to 27 bits. Of 0 it is so large that no length is ever near enough.
    pub(super) const fn of(bound: u32) -> Self {
        if bound == 0 {
            return Self {
                mantissa: 1 << 16,
                exponent: 80,
            };
        }
        let exponent = bound.leading_zeros();
        Self {
            mantissa: (1u64 << (47 - exponent)).div_ceil(bound as u64) as u32,
            exponent: exponent as u8,
        }
    }
}

/// By how much coordinates are squeezed along scanlines: `q^2 du/dx`, of which q is the word of 1/w and u is in texels.
///
/// This is the same everywhere on a scanline, and changes evenly from one to the next. The larger one of u's and v's.
#[derive(Clone, Copy, Debug)]
pub(super) struct Squeeze {
    mantissa: u32,
    exponent: i32,
}

/// `q du' - u q'`, of u/w, 1/w and how they change; in `2^CUT`, to within 3 units. The words of 1/w and of u/w may be
/// half a unit off, and their changes one.
#[inline]
fn cross([u, half_q]: [i32; 2], [u_step, q_step]: [i32; 2]) -> i32 {
    let [a, b] = [product(u_step, half_q) >> 32, product(u, q_step) >> CUT];
    a.wrapping_sub(b) as i32
}

/// What is to be known of a triangle, or of one of its scanlines.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    /// At a pixel, and the changes to the right and down.
    pub(super) words: [Words; 3],
    /// How far down from that pixel the triangle reaches, in subpixels: two of its corners, to within a pixel.
    pub(super) corners: [i32; 2],
    /// Coordinates are quotients of words times a power of two: its logarithm, for texels of u and v.
    pub(super) log2_texels: [i32; 2],
}

impl Shape {
    /// The largest magnitude of one coordinate's squeeze, in `2^CUT`; of u/w at the pixel, and the changes.
    // A function of its own: there are two coordinates.
    #[inline(never)]
    fn squeeze_of(&self, [u, right, down]: [i32; 3]) -> u32 {
        let [q, q_right, q_down] = self.words.map(|words| words.q.cast_signed());
        let half_q = (q.cast_unsigned() >> 1).cast_signed();
        let here = cross([u, half_q], [right, q_right]);
        let farther = cross([down, q_down >> 1], [right, q_right]);
        let most = self.corners.iter().fold(here.unsigned_abs(), |most, &far| {
            let there = (product(farther, far) >> 8).wrapping_add(i64::from(here));
            most.max(u32::try_from(there.unsigned_abs()).unwrap_or(u32::MAX))
        });
        // The pixel is up to a row from its corner; all rows are off by 3 units.
        let [a, b] = self.corners.map(i32::unsigned_abs);
        let rows = (a.max(b) >> 8).wrapping_add(3);
        most.saturating_add(farther.unsigned_abs())
            .saturating_add(rows.wrapping_mul(3))
    }

    #[inline]
    fn squeeze(&self) -> Squeeze {
        let [u, v] = self.log2_texels;
        let most = u.max(v);
        let of = |values: [i32; 3], log2: i32| {
            let down = most.wrapping_sub(log2).cast_unsigned().min(31);
            (self.squeeze_of(values) >> down).saturating_add(1)
        };
        let [of_u, of_v] = [
            of(self.words.map(|words| words.u), u),
            of(self.words.map(|words| words.v), v),
        ];
        Squeeze {
            mantissa: of_u.max(of_v),
            exponent: most.wrapping_add(CUT),
        }
    }
}

/// How near pixels have to be for pieces of a length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lengths {
    /// 1/w rises along scanlines.
    rises: bool,
    /// The reciprocal of how much 1/w changes in a pixel, 16 bits, rounded down; how far differences of 1/w are shifted
    /// down before they are multiplied with that, and after.
    inverse: u32,
    before: u8,
    after: u8,
    /// For each of [`LENGTHS`], 1/w at the first pixel of pieces is more than this.
    least: [u32; LENGTHS.len()],
}

/// How long the pieces are at a place: a pixel, or one of [`LENGTHS`].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Level(usize);

impl Level {
    #[inline]
    pub(super) fn pixels(self) -> u32 {
        let length = LENGTHS.get(self.0.wrapping_sub(1));
        length.map_or(1, |length| length.pixels)
    }

    /// The base-2 logarithm of the length, if groups are made of it.
    #[inline]
    pub(super) fn log2_grouped(self) -> Option<u32> {
        let log2 = (self.0 as u32).wrapping_add(1);
        matches!(log2, 2..=4).then_some(log2)
    }
}

/// `mantissa 2^exponent`, rounded up, or the largest number.
#[inline]
fn whole(mantissa: u32, exponent: i32) -> u32 {
    if exponent < 0 {
        (mantissa >> exponent.unsigned_abs().min(31)).saturating_add(1)
    } else if exponent.cast_unsigned() > mantissa.leading_zeros() {
        u32::MAX
    } else {
        mantissa << (exponent & 31)
    }
}

/// The cube root of a number of up to 30 bits, rounded down.
#[inline]
fn cube_root(n: u32) -> u32 {
    let (mut root, mut bit) = (0u32, stepwise(1 << 9));
    while bit > 0 {
        let more = root | bit;
        if more.wrapping_mul(more).wrapping_mul(more) <= n {
            root = more;
        }
        bit >>= 1;
        keep_rolled();
    }
    root
}

/// How near pixels have to be for a length.
struct Nearness {
    rises: bool,
    /// How much 1/w changes in a pixel: at least where it rises, at most where it falls.
    slope: u32,
    /// T of four pixels and the cube root of T D, see [`Lengths::new`]: mantissas and exponents.
    linear: u32,
    linear_exponent: i32,
    root: u32,
    root_exponent: i32,
}

impl Nearness {
    /// 1/w has to be more than this.
    // A function of its own: in a loop the compiler makes copies of it for both directions.
    #[inline(never)]
    fn least(&self, length: &Length) -> u32 {
        let reach = self.slope.saturating_mul(length.pixels);
        let near = whole(
            self.linear.wrapping_mul(length.square),
            self.linear_exponent,
        )
        .min(whole(
            self.root.wrapping_mul(length.root),
            self.root_exponent,
        ));
        if near == u32::MAX {
            near
        } else if self.rises {
            // At its middle 1/w counts as a quarter of the way nearer, and as no more than a quarter more.
            let most = (near >> 3).wrapping_add(near >> 4);
            near.wrapping_sub(most.min(reach >> 2))
        } else {
            // No farther than to twice the depth.
            near.saturating_add(reach.wrapping_sub(reach >> 2))
                .max(reach.saturating_mul(2))
        }
    }
}

impl Lengths {
    /// For pieces that keep a bound, given as its inverse.
    ///
    /// With k for the change of 1/w over a pixel, D for the squeeze and T for `n^2 k / (4 bound)`, pieces of n pixels
    /// keep it where `q max(1, q^2 / D) >= T`: from T on, or from the cube root of T D.
    // A function of its own: it is the same for all pipelines.
    #[inline(never)]
    pub(super) fn new(bound: InverseBound, shape: &Shape) -> Self {
        let step = shape.words[1].q.cast_signed();
        let rises = step > 0;
        // Rounded up, and to the safe side.
        let most = step.unsigned_abs().saturating_add(1);
        let slope = if rises { most.saturating_sub(2) } else { most };
        let zeros = leading_zeros(most);
        let head = most << (zeros & 31) >> 16;
        // 2^32 / head is off by up to 4 where the head is cut.
        let inverse = quotient_apart(head).saturating_sub(5) >> 1;
        let before = 27u32.saturating_sub(zeros);
        let after = 47u32.wrapping_sub(zeros).wrapping_sub(before);
        // T of four pixels: 2^14 k / bound. 15 bits of k and 17 of the inverse.
        let linear = (head >> 1).wrapping_add(1).wrapping_mul(bound.mantissa);
        let linear_exponent = i32::from(bound.exponent)
            .wrapping_sub(zeros.cast_signed())
            .wrapping_sub(16);
        // The cube root of that times the squeeze: of 27 to 29 bits, with an exponent that 3 divides.
        let Squeeze { mantissa, exponent } = shape.squeeze();
        let cube = product_unsigned(linear, mantissa);
        let cube_zeros = leading_zeros_long(cube);
        let cube_exponent = exponent
            .wrapping_add(linear_exponent)
            .wrapping_add(34)
            .wrapping_sub(cube_zeros.cast_signed());
        // Exponents are from -60 to 200, and n / 3 is 171 n / 512 below 512.
        let third = (cube_exponent.wrapping_add(120)).wrapping_mul(171) >> 9;
        let root_exponent = third.wrapping_sub(39);
        let down = root_exponent.wrapping_mul(3).wrapping_sub(cube_exponent);
        let head = (cube << (cube_zeros & 63) >> 34) as u32;
        let root = cube_root(head >> (down & 31)).wrapping_add(1);
        let nearness = Nearness {
            rises,
            slope,
            // 18 bits, so that their product with a square has 26.
            linear: (linear >> 13).wrapping_add(1),
            linear_exponent: linear_exponent.wrapping_add(13),
            root,
            root_exponent: root_exponent.wrapping_sub(11),
        };
        let mut least = [0; LENGTHS.len()];
        for (least, length) in least.iter_mut().zip(&LENGTHS) {
            *least = nearness.least(length);
            keep_rolled();
        }
        Self {
            rises,
            inverse,
            before: before as u8,
            after: after as u8,
            least,
        }
    }

    /// Where a scanline begins.
    #[inline]
    pub(super) fn first(&self, q: u32) -> Level {
        self.next(q, Level(if self.rises { 0 } else { LENGTHS.len() }))
    }

    /// From that of the piece before.
    #[inline]
    pub(super) fn next(&self, q: u32, Level(mut level): Level) -> Level {
        if self.rises {
            while let Some(&least) = self.least.get(level)
                && q > least
            {
                level = level.wrapping_add(1);
                keep_rolled();
            }
        } else {
            while let Some(&least) = self.least.get(level.wrapping_sub(1))
                && q <= least
            {
                level = level.wrapping_sub(1);
                keep_rolled();
            }
        }
        Level(level)
    }

    /// How many pieces are of a level, at least; up to [`GROUP`]. Lengths have a base-2 logarithm.
    #[inline]
    pub(super) fn count(&self, q: u32, level: Level, log2: u32) -> u32 {
        // Until 1/w gets to the next level, or below this.
        let room = if self.rises {
            let next = self.least.get(level.0).copied().unwrap_or(u32::MAX);
            next.wrapping_sub(q)
        } else {
            let least = self.least.get(level.0.wrapping_sub(1)).copied();
            q.wrapping_sub(least.unwrap_or(0))
        };
        let differs = (room >> (self.before & 31)).min(u32::from(u16::MAX));
        let pixels = differs.wrapping_mul(self.inverse) >> (self.after & 31);
        (pixels >> (log2 & 31)).wrapping_add(1).min(GROUP)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Random(u32);

    impl Random {
        fn next(&mut self) -> u32 {
            self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            self.0 ^ self.0 >> 15
        }

        fn signed(&mut self, bits: u32) -> i32 {
            self.next().cast_signed() >> (32 - bits)
        }
    }

    /// Words of a point, and how they change, of all magnitudes.
    fn shape(random: &mut Random, round: u32) -> Shape {
        let mut change = || {
            let bits = 4 + random.next() % 20;
            let fewer = 1 + (random.next() >> 20) % 24;
            Words {
                q: random.signed(bits).cast_unsigned(),
                u: random.signed(bits),
                v: random.signed(fewer),
            }
        };
        let [right, down] = [change(), change()];
        Shape {
            words: [
                Words {
                    q: random.next() >> (round % 7) | 1 << 25,
                    u: random.signed(1 + round % 30),
                    v: random.signed(1 + round % 13),
                },
                right,
                if round.is_multiple_of(3) {
                    Words::default()
                } else {
                    down
                },
            ],
            corners: if round.is_multiple_of(3) {
                [0; 2]
            } else {
                [random.signed(17), random.signed(17)]
            },
            log2_texels: [0; 2].map(|_| (random.next() % 13 + random.next() % 7).cast_signed()),
        }
    }

    /// The largest squeeze on any row between corners, in texels.
    fn squeeze_of(shape: &Shape) -> f64 {
        let [at, right, down] = shape.words;
        let of = |u: fn(&Words) -> i32, log2: i32| {
            let [q, q_right, q_down] = [
                f64::from(at.q),
                f64::from(right.q.cast_signed()),
                f64::from(down.q.cast_signed()),
            ];
            let [u, u_right, u_down] = [at, right, down].map(|words| f64::from(u(&words)));
            let [a, b] = shape.corners.map(|far| f64::from(far) / 256.0);
            // The pixel is up to a row from its corner.
            [0.0, a, b, -1.0, a - 1.0, b - 1.0]
                .map(|y| {
                    let (q, u) = (q + y * q_down, u + y * u_down);
                    (q * u_right - u * q_right).abs()
                })
                .into_iter()
                .fold(0.0, f64::max)
                * f64::from(log2).exp2()
        };
        let [u, v] = shape.log2_texels;
        of(|words| words.u, u).max(of(|words| words.v, v))
    }

    #[test]
    fn squeezes_are_rounded_up() {
        let mut random = Random(1);
        for round in 0..100_000 {
            let shape = shape(&mut random, round);
            let Squeeze { mantissa, exponent } = shape.squeeze();
            let (found, exact) = (f64::from(mantissa), squeeze_of(&shape));
            let unit = f64::from(exponent).exp2();
            assert!(found * unit >= exact, "{round}: {found} {exact}");
            // Two rows more, and three units for each.
            let [a, b] = shape
                .corners
                .map(|far| f64::from(far.unsigned_abs()) / 256.0);
            let [at, right, down] = shape.words;
            let row = [(right.u, down.u), (right.v, down.v)].map(|(right_of, down_of)| {
                let [a, b] = [down.q, right.q].map(|q| f64::from(q.cast_signed()));
                (f64::from(right_of) * a - f64::from(down_of) * b).abs()
            });
            let more = 2.0 * row[0].max(row[1]) / f64::from(CUT).exp2() + 6.0 * a.max(b) + 20.0;
            assert!(
                found <= exact / unit + more,
                "{round}: {found} {} {more} {at:?}",
                exact / unit
            );
        }
    }

    /// Against float64: never longer, and little shorter.
    #[test]
    fn lengths_are_rounded_down() {
        let mut random = Random(2);
        let (mut allowed, mut refused, mut cubic) = (0, 0, 0);
        for round in 0..40_000 {
            let shape = shape(&mut random, round);
            let bound = (random.next() >> (5 + random.next() % 27)).max(1);
            let lengths = Lengths::new(InverseBound::of(bound), &shape);
            let step = f64::from(shape.words[1].q.cast_signed());
            let Squeeze { mantissa, exponent } = shape.squeeze();
            let squeeze = f64::from(mantissa) * f64::from(exponent).exp2();
            // Whether n pixels keep the bound, if 1/w changes so much.
            let holds = |q: f64, n: f64, k: f64| {
                let reach = n * k;
                let middle = if step > 0.0 {
                    q + reach.min(q) / 4.0
                } else {
                    q - reach * 0.75
                };
                let far_enough = step > 0.0 || reach <= q / 2.0;
                let most = 4.0 * f64::from(bound) / 4096.0 / k
                    * middle
                    * f64::max(1.0, middle * middle / squeeze);
                (far_enough && n * n <= most, middle * middle > squeeze)
            };
            for (least, length) in lengths.least.into_iter().zip(&LENGTHS) {
                let n = length.pixels;
                // A margin on either side of the limit: k is rounded by up to 2 units to the safe side.
                let from = f64::from(least);
                let (is_right, is_cubic) = holds(from + 1.0, f64::from(n), step.abs());
                if least < u32::MAX {
                    assert!(is_right, "{round}: {n} from {least}, {shape:?}, {bound}");
                    cubic += u32::from(is_cubic);
                    allowed += 1;
                } else {
                    refused += 1;
                }
                let less = from * (1.0 - 1.0 / 32.0) - 8.0;
                if step.abs() > 1000.0 && less > 0.0 {
                    let is_longer = holds(less, f64::from(n), step.abs()).0;
                    assert!(!is_longer, "{round}: {n} from {least}, {shape:?}, {bound}");
                }
            }
            assert!(lengths.least.is_sorted(), "{lengths:?}");
        }
        let counts = [allowed, refused, cubic];
        assert!(counts.iter().all(|&n| n > 2_000), "{counts:?}");
    }

    /// Whatever the words.
    #[test]
    fn a_bound_of_0_has_no_lengths() {
        let mut random = Random(3);
        for round in 0..10_000 {
            let shape = shape(&mut random, round);
            let lengths = Lengths::new(InverseBound::of(0), &shape);
            assert_eq!(lengths.least, [u32::MAX; LENGTHS.len()], "{shape:?}");
        }
    }

    /// So many pieces are of a level that the last one begins where it is allowed, and that the next level is not
    /// missed by more than one.
    #[test]
    fn pieces_are_counted() {
        let mut random = Random(4);
        let mut many = 0;
        for round in 0..200_000 {
            let shape = shape(&mut random, round);
            let bound = 16 << (round % 12);
            let lengths = Lengths::new(InverseBound::of(bound), &shape);
            let step = shape.words[1].q.cast_signed();
            let q = random.next() >> (round % 5);
            let level = lengths.first(q);
            let Some(log2) = level.log2_grouped() else {
                continue;
            };
            let length = i64::from(level.pixels());
            assert_eq!(length, 1 << log2);
            let count = i64::from(lengths.count(q, level, log2));
            assert!((1..=i64::from(GROUP)).contains(&count), "{count}");
            let at = |piece: i64, step: i64| i64::from(q) + piece * length * step;
            let step = i64::from(step);
            let [shorter, longer] = [level.0.wrapping_sub(1), level.0]
                .map(|level| lengths.least.get(level).copied().map(i64::from));
            // Where pieces begin that are allowed, and so long as no longer one is.
            let is_of_level = |q: i64| q > shorter.unwrap_or(-1) && longer.is_none_or(|l| q <= l);
            assert!(is_of_level(i64::from(q)), "{lengths:?} {q}");
            if step > 0 {
                // All but the last two: a sixteenth of a pixel is lost.
                if count > 2 {
                    assert!(is_of_level(at(count - 2, step)), "{lengths:?} {q} {count}");
                }
                if count < i64::from(GROUP) {
                    let missed = longer
                        .is_some_and(|l| at(count, step + 1) + 1 < l - 2 * length * (step + 1));
                    assert!(!missed, "{lengths:?} {q} {count}");
                }
            } else {
                assert!(
                    is_of_level(at(count - 1, step - 1)) || count == 1,
                    "{lengths:?} {q} {count}"
                );
                if count < i64::from(GROUP) {
                    assert!(!is_of_level(at(count + 1, step)), "{lengths:?} {q} {count}");
                }
            }
            many += u32::from(count > 2);
        }
        assert!(many > 10_000, "{many}");
    }

    #[test]
    fn lengths_have_squares_and_cube_roots() {
        for Length {
            pixels,
            square,
            root,
        } in LENGTHS
        {
            assert_eq!(square * 16, pixels * pixels);
            let exact = f64::from(square).cbrt() * 2048.0;
            assert!((0.0..1.0).contains(&(f64::from(root) - exact)), "{pixels}");
        }
    }

    #[test]
    fn cube_roots_are_rounded_down() {
        for n in (0..1u32 << 30)
            .step_by(9973)
            .chain([7, 8, 26, 27, 999_999, 1_000_000])
        {
            let root = u64::from(cube_root(n));
            assert!(
                root.pow(3) <= u64::from(n) && (root + 1).pow(3) > u64::from(n),
                "{n}"
            );
        }
    }
}
