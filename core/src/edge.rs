//! The exact walk along one edge of a triangle, scanline by scanline, in 32-bit integers.

use core::num::NonZeroU32;

use crate::arith::{div_floor, div_rem};
use crate::project::{ScreenVertex, first_centre};
use crate::viewport::SUBPIXELS;

/// An edge that crosses at least one scanline (a row of pixel centres), and where it crosses.
///
/// The crossing is a rational number of subpixels; what is kept is its ceiling and how far the
/// ceiling is beyond it, as in Bresenham's algorithm (IBM Systems Journal 4(1), 1965), so that
/// no error arises, however long the edge.
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
    /// Ceiling of the crossing, in subpixels.
    x: i32,
    /// `(ceiling - crossing) * height`, below `height`.
    excess: u32,
    /// Change of the crossing per row, rounded down, and the remainder.
    step: i32,
    remainder: u32,
    /// Extent in y, in subpixels.
    height: NonZeroU32,
}

impl Edge {
    /// The edge between two vertices, `upper` not below `lower`. `None` if no row of pixel
    /// centres lies between them.
    // A call takes some twenty instructions; a copy saves little beside Armv6-M's divisions.
    #[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
    #[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline)]
    #[must_use]
    pub fn new(upper: &ScreenVertex, lower: &ScreenVertex) -> Option<Self> {
        let (x0, y0) = (upper.x().to_bits(), upper.y().to_bits());
        let (x1, y1) = (lower.x().to_bits(), lower.y().to_bits());
        let (top, bottom) = (first_centre(y0), first_centre(y1));
        if top >= bottom {
            return None;
        }
        // bottom > top means that y1 is beyond y0.
        let height = NonZeroU32::new(y1.wrapping_sub(y0).unsigned_abs())?;
        let width = x1.wrapping_sub(x0);
        // From y0 to the first centre: 0 .. 255 subpixels; times a width below 2^20.
        let offset = top
            .wrapping_mul(SUBPIXELS)
            .wrapping_add(SUBPIXELS / 2)
            .wrapping_sub(y0);
        // ceil(q) = -floor(-q), and the remainder of the negated division is the excess.
        let (negated, excess) = div_floor(offset.wrapping_mul(width).wrapping_neg(), height);
        let (step, remainder) = div_floor(width.wrapping_mul(SUBPIXELS), height);
        Some(Self {
            top,
            bottom,
            x: x0.wrapping_sub(negated),
            excess,
            step,
            remainder,
            height,
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
    pub const fn column(&self) -> i32 {
        first_centre(self.x)
    }

    /// On to the next row.
    #[inline]
    pub const fn step(&mut self) {
        self.x = self.x.wrapping_add(self.step);
        if self.excess < self.remainder {
            self.x = self.x.wrapping_add(1);
            self.excess = self.excess.wrapping_add(self.height.get());
        }
        self.excess = self.excess.wrapping_sub(self.remainder);
    }

    /// On by `rows` rows at once: the same state as so many single steps.
    #[inline]
    pub fn skip(&mut self, rows: u32) {
        if rows == 0 {
            return;
        }
        // rows <= 2^11, remainder < 2^20 (see SUBPIXEL_BITS for the product).
        let total = rows.wrapping_mul(self.remainder);
        let (whole, rest) = div_rem(total, self.height);
        self.x = self
            .x
            .wrapping_add(self.step.wrapping_mul(rows.cast_signed()))
            .wrapping_add_unsigned(whole);
        if self.excess < rest {
            self.x = self.x.wrapping_add(1);
            self.excess = self.excess.wrapping_add(self.height.get());
        }
        self.excess = self.excess.wrapping_sub(rest);
    }
}
