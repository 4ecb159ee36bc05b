//! Forward mapping: from the texture to the screen.
//!
//! Each texel whose centre is in the triangle of texture coordinates, in every repeat, is
//! projected and written to the pixel that it falls into. Sega's VDP1 in the Saturn drew its
//! distorted sprites in this direction: row by row of the sprite, each a line between two edges of
//! the quadrilateral, texel by texel and without perspective. It is not the VDP1 that is rebuilt
//! here: that repeated texels and added pixels at diagonal steps to close its lines, and so traded
//! holes for overdraw. Here each texel is one write, and is projected with perspective, by one
//! division, so that what remains is what the direction itself costs.
//!
//! The texture is read in order and each texel once, which suited memory without a cache. The
//! price: where a texel is larger than a pixel, pixels between the texels are left out (a texel
//! of m x m pixels leaves out 1 - 1/m^2 of them), and where
//! it is smaller, pixels are written again and again (m^2 texels a pixel, all but one for
//! nothing). The work is that of the texture and not of the screen. A triangle with constant
//! coordinates has no texels and is not drawn at all. A pixel's coordinates are those of a texel
//! somewhere in it: off by up to half a pixel along both axes.

use super::{Canvas, Paint};
use crate::error::Error;
use crate::frame::{Frame, ScreenTriangle};

/// Most texels and rows of texels that a frame may take: some seconds of work.
pub const MAX_TEXELS: u64 = 1 << 26;

/// 1/65536 texel, the unit of the texture triangle.
const UNIT: i128 = 1 << 16;

/// The triangle in the texture, exactly, in [`UNIT`]s.
struct TexelTriangle {
    /// Edges turned to positive area: start, direction.
    edges: [([i128; 2], [i128; 2]); 3],
    /// Rows of texels: first, and one past the last.
    rows: [i128; 2],
    /// Twice the area in square units.
    area: i128,
}

impl TexelTriangle {
    /// `None` if it has no area.
    fn new(triangle: &ScreenTriangle, size: [u32; 2]) -> Option<Self> {
        let [a, mut b, mut c] = triangle.vertices.map(|v| {
            let [u, v] = v.uv().map(|c| i128::from(c.to_bits()));
            [u * i128::from(size[0]), v * i128::from(size[1])]
        });
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area < 0 {
            (b, c) = (c, b);
        }
        let edge = |p: [i128; 2], q: [i128; 2]| (p, [q[0] - p[0], q[1] - p[1]]);
        let top = a[1].min(b[1]).min(c[1]);
        let bottom = a[1].max(b[1]).max(c[1]);
        (area != 0).then(|| Self {
            edges: [edge(a, b), edge(b, c), edge(c, a)],
            rows: [top.div_euclid(UNIT), bottom.div_euclid(UNIT) + 1],
            area: area.abs(),
        })
    }

    /// Texels whose centres are inside or on a top or left edge: first, and one past the last.
    fn columns(&self, row: i128) -> [i128; 2] {
        let y = row * UNIT + UNIT / 2;
        let (mut first, mut end) = (i128::MIN, i128::MAX);
        for &([x0, y0], [dx, dy]) in &self.edges {
            let inclusive = dy < 0 || (dy == 0 && dx > 0);
            // The edge function at column 0, less what it must reach: it falls by dy a unit.
            let over = dx * (y - y0) - dy * (UNIT / 2 - x0) - i128::from(!inclusive);
            match dy.signum() {
                1 => end = end.min(over.div_euclid(dy * UNIT) + 1),
                -1 => first = first.max(-over.div_euclid(-dy * UNIT)),
                _ if over < 0 => return [0, 0],
                _ => {}
            }
        }
        [first, end.max(first)]
    }
}

fn size(batch: &crate::frame::Batch) -> [u32; 2] {
    [batch.picture.width(), batch.picture.height()]
}

/// # Errors
///
/// [`Error::Content`] if there are more than [`MAX_TEXELS`] texels and rows.
pub(super) fn check_work(frame: &Frame) -> Result<(), Error> {
    let work: i128 = frame
        .triangles()
        .filter(|(_, t)| t.is_shown(frame.cull))
        .filter_map(|(batch, t)| TexelTriangle::new(t, size(batch)))
        .map(|t| t.area / (2 * UNIT * UNIT) + t.rows[1] - t.rows[0])
        .sum();
    if work <= i128::from(MAX_TEXELS) {
        return Ok(());
    }
    Err(Error::content(
        "forward mapping",
        &format!("it would read about {work} texels, more than {MAX_TEXELS}"),
        "choose a scene with smaller textures or fewer repeats",
    ))
}

/// Draws a triangle.
pub(super) fn draw(canvas: &mut Canvas, paint: &Paint<'_>, triangle: &ScreenTriangle) {
    let size = size(paint.batch);
    let Some(texels) = TexelTriangle::new(triangle, size) else {
        return;
    };
    let corners = triangle.corners();
    let [a, b, c] = corners.uv;
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    for row in texels.rows[0]..texels.rows[1] {
        let [first, end] = texels.columns(row);
        canvas.cost.lines += u64::from(first < end);
        for column in first..end {
            let uv = [
                (column as f64 + 0.5) / f64::from(size[0]),
                (row as f64 + 0.5) / f64::from(size[1]),
            ];
            // x w, y w and w are linear in the texture as they are in the world.
            let mut sum = [0.0; 3];
            for i in 0..3 {
                let (p, q) = (corners.uv[(i + 1) % 3], corners.uv[(i + 2) % 3]);
                let weight =
                    ((q[0] - p[0]) * (uv[1] - p[1]) - (q[1] - p[1]) * (uv[0] - p[0])) / area;
                let [x, y] = corners.position[i];
                for (sum, value) in sum.iter_mut().zip([x, y, 1.0]) {
                    *sum += weight * corners.w[i] * value;
                }
            }
            let inverse = 1.0 / sum[2];
            canvas.cost.texels += 1;
            canvas.cost.divisions += 1;
            let pixel = [sum[0] * inverse, sum[1] * inverse].map(|p| p.floor() as i64);
            canvas.write(paint, pixel, uv, inverse);
        }
    }
}
