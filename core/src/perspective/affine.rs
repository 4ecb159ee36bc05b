//! No perspective: u and v as linear functions of the screen.

use super::{Run, RunSink, Strategy};
use crate::arith::leading_zeros;
use crate::setup::{SHORT_BITS, Slant, TriangleSetup, magnitudes};
use crate::span::Span;
use crate::uv::Uv;

/// Affine mapping, as on the PlayStation: one run a span and no division after setup.
///
/// Exact where 1/w is constant over the triangle. Elsewhere the error on a line between two
/// points of the triangle's outline with depths of ratio `r >= 1` is at most
/// `|du| (sqrt r - 1) / (sqrt r + 1)`, the farthest that a hyperbola bends away from its chord, in
/// addition to 2^-25 repeats per pixel of the span for the step's rounding, and at most as much for each
/// column and row from the first corner: 1/32 of it, or P/64, where the coordinates span P < 64 repeats. In
/// triangles of corners less than 16 pixels and a repeat from the first, each way, which are set up with fewer bits,
/// up to 3 2^-15 of what the coordinates span is added. Choose it for sprites, distant or small triangles, and
/// subdivided meshes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Affine;

/// The planes of u and v themselves.
///
/// Sums of products of 32 bits: u and v are counted from the first corner's, with as many bits behind
/// the point as leave their span room.
#[derive(Clone, Copy, Debug)]
pub struct AffinePlanes {
    u: Coordinate,
    v: Coordinate,
    /// Bits behind those of 8.24.
    more_bits: u32,
    /// From one pixel to the next.
    step: Uv,
}

/// The plane of one coordinate.
#[derive(Clone, Copy, Debug)]
struct Coordinate {
    /// The first corner's, 8.24.
    first: i32,
    /// By how much others exceed it, and half a unit of 8.24.
    beyond: Slant,
}

impl Coordinate {
    /// From the first corner's value, in 16.16.
    #[inline]
    fn new(first: i32, slant: Slant, more_bits: u32) -> Self {
        Self {
            first: first << 8,
            beyond: Slant {
                origin: slant.origin.wrapping_add(half(more_bits)),
                ..slant
            },
        }
    }

    /// From one pixel to the next, 8.24, rounded to nearest.
    #[inline]
    fn step(&self, more_bits: u32) -> i32 {
        self.beyond.right.wrapping_add(half(more_bits)) >> (more_bits & 31)
    }

    /// At a pixel, 8.24.
    #[inline]
    fn at(&self, x: i32, y: i32, more_bits: u32) -> i32 {
        let beyond = self.beyond.at(x, y);
        self.first.wrapping_add(beyond >> (more_bits & 31))
    }
}

/// Bits that planes have at most behind those of 8.24.
const MOST_MORE_BITS: u32 = SHORT_BITS - Uv::FRACTION_BITS;

/// Half a unit of 8.24.
#[inline]
const fn half(more_bits: u32) -> i32 {
    1 << (more_bits & 31) >> 1
}

impl Strategy for Affine {
    type Planes = AffinePlanes;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<AffinePlanes> {
        let (first, beyond) = triangle.coordinates();
        let [[ub, uc], [vb, vc]] = beyond;
        let all = magnitudes([ub, uc, vb, vc]);
        if all >= 1 << 22 && !beyond.into_iter().all(spans_below_128) {
            return None;
        }
        // No pixel of the triangle is farther from the first corner than another corner is: at most 2^30
        // once shifted up, which leaves rounding room; in units of 8.24 it needs none.
        let more_bits = if all < 1 << 16 {
            MOST_MORE_BITS
        } else {
            leading_zeros(all).saturating_sub(10)
        };
        let [du, dv] = triangle.slants(beyond, all, Uv::FRACTION_BITS.wrapping_add(more_bits));
        let [u, v] = first;
        let (u, v) = (
            Coordinate::new(u, du, more_bits),
            Coordinate::new(v, dv, more_bits),
        );
        Some(AffinePlanes {
            u,
            v,
            more_bits,
            step: Uv::from_bits(u.step(more_bits), v.step(more_bits)),
        })
    }

    #[inline]
    fn runs(&self, planes: &AffinePlanes, span: Span, mut to: impl RunSink) {
        let at = |coordinate: &Coordinate| coordinate.at(span.left, span.y, planes.more_bits);
        to.long_run(Run {
            offset: 0,
            len: span.right.abs_diff(span.left) as usize,
            uv: Uv::from_bits(at(&planes.u), at(&planes.v)),
            step: planes.step,
        });
    }

    fn divisions(&self, _: &AffinePlanes, _: Span) -> u32 {
        0
    }
}

/// Whether coordinates that exceed the first corner's by so much, in 16.16, span less than 128
/// repeats.
#[inline]
fn spans_below_128([b, c]: [i32; 2]) -> bool {
    b.unsigned_abs() | c.unsigned_abs() < 1 << 23 && b.abs_diff(c) < 1 << 23
}
