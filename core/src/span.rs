//! Spans: the runs of pixels that a triangle covers, one a scanline, from an edge on the left and
//! one on the right.

use crate::edge::Edge;
use crate::project::ScreenVertex;
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

/// Calls `emit` for each span of a triangle inside `area`, from top to bottom.
///
/// Coverage is exact (see [`Edge`]) and independent of the area: cutting a frame into bands
/// changes nothing.
#[inline]
pub fn for_each_span(triangle: &TriangleSetup<'_>, area: Area, mut emit: impl FnMut(Span)) {
    let ([top, middle, bottom], reversed) = by_height(triangle.vertices());
    let Some(mut long) = Edge::new(top, bottom) else {
        return;
    };
    // Clockwise from the top, the middle corner comes before the bottom: it is on the right.
    let long_is_left = triangle.is_counter_clockwise() == reversed;
    let mut row = long.top();
    // One place for both short edges: what a span is filled with is in the image once.
    let mut corners = (top, middle);
    for is_last in [false, true] {
        if is_last {
            corners = (middle, bottom);
        }
        let Some(mut short) = Edge::new(corners.0, corners.1) else {
            continue;
        };
        let first = short.top().max(area.top);
        let end = short.bottom().min(area.bottom);
        if first >= end {
            continue;
        }
        long.skip(first.abs_diff(row));
        short.skip(first.abs_diff(short.top()));
        for y in first..end {
            let (left, right) = if long_is_left {
                (long.column(), short.column())
            } else {
                (short.column(), long.column())
            };
            let (left, right) = (left.max(0), right.min(area.width));
            if left < right {
                emit(Span { y, left, right });
            }
            long.step();
            short.step();
        }
        row = end;
    }
}
