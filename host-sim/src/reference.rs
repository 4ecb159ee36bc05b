//! The reference: coverage by exact integer edge functions, coordinates in float64 at every pixel
//! centre. It takes the snapped vertices as plain numbers and shares no arithmetic with the core.
//! From the coordinates and their derivatives [`lod`] chooses mip levels and [`filter`] computes
//! colours; [`ideal`] is what no real-time filter reaches, and how far one stays from it.

pub mod filter;
pub mod ideal;
pub mod lod;

/// A screen triangle as plain numbers.
#[derive(Clone, Copy, Debug)]
pub struct Corners {
    /// x and y of each corner in pixels, y down.
    pub position: [[f64; 2]; 3],
    /// Clip w of each corner, positive.
    pub w: [f64; 3],
    /// u and v of each corner in repeats.
    pub uv: [[f64; 2]; 3],
}

/// Texture coordinates at a point of a triangle, and how they change around it.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// u and v in repeats.
    pub uv: [f64; 2],
    /// Clip w.
    pub w: f64,
    /// Change of u and v per pixel to the right.
    pub dx: [f64; 2],
    /// Change of u and v per pixel down.
    pub dy: [f64; 2],
}

impl Sample {
    /// rho: the texels of a texture of this size that one pixel step spans, the longer of the two
    /// axes' lengths (OpenGL 4.6 core, section 8.14).
    #[must_use]
    pub fn footprint(&self, size: [f64; 2]) -> f64 {
        let length = |d: [f64; 2]| (d[0] * size[0]).hypot(d[1] * size[1]);
        length(self.dx).max(length(self.dy))
    }
}

/// u/w, v/w and 1/w of a triangle as linear functions of the screen, in float64.
#[derive(Clone, Copy, Debug)]
pub struct Planes {
    position: [[f64; 2]; 3],
    area: f64,
    /// u/w, v/w, 1/w at the corners.
    corner: [[f64; 3]; 3],
}

impl Planes {
    /// `None` for a triangle without area.
    #[must_use]
    pub fn new(corners: &Corners) -> Option<Self> {
        let [a, b, c] = corners.position;
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let mut corner = [[0.0; 3]; 3];
        for (i, to) in corner.iter_mut().enumerate() {
            let [u, v] = corners.uv[i];
            *to = [u / corners.w[i], v / corners.w[i], 1.0 / corners.w[i]];
        }
        (area != 0.0).then_some(Self {
            position: corners.position,
            area,
            corner,
        })
    }

    /// At a point of the screen, in pixels; inside the triangle or beyond.
    #[must_use]
    pub fn at(&self, x: f64, y: f64) -> Sample {
        let mut value = [0.0; 3];
        let mut dx = [0.0; 3];
        let mut dy = [0.0; 3];
        for i in 0..3 {
            // The weight of a corner is the part of the area that the opposite edge and the point
            // enclose.
            let p = self.position[(i + 1) % 3];
            let q = self.position[(i + 2) % 3];
            let weight = ((q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])) / self.area;
            let weight_dx = -(q[1] - p[1]) / self.area;
            let weight_dy = (q[0] - p[0]) / self.area;
            for k in 0..3 {
                value[k] += weight * self.corner[i][k];
                dx[k] += weight_dx * self.corner[i][k];
                dy[k] += weight_dy * self.corner[i][k];
            }
        }
        let w = 1.0 / value[2];
        let uv = [value[0] * w, value[1] * w];
        let slope = |d: [f64; 3]| [(d[0] - uv[0] * d[2]) * w, (d[1] - uv[1] * d[2]) * w];
        Sample {
            uv,
            w,
            dx: slope(dx),
            dy: slope(dy),
        }
    }
}

/// Exact coverage of a triangle on an integer grid.
#[derive(Clone, Copy, Debug)]
pub struct Coverage {
    /// Edges of the triangle turned to positive area: start, direction.
    edges: [([i64; 2], [i64; 2]); 3],
    /// Grid units per pixel; even.
    unit: i64,
}

impl Coverage {
    /// A triangle with corners in units of 1/`unit` pixel. `None` if it has no area.
    #[must_use]
    pub fn new(corners: [[i64; 2]; 3], unit: i64) -> Option<Self> {
        let [a, mut b, mut c] = corners;
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area == 0 {
            return None;
        }
        if area < 0 {
            (b, c) = (c, b);
        }
        let edge = |p: [i64; 2], q: [i64; 2]| (p, [q[0] - p[0], q[1] - p[1]]);
        Some(Self {
            edges: [edge(a, b), edge(b, c), edge(c, a)],
            unit,
        })
    }

    /// Whether the centre of a pixel is inside, or on a top or left edge.
    #[must_use]
    pub fn covers(&self, x: i64, y: i64) -> bool {
        let px = x * self.unit + self.unit / 2;
        let py = y * self.unit + self.unit / 2;
        self.edges.iter().all(|&([x0, y0], [dx, dy])| {
            let e = dx * (py - y0) - dy * (px - x0);
            // Clockwise on a y-down screen: left edges go up, top edges go right.
            e > 0 || (e == 0 && (dy < 0 || (dy == 0 && dx > 0)))
        })
    }

    /// Calls `visit` for each covered pixel of a `width` x `height` frame, row by row.
    pub fn for_each(&self, width: u32, height: u32, mut visit: impl FnMut(u32, u32)) {
        let bounds = |axis: usize, size: u32| {
            let all = self
                .edges
                .map(|(start, _)| start[axis].div_euclid(self.unit));
            let low = all.iter().min().map_or(0, |&m| m.max(0));
            let high = all
                .iter()
                .max()
                .map_or(0, |&m| (m + 1).min(i64::from(size)));
            (low, high)
        };
        let ((left, right), (top, bottom)) = (bounds(0, width), bounds(1, height));
        for y in top..bottom {
            for x in left..right {
                if self.covers(x, y) {
                    visit(x as u32, y as u32);
                }
            }
        }
    }
}

/// What lies beyond the edges of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beyond {
    /// The texture again.
    Repeat,
    /// The edge texel.
    Clamp,
    /// The texture mirrored.
    Mirror,
}

impl Beyond {
    /// The texel of an axis of `size` texels that a coordinate in repeats falls into.
    #[must_use]
    pub fn texel(self, coordinate: f64, size: u32) -> u32 {
        self.wrapped((coordinate * f64::from(size)).floor() as i64, size)
    }

    /// The texel of an axis of `size` texels that a texel number stands for; `size` is not 0.
    #[must_use]
    pub fn wrapped(self, number: i64, size: u32) -> u32 {
        let n = i64::from(size);
        let i = match self {
            Self::Repeat => number.rem_euclid(n),
            Self::Clamp => number.clamp(0, n - 1),
            Self::Mirror => {
                let m = number.rem_euclid(2 * n);
                if m < n { m } else { 2 * n - 1 - m }
            }
        };
        i as u32
    }
}
