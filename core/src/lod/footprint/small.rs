//! The derivatives of small triangles of nearly one depth, from products of 32 bits.

use super::centre;
use super::line::{FootprintWords, Step, WordAxis};
use crate::lod::Rule;
use crate::lod::log2::{FRACTION_BITS, log2, log2_word};
use crate::near_depths::NearDepths;
use crate::setup::{RatioSlants, Slant, TriangleSetup, magnitudes};
use crate::viewport::SUBPIXEL_BITS;

/// Of how far coordinates are from the first corner's, in 16.16: an eighth of a repeat.
const MOST_BITS: u32 = 13;

/// A third.
const THIRD: i32 = 0x5555;
const THIRD_BITS: u32 = 16;

/// Bits of the largest affine numerator.
const NUMERATOR_BITS: u32 = 15;

/// And at least: what is cut is to be little beside it.
const LEAST_BITS: u32 = 13;

/// Of a triangle of at most 16 pixels each way, not long and thin, whose other corners' w and coordinates differ from
/// the first's by less than an eighth of it and an eighth of a repeat.
///
/// With `e_i = w_i - w_0` the sum of [the module](super) is, but for the factor `1 / (w_0 w_1 w_2)`,
///
/// ```text
///   w_0 A + sum over k of e_k (u_i - u_j) (y - y_k),   A = sum over k of (u_i - u_j) (y - y_k)
/// ```
///
/// of which A does not depend on y, as the `u_i - u_j` add up to 0: it is exact in a word.
///
/// Lambda is off by less than 2^-8.7 where a pixel spans 1/16 texel or more, and of 99.8 % of such pixels by less than
/// 2^-12: the largest A has 13 to 15 bits, w 14 and its differences 18, 1/w 17, and logarithms are low by up
/// to 7.9e-5.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SmallFootprint {
    /// Of u and of v, in level-0 texels.
    axes: [Numerators; 2],
    /// 1/w, and what it is at the first corner.
    q: Slant,
    first_q: u32,
    /// What lambda is more than the logarithms of the numerator and of 1/w make: 16.16.
    offset: i32,
}

/// One coordinate's numerators, modulo 2^32: in row y `across + slope y`, in column x `down - slope x`.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Numerators {
    slope: i32,
    across: i32,
    down: i32,
}

impl SmallFootprint {
    /// For a texture whose finest level has these base-2 logarithms of width and height. `None` for other
    /// triangles.
    #[inline]
    #[must_use]
    pub fn new(triangle: &TriangleSetup<'_>, log2_size: (u32, u32)) -> Option<Self> {
        let [[bx, by], [cx, cy]] = triangle.sides();
        let (_, beyond) = triangle.coordinates();
        let [[ub, uc], [vb, vc]] = beyond;
        let longest = triangle.width().max(triangle.height());
        if magnitudes([ub, uc, vb, vc]) >> MOST_BITS != 0
            || longest >> (4 + SUBPIXEL_BITS) != 0
            || longest.wrapping_mul(longest) >> 2 > triangle.twice_area() as u32
        {
            return None;
        }
        let corners = triangle.vertices();
        let near = NearDepths::new(corners.each_ref().map(|v| v.w()))?;
        let RatioSlants {
            first, zeros, q, ..
        } = triangle.ratio_slants(near.first, near.beyond, [])?;
        // A along x and along y: below 2^26 in 16.16.
        let affine = beyond.map(|[b, c]| {
            [
                b.wrapping_mul(cy).wrapping_sub(c.wrapping_mul(by)),
                c.wrapping_mul(bx).wrapping_sub(b.wrapping_mul(cx)),
            ]
        });
        // In texels of the larger side, as many bits as are there.
        let most_size = log2_size.0.max(log2_size.1);
        let less = [log2_size.0, log2_size.1].map(|size| most_size.wrapping_sub(size) & 31);
        let [u, v] = affine;
        let bits = |[along, below]: [i32; 2], less: u32| {
            let all = magnitudes([along, below, 0, 0]) >> less;
            32u32.wrapping_sub((all | 1).leading_zeros())
        };
        let most_bits = bits(u, less[0]).max(bits(v, less[1]));
        if most_bits < LEAST_BITS {
            return None;
        }
        let down = most_bits.saturating_sub(NUMERATOR_BITS);
        // The first corner's w with 14 bits, and how others' exceed it with four more.
        let [a, b, c] = near.w;
        let (first_w, eb, ec) = (a >> 17, b.wrapping_sub(a) >> 13, c.wrapping_sub(a) >> 13);
        let [first_x, first_y] = [corners[0].x(), corners[0].y()].map(|c| c.to_bits());
        let axis = |k: usize| {
            let down = down.wrapping_add(less[k]);
            let ([[b, c], [along, below]], down) = ([beyond[k], affine[k]], down & 31);
            let more = down.wrapping_add(4) & 31;
            let (b_term, c_term) = (eb.wrapping_mul(c) >> more, ec.wrapping_mul(b) >> more);
            let slope = b_term.wrapping_sub(c_term);
            // Sides were turned, and with them all but the slope.
            let slope = if triangle.is_counter_clockwise() {
                slope.wrapping_neg()
            } else {
                slope
            };
            let across = first_w
                .wrapping_mul(along >> down)
                .wrapping_sub(b_term.wrapping_mul(by))
                .wrapping_add(c_term.wrapping_mul(cy));
            let below = first_w
                .wrapping_mul(below >> down)
                .wrapping_add(b_term.wrapping_mul(bx))
                .wrapping_sub(c_term.wrapping_mul(cx));
            Numerators {
                slope,
                across: across.wrapping_sub(slope.wrapping_mul(first_y)),
                down: below.wrapping_add(slope.wrapping_mul(first_x)),
            }
        };
        // With w as `near` has it, W the product of all three, D twice the area, and numerator N and plane Q as they
        // are here, rho = 2^8 2^-16 2^(17 + down + most_size) N W D 2^(2 k) / Q^2. At the first corner Q
        // is D W 2^k / w, where k = near.zeros + zeros - 60; and what w had behind its 14 bits is missing in N.
        let behind = a & ((1 << 17) - 1);
        let product =
            u64::from(first).wrapping_mul(u64::from(a.wrapping_add(behind).cast_unsigned()));
        let exponent = 9u32
            .wrapping_add(down)
            .wrapping_add(most_size)
            .wrapping_add(near.zeros)
            .wrapping_add(zeros)
            .wrapping_sub(60);
        Some(Self {
            axes: [axis(0), axis(1)],
            q,
            first_q: first,
            offset: log2(product).wrapping_add((exponent << FRACTION_BITS).cast_signed()),
        })
    }

    /// Lambda at the mean of the corners.
    #[inline]
    #[must_use]
    pub fn lambda_of_mean<R: Rule>(&self, triangle: &TriangleSetup<'_>, rule: R) -> i32 {
        let [a, b, c] = triangle.vertices().each_ref().map(|v| [v.x(), v.y()]);
        // From the first corner, thrice as far.
        let beyond = [0, 1].map(|k| {
            let [a, b, c] = [a[k], b[k], c[k]].map(|c| c.to_bits());
            b.wrapping_add(c).wrapping_sub(a.wrapping_mul(2))
        });
        // To within a subpixel.
        let [x, y] = [0, 1].map(|k| {
            let third = beyond[k].wrapping_mul(THIRD) >> THIRD_BITS;
            a[k].to_bits().wrapping_add(third)
        });
        // The change is below 2^25.
        let change = (self.q.over_subpixels(beyond) >> 9).wrapping_mul(THIRD) >> (THIRD_BITS - 9);
        let steps = [
            self.axes.each_ref().map(|axis| axis.across(y)),
            self.axes.each_ref().map(|axis| axis.down(x)),
        ];
        let [across, down] = steps.map(|step| rule.length_of_words(step));
        let q = self.first_q.wrapping_add_signed(change);
        rule.log2_of_word(across.max(down))
            .wrapping_add(self.offset)
            .wrapping_sub(log2_word(q).wrapping_mul(2))
    }

    /// At pixels.
    #[inline]
    #[must_use]
    pub fn words(&self) -> FootprintWords {
        let first = centre(0);
        FootprintWords {
            axes: self.axes.each_ref().map(|axis| WordAxis {
                across: axis.across(first),
                down: axis.down(first),
                step: Step::whole(axis.slope << SUBPIXEL_BITS),
            }),
            q: self.q.origin,
            q_right: Step::whole(self.q.right),
            q_down: Step::whole(self.q.down),
            offset: self.offset,
        }
    }
}

impl Numerators {
    /// Along x, at a height in subpixels.
    #[inline]
    fn across(&self, y: i32) -> i32 {
        self.across.wrapping_add(self.slope.wrapping_mul(y))
    }

    /// Along y.
    #[inline]
    fn down(&self, x: i32) -> i32 {
        self.down.wrapping_sub(self.slope.wrapping_mul(x))
    }
}
