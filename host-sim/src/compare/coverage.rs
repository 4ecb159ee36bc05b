//! The core's spans against the exact rule, triangle by triangle.

use std::collections::{HashMap, HashSet};

use crate::frame::{Frame, ScreenTriangle};
use crate::reference::Coverage;
use crate::render::spans;

/// Coverage in numbers; see [`Comparison`](super::Comparison) for what they count.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CoverageCheck {
    pub(crate) mismatches: usize,
    pub(crate) double_draws: usize,
    pub(crate) gaps: usize,
}

/// The core's spans of every triangle against the exact rule, hidden pixels included.
pub(crate) fn check(frame: &Frame, shown: &[bool]) -> CoverageCheck {
    let (width, height) = (frame.viewport.width(), frame.viewport.height());
    let pixels = (width * height) as usize;
    let mut mismatches = 0;
    let mut wanted = vec![false; pixels];
    let mut drawn: Vec<Vec<u32>> = vec![Vec::new(); pixels];
    let mut pending = HashSet::new();
    for (number, (_, triangle)) in frame.triangles().enumerate() {
        pending.clear();
        if shown[number]
            && let Some(coverage) = Coverage::new(triangle.grid(), 256)
        {
            coverage.for_each(width, height, |x, y| {
                let i = (y * width + x) as usize;
                wanted[i] = true;
                pending.insert(i);
            });
        }
        for span in spans(&triangle.vertices, width, height, frame.cull) {
            let row = span.y as usize * width as usize;
            let columns = row + span.left as usize..row + span.right as usize;
            for (i, by) in columns.clone().zip(&mut drawn[columns]) {
                if !pending.remove(&i) {
                    mismatches += 1;
                }
                by.push(number as u32);
            }
        }
        mismatches += pending.len();
    }
    let gaps = wanted
        .iter()
        .zip(&drawn)
        .filter(|(wanted, by)| **wanted && by.is_empty())
        .count();
    let neighbours = Neighbours::find(frame, shown);
    let double_draws = drawn
        .iter()
        .filter(|by| {
            by.iter()
                .enumerate()
                .any(|(i, a)| by[..i].iter().any(|b| neighbours.share_edge(*a, *b)))
        })
        .count();
    CoverageCheck {
        mismatches,
        double_draws,
        gaps,
    }
}

/// Which triangles share an edge of the screen, running along it in opposite directions: then
/// they face the same way and lie on its two sides.
struct Neighbours(HashSet<(u32, u32)>);

impl Neighbours {
    fn find(frame: &Frame, shown: &[bool]) -> Self {
        let mut edges: HashMap<_, Vec<u32>> = HashMap::new();
        let mut pairs = HashSet::new();
        for (number, (_, triangle)) in frame.triangles().enumerate() {
            if !shown[number] {
                continue;
            }
            for (a, b) in directed_edges(triangle) {
                for &other in edges.get(&(b, a)).into_iter().flatten() {
                    pairs.insert((other, number as u32));
                }
            }
            for edge in directed_edges(triangle) {
                edges.entry(edge).or_default().push(number as u32);
            }
        }
        Self(pairs)
    }

    fn share_edge(&self, a: u32, b: u32) -> bool {
        self.0.contains(&(a.min(b), a.max(b)))
    }
}

/// The three edges, turned to one winding, in 1/256 pixel and with depth: edges that only
/// look the same on the screen are not shared.
fn directed_edges(triangle: &ScreenTriangle) -> [([i64; 3], [i64; 3]); 3] {
    let [a, b, c] = triangle.grid();
    let [wa, wb, wc] = triangle.vertices.map(|v| i64::from(v.w().to_bits()));
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let (a, b, c) = ([a[0], a[1], wa], [b[0], b[1], wb], [c[0], c[1], wc]);
    if area < 0 {
        [(a, c), (c, b), (b, a)]
    } else {
        [(a, b), (b, c), (c, a)]
    }
}
