//! The derivatives along a span in single words: for rates that ask for more than one pixel of it.

use super::{Footprint, centre};
use crate::lod::Rule;
use crate::lod::log2::{FRACTION_BITS, log2_word};
use crate::setup::{Plane, TriangleSetup};
use crate::span::Span;

/// Bits that three terms of a numerator, and extents that are sides' sums, have more than a weight and
/// a side.
const MORE: u32 = 3;

/// A change from one pixel to the next: a word, and what lies behind it in 2^-16.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Step {
    word: i32,
    part: u16,
}

impl Step {
    /// Of the upper word.
    #[inline]
    fn new(change: i64) -> Self {
        Self {
            word: upper(change),
            part: (change >> 16) as u16,
        }
    }

    /// The change over so many pixels, below 2^15; rounded down.
    #[inline]
    fn over(self, pixels: i32) -> i32 {
        let behind = i32::from(self.part).wrapping_mul(pixels) >> 16;
        self.word.wrapping_mul(pixels).wrapping_add(behind)
    }
}

#[inline]
fn upper(n: i64) -> i32 {
    (n >> 32) as i32
}

/// How a triangle's numerators become words.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FootprintWords {
    /// How far up they are shifted to use a word's bits.
    up: u32,
    /// Those along y, from one pixel to the next.
    down: [Step; 2],
    /// What lambda is more than the words' logarithms make.
    offset: i32,
}

impl FootprintWords {
    #[inline]
    pub(super) fn new(footprint: &Footprint, triangle: &TriangleSetup<'_>) -> Self {
        let [a, b, c] = triangle
            .vertices()
            .each_ref()
            .map(|v| [v.x().to_bits(), v.y().to_bits()]);
        let magnitude = |n: i32| n ^ (n >> 31);
        let sides =
            [b, c].map(|[x, y]| magnitude(x.wrapping_sub(a[0])) | magnitude(y.wrapping_sub(a[1])));
        let side_bits = 32u32.wrapping_sub((sides[0] | sides[1]).leading_zeros());
        // One bit is the sign's.
        let bits = footprint
            .weight_bits
            .wrapping_add(side_bits)
            .wrapping_add(MORE);
        let up = 63u32.saturating_sub(bits).min(31);
        Self {
            up,
            down: footprint
                .axes
                .each_ref()
                .map(|axis| Step::new(axis.down_step().wrapping_shl(up))),
            // The words stand for 2^32 more, shifted down by `up`; 1/w counts twice.
            offset: footprint.offset.wrapping_sub(
                up.wrapping_add(32)
                    .wrapping_shl(FRACTION_BITS)
                    .cast_signed(),
            ),
        }
    }
}

/// A triangle's derivatives along one span, as [`FootprintRow`](super::FootprintRow) has them, in words.
///
/// Of the triangle's largest numerator the words have 26 to 30 bits, of its largest 1/w 30; all of
/// them are low by less than 2 units and a 32nd. Lambda is off by as much as that is of the pixel's
/// own.
#[derive(Clone, Copy, Debug)]
pub struct FootprintLine<R: Rule> {
    rule: R,
    offset: i32,
    length_across: R::Word,
    /// Along y at the span's first pixel.
    first: [i32; 2],
    down: [Step; 2],
    /// 1/w there.
    q: i32,
    q_step: Step,
}

impl<R: Rule> FootprintLine<R> {
    #[inline]
    pub(super) fn new(footprint: &Footprint, words: &FootprintWords, span: Span, rule: R) -> Self {
        let (x, y) = (centre(span.left), centre(span.y));
        let word = |n: i64| upper(n.wrapping_shl(words.up));
        let axes = footprint.axes.each_ref();
        Self {
            rule,
            offset: words.offset,
            length_across: rule.length_of_words(axes.map(|axis| word(axis.across(y)))),
            first: axes.map(|axis| word(axis.down(x))),
            down: words.down,
            q: upper(footprint.q.at(span.left, span.y)),
            q_step: Step::new(Plane::step_x(&footprint.q)),
        }
    }

    /// Lambda at a pixel, as [`FootprintRow::lambda`](super::FootprintRow::lambda) has it.
    #[inline]
    #[must_use]
    pub fn lambda(&self, offset: u32) -> i32 {
        let pixels = offset.cast_signed();
        let [u, v] = self.first;
        let [u_step, v_step] = self.down;
        let down = [
            u.wrapping_add(u_step.over(pixels)),
            v.wrapping_add(v_step.over(pixels)),
        ];
        let longer = self.length_across.max(self.rule.length_of_words(down));
        // Positive inside the triangle; what rounding makes of the farthest point must not matter.
        let q = self.q.wrapping_add(self.q_step.over(pixels)).max(1);
        self.rule
            .log2_of_word(longer)
            .wrapping_add(self.offset)
            .wrapping_sub(log2_word(q.cast_unsigned()).wrapping_mul(2))
    }
}
