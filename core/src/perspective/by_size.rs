//! Small triangles apart from others: their planes take a fraction of the work.

use super::homogeneous::short::ShortPlanes;
use super::homogeneous::words::{Large, WordPlanes};
use super::{Homogeneous, Run, RunSink, SpanSink};
use crate::arith::{NARROW, keep_in_place, keep_rolled};
use crate::setup::TriangleSetup;
use crate::span::{Area, Span, for_each_span};
use crate::uv::Uv;

/// The planes of a triangle of any size.
#[derive(Clone, Copy, Debug)]
pub enum Planes<W = WordPlanes> {
    /// Of a small one.
    Short(ShortPlanes),
    /// Of another, if words will do.
    Words(W),
    /// Of any.
    Whole(Homogeneous),
}

impl Planes {
    /// As [`Self::with`], with nothing beside words.
    #[inline]
    pub(super) fn new(triangle: &TriangleSetup<'_>, log2_pixels: u32, units: i32) -> Option<Self> {
        Self::with(triangle, log2_pixels, units, |words| words)
    }
}

impl<W> Planes<W> {
    /// With so many units of 2^-24 added to all coordinates. Triangles of so many pixels and less may count
    /// as small; what belongs to words is added to them. `None` if u or v spans 128 repeats or more.
    #[inline]
    pub(super) fn with(
        triangle: &TriangleSetup<'_>,
        log2_pixels: u32,
        units: i32,
        add: impl FnOnce(WordPlanes) -> W,
    ) -> Option<Self> {
        if ShortPlanes::may_hold(triangle, log2_pixels) {
            Self::short(triangle, units, add)
        } else {
            Self::any(triangle, units, add)
        }
    }

    /// Of a small triangle, unless its depths or coordinates differ, or it is a sliver.
    // Functions of their own, where stack is short: each takes what it needs, and not that of the other too.
    #[cfg_attr(target_pointer_width = "32", inline(never))]
    #[cfg_attr(target_pointer_width = "64", inline(always))]
    fn short(
        triangle: &TriangleSetup<'_>,
        units: i32,
        add: impl FnOnce(WordPlanes) -> W,
    ) -> Option<Self> {
        match ShortPlanes::biased(triangle, units) {
            Some(planes) => Some(Self::Short(planes)),
            None => Self::any(triangle, units, add),
        }
    }

    /// Of any triangle.
    #[inline(never)]
    fn any(
        triangle: &TriangleSetup<'_>,
        units: i32,
        add: impl FnOnce(WordPlanes) -> W,
    ) -> Option<Self> {
        Homogeneous::biased(triangle, units, |planes, words| match words {
            Some(words) => Self::Words(add(words)),
            None => Self::Whole(planes),
        })
    }
}

/// Makes runs of all kinds.
pub(super) trait BySize<W = WordPlanes> {
    /// The runs of a span of a small triangle.
    fn short_runs(&self, planes: &ShortPlanes, span: Span, to: impl RunSink);

    /// The runs of a span of another, from words.
    fn word_runs(&self, planes: &W, span: Span, to: impl RunSink);

    /// The runs of a span of any, with all bits of the planes.
    fn whole_runs(&self, planes: &Homogeneous, span: Span, to: impl RunSink);

    /// The runs of a span of a small triangle, of which every pixel is divided.
    // Here, and not with the strategy that does nothing else: what two strategies share is called, and it is the inner
    // loop of a mesh.
    #[inline]
    fn short_points(&self, planes: &ShortPlanes, span: Span, mut to: impl RunSink) {
        let len = span.right.abs_diff(span.left);
        to.points::<_, 1>(
            0,
            len as usize,
            planes.at(span.left, span.y),
            |&point| planes.divide(point),
            |point| *point = planes.step(*point, 1),
        );
    }

    /// The same with all bits of the planes.
    #[inline]
    fn whole_points(&self, planes: &Homogeneous, span: Span, mut to: impl RunSink) {
        let len = span.right.abs_diff(span.left);
        let leap = planes.leap(1);
        to.points::<_, 1>(
            0,
            len as usize,
            planes.at(span.left, span.y),
            |&point| planes.divide(point),
            |point| *point = point.after(&leap),
        );
    }

    /// The runs of a span of a triangle that is not small.
    #[inline]
    fn large_runs(&self, planes: Large<'_, W>, span: Span, to: impl RunSink) {
        match planes {
            Large::Words(planes) => self.word_runs(planes, span, to),
            Large::Whole(planes) => self.whole_runs(planes, span, to),
        }
    }

    /// The runs of a span.
    #[inline]
    fn runs_by_size(&self, planes: &Planes<W>, span: Span, to: impl RunSink) {
        match planes {
            Planes::Short(planes) => self.short_runs(planes, span, to),
            Planes::Words(planes) => self.word_runs(planes, span, to),
            Planes::Whole(planes) => self.whole_runs(planes, span, to),
        }
    }

    /// The runs of all spans.
    #[inline]
    fn all_runs_by_size(
        &self,
        planes: &Planes<W>,
        triangle: &TriangleSetup<'_>,
        area: Area,
        mut to: impl SpanSink,
    ) {
        // Two loops are a kilobyte or more, and 5 % of the instructions of a mesh: small processors come with
        // little flash.
        if const { NARROW } {
            for_each_span(triangle, area, |span| {
                if let Some(to) = to.span(span) {
                    keep_in_place(planes);
                    self.runs_by_size(planes, span, to);
                }
            });
            return;
        }
        match planes {
            Planes::Short(planes) => {
                keep_in_place(planes);
                for_each_span(triangle, area, |span| {
                    if let Some(to) = to.span(span) {
                        keep_rolled();
                        self.short_runs(planes, span, to);
                    }
                });
            }
            Planes::Words(_) | Planes::Whole(_) => for_each_span(triangle, area, |span| {
                if let Some(to) = to.span(span) {
                    keep_in_place(planes);
                    match planes {
                        Planes::Words(planes) => self.word_runs(planes, span, to),
                        Planes::Whole(planes) => self.whole_runs(planes, span, to),
                        Planes::Short(_) => {}
                    }
                }
            }),
        }
    }
}

/// The runs of a span that is one piece: exact at both ends.
// Always: it is the inner loop of a mesh, and in an image of several strategies it would be called.
#[inline(always)]
pub(super) fn one_piece(planes: &ShortPlanes, span: Span, mut to: impl RunSink) {
    let len = span.left.abs_diff(span.right);
    let line = planes.line(planes.at(span.left, span.y));
    let uv = line.start(planes);
    let step = if len > 1 {
        line.step(planes, len.wrapping_sub(1))
    } else {
        Uv::default()
    };
    to.short_run(Run {
        offset: 0,
        len: len as usize,
        uv,
        step,
    });
}
