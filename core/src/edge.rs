//! The exact walk along one edge of a triangle, scanline by scanline.

use core::num::NonZeroU32;

use crate::arith::{Divider, product_with_short, quotient};
use crate::project::{ScreenVertex, first_centre};
use crate::viewport::{GUARD_BAND, SUBPIXEL_BITS, SUBPIXELS};

/// Where an edge crosses scanlines, one after another.
pub(crate) trait Crossing: Sized {
    /// Between two vertices, `upper` not below `lower`, from `row` on, which it crosses. `None` only where
    /// no row of pixel centres lies between them.
    fn enter(upper: &ScreenVertex, lower: &ScreenVertex, row: i32) -> Option<Self>;

    /// The first column whose centre is at the crossing or right of it, in the current row: modulo 2^12, with
    /// [`COLUMN_BITS`] behind it that mean nothing, so that it fills the lower half of a word. What is above is
    /// of no use.
    fn column(&self) -> u32;

    /// On to the next row.
    fn step(&mut self);
}

/// Bits behind a [`Crossing::column`]: those that the guard band leaves of 16.
pub(crate) const COLUMN_BITS: u32 = 16 - (2 * GUARD_BAND).ilog2() - 1;

impl Crossing for TallEdge {
    #[inline]
    fn enter(upper: &ScreenVertex, lower: &ScreenVertex, row: i32) -> Option<Self> {
        Some(Self::new(upper, lower, row))
    }

    #[inline]
    fn column(&self) -> u32 {
        (self.x >> (32 + SUBPIXEL_BITS - COLUMN_BITS)) as u32
    }

    #[inline]
    fn step(&mut self) {
        self.x = self.x.wrapping_add(self.step);
    }
}

/// An edge of few rows: a division for each, and where there is none a product, is less work than to find
/// a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShortEdge {
    dividend: u32,
    divider: Divider,
    step: i32,
}

impl ShortEdge {
    /// Rows that it is worth while for, and that [`Divider`] has room for.
    const ROWS: i32 = 8;

    /// Columns from which the crossing is counted, left of all that a triangle reaches: 0 in [`Crossing::column`].
    const BEYOND: i32 = 1 << (16 - COLUMN_BITS);

    /// Whether an edge between two vertices, `upper` not below `lower`, is short.
    #[inline]
    pub(crate) fn reaches(upper: &ScreenVertex, lower: &ScreenVertex) -> bool {
        let height = lower.y().to_bits().wrapping_sub(upper.y().to_bits());
        height < Self::ROWS << SUBPIXEL_BITS
    }
}

impl Crossing for ShortEdge {
    #[inline]
    fn enter(upper: &ScreenVertex, lower: &ScreenVertex, row: i32) -> Option<Self> {
        let [x, y] = [upper.x(), upper.y()].map(|c| c.to_bits());
        let [width, height] = [
            lower.x().to_bits().wrapping_sub(x),
            lower.y().to_bits().wrapping_sub(y),
        ];
        let divisor = NonZeroU32::new(height.cast_unsigned() << SUBPIXEL_BITS)?;
        // The crossing is x + (centre - y) width / height, and the column is so much less half a pixel,
        // over 256, rounded up. Counted from beyond the guard band there are no signs, and the sum is
        // below 2^32, whatever its terms are.
        let down = (row << SUBPIXEL_BITS)
            .wrapping_add(SUBPIXELS / 2)
            .wrapping_sub(y);
        let right = x
            .wrapping_sub(SUBPIXELS / 2)
            .wrapping_add((Self::BEYOND + 1) << SUBPIXEL_BITS);
        let dividend = width
            .wrapping_mul(down)
            .wrapping_add(right.wrapping_mul(height))
            .wrapping_sub(1);
        Some(Self {
            dividend: dividend.cast_unsigned(),
            divider: Divider::new(divisor),
            step: width << SUBPIXEL_BITS,
        })
    }

    #[inline]
    fn column(&self) -> u32 {
        self.divider.quotient(self.dividend) << COLUMN_BITS
    }

    #[inline]
    fn step(&mut self) {
        self.dividend = self.dividend.wrapping_add_signed(self.step);
    }
}

/// An edge that crosses at least one scanline (a row of pixel centres), and where it crosses.
///
/// The crossing is a rational number of subpixels, of which the divisor is the edge's height. It is
/// stepped with 32 bits behind the point, always a little too low: by less than one part of the
/// divisor, so that no whole number lies between it and what it stands for, and its ceiling is exact
/// on every scanline.
///
/// ```text
///   centres   o     o     o     o         A centre on the edge belongs to the triangle on the
///                 \                       right of it: the first column of a left edge is the
///             o    \o     o     o         first one of which the centre is not left of the
///                   |\                    crossing, and the first column after a right edge is
///             o     o \   o     o         found by the same rule. With rows treated alike this
///                                         is the top-left rule.
/// ```
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Edge {
    /// First row.
    top: i32,
    /// Row after the last.
    bottom: i32,
    crossing: TallEdge,
}

/// Where an edge of any height crosses a row.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct TallEdge {
    /// The crossing, 32.32 subpixels, and [`TO_COLUMN`].
    x: i64,
    /// From one row to the next.
    step: i64,
}

/// Added to a crossing, makes its upper word the ceiling, and 127 more: see [`first_centre`].
const TO_COLUMN: i64 = ((SUBPIXELS as i64 / 2 - 1) << 32) | 0xffff_ffff;

impl TallEdge {
    /// In a row that the edge crosses.
    // Two copies are several hundred bytes, and a call is little beside the divisions.
    #[inline(never)]
    fn new(upper: &ScreenVertex, lower: &ScreenVertex, row: i32) -> Self {
        let (x0, y0) = (upper.x().to_bits(), upper.y().to_bits());
        let (x1, y1) = (lower.x().to_bits(), lower.y().to_bits());
        // At most 2^19, and not 0 where a row is crossed.
        let height = NonZeroU32::new(y1.wrapping_sub(y0).cast_unsigned());
        let height = height.unwrap_or(NonZeroU32::MIN);
        let step = quotient(x1.wrapping_sub(x0).wrapping_mul(SUBPIXELS), height);
        // From y0 to the first centre: 0 .. 255 subpixels, and less than the height, so that the
        // product is less than the width in 32.40.
        let offset = (SUBPIXELS / 2).wrapping_sub(y0) & (SUBPIXELS - 1);
        let beyond = product_with_short(step, offset) >> SUBPIXELS.trailing_zeros();
        // Too low by at most 2^-32 for each row and two units of that: less than 2^-20 over the 2^11 rows
        // of a height up to 2^19.
        let mut edge = Self {
            x: (i64::from(x0) << 32)
                .wrapping_add(beyond)
                .wrapping_add(TO_COLUMN),
            step,
        };
        edge.skip(row.abs_diff(first_centre(y0)));
        edge
    }

    /// On by `rows` rows at once, at most 2^11: the same state as so many single steps.
    #[inline]
    fn skip(&mut self, rows: u32) {
        if rows == 0 {
            return;
        }
        let far = product_with_short(self.step, rows.cast_signed());
        self.x = self.x.wrapping_add(far);
    }
}

impl Edge {
    /// The edge between two vertices, `upper` not below `lower`. `None` if no row of pixel
    /// centres lies between them.
    #[inline]
    #[must_use]
    pub fn new(upper: &ScreenVertex, lower: &ScreenVertex) -> Option<Self> {
        let [top, bottom] = [upper, lower].map(|end| first_centre(end.y().to_bits()));
        (top < bottom).then(|| Self {
            top,
            bottom,
            crossing: TallEdge::new(upper, lower, top),
        })
    }

    /// First row whose centres lie between the ends.
    #[inline]
    #[must_use]
    pub const fn top(&self) -> i32 {
        self.top
    }

    /// The row after the last one.
    #[inline]
    #[must_use]
    pub const fn bottom(&self) -> i32 {
        self.bottom
    }

    /// The first column whose centre is at the crossing or right of it, in the current row.
    #[inline]
    #[must_use]
    pub fn column(&self) -> i32 {
        (self.crossing.x >> (32 + SUBPIXEL_BITS)) as i32
    }

    /// On to the next row.
    #[inline]
    pub fn step(&mut self) {
        self.crossing.step();
    }

    /// On by `rows` rows at once, at most 2^11: the same state as so many single steps.
    #[inline]
    pub fn skip(&mut self, rows: u32) {
        self.crossing.skip(rows);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fixed::types::{I16F16, I24F8};

    extern crate std;

    fn vertex(x: i32, y: i32) -> ScreenVertex {
        let [x, y] = [x, y].map(I24F8::from_bits);
        ScreenVertex::new(x, y, I16F16::ONE, [I16F16::ZERO; 2]).expect("a vertex on the screen")
    }

    /// The first centre at or beyond the crossing of a row, as a rational number.
    fn exact(upper: [i32; 2], lower: [i32; 2], row: i32) -> i32 {
        let [x0, y0, x1, y1] = [upper[0], upper[1], lower[0], lower[1]].map(i64::from);
        let centre = i64::from(row) * 256 + 128;
        // x0 + (x1 - x0) (centre - y0) / (y1 - y0) <= 256 column + 128
        let (n, d) = (
            (x1 - x0) * (centre - y0) + (x0 - 128) * (y1 - y0),
            (y1 - y0) * 256,
        );
        (-(-n).div_euclid(d)) as i32
    }

    fn check(upper: [i32; 2], lower: [i32; 2]) {
        let [from, to] = [upper, lower].map(|[x, y]| vertex(x, y));
        let Some(mut edge) = Edge::new(&from, &to) else {
            assert!(first_centre(upper[1]) >= first_centre(lower[1]));
            return;
        };
        if ShortEdge::reaches(&from, &to) {
            let mut short = ShortEdge::enter(&from, &to, edge.top()).expect("a height");
            for row in edge.top()..edge.bottom() {
                assert_eq!(
                    i32::from(short.column() as i16) >> COLUMN_BITS,
                    exact(upper, lower, row),
                    "{upper:?} {lower:?} {row}"
                );
                short.step();
            }
        }
        let start = edge;
        for row in edge.top()..edge.bottom() {
            assert_eq!(
                edge.column(),
                exact(upper, lower, row),
                "{upper:?} {lower:?} {row}"
            );
            let mut skipped = start;
            skipped.skip(row.abs_diff(start.top()));
            assert_eq!(skipped.column(), edge.column());
            edge.step();
        }
    }

    #[test]
    fn columns_are_exact() {
        const MOST: i32 = 1024 << 8;
        let mut state = 1u32;
        let mut next = |span: i32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((u64::from(state) * (2 * span as u64 + 1)) >> 32) as i32 - span
        };
        for span in [300, 2000, 4095, 4096, 9000, MOST] {
            for _ in 0..if span == MOST { 2000 } else { 50_000 } {
                let from = [next(MOST), next(MOST)];
                let mut to = || (next(span), next(span));
                let (x, y) = to();
                let to = [from[0] + x, from[1] + y].map(|c| c.clamp(-MOST, MOST));
                let (upper, lower) = if from[1] <= to[1] {
                    (from, to)
                } else {
                    (to, from)
                };
                check(upper, lower);
            }
        }
    }

    /// Crossings on centres, and as near to them as rational numbers come.
    #[test]
    fn columns_are_exact_at_the_limits() {
        const MOST: i32 = 1024 << 8;
        for height in [
            1,
            2,
            255,
            256,
            257,
            2047,
            2048,
            4095,
            4096,
            4097,
            2 * MOST - 1,
            2 * MOST,
        ] {
            for width in [0, 1, 2, 255, 256, 257, 4095, MOST, 2 * MOST - 1, 2 * MOST] {
                for (x, y) in [(-MOST, -MOST), (128 - MOST, 128 - MOST), (0, 0), (1, 127)] {
                    let lower = [x + width, y + height];
                    if lower.iter().all(|c| *c <= MOST) {
                        check([x, y], lower);
                        check([lower[0], y], [x, lower[1]]);
                    }
                }
            }
        }
    }
}
