//! Pictures that are computed: the crate's planks, stripes, paving, checkers.

use crate::picture::Picture;

/// A pseudo-random number, 0..256, that depends on a position only (a multiplicative hash).
fn noise(x: u32, y: u32) -> i32 {
    let mut h = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77);
    h ^= h >> 15;
    h = h.wrapping_mul(0xC2B2_AE3D);
    (h >> 24) as i32
}

fn paint(width: u32, height: u32, colour: impl Fn(u32, u32) -> [i32; 3]) -> Picture {
    let pixels = (0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .map(|(x, y)| colour(x, y).map(|c| c.clamp(0, 255) as u8))
        .collect();
    Picture::new(width, height, pixels).expect("the sizes are powers of two")
}

/// The side of a wooden crate, 256 x 256: upright boards in a frame, with a diagonal brace.
#[must_use]
pub fn planks() -> Picture {
    paint(256, 256, |x, y| {
        let (xi, yi) = (x as i32, y as i32);
        let edge = xi.min(255 - xi).min(yi).min(255 - yi);
        let diagonal = xi - (255 - yi);
        // Each board: how far from its side, along its grain, across its grain, tint.
        let (side, along, across, tint) = if edge < 30 {
            let lying = yi.min(255 - yi) < 30;
            let inner = if lying {
                yi.min(255 - yi)
            } else {
                xi.min(255 - xi)
            };
            let (a, b) = if lying { (x, y) } else { (y, x) };
            (inner.min(29 - inner), a, b, 14)
        } else if diagonal.abs() < 26 {
            let away = 25 - diagonal.abs();
            (away, (x + 255 - y) / 2, (diagonal + 512) as u32, 6)
        } else {
            let board = (xi - 30) / 28;
            let within = (xi - 30) % 28;
            (
                within.min(27 - within),
                y,
                x,
                noise(board as u32, 77) / 10 - 26,
            )
        };
        let grain = noise(across, along / 24) / 10 + noise(across / 2, along / 56) / 8;
        let shade = tint + grain - 28 - if side < 2 { 62 } else { 0 };
        let nail = edge < 30 && {
            let near = |c: i32| [15, 240].iter().any(|n| (c - n).abs() < 4);
            near(xi) && near(yi)
        };
        if nail {
            [70, 66, 62]
        } else {
            [176 + shade, 122 + shade * 9 / 10, 66 + shade * 3 / 4]
        }
    })
}

/// Upright stripes, 64 x 64: dark and light, one in four red.
#[must_use]
pub fn stripes() -> Picture {
    paint(64, 64, |x, y| {
        let base = match x / 8 {
            0 | 4 => [236, 232, 220],
            2 => [196, 52, 44],
            6 => [60, 96, 160],
            _ => [44, 46, 54],
        };
        // A thin line across shows the other direction.
        if y % 32 == 0 {
            base.map(|c| c * 3 / 5)
        } else {
            base
        }
    })
}

/// Paving slabs, 128 x 128: two rows of two, the second one shifted.
#[must_use]
pub fn paving() -> Picture {
    paint(128, 128, |x, y| {
        let row = y / 64;
        let shifted = (x + 32 * row) % 128;
        let (sx, sy) = (shifted % 64, y % 64);
        let joint = sx < 3 || sy < 3;
        let speckle = noise(x, y) / 9 + noise(x / 5, y / 5) / 14;
        let slab = noise(shifted / 64 + 9, row + 5) / 8;
        let c = if joint {
            82 + speckle / 2
        } else {
            142 + slab + speckle
        };
        [c, c - 2, c - 10]
    })
}

/// A checkerboard, 64 x 64 texels, with squares of 8.
#[must_use]
pub fn checkers() -> Picture {
    paint(64, 64, |x, y| {
        if (x / 8 + y / 8) % 2 == 0 {
            [240, 240, 236]
        } else {
            [24, 24, 30]
        }
    })
}

/// A map of texture coordinates, 256 x 256: red grows with u, green with v, lines every 32 texels
/// and a dotted one between.
#[must_use]
pub fn coordinates() -> Picture {
    paint(256, 256, |x, y| {
        let (r, g) = (x as i32 * 3 / 4 + 32, y as i32 * 3 / 4 + 32);
        if x % 32 == 0 || y % 32 == 0 {
            [250, 250, 250]
        } else if (x % 16 == 0 || y % 16 == 0) && (x + y) % 4 < 2 {
            [20, 20, 20]
        } else {
            [r, g, 96 + (x ^ y) as i32 % 64]
        }
    })
}
