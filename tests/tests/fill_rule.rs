//! The top-left rule as pictures. A pixel is drawn when its centre (at +0.5) is inside; a centre
//! on an edge belongs to the shape below a horizontal edge or right of any other.
//!
//! Each shape is drawn as a fan of triangles in its own letter. Drawing a pixel twice fails at
//! once, so that the pictures also show that shared edges are drawn once. No picture may depend
//! on the winding or on which corner comes first: each is drawn in all ways.

use multum::fixed::types::I24F8;
use tests::frame::{Frame, Overdraw};
use tests::{Point, at, flat};

/// Corners in pixels; multiples of 1/256.
type Shape<'a> = &'a [[f64; 2]];

/// 1/256 px.
const D: f64 = 1.0 / 256.0;

fn point([x, y]: [f64; 2]) -> Point {
    [x, y].map(|c| {
        assert_eq!((c / D).fract(), 0.0, "{c} is not on the subpixel grid");
        I24F8::from_num(c).to_bits()
    })
}

/// Draws shapes a, b, c .. and compares with the expected rows.
fn check(shapes: &[Shape<'_>], expected: &[&str]) {
    let size = (expected[0].len() as i32, expected.len() as i32);
    let orders = [
        [0, 1, 2],
        [1, 2, 0],
        [2, 0, 1],
        [0, 2, 1],
        [2, 1, 0],
        [1, 0, 2],
    ];
    for order in orders {
        let mut frame = Frame::new(size.0, size.1, b'.', Overdraw::Panics);
        for (letter, shape) in (b'a'..).zip(shapes) {
            for pair in shape[1..].windows(2) {
                let corners = [shape[0], pair[0], pair[1]].map(point).map(at);
                flat(letter).draw_triangle(&mut frame, &order.map(|i: usize| corners[i]));
            }
        }
        let drawn = frame.picture();
        assert_eq!(
            drawn,
            expected.join("\n") + "\n",
            "corners in order {order:?}:\n{drawn}"
        );
    }
}

/// Centres on the top and on the left edge are in, on the bottom and on the right edge out.
#[test]
fn centres_on_the_edges_of_a_rectangle() {
    check(
        &[&[[1.5, 1.5], [4.5, 1.5], [4.5, 3.5], [1.5, 3.5]]],
        &[
            "......", //
            ".aaa..", ".aaa..", "......", "......",
        ],
    );
}

/// Edges on pixel borders meet no centre.
#[test]
fn a_rectangle_of_whole_pixels() {
    check(
        &[&[[1.0, 1.0], [4.0, 1.0], [4.0, 3.0], [1.0, 3.0]]],
        &[
            "......", //
            ".aaa..", ".aaa..", "......",
        ],
    );
}

/// 1/256 px decides: right of and below the centres, then left of and above them.
#[test]
fn one_subpixel_beside_the_centres() {
    check(
        &[&[
            [1.5 + D, 1.5 + D],
            [4.5 + D, 1.5 + D],
            [4.5 + D, 3.5 + D],
            [1.5 + D, 3.5 + D],
        ]],
        &[
            "......", //
            "......", "..aaa.", "..aaa.", "......",
        ],
    );
    check(
        &[&[
            [1.5 - D, 1.5 - D],
            [4.5 - D, 1.5 - D],
            [4.5 - D, 3.5 - D],
            [1.5 - D, 3.5 - D],
        ]],
        &[
            "......", //
            ".aaa..", ".aaa..", "......", "......",
        ],
    );
}

/// The edge x = 2.5 runs through centres: they belong to the shape on the right.
#[test]
fn shared_vertical_edge() {
    check(
        &[
            &[[0.5, 0.0], [2.5, 0.0], [2.5, 3.0], [0.5, 3.0]],
            &[[2.5, 0.0], [4.5, 0.0], [4.5, 3.0], [2.5, 3.0]],
        ],
        &[
            "aabb.", //
            "aabb.", "aabb.", ".....",
        ],
    );
}

/// The edge y = 1.5 runs through centres: they belong to the shape below.
#[test]
fn shared_horizontal_edge() {
    check(
        &[
            &[[0.0, 0.5], [4.0, 0.5], [4.0, 1.5], [0.0, 1.5]],
            &[[0.0, 1.5], [4.0, 1.5], [4.0, 3.5], [0.0, 3.5]],
        ],
        &[
            "aaaa.", //
            "bbbb.", "bbbb.", ".....",
        ],
    );
}

/// The diagonals of a square run through centres: they belong to the triangle on the right.
#[test]
fn shared_diagonal_edge() {
    check(
        &[
            &[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]],
            &[[0.0, 0.0], [4.0, 4.0], [0.0, 4.0]],
        ],
        &[
            "aaaa", //
            "baaa", "bbaa", "bbba",
        ],
    );
    check(
        &[
            &[[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]],
            &[[4.0, 0.0], [4.0, 4.0], [0.0, 4.0]],
        ],
        &[
            "aaab", //
            "aabb", "abbb", "bbbb",
        ],
    );
}

/// A steep and a flat edge that meet every second centre on their way.
#[test]
fn shared_edges_at_other_angles() {
    // x = 1 + (y - 0.5) / 2: 1, 1.5, 2, 2.5 on rows 0 to 3; it meets the centres of column 1 on
    // row 1 and of column 2 on row 3.
    check(
        &[
            &[[0.0, 0.5], [1.0, 0.5], [3.0, 4.5], [0.0, 4.5]],
            &[[1.0, 0.5], [5.0, 0.5], [5.0, 4.5], [3.0, 4.5]],
        ],
        &[
            "abbbb", //
            "abbbb", "aabbb", "aabbb", ".....",
        ],
    );
    // x = 0.5 + 2 (y - 1): 1.5 on row 1 and 3.5 on row 2, each through a centre. The shape above
    // lies on the right of it.
    check(
        &[
            &[[0.5, 0.0], [4.5, 0.0], [4.5, 3.0], [0.5, 1.0]],
            &[[0.5, 1.0], [4.5, 3.0], [4.5, 4.0], [0.5, 4.0]],
        ],
        &[
            "aaaa.", //
            "baaa.", "bbba.", "bbbb.", ".....",
        ],
    );
}

/// A corner on the centre (2.5, 1.5) as the top of a triangle lies on its right edge: out.
/// Edges at x = 2.5 -+ 0.6 (y - 1.5).
#[test]
fn top_corner_on_a_centre() {
    check(
        &[&[[2.5, 1.5], [4.0, 4.0], [1.0, 4.0]]],
        &[
            ".....", //
            ".....", "..a..", ".aaa.", ".....",
        ],
    );
}

/// As the bottom of a triangle: out, for no row below the corner belongs to it.
#[test]
fn bottom_corner_on_a_centre() {
    check(
        &[&[[2.5, 2.5], [1.0, 0.0], [4.0, 0.0]]],
        &[
            ".aaa.", //
            "..a..", ".....",
        ],
    );
}

/// As the left corner: on two left edges, hence in.
#[test]
fn left_corner_on_a_centre() {
    check(
        &[&[[1.5, 1.5], [4.0, 0.0], [4.0, 3.0]]],
        &[
            "...a.", //
            ".aaa.", "...a.",
        ],
    );
}

/// As the right corner: on two right edges, hence out.
#[test]
fn right_corner_on_a_centre() {
    check(
        &[&[[3.5, 1.5], [1.0, 0.0], [1.0, 3.0]]],
        &[
            ".a...", //
            ".aa..", ".a...",
        ],
    );
}

/// Four triangles around the centre (2.5, 2.5), which belongs to the right one: it alone has
/// only left edges there. The diagonals meet five centres.
#[test]
fn fan_around_a_centre() {
    let c = [2.5, 2.5];
    check(
        &[
            &[c, [1.0, 1.0], [4.0, 1.0]],
            &[c, [4.0, 1.0], [4.0, 4.0]],
            &[c, [4.0, 4.0], [1.0, 4.0]],
            &[c, [1.0, 4.0], [1.0, 1.0]],
        ],
        &[
            ".....", //
            ".aab.", ".dbb.", ".ccb.", ".....",
        ],
    );
}

/// Four squares around it: it belongs to the one below and right.
#[test]
fn four_squares_around_a_centre() {
    check(
        &[
            &[[0.5, 0.5], [2.5, 0.5], [2.5, 2.5], [0.5, 2.5]],
            &[[2.5, 0.5], [4.5, 0.5], [4.5, 2.5], [2.5, 2.5]],
            &[[0.5, 2.5], [2.5, 2.5], [2.5, 4.5], [0.5, 4.5]],
            &[[2.5, 2.5], [4.5, 2.5], [4.5, 4.5], [2.5, 4.5]],
        ],
        &[
            "aabb.", //
            "aabb.", "ccdd.", "ccdd.", ".....",
        ],
    );
}

/// Triangles that pass between the centres draw nothing.
#[test]
fn thin_triangles_between_centres() {
    check(
        &[
            &[[1.625, 0.0], [2.375, 0.0], [2.0, 4.0]],
            &[[0.0, 1.625], [4.0, 1.75], [0.0, 2.25]],
            &[[2.625, 2.625], [3.375, 2.625], [3.0, 3.375]],
        ],
        &["....", "....", "....", "...."],
    );
}

/// Triangles 1/256 px wide: a left edge through centres draws them, a right edge does not, and
/// beside the centres there is nothing to draw.
#[test]
fn slivers_along_a_column_of_centres() {
    check(
        &[&[[1.5, 0.0], [1.5 + D, 0.0], [1.5, 4.0]]],
        &[".a..", ".a..", ".a..", ".a.."],
    );
    check(
        &[
            &[[1.5 - D, 0.0], [1.5, 0.0], [1.5, 4.0]],
            &[[1.5 + D, 0.0], [1.5 + 2.0 * D, 0.0], [1.5 + D, 4.0]],
        ],
        &["....", "....", "....", "...."],
    );
}

/// Triangles 1/256 px high: a top edge through centres draws them, a bottom edge does not.
#[test]
fn slivers_along_a_row_of_centres() {
    check(
        &[&[[0.0, 1.5], [4.0, 1.5], [0.0, 1.5 + D]]],
        &["....", "aaaa", "....", "...."],
    );
    check(
        &[&[[0.0, 1.5 - D], [4.0, 1.5], [0.0, 1.5]]],
        &["....", "....", "....", "...."],
    );
}

/// No area, no pixel, wherever the corners are.
#[test]
fn no_area() {
    check(
        &[
            &[[1.5, 1.5], [1.5, 1.5], [1.5, 1.5]],
            &[[0.0, 0.0], [4.0, 4.0], [2.0, 2.0]],
            &[[0.0, 1.5], [4.0, 1.5], [2.0, 1.5]],
            &[[1.5, 0.0], [1.5, 4.0], [1.5, 4.0]],
        ],
        &["....", "....", "....", "...."],
    );
}

/// What the pictures rely on: the sink does fail on overdraw.
#[test]
#[should_panic(expected = "draws a pixel again")]
fn overdraw_is_noticed() {
    check(
        &[
            &[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]],
            &[[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]],
        ],
        &["aa.", "abb", ".bb"],
    );
}
