//! The planes of small triangles, in words: a fraction of the work of those that hold for all.

use fixed::types::I8F24;

use super::counted_from;
use super::words::Words;
use crate::arith::{
    add_short_multiply_high, leading_zeros_from, reciprocal_of_any, scaled_product, shared_inverses,
};
use crate::setup::{Slant, TriangleSetup, magnitudes};
use crate::uv::Uv;

/// 1/w, u/w and v/w of a triangle of at most 16 pixels each way, whose other corners differ from the first
/// by less than an eighth of its 1/w and less than an eighth of a repeat.
///
/// At the first corner 1/w is `5/4 2^30 .. 5/2 2^30`, so that all of them need no more than 32 bits and can
/// be divided by as they are. u and v are counted from those of the first corner, in a unit, a power of two of
/// repeats, with which u/w and v/w stay below a quarter of 1/w. Changes over a pixel are rounded down, so
/// that values at pixels of the triangle are off by less than 34 units; with the division that is less
/// than 2^-24 repeats.
#[derive(Clone, Copy, Debug)]
pub struct ShortPlanes {
    q: Slant,
    u: Slant,
    v: Slant,
    /// What coordinates are counted from; see [`Homogeneous`](super::Homogeneous).
    first: Uv,
    /// From the ratio with 29 fraction bits down to 8.24.
    down: u32,
}

impl ShortPlanes {
    /// The base-2 logarithm of how wide and high a small triangle is at most.
    pub(in crate::perspective) const LOG2_PIXELS: u32 = 4;

    /// Of how far coordinates are from the first corner's, in 16.16: an eighth of a repeat.
    const MOST_BITS: u32 = 13;

    /// Whether a triangle is of so many pixels and less: what [`Self::biased`] takes for granted.
    #[inline]
    pub(in crate::perspective) fn may_hold(triangle: &TriangleSetup<'_>, log2_pixels: u32) -> bool {
        triangle.is_within(log2_pixels.min(Self::LOG2_PIXELS))
    }

    /// With so many units of 2^-24 added to all coordinates. `None` for slivers and triangles of more than an
    /// eighth of a repeat or more than one depth.
    #[inline]
    pub(in crate::perspective) fn biased(triangle: &TriangleSetup<'_>, units: i32) -> Option<Self> {
        let (first, [[ub, uc], [vb, vc]]) = triangle.coordinates();
        let all = magnitudes([ub, uc, vb, vc]);
        if all >> Self::MOST_BITS != 0 {
            return None;
        }
        let w = triangle.vertices().each_ref().map(|v| v.w());
        let [p, q, r] = shared_inverses(w);
        let [qb, qc] = [q, r].map(|q| q.wrapping_sub(p).cast_signed());
        if magnitudes([qb, qc, 0, 0]) >= p >> 3 {
            return None;
        }
        // The widest coordinate has 30 bits, and over w 29.
        let zeros = leading_zeros_from(32 - Self::MOST_BITS, all);
        let over = |c: i32, q: u32| scaled_product(q.cast_signed(), c, 34u32.wrapping_sub(zeros));
        let u = [over(ub, q), over(uc, r)];
        let v = [over(vb, q), over(vc, r)];
        let (first_q, [mut q, u, v]) = triangle.ratio_slants(p.cast_signed(), [[qb, qc], u, v])?;
        q.origin = q.origin.wrapping_add_unsigned(first_q);
        Some(Self {
            q,
            u,
            v,
            first: counted_from(first, units),
            down: zeros.wrapping_sub(13),
        })
    }

    /// The planes at the centre of a pixel.
    #[inline]
    pub(in crate::perspective) fn at(&self, x: i32, y: i32) -> Words {
        Words {
            q: self.q.at(x, y).cast_unsigned(),
            u: self.u.at(x, y),
            v: self.v.at(x, y),
        }
    }

    /// So many pixels to the right of a point.
    #[inline]
    pub(in crate::perspective) fn step(&self, point: Words, pixels: u32) -> Words {
        let pixels = pixels.cast_signed();
        let over = |slant: &Slant| slant.right.wrapping_mul(pixels);
        point.after(Words {
            q: over(&self.q).cast_unsigned(),
            u: over(&self.u),
            v: over(&self.v),
        })
    }

    /// u and v at a point of the triangle; see [`Homogeneous::divide`](super::Homogeneous::divide).
    #[inline]
    pub(in crate::perspective) fn divide(&self, Words { q, u, v }: Words) -> Uv {
        // Cut to the bits that a coordinate has, so that the shift serves both.
        let inverse = (reciprocal_of_any(q) >> (self.down & 31)).cast_signed();
        let coordinate =
            |over_w, first: I8F24| add_short_multiply_high(first.to_bits(), over_w, inverse);
        Uv::from_bits(coordinate(u, self.first.u), coordinate(v, self.first.v))
    }
}

#[cfg(test)]
mod tests {
    use fixed::types::{I16F16, I24F8};

    use super::*;
    use crate::perspective::Homogeneous;
    use crate::project::ScreenVertex;
    use crate::setup::Cull;
    use crate::span::{Area, for_each_span};

    fn vertex([x, y]: [i32; 2], w: i32, uv: [i32; 2]) -> ScreenVertex {
        let [x, y] = [x, y].map(I24F8::from_bits);
        ScreenVertex::new(x, y, I16F16::from_bits(w), uv.map(I16F16::from_bits))
            .expect("a vertex on the screen")
    }

    /// Which triangles are small, at the limits.
    #[test]
    fn limits() {
        let is_small = |far: [i32; 2], w: i32, uv: i32, log2_pixels: u32| {
            let vertices = [
                vertex([0, 0], 1 << 16, [0; 2]),
                vertex([far[0], 256], 1 << 16, [uv, 0]),
                vertex([256, far[1]], w, [0, 0]),
            ];
            let triangle = TriangleSetup::new(&vertices, Cull::Off).expect("an area");
            ShortPlanes::may_hold(&triangle, log2_pixels)
                && ShortPlanes::biased(&triangle, 0).is_some()
        };
        let depth = 1 << 16;
        for (far, w, uv, pixels, expected) in [
            ([2_000, 2_000], depth, 8_191, 4, true),
            ([2_000, 2_000], depth, 8_192, 4, false),
            ([2_000, 2_000], depth, -8_192, 4, true),
            ([2_000, 2_000], depth, -8_193, 4, false),
            ([4_095, 4_095], depth, 0, 4, true),
            ([4_096, 2_000], depth, 0, 4, false),
            ([2_000, 4_096], depth, 0, 4, false),
            ([2_000, 2_000], depth, 0, 3, true),
            ([2_048, 2_000], depth, 0, 3, false),
            // The second and the third are on both sides of the first.
            ([-3_000, 2_000], depth, 0, 4, true),
            ([-3_841, 2_000], depth, 0, 4, false),
            ([2_000, 2_000], depth * 8 / 7 - 9, 0, 4, true),
            ([2_000, 2_000], depth * 8 / 7 + 9, 0, 4, false),
            ([2_000, 2_000], depth * 8 / 9 + 9, 0, 4, true),
            ([2_000, 2_000], depth * 8 / 9 - 9, 0, 4, false),
            // A sliver.
            ([3_000, 23], depth, 0, 4, false),
        ] {
            let found = is_small(far, w, uv, pixels);
            assert_eq!(found, expected, "{far:?} {w} {uv} {pixels}");
        }
    }

    /// Against planes of 64 bits, whose error is less; and what lies on a texel's edge does not come out
    /// before it.
    #[test]
    fn coordinates_are_those_of_long_planes() {
        let mut state = 1u32;
        let mut next = |span: i32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((u64::from(state) * span as u64) >> 32) as i32
        };
        let area = Area {
            width: 1_000,
            top: 0,
            bottom: 1_000,
        };
        let (mut seen, mut before) = (0, 0);
        for round in 0..20_000 {
            let corner = [next(200_000), next(200_000)];
            let size = 1 << (8 + round % 5);
            let (w, more) = (1 << 12 << next(18), 1 << (1 + round % 13));
            let uv = [next(1 << 22), next(1 << 22)];
            let vertices = [0; 3].map(|_| {
                // Powers of two too: sides that just do not fit.
                let at = corner.map(|c| match round % 3 {
                    0 => c + (1 << next(13) & !1),
                    _ => c + next(size),
                });
                vertex(at, w + next(w / 9), uv.map(|c| c + next(more)))
            });
            let Some(triangle) = TriangleSetup::new(&vertices, Cull::Off) else {
                continue;
            };
            let may = ShortPlanes::may_hold(&triangle, ShortPlanes::LOG2_PIXELS);
            let short = may.then(|| ShortPlanes::biased(&triangle, 0));
            let Some(short) = short.flatten() else {
                continue;
            };
            let long = Homogeneous::new(&triangle).expect("few repeats");
            for_each_span(&triangle, area, |span| {
                let first = short.at(span.left, span.y);
                for x in span.left..span.right {
                    let steps = x.abs_diff(span.left);
                    let point = short.step(first, steps);
                    assert!((1 << 30..3 << 30).contains(&point.q), "{vertices:?}");
                    let found = short.divide(point);
                    let exact = long.divide(long.at(x, span.y));
                    // Each is less than a unit and a half above the exact one, and not below it.
                    for (found, exact) in [(found.u, exact.u), (found.v, exact.v)] {
                        let off = found.to_bits() - exact.to_bits();
                        assert!(off.abs() <= 1, "{vertices:?} at {x}, {}: {off}", span.y);
                        before += u32::from(off < 0);
                    }
                    seen += 1;
                }
            });
        }
        assert!(seen > 50_000 && before > 0, "{seen} {before}");
    }
}
