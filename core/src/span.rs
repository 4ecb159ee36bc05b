//! Spans: the runs of pixels that a triangle covers, one a scanline, from an edge on the left and
//! one on the right.

use heapless::Vec;

use crate::arith::{NARROW, keep_rolled};
use crate::edge::{COLUMN_BITS, Crossing, ShortEdge, TallEdge};
use crate::project::{ScreenVertex, first_centre};
use crate::setup::TriangleSetup;

/// The pixels `left .. right` of row `y`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Span {
    /// The row.
    pub y: i32,
    /// First column.
    pub left: i32,
    /// The column after the last; beyond `left`.
    pub right: i32,
}

/// The part of the screen that is drawn to: columns `0 .. width`, rows `top .. bottom`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Area {
    /// Columns.
    pub width: i32,
    /// First row.
    pub top: i32,
    /// The row after the last.
    pub bottom: i32,
}

/// The three corners from top to bottom, by y alone, and whether their order was reversed: an odd
/// number of exchanges.
#[inline]
fn by_height(vertices: &[ScreenVertex; 3]) -> ([&ScreenVertex; 3], bool) {
    let [mut a, mut b, mut c] = vertices.each_ref();
    let mut reversed = false;
    if b.y() < a.y() {
        (a, b) = (b, a);
        reversed = !reversed;
    }
    if c.y() < b.y() {
        (b, c) = (c, b);
        reversed = !reversed;
    }
    if b.y() < a.y() {
        (a, b) = (b, a);
        reversed = !reversed;
    }
    ([a, b, c], reversed)
}

/// Rows of which the columns are found at a time.
const ROWS: usize = 16;

/// Where the rows of a triangle begin and end, as [`Crossing::column`] has it: the first column in the upper half,
/// the one after the last in the lower.
type Columns = Vec<u32, ROWS>;

/// From a column up to a word's upper half.
const COLUMN_UP: u32 = 16 + COLUMN_BITS;

/// The walk down a triangle, between its long edge and its two short ones.
struct Walk<'a> {
    /// From top to bottom.
    corners: [&'a ScreenVertex; 3],
    /// By how many bits the long edge's column is beyond the lower half.
    long: u32,
    /// The row after the last.
    end: i32,
}

impl Walk<'_> {
    /// Columns of a row and of those after it.
    #[inline]
    fn columns(&self, row: i32, columns: &mut Columns) {
        if const { NARROW } {
            // A frame of the stack that only hands over would be a fifth of it.
            if self.is_short() {
                self.short(row, columns);
            } else {
                self.tall(row, columns);
            }
        } else {
            self.short_or_tall(row, columns);
        }
    }

    /// Whether edges are.
    #[inline]
    fn is_short(&self) -> bool {
        let [top, _, bottom] = self.corners;
        ShortEdge::reaches(top, bottom)
    }

    // Not a part of what draws the spans where registers are few: edges and pixels together are more.
    #[cfg_attr(target_pointer_width = "32", inline(never))]
    #[cfg_attr(target_pointer_width = "64", inline(always))]
    fn short_or_tall(&self, row: i32, columns: &mut Columns) {
        if self.is_short() {
            self.between::<ShortEdge>(row, columns);
        } else {
            self.tall(row, columns);
        }
    }

    /// Of a triangle of few rows.
    #[inline(never)]
    fn short(&self, row: i32, columns: &mut Columns) {
        self.between::<ShortEdge>(row, columns);
    }

    /// Of any triangle.
    // A function of its own: its registers are more than a short triangle's.
    #[inline(never)]
    fn tall(&self, row: i32, columns: &mut Columns) {
        self.between::<TallEdge>(row, columns);
    }

    /// Between edges of one kind.
    #[inline]
    fn between<E: Crossing>(&self, row: i32, columns: &mut Columns) {
        columns.clear();
        let [top, middle, bottom] = self.corners;
        let Some(mut long) = E::enter(top, bottom, row) else {
            return;
        };
        // Where there is no room for more, the rest comes with the next call. It is seen to before the loop
        // or in it: each is less work on some processors.
        let most = if const { NARROW } { ROWS } else { usize::MAX };
        let rows = |end: i32| (end.wrapping_sub(row).max(0) as usize).min(most);
        let all = rows(self.end);
        let (mut upper, mut lower) = (top, middle);
        let mut until = rows(first_centre(middle.y().to_bits())).min(all);
        loop {
            if columns.len() < until
                && let Some(mut short) =
                    E::enter(upper, lower, row.wrapping_add(columns.len() as i32))
            {
                while columns.len() < until {
                    let both = long.column() & 0xffff | short.column() << 16;
                    let is_full = columns.push(both.rotate_left(self.long)).is_err();
                    if const { !NARROW } && is_full {
                        return;
                    }
                    long.step();
                    short.step();
                }
            }
            if until == all {
                return;
            }
            (upper, lower, until) = (middle, bottom, all);
        }
    }
}

/// Calls `emit` for each span of a triangle inside `area`, from top to bottom.
///
/// Coverage is exact (see [`Edge`](crate::edge::Edge)) and independent of the area: cutting a frame into bands
/// changes nothing.
#[inline]
pub fn for_each_span(triangle: &TriangleSetup<'_>, area: Area, mut emit: impl FnMut(Span)) {
    let (corners, reversed) = by_height(triangle.vertices());
    let [top, _, bottom] = corners.map(|corner| first_centre(corner.y().to_bits()));
    // Clockwise from the top, the middle corner comes before the bottom: it is on the right.
    let long_is_left = triangle.is_counter_clockwise() == reversed;
    let walk = Walk {
        corners,
        long: if long_is_left { 16 } else { 0 },
        end: bottom.min(area.bottom),
    };
    let mut y = top.max(area.top);
    let mut columns = Columns::new();
    while y < walk.end {
        walk.columns(y, &mut columns);
        for both in &columns {
            let [left, right] = [*both, both << 16].map(|half| half.cast_signed() >> COLUMN_UP);
            let (left, right) = (left.max(0), right.min(area.width));
            if left < right {
                // Else what `emit` asks first is asked before this, and both kept.
                if const { NARROW } {
                    keep_rolled();
                }
                emit(Span { y, left, right });
            }
            y = y.wrapping_add(1);
        }
        if columns.is_empty() {
            return;
        }
    }
}
