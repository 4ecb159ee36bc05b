//! The coverage rule, written down as directly as it reads: a pixel is drawn when its centre is
//! inside, or on a top or left edge. Integers of subpixels; nothing is stepped, nothing rounded.

use crate::Point;

/// A triangle as three edge functions.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    corners: [Point; 3],
}

impl Triangle {
    /// `None` without area.
    #[must_use]
    pub fn new([a, b, c]: [Point; 3]) -> Option<Self> {
        match edge(a, b, c) {
            0 => None,
            // Clockwise as seen on a screen with y down: the inside is where edges are positive.
            1.. => Some(Self { corners: [a, b, c] }),
            _ => Some(Self { corners: [a, c, b] }),
        }
    }

    /// Whether the pixel in this column and row is drawn.
    #[must_use]
    pub fn covers(&self, column: i32, row: i32) -> bool {
        let centre = [256 * column + 128, 256 * row + 128];
        let [a, b, c] = self.corners;
        [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| {
            let side = edge(from, to, centre);
            // Going round clockwise, a top edge runs to the right and a left edge runs up.
            let top = from[1] == to[1] && to[0] > from[0];
            let left = to[1] < from[1];
            side > 0 || (side == 0 && (top || left))
        })
    }
}

/// Twice the area of the triangle `from`, `to`, `p`. With 20-bit extents: 41 bits.
#[must_use]
pub fn edge(from: Point, to: Point, p: Point) -> i64 {
    let d = |a: i32, b: i32| i64::from(a) - i64::from(b);
    d(to[0], from[0]) * d(p[1], from[1]) - d(to[1], from[1]) * d(p[0], from[0])
}

/// Whether a pixel belongs to a closed outline, by the same rule: an odd number of its edges
/// cross the pixel's row at its centre or left of it, each edge taken with its upper end and
/// without its lower one.
#[must_use]
pub fn outline_covers(outline: &[Point], column: i32, row: i32) -> bool {
    let [x, y] = [256 * column + 128, 256 * row + 128];
    let next = outline.iter().cycle().skip(1);
    let crossings = outline.iter().zip(next).filter(|&(&a, &b)| {
        let (upper, lower) = if a[1] <= b[1] { (a, b) } else { (b, a) };
        // (y - y0) (x1 - x0) <= (x - x0) (y1 - y0): the crossing is not right of the centre.
        upper[1] <= y && y < lower[1] && edge(upper, lower, [x, y]) <= 0
    });
    crossings.count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The two formulations of the rule agree where both apply.
    #[test]
    fn outlines_and_edge_functions_agree() {
        for shape in [
            [[128, 128], [1152, 128], [128, 1152]],
            [[1152, 1152], [1152, 128], [128, 1152]],
            [[0, 600], [1300, 128], [640, 1300]],
        ] {
            let triangle = Triangle::new(shape).expect("an area");
            for (x, y) in (0..36).map(|i| (i % 6, i / 6)) {
                assert_eq!(
                    triangle.covers(x, y),
                    outline_covers(&shape, x, y),
                    "{shape:?} at {x}, {y}"
                );
            }
        }
    }
}
