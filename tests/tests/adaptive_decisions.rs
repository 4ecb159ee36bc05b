//! Where the length of an adaptive piece is best decided: for each piece, for each scanline or for
//! each triangle. Measured in float64, with the error itself and not a bound of it.

use host_sim::choice::Perspective;
use host_sim::reference::{Planes, Sample};
use host_sim::render::{divisions, spans};
use host_sim::subject::Subject;
use multum::fixed::types::I16F16;
use multum::span::Span;
use multum::viewport::Viewport;

const BOUND: f64 = 0.25;

/// What float64 adds to an error of 0.
const NOISE: f64 = 1e-6;

/// The coordinates along a scanline, in texels, and what may be added to them.
struct Line {
    span: Span,
    texels: Vec<[f64; 2]>,
    allowed: Vec<f64>,
}

impl Line {
    fn new(planes: &Planes, span: Span, size: [f64; 2]) -> Self {
        let samples: Vec<Sample> = (span.left..span.right)
            .map(|x| planes.at(f64::from(x) + 0.5, f64::from(span.y) + 0.5))
            .collect();
        Self {
            span,
            texels: samples
                .iter()
                .map(|s| [0, 1].map(|axis| s.uv[axis] * size[axis]))
                .collect(),
            allowed: samples
                .iter()
                .map(|s| BOUND * s.footprint(size).max(1.0) + NOISE)
                .collect(),
        }
    }

    fn last(&self) -> usize {
        self.texels.len() - 1
    }

    /// Whether a chord between two pixels keeps the bound at all between them.
    fn keeps(&self, first: usize, end: usize) -> bool {
        (first..end).all(|i| {
            let share = (i - first) as f64 / (end - first) as f64;
            [0, 1].into_iter().all(|axis| {
                let (a, b) = (self.texels[first][axis], self.texels[end][axis]);
                (a + (b - a) * share - self.texels[i][axis]).abs() <= self.allowed[i]
            })
        })
    }

    /// Ends of pieces at the columns that are multiples of `length`, and at both ends.
    fn anchors(&self, length: usize) -> Vec<usize> {
        let first = self.span.left as usize % length;
        let inner = (length - first..self.last()).step_by(length);
        let mut anchors: Vec<usize> = [0].into_iter().chain(inner).collect();
        if self.last() > 0 {
            anchors.push(self.last());
        }
        anchors
    }

    /// The longest power of two that keeps the bound; 1 always does.
    fn longest(&self) -> usize {
        let keeps = |length: usize| {
            let anchors = self.anchors(length);
            anchors
                .windows(2)
                .all(|piece| self.keeps(piece[0], piece[1]))
        };
        (1..=10)
            .rev()
            .map(|log2| 1 << log2)
            .find(|&length| keeps(length))
            .unwrap_or(1)
    }

    /// Divisions if every piece goes as far as the bound allows. No choice of pieces between exact
    /// pixels takes fewer: coordinates are convex or concave along a line, so that a part of a piece
    /// that keeps the bound keeps it too.
    fn greedy(&self) -> usize {
        self.greedy_in(|length| length)
    }

    /// The same in those lengths that `round_down` makes of any.
    fn greedy_in(&self, round_down: fn(usize) -> usize) -> usize {
        let (mut from, mut count) = (0, 1);
        while from < self.last() {
            let mut end = from + 1;
            while end < self.last() && self.keeps(from, end + 1) {
                end += 1;
            }
            if end < self.last() {
                end = from + round_down(end - from);
            }
            (from, count) = (end, count + 1);
        }
        count
    }
}

/// The lengths of adaptive pieces.
fn length(most: usize) -> usize {
    match most {
        64.. => 64,
        48.. => 48,
        32.. => 32,
        16.. => 16,
        8.. => 8,
        4.. => 4,
        _ => 1,
    }
}

#[test]
fn deciding_for_each_piece_divides_less_often_than_for_scanlines_or_triangles() {
    for name in ["corridor", "room"] {
        let viewport = Viewport::new(320, 240).expect("a size in range");
        let frame = Subject::by_name(name)
            .and_then(|s| s.frame(viewport))
            .expect("a built-in scene");
        let (mut least, mut in_lengths, mut by_line, mut by_triangle) = (0, 0, 0, 0);
        for (batch, triangle) in frame.triangles() {
            let Some(planes) = Planes::new(&triangle.corners()) else {
                continue;
            };
            let size = [batch.picture.width(), batch.picture.height()].map(f64::from);
            let lines: Vec<Line> = spans(&triangle.vertices, 320, 240, frame.cull)
                .into_iter()
                .map(|span| Line::new(&planes, span, size))
                .collect();
            let lengths: Vec<usize> = lines.iter().map(Line::longest).collect();
            let shortest = lengths.iter().copied().min().unwrap_or(1);
            for (line, length) in lines.iter().zip(lengths) {
                least += line.greedy();
                in_lengths += line.greedy_in(self::length);
                by_line += line.anchors(length).len();
                by_triangle += line.anchors(shortest).len();
            }
        }
        let bound = I16F16::from_num(BOUND);
        let by_piece = divisions(&frame, Perspective::Adaptive(bound)) as usize;
        let found = format!(
            "{name}: {least} at least, {in_lengths} in its lengths, {by_piece} by piece, {by_line} \
             by scanline, {by_triangle} by triangle"
        );
        assert!(
            in_lengths < by_line && by_line < by_triangle && by_piece < by_triangle,
            "{found}"
        );
        // One length for a scanline knows the error itself here, and takes as many divisions as pieces that know a bound.
        assert!(by_piece * 100 < by_line * 101, "{found}");
        // What the bound costs, which knows how far a pixel reaches along the scanline but not down its column, and of
        // the rows of a triangle only the one on which texels are squeezed the most.
        assert!(by_piece * 100 < in_lengths * 121, "{found}");
        // In the corridor no chords between exact pixels keep the bound with as few divisions as
        // every:16 takes, which doesn't.
        let every = divisions(&frame, Perspective::Every(16)) as usize;
        assert_eq!(
            least < every,
            name == "room",
            "{found}, {every} by every:16"
        );
    }
}
