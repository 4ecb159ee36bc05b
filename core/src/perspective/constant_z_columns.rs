//! One division for a column along which the depth does not change.

use core::cell::Cell;

use super::by_size::BySize;
use super::homogeneous::parts::{Scale, head, shift};
use super::homogeneous::words::WithWords;
use super::{Every, RunSink, Strategy, exact_ends};
use crate::arith::reciprocal;
use crate::setup::TriangleSetup;
use crate::span::Span;

/// One division a column where 1/w is constant along it, as for Doom's walls (Sanglard, *Game
/// Engine Black Book: Doom*, "Walls"): [`ConstantZ`](super::ConstantZ) with the roles of x and y
/// exchanged.
///
/// Spans stay rows, so that coverage and sinks are those of every strategy; what is kept for each
/// column is the reciprocal of its 1/w, in the caller's memory, found when the column is first
/// met. u and v of a pixel are its u/w and v/w times that: linear along the column, as in a
/// drawer of columns.
///
/// It serves triangles along whose columns 1/w changes by at most 2^-14 of its least value at the
/// corners. With R the power of two of repeats that the triangle's u (or v) fits in, the error is
/// at most `R 2^-14` repeats, and nothing where the depth is constant, in addition to that of
/// [`PerPixel`](super::PerPixel). Other triangles, and columns beyond the memory, fall back to
/// [`Every<16>`](super::Every), with its divisions and its error.
///
/// Costs four bytes for each column of the frame and a division for each column of the triangle
/// (of each band of it); then three multiplications a pixel. Choose it for walls seen by a
/// camera that neither rolls nor looks up or down.
#[derive(Clone, Copy, Debug)]
pub struct ConstantZColumns<'a> {
    /// Reciprocals of the current triangle's columns; 0 is none.
    columns: &'a [Cell<u32>],
}

/// Planes, and the row that speaks for the columns where their depth is constant.
#[derive(Clone, Copy, Debug)]
pub struct ColumnPlanes {
    planes: WithWords,
    row: Option<i32>,
}

impl<'a> ConstantZColumns<'a> {
    /// 1/w may differ along a column by one part in 2 to this power.
    pub const TOLERANCE_BITS: u32 = 14;

    /// With memory for as many columns as the frame has. What it holds does not matter. It serves
    /// one triangle at a time: pipelines that draw in turn can share it if each draws whole
    /// triangles.
    #[must_use]
    pub const fn new(columns: &'a [Cell<u32>]) -> Self {
        Self { columns }
    }

    /// The memory for a span, and the row, if it can be drawn by columns.
    #[inline]
    fn row(&self, planes: &ColumnPlanes, span: Span) -> Option<(i32, &'a [Cell<u32>])> {
        let left = usize::try_from(span.left).ok()?;
        let right = usize::try_from(span.right).ok()?;
        Some((planes.row?, self.columns.get(left..right)?))
    }
}

impl Strategy for ConstantZColumns<'_> {
    type Planes = ColumnPlanes;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<ColumnPlanes> {
        let with_words = WithWords::new(triangle)?;
        let planes = &with_words.planes;
        let rows = triangle.vertices().each_ref().map(|v| v.y().to_bits() >> 8);
        let columns = triangle.vertices().each_ref().map(|v| v.x().to_bits() >> 8);
        let bounds = |c: [i32; 3]| {
            let [p, q, r] = c;
            (p.min(q).min(r), p.max(q).max(r))
        };
        let ((top, bottom), (left, right)) = (bounds(rows), bounds(columns));
        let row = top.wrapping_add(bottom) >> 1;
        // 1/w is linear along the row, so least at one of the outermost columns.
        let least = planes.at(left, row).q().min(planes.at(right, row).q());
        let change = planes.change_down(bottom.abs_diff(top).wrapping_add(1));
        let is_constant = change <= least.cast_unsigned() >> Self::TOLERANCE_BITS;
        if is_constant {
            // From the column before the first centre to the one after the last.
            let left = usize::try_from(left).unwrap_or(0).min(self.columns.len());
            let right = usize::try_from(right.saturating_add(1)).unwrap_or(0);
            let right = right.clamp(left, self.columns.len());
            for column in self.columns.get(left..right).unwrap_or_default() {
                column.set(0);
            }
        }
        Some(ColumnPlanes {
            planes: with_words,
            row: is_constant.then_some(row),
        })
    }

    #[inline]
    fn runs(&self, planes: &ColumnPlanes, span: Span, mut to: impl RunSink) {
        let Some((row, columns)) = self.row(planes, span) else {
            Every::<16>.large_runs(planes.planes.large(), span, to);
            return;
        };
        let planes = &planes.planes.planes;
        let point = planes.at(span.left, span.y);
        let of_column = planes.at(span.left, row);
        let leap = planes.leap(1);
        to.points::<_, 1>(
            0,
            columns.len(),
            (point, of_column, columns),
            |&(point, of_column, columns)| {
                let q = of_column.q();
                let shift = shift(q);
                let known = columns.first();
                let mut inverse = known.map_or(0, Cell::get);
                if inverse == 0 {
                    inverse = reciprocal(head(q, shift));
                    if let Some(column) = known {
                        column.set(inverse);
                    }
                }
                planes.scaled(point, Scale { shift, inverse })
            },
            |(point, of_column, columns)| {
                *point = point.after(&leap);
                *of_column = of_column.after(&leap);
                *columns = columns.get(1..).unwrap_or_default();
            },
        );
    }

    /// Those that are still to be made: asking makes none, and drawing makes each once.
    fn divisions(&self, planes: &ColumnPlanes, span: Span) -> u32 {
        match self.row(planes, span) {
            Some((_, columns)) => columns.iter().filter(|c| c.get() == 0).count() as u32,
            None => exact_ends(|to| Every::<16>.large_runs(planes.planes.large(), span, to)),
        }
    }
}
