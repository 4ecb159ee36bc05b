//! Triangles in clip space without clipping (Olano and Greer, "Triangle scan conversion using 2D
//! homogeneous coordinates", Graphics Hardware 1997): where a pixel's ray meets the triangle's
//! plane, and how far the pixel is from what bounds the triangle on the screen.
//!
//! Edge functions are exact integers; what is interpolated is float64. There is no guard band.

use multum::clip::ClipVertex;

/// A triangle seen through a near plane, in a frame of some size.
#[derive(Clone, Copy, Debug)]
pub struct Homogeneous {
    /// The functions `a x + b y + c` that are positive inside the three edges, over twice the
    /// pixel coordinates; each belongs to the corner that it is not zero at.
    edges: [[i128; 3]; 3],
    /// Positive where w is beyond the near plane.
    near: [i128; 3],
    /// From the values of these four functions to distances in pixels.
    scales: [f64; 4],
    /// Slopes of the edge functions over a pixel, in x and in y.
    slopes: [[f64; 3]; 2],
    determinant: f64,
    u: [f64; 3],
    v: [f64; 3],
}

/// What is at the centre of a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Distance in pixels to the lines that bound the triangle: its three edges, and the line
    /// where it meets the near plane. Negative outside.
    pub distances: [f64; 4],
    /// Depth in units.
    pub w: f64,
    /// Texture coordinates in repeats.
    pub uv: [f64; 2],
    /// `|dU - u dQ| / Q` and alike for v, summed over a pixel in x and one in y.
    slope: [f64; 2],
    /// `|dQ| / Q`, likewise.
    slope_q: f64,
}

impl Sample {
    /// Inside by more than `margin` pixels, outside by more (`Some(false)`), or neither.
    #[must_use]
    pub fn inside(&self, margin: f64) -> Option<bool> {
        if self.distances.iter().any(|&d| d < -margin) {
            Some(false)
        } else if self.distances.iter().all(|&d| d > margin) {
            Some(true)
        } else {
            None
        }
    }

    /// The largest change of u and v when the position moves by up to `d` pixels in x and in y:
    /// with u = U / Q, both linear, `u(p + m) - u(p) = (dU - u dQ) / (Q + dQ)`. `None` if that
    /// may cross the horizon.
    #[must_use]
    pub fn change(&self, d: f64) -> Option<[f64; 2]> {
        let rest = 1.0 - self.slope_q * d;
        (rest > 0.0).then(|| self.slope.map(|s| s * d / rest))
    }
}

fn cross([ax, ay, aw]: [i128; 3], [bx, by, bw]: [i128; 3]) -> [i128; 3] {
    [ay * bw - aw * by, aw * bx - ax * bw, ax * by - ay * bx]
}

impl Homogeneous {
    /// `near` in units as raw 16.16 bits. `None` if the triangle is seen edge-on, or has no area.
    #[must_use]
    pub fn new(corners: &[ClipVertex; 3], size: (u32, u32), near: i32) -> Option<Self> {
        // x / w (in -1 .. 1) becomes twice the pixel coordinate, (x + w) / w * width: 43 bits.
        let [a, b, c] = corners.each_ref().map(|v| {
            let [x, y, w] = [v.x, v.y, v.w].map(|c| i128::from(c.to_bits()));
            let (width, height) = (i128::from(size.0), i128::from(size.1));
            [(x + w) * width, (w - y) * height, w]
        });
        // 87 bits, and 119 with the near distance or in the determinant.
        let mut edges = [cross(b, c), cross(c, a), cross(a, b)];
        let determinant: i128 = edges[0].iter().zip(a).map(|(e, a)| e * a).sum();
        if determinant == 0 {
            return None;
        }
        for edge in edges.iter_mut().flatten() {
            *edge *= determinant.signum();
        }
        // The edge functions over the determinant are the shares of the corners, and sum to
        // 1 / w: w >= near where near * sum <= determinant.
        let sum: [i128; 3] = [0, 1, 2].map(|i| edges.iter().map(|e| e[i]).sum());
        let mut beyond = sum.map(|s| -s * i128::from(near));
        beyond[2] += determinant.abs();
        let [a, b, c] = edges;
        // A pixel is two units of the functions. One without slope is as far as can be.
        let scales = [a, b, c, beyond].map(|f| 0.5 / (f[0] as f64).hypot(f[1] as f64));
        let slopes = [0, 1].map(|axis| [a, b, c].map(|f| 2.0 * f[axis] as f64));
        Some(Self {
            edges,
            near: beyond,
            scales,
            slopes,
            determinant: determinant.abs() as f64,
            u: corners.map(|v| v.u.to_num()),
            v: corners.map(|v| v.v.to_num()),
        })
    }

    /// Which side the viewer sees: triangles of one plane with the same sign do not overlap
    /// unless they do so in the plane.
    #[must_use]
    pub fn orientation(corners: &[ClipVertex; 3]) -> i128 {
        let [a, b, c] = corners
            .each_ref()
            .map(|v| [v.x, v.y, v.w].map(|c| i128::from(c.to_bits())));
        let [x, y, z] = cross(b, c);
        (x * a[0] + y * a[1] + z * a[2]).signum()
    }

    /// At the centre of a pixel.
    #[must_use]
    pub fn sample(&self, column: i32, row: i32) -> Sample {
        let p = [i128::from(2 * column + 1), i128::from(2 * row + 1), 1];
        let value = |f: &[i128; 3]| f.iter().zip(p).map(|(f, p)| f * p).sum::<i128>() as f64;
        let shares = self.edges.each_ref().map(value);
        let [a, b, c] = shares;
        let values = [a, b, c, value(&self.near)];
        let q: f64 = shares.iter().sum();
        let weighted = |by: [f64; 3]| -> f64 { shares.iter().zip(by).map(|(s, b)| s * b).sum() };
        let uv = [self.u, self.v].map(|by| weighted(by) / q);
        let slope = |by: [f64; 3], less: f64| -> f64 {
            let along = |s: &[f64; 3]| s.iter().zip(by).map(|(s, b)| s * (b - less)).sum::<f64>();
            self.slopes.iter().map(|s| along(s).abs()).sum()
        };
        Sample {
            distances: [0, 1, 2, 3].map(|i| values[i] * self.scales[i]),
            w: self.determinant / q / 65_536.0,
            uv,
            slope: [
                slope(self.u, uv[0]) / q.abs(),
                slope(self.v, uv[1]) / q.abs(),
            ],
            slope_q: slope([1.0; 3], 0.0) / q.abs(),
        }
    }
}
