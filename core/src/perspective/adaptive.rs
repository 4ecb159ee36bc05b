//! Spans as long as a bound on their error allows.

use core::num::NonZeroU32;

use fixed::types::I16F16;

use super::by_size::{BySize, Planes, one_piece};
use super::chord::step;
use super::every::short_step;
use super::homogeneous::short::ShortPlanes;
use super::homogeneous::words::{WordPlanes, Words};
use super::{Homogeneous, Run, RunSink, SpanSink, Strategy};
use crate::arith::{RECIPROCALS, leading_zeros, multiply_high, product, product_unsigned};
use crate::setup::TriangleSetup;
use crate::span::{Area, Span};
use crate::uv::Uv;

/// The longest spans whose error stays within a bound that the caller gives, in footprints.
///
/// A footprint is rho level-0 texels, the texels that a pixel spans, or one texel where rho is
/// less: what the eye sees once a mip level is chosen. The error at every pixel is at most
///
/// `bound * max(1, rho)` texels, plus three times that of [`PerPixel`](super::PerPixel) (two of
/// them in the measurement of the scanline, one in the coordinates), plus 1/32 texel for the
/// rounding of steps.
///
/// **How.** Along a scanline 1/w = q and u/w are linear, so u is a hyperbola, of which
/// `D = q^2 du/dx` is constant. On a piece of n steps between depths of ratio r, with q = a at
/// the nearer end and b at the farther one, u changes by `|du| = n D / (a b)`, and a chord is
/// off by exactly
///
/// `|du| (sqrt r - 1) / (sqrt r + 1) = |du| (a - b) / (a + b + 2 sqrt(a b)) <= |du| (a - b) / (a + 3 b)`.
///
/// As rho is at least `D / q^2`, the error in footprints is at most `n (a - b) / (a b)` times the
/// largest `s (1 - s) q` on the piece, s from 0 to 1, which is no more than `(16 a + 11 b) / 108`.
/// Where the change of u down the column, times q^2, is at least D' along the scanline (it is
/// linear along it, so its ends tell), `D / D'` of that counts. With k for the change of 1/w a pixel,
/// `a = b + n k`, both tests hold for
///
/// `n^2 <= 4 bound / (k D) q max(D, D', q^2)`, where `q = b + (a - b) / 4 <= 5 b / 4`,
///
/// since `a b (a + 3 b) >= 4 q^3` and `27 a b >= (16 a + 11 b) q` there, up to a ratio of depths
/// of 2. k, D and D' are those of the scanline, so that this is a function of q alone. The length of
/// the piece before gives q: along a scanline lengths only grow or only shrink, so it errs on the
/// safe side, and the new length is found from the old one, by ones up to 63 and by 1/32 above.
/// Where depth grows no piece reaches farther than twice as far. All roundings are to the safe side.
/// A piece of one step is exact, so the bound holds wherever it can be asked for; 0 gives the
/// per-pixel result where the depth varies.
///
/// Pieces have up to 1024 pixels, and with textures of more than 512 texels `2^19 / size`, so that
/// rounding keeps to its 1/32 texel.
///
/// **Cost.** A division for each piece and one for each scanline; two for a scanline of constant
/// depth, whatever its length. Three products and a few comparisons to decide on a piece, of 32 bits
/// all; a scanline of more than one piece takes an integer division, a square root and a dozen
/// products of its own. Deciding for each piece takes fewer divisions than deciding once a scanline
/// or once a triangle, where the nearest or most distorted end decides for all.
///
/// A triangle of up to 16 pixels each way whose largest span keeps the bound in one piece, by its corners'
/// depths, is set up with fewer bits and has nothing to decide.
///
/// Choose it where the error must be known, or where walls at all angles share a frame: it spends
/// divisions only where depth varies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Adaptive {
    /// In 2^-12 footprints.
    bound: u32,
    log2_width: u8,
    log2_height: u8,
}

/// Fraction bits of distances in texels.
const TEXEL_BITS: u32 = 12;

impl Adaptive {
    /// A quarter of a footprint: below what nearest sampling shows.
    pub const DEFAULT_BOUND: I16F16 = I16F16::lit("0.25");

    /// For a texture with these base-2 logarithms of width and height, as
    /// [`Texture::log2_size`](crate::texture::Texture::log2_size) gives them; the bound in
    /// footprints, with 12 fraction bits, rounded down. A negative bound counts as 0, sizes
    /// beyond [`MAX_TEXTURE_SIZE`](crate::texture::MAX_TEXTURE_SIZE) as that.
    ///
    /// It takes the size because the bound is in texels and coordinates are in repeats; a
    /// pipeline holds one texture, so the two are made together.
    #[must_use]
    pub const fn new(bound: I16F16, (log2_width, log2_height): (u32, u32)) -> Self {
        const fn at_most_12(log2: u32) -> u8 {
            if log2 < 12 { log2 as u8 } else { 12 }
        }
        let bits = bound.to_bits();
        Self {
            bound: if bits < 0 {
                0
            } else {
                bits.cast_unsigned() >> (16 - TEXEL_BITS)
            },
            log2_width: at_most_12(log2_width),
            log2_height: at_most_12(log2_height),
        }
    }

    /// In 2^-12 texels, below 2^27.
    #[inline]
    pub(super) fn bound(&self) -> u32 {
        self.bound
    }

    /// The larger distance of u and v, in 2^-12 texels, rounded up; below 2^32.
    #[inline]
    pub(super) fn distance(&self, from: Uv, to: Uv) -> u32 {
        let texels = |from: i32, to: i32, log2_size: u8| {
            // A distance in 8.24 is below 2^31, so 2^43 at the largest size.
            let down = (Uv::FRACTION_BITS - TEXEL_BITS).wrapping_sub(u32::from(log2_size)) & 31;
            let all = (1u32 << down).wrapping_sub(1);
            let distance = from.abs_diff(to);
            (distance >> down).wrapping_add(u32::from(distance & all != 0))
        };
        texels(from.u.to_bits(), to.u.to_bits(), self.log2_width).max(texels(
            from.v.to_bits(),
            to.v.to_bits(),
            self.log2_height,
        ))
    }

    /// How far down a product of each axis counts in the texels of the longer side.
    #[inline]
    fn shifts(&self) -> [u32; 2] {
        let most = self.log2_size();
        [self.log2_width, self.log2_height].map(|log2| most.wrapping_sub(u32::from(log2)) & 15)
    }

    /// Of the longer side.
    #[inline]
    fn log2_size(&self) -> u32 {
        u32::from(self.log2_width.max(self.log2_height))
    }

    /// The longest piece: the rounding of its steps keeps to 1/32 texel.
    #[inline]
    fn longest(&self) -> u32 {
        1 << 19u32.wrapping_sub(self.log2_size()).min(10)
    }

    /// Whether a chord from end to end keeps the bound.
    #[inline]
    fn is_whole(&self, ends: &Ends) -> bool {
        let (steps, change, [_, far]) = (ends.steps, ends.change(), ends.by_nearness());
        if product_unsigned(steps << 10, change) <= product_unsigned(self.bound, far) {
            return true;
        }
        let distance = self.distance(ends.uv[0], ends.uv[1]);
        let mean = far.wrapping_add(change >> 2);
        product_unsigned(distance, change) <= product_unsigned(4 * self.bound, mean)
    }

    /// Whether a chord from end to end of any span keeps the bound: its length times how far the ratio of
    /// depths is from 1, over 4.
    #[inline]
    fn is_whole_everywhere(&self, triangle: &TriangleSetup<'_>) -> bool {
        let [nearest, farthest] = triangle.depths();
        product_unsigned(triangle.width() << 2, farthest.wrapping_sub(nearest))
            <= product_unsigned(self.bound, nearest)
    }

    /// The pieces of a span: `at` gives 1/w and the coordinates some pixels from its first.
    #[inline]
    fn pieces(
        &self,
        ends: &Ends,
        rule: impl FnOnce() -> Rule,
        at: impl Fn(u32) -> (u32, Uv),
        mut to: impl RunSink,
    ) {
        let most = self.longest();
        let ([mut q, _], [mut uv, last]) = (ends.q, ends.uv);
        let rule = if ends.steps <= 1 || self.is_whole(ends) {
            None
        } else {
            Some(rule())
        };
        let mut length = rule
            .as_ref()
            .map_or(most, |rule| rule.first(q, most.min(ends.steps)));
        let mut offset = 0;
        loop {
            if let Some(rule) = &rule {
                length = rule.next(q, length, most);
            }
            let rest = ends.steps.wrapping_sub(offset);
            let is_last = length >= rest;
            let steps = length.min(rest);
            let end = offset.wrapping_add(steps);
            let (end_q, end_uv) = if is_last { (q, last) } else { at(end) };
            to.long_run(Run {
                offset: offset as usize,
                len: steps.wrapping_add(u32::from(is_last)) as usize,
                uv,
                step: if steps < RECIPROCALS.len() as u32 {
                    short_step(uv, end_uv, steps)
                } else {
                    step(uv, end_uv, steps)
                },
            });
            if is_last {
                return;
            }
            (offset, q, uv) = (end, end_q, end_uv);
        }
    }
}

/// The ends of a span.
#[derive(Clone, Copy, Debug)]
struct Ends {
    steps: u32,
    /// 1/w.
    q: [u32; 2],
    uv: [Uv; 2],
}

impl Ends {
    /// 1/w at the nearer end and at the farther one.
    #[inline]
    fn by_nearness(&self) -> [u32; 2] {
        let [p, q] = self.q;
        [p.max(q), p.min(q)]
    }

    /// How much 1/w changes at most: words may be half a unit off for each pixel.
    #[inline]
    fn change(&self) -> u32 {
        let [p, q] = self.q;
        p.abs_diff(q).saturating_add(self.steps.wrapping_add(3))
    }
}

/// How u/w and v/w turn against 1/w along a row or a column: `q^2 du/dx` or `q^2 du/dy`, each in
/// half squares of words.
#[derive(Clone, Copy, Debug)]
struct Turn {
    axes: [i64; 2],
    /// Of both, at most.
    error: u64,
}

impl Turn {
    /// From words that are off by no more than 17 units and their changes, by one.
    #[inline]
    fn new(at: Words, change: Words) -> Self {
        let half = (at.q >> 1).cast_signed();
        let q_change = change.q.cast_signed();
        let turn =
            |value: i32, step: i32| product(step, half).wrapping_sub(product(value >> 1, q_change));
        let steps = u64::from(change.u.unsigned_abs().max(change.v.unsigned_abs()))
            .wrapping_add(u64::from(q_change.unsigned_abs()));
        Self {
            axes: [turn(at.u, change.u), turn(at.v, change.v)],
            error: u64::from(at.q).wrapping_add(16 * steps),
        }
    }

    /// Of the larger axis, in texels of the longer side.
    #[inline]
    fn at_most(&self, [u_shift, v_shift]: [u32; 2]) -> u64 {
        let most = |turn: i64, shift: u32| turn.unsigned_abs().wrapping_add(self.error) >> shift;
        let [u, v] = self.axes;
        most(u, u_shift).max(most(v, v_shift)).wrapping_add(1)
    }

    /// What one of the axes has at least, both here and there, and all between.
    #[inline]
    fn at_least(&self, other: &Self, [u_shift, v_shift]: [u32; 2]) -> u64 {
        let least = |a: i64, b: i64, shift: u32| {
            if (a ^ b) < 0 {
                return 0;
            }
            let a = a.unsigned_abs().saturating_sub(self.error);
            let b = b.unsigned_abs().saturating_sub(other.error);
            a.min(b) >> shift
        };
        let ([u, v], [other_u, other_v]) = (self.axes, other.axes);
        least(u, other_u, u_shift).max(least(v, other_v, v_shift))
    }
}

/// How long pieces of a scanline may be: `n^2 <= q max(c, t q^2)`, with q = 1/w at the piece's
/// farther end, or a quarter of the way to the nearer one.
#[derive(Clone, Copy, Debug)]
struct Rule {
    /// 1/w rises along the scanline.
    rises: bool,
    /// How much it does in a pixel, at least; how much it falls, at most.
    slope: u32,
    /// The largest 1/w, and the shift that gives it 32 bits.
    near: u32,
    up: u32,
    constant: u32,
    square: u32,
    down: u32,
}

impl Rule {
    /// `turn` is that along the scanline, at most, `floor` the larger of that and the one down
    /// its columns; `unit` the base-2 logarithm of the texels that u/w = 1/w stands for.
    #[inline]
    fn new(bound: u32, ends: &Ends, q_step: i32, turn: u64, floor: u64, unit: i32) -> Self {
        let [near, _] = ends.by_nearness();
        let up = leading_zeros(near);
        let change = ends.change();
        let change_zeros = leading_zeros(change);
        let turn_shift = 49u32.wrapping_sub(turn.leading_zeros()) & 63;
        // 15 bits each, rounded up: 15 or 16 bits.
        let heads = ((change << change_zeros) >> 17)
            .wrapping_add(1)
            .wrapping_mul(((turn >> turn_shift) as u32).wrapping_add(1));
        let divisor = NonZeroU32::MIN.saturating_add(heads >> 14);
        let dividend = bound.min(1 << 20).wrapping_mul(ends.steps);
        let dividend_zeros = leading_zeros(dividend);
        // 28 to 31 bits.
        let square = (((dividend << dividend_zeros) / divisor) << 13).cast_signed();
        let signed = u32::cast_signed;
        let rise = signed(up).wrapping_sub(1);
        let down = signed(dividend_zeros)
            .wrapping_add(signed(turn_shift))
            .wrapping_sub(signed(change_zeros))
            .wrapping_add(3 * rise)
            .wrapping_add(unit)
            .wrapping_sub(37);
        // The floor with 30 bits, as many as the square of 1/w has.
        let floor_zeros = floor.leading_zeros() & 63;
        let head = ((floor << floor_zeros) >> 34) as i32;
        let exponent = (3 - signed(floor_zeros))
            .wrapping_add(unit)
            .wrapping_add(2 * rise);
        // Above that a footprint is more than a texel everywhere.
        let is_flat = exponent > 0;
        let floor = head >> exponent.min(0).unsigned_abs().min(31);
        let rises = ends.q[1] > ends.q[0];
        Self {
            rises,
            slope: if rises {
                q_step.unsigned_abs().saturating_sub(1)
            } else {
                q_step.unsigned_abs().wrapping_add(1)
            },
            near,
            up,
            constant: multiply_high(floor, square).cast_unsigned() << 3,
            square: if is_flat {
                0
            } else {
                square.cast_unsigned() >> 15
            },
            down: down
                .wrapping_sub(exponent.max(0))
                .clamp(0, 31)
                .cast_unsigned(),
        }
    }

    /// The square of the longest piece, given 1/w.
    #[inline]
    fn square(&self, q: u32) -> u32 {
        // 16 bits each.
        let q = (q << (self.up & 31)) >> 16;
        let texels = (q.wrapping_mul(self.square) >> 16).wrapping_mul(q);
        (texels.max(self.constant) >> 16).wrapping_mul(q) >> (self.down & 31)
    }

    /// A length for [`Self::next`] to begin with.
    #[inline]
    fn first(&self, q: u32, most: u32) -> u32 {
        self.square(q).isqrt().min(most).max(1)
    }

    /// The length of a piece, from that of the one before.
    #[inline]
    fn next(&self, q: u32, before: u32, most: u32) -> u32 {
        // Finely where that makes a difference.
        let grain = |length: u32| length >> 5 | 1;
        let mut length = before;
        if self.rises {
            let reach = length.wrapping_mul(self.slope).min(q) >> 2;
            let square = self.square(q.saturating_add(reach).min(self.near));
            loop {
                let longer = length.wrapping_add(grain(length));
                if longer > most || longer.wrapping_mul(longer) > square {
                    return length;
                }
                length = longer;
            }
        }
        // No farther than to twice the depth.
        while length > 1 && length.wrapping_mul(self.slope) > q >> 1 {
            length = length.wrapping_sub(grain(length));
        }
        let reach = length.wrapping_mul(self.slope);
        let square = self.square(q.saturating_sub(reach).wrapping_add(reach >> 2));
        while length > 1 && length.wrapping_mul(length) > square {
            length = length.wrapping_sub(grain(length));
        }
        length
    }
}

impl Strategy for Adaptive {
    type Planes = Planes;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<Planes> {
        // One piece is enough for a small triangle, or for a span of a pixel.
        let log2_pixels = if self.is_whole_everywhere(triangle) {
            ShortPlanes::LOG2_PIXELS
        } else {
            0
        };
        Planes::new(triangle, log2_pixels, 0)
    }

    #[inline]
    fn runs(&self, planes: &Planes, span: Span, to: impl RunSink) {
        self.runs_by_size(planes, span, to);
    }

    #[inline]
    fn all_runs(
        &self,
        planes: &Planes,
        triangle: &TriangleSetup<'_>,
        area: Area,
        to: impl SpanSink,
    ) {
        self.all_runs_by_size(planes, triangle, area, to);
    }
}

impl BySize for Adaptive {
    #[inline]
    fn short_runs(&self, planes: &ShortPlanes, span: Span, to: impl RunSink) {
        one_piece(planes, span, to);
    }

    #[inline]
    fn word_runs(&self, planes: &WordPlanes, span: Span, to: impl RunSink) {
        let steps = span.left.abs_diff(span.right).wrapping_sub(1);
        let line = planes.line(span);
        let last = line.at(steps);
        let first_uv = planes.divide(line.first);
        let last_uv = if steps > 0 {
            planes.divide(last)
        } else {
            first_uv
        };
        let ends = Ends {
            steps,
            q: [line.first.q, last.q],
            uv: [first_uv, last_uv],
        };
        self.pieces(
            &ends,
            || {
                let (down, unit) = (Some(planes.down()), WordPlanes::LOG2_UNIT);
                self.rule(&ends, [line.first, last], line.step, down, unit)
            },
            |pixels| {
                let words = line.at(pixels);
                (words.q, planes.divide(words))
            },
            to,
        );
    }

    #[inline]
    fn whole_runs(&self, planes: &Homogeneous, span: Span, to: impl RunSink) {
        self.far(planes, span, to);
    }
}

impl Adaptive {
    /// With the words at both ends and their changes over a pixel, down too if they hold it; `unit` is the
    /// base-2 logarithm of the repeats that one of u/w stands for where it is 1/w.
    #[inline(never)]
    fn rule(
        &self,
        ends: &Ends,
        [first, last]: [Words; 2],
        step: Words,
        down: Option<Words>,
        unit: i32,
    ) -> Rule {
        let shifts = self.shifts();
        let farther = if first.q < last.q { first } else { last };
        let turn = Turn::new(farther, step).at_most(shifts).max(1 << 16);
        let down = down.map_or(0, |down| {
            Turn::new(first, down).at_least(&Turn::new(last, down), shifts)
        });
        let unit = unit.wrapping_add(self.log2_size().cast_signed());
        let q_step = step.q.cast_signed();
        Rule::new(self.bound, ends, q_step, turn, turn.max(down), unit)
    }

    /// With all bits of the planes.
    #[cold]
    #[inline(never)]
    fn far(&self, planes: &Homogeneous, span: Span, to: impl RunSink) {
        let steps = span.left.abs_diff(span.right).wrapping_sub(1);
        let first = planes.at(span.left, span.y);
        let last = planes.step(first, steps);
        let first_uv = planes.divide(first);
        let last_uv = if steps > 0 {
            planes.divide(last)
        } else {
            first_uv
        };
        // The nearer end has 31 bits.
        let shift = first.q().max(last.q()).leading_zeros().wrapping_sub(1) & 63;
        let words = [first, last].map(|point| point.shifted_words(shift));
        let ends = Ends {
            steps,
            q: words.map(|words| words.q),
            uv: [first_uv, last_uv],
        };
        let step = planes.leap(1).shifted_words(shift);
        self.pieces(
            &ends,
            || {
                let (down, unit) = (planes.words_down(shift), planes.log2_unit());
                self.rule(&ends, words, step, down, unit)
            },
            |pixels| {
                let point = planes.step(first, pixels);
                (point.shifted_words(shift).q, planes.divide(point))
            },
            to,
        );
    }
}
