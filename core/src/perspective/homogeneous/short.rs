//! The planes of small triangles, in words: a fraction of the work of those that hold for all.

use fixed::types::I8F24;

use super::counted_from;
use super::words::Words;
use crate::arith::{short_product, short_reciprocal, times_short_reciprocal};
use crate::near_depths::NearDepths;
use crate::setup::{RatioSlants, Slant, TriangleSetup, magnitudes};
use crate::uv::Uv;

/// 1/w, u/w and v/w of a triangle of at most 16 pixels each way, whose other corners' w differ from the first's
/// by less than an eighth of it, and their coordinates by less than an eighth of a repeat.
///
/// At the first corner 1/w is `2^25 .. 2^26`, and one repeat over w is twice 1/w. u and v are counted from those
/// of the first corner. All that is found once a triangle or a span is found from products of 32 bits.
#[derive(Clone, Copy, Debug)]
pub struct ShortPlanes {
    q: Slant,
    u: Slant,
    v: Slant,
    /// What coordinates are counted from; see [`Homogeneous`](super::Homogeneous).
    first: Uv,
}

/// u and v along a span of a triangle, from its first pixel to its last, so many pixels farther.
#[derive(Clone, Copy, Debug)]
pub(in crate::perspective) struct ShortLine {
    /// Counted from those of the first corner.
    beyond: Uv,
    /// 1/w.
    q: u32,
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
        let NearDepths {
            first: p,
            beyond: [qb, qc],
            ..
        } = NearDepths::new(triangle.vertices().each_ref().map(|v| v.w()))?;
        let over = |c: i32, q: i32| (p.cast_signed().wrapping_add(q >> 3)).wrapping_mul(c) >> 13;
        let u = [over(ub, qb), over(uc, qc)];
        let v = [over(vb, qb), over(vc, qc)];
        let RatioSlants {
            q, others: [u, v], ..
        } = triangle.ratio_slants(p, [qb, qc], [u, v])?;
        Some(Self {
            q: Slant {
                // See `short_reciprocal`.
                origin: q.origin.wrapping_sub(1 << 9),
                ..q
            },
            u,
            v,
            first: counted_from(
                first,
                units.wrapping_add(48).wrapping_add_unsigned(all >> 7),
            ),
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
    pub(in crate::perspective) fn divide(&self, point: Words) -> Uv {
        self.line(point).start(self)
    }

    /// The span that begins at a point.
    #[inline]
    pub(in crate::perspective) fn line(&self, Words { q, u, v }: Words) -> ShortLine {
        let inverse = short_reciprocal(q);
        let beyond = |over_w| times_short_reciprocal(over_w, inverse);
        ShortLine {
            beyond: Uv::from_bits(beyond(u), beyond(v)),
            q,
        }
    }
}

impl ShortLine {
    /// u and v at the first pixel.
    #[inline]
    pub(in crate::perspective) fn start(&self, planes: &ShortPlanes) -> Uv {
        let sum = |a: I8F24, b: I8F24| a.to_bits().wrapping_add(b.to_bits());
        Uv::from_bits(
            sum(self.beyond.u, planes.first.u),
            sum(self.beyond.v, planes.first.v),
        )
    }

    /// How u and v change over a pixel on the straight line to those so many pixels farther, one at least.
    ///
    /// Where U is u at the first pixel, q is 1/w, and s is u/w, that is `(s' - U q') / (q + n q')`, with changes
    /// over a pixel dashed: no division by n, nor u at the last pixel.
    #[inline]
    pub(in crate::perspective) fn step(&self, planes: &ShortPlanes, pixels: u32) -> Uv {
        let ShortPlanes { q, u, v, .. } = planes;
        let farther = q.right.wrapping_mul(pixels.cast_signed());
        let inverse = short_reciprocal(self.q.wrapping_add_signed(farther));
        let step = |start: I8F24, slant: &Slant| {
            let bent = short_product(q.right, start.to_bits() >> 5);
            times_short_reciprocal(slant.right.wrapping_sub(bent), inverse)
        };
        Uv::from_bits(step(self.beyond.u, u), step(self.beyond.v, v))
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
            ([2_000, 2_000], depth * 9 / 8 - 9, 0, 4, true),
            ([2_000, 2_000], depth * 9 / 8 + 9, 0, 4, false),
            ([2_000, 2_000], depth * 7 / 8 + 9, 0, 4, true),
            ([2_000, 2_000], depth * 7 / 8 - 9, 0, 4, false),
            // A quarter of a pixel, and a sliver.
            ([382, 260], depth, 0, 4, true),
            ([382, 250], depth, 0, 4, false),
            ([3_000, 23], depth, 0, 4, false),
        ] {
            let found = is_small(far, w, uv, pixels);
            assert_eq!(found, expected, "{far:?} {w} {uv} {pixels}");
        }
    }

    /// Against planes of 64 bits, whose error is less; and what lies on a texel's edge does not come out
    /// before it in a triangle of one depth.
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
        let (mut seen, mut flat, mut most) = (0, 0, 0.0f64);
        for round in 0..30_000 {
            let corner = [next(200_000), next(200_000)];
            let size = 1 << (8 + round % 5);
            let (w, more) = (1 << 12 << next(18), 1 << (1 + round % 13));
            let deeper = if round % 4 == 0 { 1 } else { w / 9 };
            let uv = [next(1 << 22), next(1 << 22)];
            let vertices = [0; 3].map(|_| {
                // Powers of two too: sides that just do not fit.
                let at = corner.map(|c| match round % 3 {
                    0 => c + (1 << next(13) & !1),
                    _ => c + next(size),
                });
                vertex(at, w + next(deeper), uv.map(|c| c + next(more)))
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
            // Of `host_sim::bound`: 2^-15.6 + 2^-15.8 + 2^-15.3 + 33 2^-24.8 of the coordinates' span, and 2^-18.8
            // and 33 2^-25.8 repeats; each division is off by a unit and a half.
            let (_, beyond) = triangle.coordinates();
            let [off_u, off_v] = beyond.map(|[b, c]| {
                let span = b.max(c).max(0) - b.min(c).min(0);
                f64::from(span) / 61.0 + 47.3 + 1.5
            });
            let all = magnitudes([beyond[0][0], beyond[0][1], beyond[1][0], beyond[1][1]]);
            let edge = f64::from(48 + (all >> 7));
            for_each_span(&triangle, area, |span| {
                let first = short.at(span.left, span.y);
                for x in span.left..span.right {
                    let steps = x.abs_diff(span.left);
                    let point = short.step(first, steps);
                    // 8/9 and 8/7 of 2^25 and 2^26, with a margin.
                    assert!((7 << 22..5 << 24).contains(&point.q), "{vertices:?}");
                    let found = short.divide(point);
                    let exact = long.divide(long.at(x, span.y));
                    for (found, exact, most_off) in
                        [(found.u, exact.u, off_u), (found.v, exact.v, off_v)]
                    {
                        let off = found.to_bits() - exact.to_bits();
                        let beside = f64::from(off) - edge;
                        assert!(beside.abs() <= most_off, "{vertices:?} at {x}: {beside}");
                        most = most.max(beside.abs() / most_off);
                        if deeper == 1 {
                            assert!(off >= -1, "{vertices:?} at {x}, {}: {off}", span.y);
                            flat += 1;
                        }
                        seen += 1;
                    }
                }
            });
        }
        assert!(
            seen > 100_000 && flat > 10_000 && most > 0.4,
            "{seen} {flat} {most}"
        );
    }
}
