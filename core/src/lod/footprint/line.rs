//! The derivatives in single words: for rates that ask for pixels.

use super::{Footprint, SmallFootprint, centre};
use crate::lod::Rule;
use crate::lod::footprint::Lambdas;
use crate::lod::log2::{FRACTION_BITS, log2_word};
use crate::setup::TriangleSetup;
use crate::span::Span;

/// Bits that three terms of a numerator, and extents that are sides' sums, have more than a weight and
/// a side.
const MORE: u32 = 3;

/// A change from one pixel to the next: a word, and what lies behind it in 2^-16.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Step {
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

    /// Without a part.
    #[inline]
    pub(super) const fn whole(word: i32) -> Self {
        Self { word, part: 0 }
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

/// A triangle's derivatives, as [`Footprint`] has them, in words.
///
/// Of the triangle's largest numerator the words have 26 to 30 bits, of its largest 1/w 30; at a pixel all of
/// them are off by less than 3 units and a 16th. Lambda is off by as much as that is of the pixel's own.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FootprintWords {
    /// Of u and of v.
    pub(super) axes: [WordAxis; 2],
    /// 1/w at pixel (0, 0), and how it changes.
    pub(super) q: i32,
    pub(super) q_right: Step,
    pub(super) q_down: Step,
    /// What lambda is more than the logarithms of the numerator and of 1/w make: 16.16.
    pub(super) offset: i32,
}

/// One coordinate's numerators: along x in row 0, along y in column 0, and by how much those along x exceed those
/// of the row above; those along y are so much less than those of the column before.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct WordAxis {
    pub(super) across: i32,
    pub(super) down: i32,
    pub(super) step: Step,
}

impl FootprintWords {
    /// Of a triangle, for a texture whose finest level has these base-2 logarithms of width and height.
    #[inline]
    #[must_use]
    pub fn new(triangle: &TriangleSetup<'_>, log2_size: (u32, u32)) -> Self {
        match SmallFootprint::new(triangle, log2_size) {
            Some(small) => small.words(),
            None => Self::any(triangle, log2_size),
        }
    }

    /// Of any triangle.
    // A function of its own: small triangles do not need its stack.
    #[inline(never)]
    #[must_use]
    pub fn any(triangle: &TriangleSetup<'_>, log2_size: (u32, u32)) -> Self {
        let footprint = Footprint::in_registers(triangle, log2_size);
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
        let plane = &footprint.q;
        Self {
            axes: footprint.axes.each_ref().map(|axis| WordAxis {
                across: upper(axis.across(centre(0)).wrapping_shl(up)),
                down: upper(axis.down(centre(0)).wrapping_shl(up)),
                step: Step::new(axis.across_step().wrapping_shl(up)),
            }),
            q: upper(plane.at(0, 0)),
            q_right: Step::new(plane.step_x()),
            q_down: Step::new(plane.step_y()),
            // The words stand for 2^32 more, shifted down by `up`; 1/w counts twice.
            offset: footprint.offset.wrapping_sub(
                up.wrapping_add(32)
                    .wrapping_shl(FRACTION_BITS)
                    .cast_signed(),
            ),
        }
    }
}

impl Lambdas for FootprintWords {
    type Row<'t, R: Rule> = FootprintLine<R>;

    #[inline]
    fn row<R: Rule>(&self, span: Span, rule: R) -> FootprintLine<R> {
        let Span { y, left, .. } = span;
        let axes = self.axes.each_ref();
        let across = axes.map(|axis| axis.across.wrapping_add(axis.step.over(y)));
        FootprintLine {
            rule,
            offset: self.offset,
            length_across: rule.length_of_words(across),
            first: axes.map(|axis| axis.down.wrapping_sub(axis.step.over(left))),
            step: axes.map(|axis| axis.step),
            q: self
                .q
                .wrapping_add(self.q_down.over(y))
                .wrapping_add(self.q_right.over(left)),
            q_step: self.q_right,
        }
    }

    #[inline]
    fn lambda<R: Rule>(line: &FootprintLine<R>, offset: usize) -> i32 {
        line.lambda(offset as u32)
    }
}

/// A triangle's derivatives along one span, in words.
#[derive(Clone, Copy, Debug)]
pub struct FootprintLine<R: Rule> {
    rule: R,
    offset: i32,
    length_across: R::Word,
    /// Along y at the span's first pixel, and by how much less they are at the next.
    first: [i32; 2],
    step: [Step; 2],
    /// 1/w there.
    q: i32,
    q_step: Step,
}

impl<R: Rule> FootprintLine<R> {
    /// Lambda at a pixel, as [`FootprintRow::lambda`](super::FootprintRow::lambda) has it.
    #[inline]
    #[must_use]
    pub fn lambda(&self, offset: u32) -> i32 {
        let pixels = offset.cast_signed();
        let [u, v] = self.first;
        let [u_step, v_step] = self.step;
        let down = [
            u.wrapping_sub(u_step.over(pixels)),
            v.wrapping_sub(v_step.over(pixels)),
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
