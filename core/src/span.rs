//! Spans: the runs of pixels that a triangle covers, one a scanline, from an edge on the left and
//! one on the right.

use crate::edge::Edge;
use crate::project::ScreenVertex;

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

/// The three corners from top to bottom, by y alone; equal heights stay in order.
#[inline]
fn by_height(vertices: &[ScreenVertex; 3]) -> [&ScreenVertex; 3] {
    let [mut a, mut b, mut c] = vertices.each_ref();
    if b.y() < a.y() {
        (a, b) = (b, a);
    }
    if c.y() < b.y() {
        (b, c) = (c, b);
    }
    if b.y() < a.y() {
        (a, b) = (b, a);
    }
    [a, b, c]
}

/// Calls `emit` for each span of a triangle inside `area`, from top to bottom.
///
/// Coverage is exact (see [`Edge`]) and independent of the area: cutting a frame into bands
/// changes nothing. A triangle without area has no spans.
#[inline]
pub fn for_each_span(vertices: &[ScreenVertex; 3], area: Area, mut emit: impl FnMut(Span)) {
    let [top, middle, bottom] = by_height(vertices);
    let Some(mut long) = Edge::new(top, bottom) else {
        return;
    };
    // Is the middle vertex right of the long edge? Twice the area, in subpixels: 40 bits.
    let cross = {
        let side = |p: &ScreenVertex| {
            (
                i64::from(p.x().to_bits().wrapping_sub(top.x().to_bits())),
                i64::from(p.y().to_bits().wrapping_sub(top.y().to_bits())),
            )
        };
        let ((mx, my), (bx, by)) = (side(middle), side(bottom));
        mx * by - my * bx
    };
    let mut row = long.top();
    for short in [Edge::new(top, middle), Edge::new(middle, bottom)] {
        let Some(mut short) = short else {
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
            let (left, right) = if cross > 0 {
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
