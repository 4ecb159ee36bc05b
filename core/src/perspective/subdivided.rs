//! Affine pieces of a triangle that is divided in the world.

use fixed::types::I16F16;

use super::chord::step;
use super::{Adaptive, Homogeneous, Run, RunSink, Strategy};
use crate::arith::Inverse;
use crate::setup::{Plane, TriangleSetup};
use crate::span::Span;
use crate::uv::Uv;

/// Affine mapping on a triangle that is split in the world until that is good enough, as games for
/// the PlayStation did; the bound is in level-0 texels.
///
/// **Which edges.** An edge of which the ends differ by du texels and have depths of ratio r is
/// split at its middle in the world as long as `|du| (r - 1) > 3 bound`; a triangle is halved at
/// the worst of its edges until all pass. The test sees nothing but the edge, so both neighbours
/// split a shared edge at the same points, and their textures meet there.
///
/// **Error.** With shares s of a pixel in the corners of a piece, affine mapping is off by the sum
/// over the edges of `s_i s_j du_ij dq_ij / q`, q being 1/w; `s_i s_j` sum to at most 1/3, and each
/// edge's `|du dq| / min q = |du| (r - 1)` is at most `3 bound`, so that the error is at most
/// `bound` texels, plus twice that of [`PerPixel`](super::PerPixel), 2^-19 repeats for the rounding
/// of middles, and 2^-24 repeats a pixel for that of steps. After 24 halvings, where the triangle
/// is far smaller than a pixel, a pixel is divided instead: the bound holds everywhere.
///
/// **Coverage** is that of the whole triangle to the pixel: spans stay as they are, and the
/// pieces only say which affine function a pixel takes. There is nothing that could crack or be
/// drawn twice. A pixel is `sum m_i V_i` of the homogeneous corners V, with weights m that are
/// linear on the screen; halving the edge from V_i to V_j at `M = (V_i + V_j) / 2` turns
/// them into `m_i - m_j` and `2 m_j` where `m_i >= m_j`. So a pixel's piece is found by comparing
/// and subtracting, and its share of a corner is `m w`: without a division.
///
/// **Cost.** No division along spans; but for each run a walk from the triangle to its piece, with
/// some thirty wide multiplications a halving. Nothing is stored. Choose it to see what the
/// technique looks like, or where neighbouring triangles must agree along their edges and a
/// division is out of the question; [`Adaptive`] reaches the same bound with less work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Subdivided {
    measure: Adaptive,
}

impl Subdivided {
    /// Half a texel.
    pub const DEFAULT_BOUND: I16F16 = I16F16::lit("0.5");

    /// Halvings after which a pixel is divided instead.
    const DEPTH: usize = 24;

    /// For a texture with these base-2 logarithms of width and height; the bound in level-0
    /// texels, with 12 fraction bits, rounded down. A negative bound counts as 0.
    #[must_use]
    pub const fn new(bound: I16F16, log2_size: (u32, u32)) -> Self {
        Self {
            measure: Adaptive::new(bound, log2_size),
        }
    }

    /// By how much an edge exceeds the bound; `None` if it keeps it.
    #[inline]
    fn excess(&self, a: &Corner, b: &Corner) -> Option<u128> {
        let distance = u128::from(self.measure.distance(a.uv, b.uv));
        let off = distance * u128::from(a.w.abs_diff(b.w));
        // 2^29 times 2^47.
        let most = u128::from(self.measure.bound()) * 3 * u128::from(a.w.min(b.w));
        (off > most).then_some(off)
    }

    /// The edge to halve, as the numbers of its corners.
    #[inline]
    fn worst(&self, [a, b, c]: &[Corner; 3]) -> Option<(usize, usize)> {
        let edges = [
            (self.excess(a, b), (0, 1)),
            (self.excess(b, c), (1, 2)),
            (self.excess(c, a), (2, 0)),
        ];
        let worst = edges.into_iter().max_by_key(|(excess, _)| *excess)?;
        worst.0.map(|_| worst.1)
    }

    /// The runs, and whether they took a division.
    #[inline]
    fn walk(&self, planes: &SubdividedPlanes, span: Span, mut emit: impl FnMut(Run, bool)) {
        let last = span.left.abs_diff(span.right).wrapping_sub(1);
        let mut offset = 0;
        while offset <= last {
            let column = span.left.wrapping_add_unsigned(offset);
            let from = (column, span.y);
            let (run, steps) = match self.piece(planes, from, last.wrapping_sub(offset)) {
                Some((piece, [start, end], steps)) => {
                    let uv = piece.at(planes, start);
                    let each = step(uv, piece.at(planes, end), steps);
                    ((uv, each, false), steps)
                }
                None => {
                    let uv = planes.exact.divide(planes.exact.at(column, span.y));
                    ((uv, Uv::default(), true), 0)
                }
            };
            let (uv, step, divided) = run;
            let run = Run {
                offset: offset as usize,
                len: steps.wrapping_add(1) as usize,
                uv,
                step,
            };
            emit(run, divided);
            offset = offset.wrapping_add(steps).wrapping_add(1);
        }
    }

    /// The piece at a pixel, and how many steps to the right are certain to stay in it, with the
    /// weights at both ends. `None` if it takes too many halvings.
    #[inline]
    fn piece(
        &self,
        planes: &SubdividedPlanes,
        (x, y): (i32, i32),
        most: u32,
    ) -> Option<(Piece, [[i64; 3]; 2], u32)> {
        let mut piece = Piece {
            corners: planes.corners,
        };
        let mut steps = most;
        let mut start = planes.weights(x, y);
        let mut end = planes.weights(x.wrapping_add_unsigned(steps), y);
        let mut path = [(0u8, 0u8, false); Self::DEPTH];
        for depth in 0..Self::DEPTH {
            let Some((i, j)) = self.worst(&piece.corners) else {
                return Some((piece, [start, end], steps));
            };
            let side = is_first(&start, i, j);
            while steps > 0 && is_first(&end, i, j) != side {
                // Half as far; the weights there by the same path.
                steps >>= 1;
                end = planes.weights(x.wrapping_add_unsigned(steps), y);
                for &(i, j, side) in path.get(..depth)? {
                    halve(&mut end, usize::from(i), usize::from(j), side)?;
                }
            }
            if steps == 0 {
                end = start;
            }
            *path.get_mut(depth)? = (i as u8, j as u8, side);
            halve(&mut start, i, j, side)?;
            halve(&mut end, i, j, side)?;
            piece.halve(i, j, side)?;
        }
        None
    }
}

/// Whether a pixel lies in the half of corner `i`.
#[inline]
fn is_first(weights: &[i64; 3], i: usize, j: usize) -> bool {
    weights.get(i) >= weights.get(j)
}

/// The weights in the half of corner `i` (or of `j`), where the middle takes the other's place.
#[inline]
fn halve(weights: &mut [i64; 3], i: usize, j: usize, first: bool) -> Option<()> {
    let (keep, replace) = if first { (i, j) } else { (j, i) };
    let other = *weights.get(replace)?;
    let kept = weights.get_mut(keep)?;
    *kept = kept.wrapping_sub(other);
    *weights.get_mut(replace)? = other.wrapping_mul(2);
    Some(())
}

/// A corner in the world, as far as texture mapping goes.
#[derive(Clone, Copy, Debug)]
struct Corner {
    /// Depth with 32 fraction bits, so that middles are hardly rounded; 47 bits.
    w: u64,
    uv: Uv,
}

/// Corners of a piece of a triangle.
#[derive(Clone, Copy, Debug)]
struct Piece {
    corners: [Corner; 3],
}

impl Piece {
    #[inline]
    fn halve(&mut self, i: usize, j: usize, first: bool) -> Option<()> {
        let (a, b) = (self.corners.get(i)?, self.corners.get(j)?);
        // Symmetric, so that neighbours agree.
        let mean = |a: i32, b: i32| ((i64::from(a) + i64::from(b)) >> 1) as i32;
        let middle = Corner {
            w: (a.w + b.w) >> 1,
            uv: Uv::from_bits(
                mean(a.uv.u.to_bits(), b.uv.u.to_bits()),
                mean(a.uv.v.to_bits(), b.uv.v.to_bits()),
            ),
        };
        *self.corners.get_mut(if first { j } else { i })? = middle;
        Some(())
    }

    /// The affine coordinates at a pixel with these weights.
    #[inline]
    fn at(&self, planes: &SubdividedPlanes, [p, q, _]: [i64; 3]) -> Uv {
        let [a, b, c] = &self.corners;
        // 2^31 is the whole.
        let share = |weight: i64, corner: &Corner| {
            ((i128::from(weight) * i128::from(corner.w)) >> planes.share_shift) as i64
        };
        let (p, q) = (share(p, a), share(q, b));
        let mix = |c: fn(&Corner) -> i32, corner: &Corner| {
            let from = c(corner);
            let part =
                |share: i64, to: i32| i128::from(share) * (i128::from(to) - i128::from(from));
            from.wrapping_add(((part(p, c(a)) + part(q, c(b)) + (1 << 30)) >> 31) as i32)
        };
        Uv::from_bits(mix(|c| c.uv.u.to_bits(), c), mix(|c| c.uv.v.to_bits(), c))
    }
}

/// The triangle's corners, and a pixel's share in each.
#[derive(Clone, Copy, Debug)]
pub struct SubdividedPlanes {
    exact: Homogeneous,
    corners: [Corner; 3],
    /// Shares on the screen: 2^31 is the whole.
    shares: [Plane; 3],
    /// 1/w of the corners: mantissa, and shift to the common exponent.
    inverses: [(u32, u32); 3],
    /// From weight times w to a share with 31 bits.
    share_shift: u32,
}

impl SubdividedPlanes {
    /// The weights of the homogeneous corners: shares over w.
    #[inline]
    fn weights(&self, x: i32, y: i32) -> [i64; 3] {
        let [a, b, c] = &self.shares;
        let [p, q, r] = self.inverses;
        let weight = |plane: &Plane, (mantissa, shift): (u32, u32)| {
            let share = plane.at(x, y) >> Plane::FRACTION_BITS;
            share.wrapping_mul(i64::from(mantissa)) >> shift
        };
        [weight(a, p), weight(b, q), weight(c, r)]
    }
}

impl Strategy for Subdivided {
    type Planes = SubdividedPlanes;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<SubdividedPlanes> {
        const WHOLE: i32 = i32::MAX;
        let exact = Homogeneous::new(triangle)?;
        let vertices = triangle.vertices();
        let inverses = vertices
            .each_ref()
            .map(|v| Inverse::new(v.w().to_bits().cast_unsigned()));
        let nearest = inverses.iter().fold(0, |most, i| i.exponent.max(most));
        Some(SubdividedPlanes {
            exact,
            corners: vertices.each_ref().map(|v| Corner {
                w: u64::from(v.w().to_bits().cast_unsigned()) << 16,
                uv: {
                    let [u, v] = v.uv().map(|c| c.to_bits().wrapping_shl(8));
                    Uv::from_bits(u, v)
                },
            }),
            shares: [
                triangle.plane([WHOLE, 0, 0]),
                triangle.plane([0, WHOLE, 0]),
                triangle.plane([0, 0, WHOLE]),
            ],
            inverses: inverses.map(|i| (i.mantissa, nearest.wrapping_sub(i.exponent) & 31)),
            // mantissa = 2^62 / (w 2^exponent), and 16 more bits of w.
            share_shift: 62 + 16 - (nearest & 31),
        })
    }

    #[inline]
    fn runs(&self, planes: &SubdividedPlanes, span: Span, mut to: impl RunSink) {
        self.walk(planes, span, |run, _| to.run(run));
    }

    fn divisions(&self, planes: &SubdividedPlanes, span: Span) -> u32 {
        let mut divisions = 0u32;
        self.walk(planes, span, |_, divided| {
            divisions = divisions.wrapping_add(u32::from(divided));
        });
        divisions
    }
}
