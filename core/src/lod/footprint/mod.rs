//! The footprint of a pixel in the texture: the derivatives of u and v at a pixel, from the corners
//! of the triangle (Ewins et al., "MIP-Map Level Selection for Texture Mapping", IEEE TVCG 1998).
//!
//! With shares `s_i` of a pixel in the corners, `Q = sum s_i q_i` is 1/w and `U = sum s_i q_i u_i`
//! is u/w. Then `du/dx = (U' Q - U Q') / Q^2`, of which the numerator is
//!
//! ```text
//!   sum over the corners k, with i and j after it:   m_k (y - y_k) / D,   m_k = q_i q_j (u_i - u_j)
//! ```
//!
//! where D is twice the area: it depends on the row alone, and `du/dy` has the same with x in the
//! place of y and the other sign. So the numerators cost an addition a pixel, differences of nearly
//! equal u and v keep their bits, and of the denominator `D Q^2` only the logarithm is needed.

mod lambdas;
mod line;
mod small;

pub use lambdas::{AtMean, Lambdas};
pub use line::{FootprintLine, FootprintWords};
pub use small::SmallFootprint;

use super::Rule;
use super::log2::{FRACTION_BITS, log2};
use crate::arith::{reciprocal, shared_inverses};
use crate::project::ScreenVertex;
use crate::setup::{Plane, TriangleSetup, inverse};
use crate::span::Span;
use crate::uv::Uv;
use crate::viewport::SUBPIXEL_BITS;

/// Bits of the weights `m_k`: with extents of 2^19 subpixels three products fit 62.
const WEIGHT_BITS: u32 = 41;

/// A triangle's derivatives, up to the denominator that all share.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Footprint {
    /// Of u and of v, in level-0 texels.
    axes: [Axis; 2],
    /// 1/w, with a scale of its own.
    q: Plane,
    /// The sum of 1/w at the corners, in units of the plane without its fraction.
    sum_q: u64,
    /// What lambda is more than the logarithms of the numerator and of 1/w make: 16.16.
    offset: i32,
    /// D, and the numerators' exponent.
    twice_area: u64,
    exponent: u32,
    /// Bits of the largest weight.
    weight_bits: u32,
    log2_size: (u32, u32),
}

/// One coordinate's numerators: `slope y + across` along x, `down - slope x` along y, with x and y
/// in subpixels.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Axis {
    slope: i64,
    across: i64,
    down: i64,
}

impl Axis {
    /// From weights that are shifted down so far.
    // A function of its own: two copies are a kilobyte, and both at once more than a processor's registers.
    #[inline(never)]
    fn new(weights: [i64; 3], down: u32, vertices: &[ScreenVertex; 3]) -> Self {
        let mut axis = Self {
            slope: 0,
            across: 0,
            down: 0,
        };
        // Modulo 2^64: only what they give inside the triangle must fit, and it does.
        for (weight, vertex) in weights.into_iter().zip(vertices) {
            let weight = weight >> (down & 63);
            let [x, y] = [vertex.x(), vertex.y()].map(|c| i64::from(c.to_bits()));
            axis.slope = axis.slope.wrapping_add(weight);
            axis.across = axis.across.wrapping_sub(weight.wrapping_mul(y));
            axis.down = axis.down.wrapping_add(weight.wrapping_mul(x));
        }
        axis
    }

    /// Along x, at a height in subpixels.
    #[inline]
    fn across(&self, y: i32) -> i64 {
        self.across.wrapping_add(self.slope.wrapping_mul(y.into()))
    }

    /// Along y.
    #[inline]
    fn down(&self, x: i32) -> i64 {
        self.down.wrapping_sub(self.slope.wrapping_mul(x.into()))
    }

    /// How [`Self::across`] changes from one row to the next.
    #[inline]
    fn across_step(&self) -> i64 {
        self.slope << SUBPIXEL_BITS
    }
}

/// `m_k` of one coordinate, 16.16, in texels: of products `q_i q_j` with 62 bits 54 stay, of the
/// coordinate's differences 23.
// A function of its own, as `Axis::new` is.
#[inline(never)]
fn weights([a, b, c]: [i32; 3], products: [u64; 3], log2_size: u32) -> [i64; 3] {
    let differences = [b.wrapping_sub(c), c.wrapping_sub(a), a.wrapping_sub(b)];
    let mut weights = [0i64; 3];
    for ((to, product), difference) in weights.iter_mut().zip(products).zip(differences) {
        let difference = i64::from(difference);
        let high = ((product >> 32) as i64).wrapping_mul(difference);
        let low = i64::from(product as u32).wrapping_mul(difference) >> 32;
        // From repeats to texels, downwards so that nothing is lost above.
        *to = high.wrapping_add(low) >> (12u32.wrapping_sub(log2_size) & 31);
    }
    weights
}

impl Footprint {
    /// For a texture whose finest level has these base-2 logarithms of width and height.
    // A function of its own, which writes where the caller has it: to copy it there would take a
    // kilobyte more, of the compiler's library.
    #[inline(never)]
    #[must_use]
    pub fn new(triangle: &TriangleSetup<'_>, log2_size: (u32, u32)) -> Self {
        Self::in_registers(triangle, log2_size)
    }

    /// The same for where it is used up at once.
    #[inline]
    fn in_registers(triangle: &TriangleSetup<'_>, log2_size: (u32, u32)) -> Self {
        let vertices = triangle.vertices();
        let q = shared_inverses(vertices.each_ref().map(|v| v.w()));
        let [a, b, c] = q.map(u64::from);
        // Of the edge opposite each corner; 62 bits.
        let products = [b * c, c * a, a * b];
        let coordinates = vertices.each_ref().map(|v| v.uv().map(|c| c.to_bits()));
        let u = weights(coordinates.map(|[u, _]| u), products, log2_size.0);
        let v = weights(coordinates.map(|[_, v]| v), products, log2_size.1);
        let all = u
            .into_iter()
            .chain(v)
            .fold(0, |all, w| all | w.unsigned_abs());
        let exponent = (64 - WEIGHT_BITS).saturating_sub(all.leading_zeros());
        Self {
            axes: [u, v].map(|weights| Axis::new(weights, exponent, vertices)),
            q: triangle.plane(q.map(u32::cast_signed)),
            sum_q: a.wrapping_add(b).wrapping_add(c),
            // With the numerator N and the plane's value Q as they are here, and D in square
            // subpixels, rho = 2^8 N 2^(32 - 16 + 12 + exponent) 2^62 / (D Q^2): subpixels in a
            // pixel; what was shifted out of the products, the fraction of u and v, the size of
            // the largest texture and the shift to 41 bits; twice the plane's fraction.
            offset: ((exponent.wrapping_add(98)) << FRACTION_BITS)
                .cast_signed()
                .wrapping_sub(log2(triangle.twice_area())),
            twice_area: triangle.twice_area(),
            exponent,
            weight_bits: (64 - all.leading_zeros()).wrapping_sub(exponent),
            log2_size,
        }
    }

    /// Lambda at the mean of the corners of its triangle, with [`FRACTION_BITS`] fraction bits.
    #[inline]
    #[must_use]
    pub fn lambda_of_mean<R: Rule>(&self, triangle: &TriangleSetup<'_>, rule: R) -> i32 {
        let [across, down] = self.steps_at_mean(triangle).map(|step| rule.length(step));
        self.lambda(rule.log2(across.max(down)), self.mean_q())
    }

    /// The numerators along x and y at the mean of the corners.
    #[inline]
    fn steps_at_mean(&self, triangle: &TriangleSetup<'_>) -> [[i64; 2]; 2] {
        let [x, y] = mean(triangle.vertices());
        [
            self.axes.each_ref().map(|axis| axis.across(y)),
            self.axes.each_ref().map(|axis| axis.down(x)),
        ]
    }

    /// 1/w there.
    #[inline]
    fn mean_q(&self) -> u64 {
        (self.sum_q / 3) << Plane::FRACTION_BITS
    }

    /// Lambda from the logarithm of the longer numerator and from 1/w.
    #[inline]
    fn lambda(&self, longer: i32, q: u64) -> i32 {
        longer
            .wrapping_add(self.offset)
            .wrapping_sub(log2(q).wrapping_mul(2))
    }

    /// The derivatives along one span, measured by a rule, with all bits.
    #[inline]
    #[must_use]
    pub fn row<R: Rule>(&self, span: Span, rule: R) -> FootprintRow<'_, R> {
        let y = centre(span.y);
        let across = self.axes.each_ref().map(|axis| axis.across(y));
        FootprintRow {
            footprint: self,
            rule,
            left: span.left,
            across,
            length_across: rule.length(across),
            q: self.q.at(span.left, span.y),
        }
    }
}

/// A pixel's centre in subpixels.
#[inline]
fn centre(pixel: i32) -> i32 {
    (pixel << SUBPIXEL_BITS).wrapping_add(1 << (SUBPIXEL_BITS - 1))
}

#[inline]
fn mean(vertices: &[ScreenVertex; 3]) -> [i32; 2] {
    let of = |[a, b, c]: [i32; 3]| a.wrapping_add(b).wrapping_add(c).div_euclid(3);
    [
        of(vertices.each_ref().map(|v| v.x().to_bits())),
        of(vertices.each_ref().map(|v| v.y().to_bits())),
    ]
}

/// A triangle's derivatives along one span.
#[derive(Clone, Copy, Debug)]
pub struct FootprintRow<'t, R: Rule> {
    footprint: &'t Footprint,
    rule: R,
    left: i32,
    across: [i64; 2],
    length_across: R::Length,
    /// 1/w at the span's start.
    q: i64,
}

impl<R: Rule> FootprintRow<'_, R> {
    #[inline]
    fn down(&self, offset: u32) -> [i64; 2] {
        let x = centre(self.left.wrapping_add_unsigned(offset));
        self.footprint.axes.each_ref().map(|axis| axis.down(x))
    }

    #[inline]
    fn q(&self, offset: u32) -> u64 {
        let step = self.footprint.q.step_x();
        let q = self.q.wrapping_add(step.wrapping_mul(offset.into()));
        // Positive inside the triangle; what rounding makes of the farthest point must not matter.
        q.max(1).cast_unsigned()
    }

    /// Lambda at a pixel, with [`FRACTION_BITS`] fraction bits: the logarithm of the longer of the
    /// steps to the right and down, in level-0 texels.
    ///
    /// Off by less than 2^-12: 7.9e-5 low for the logarithm of the numerator, up to three times that
    /// high for those of the area and, twice, 1/w; and what the corners' rounding to 2^-30 and to 41
    /// bits comes to, below 2^-19 at depths of ratio 1:256. In slivers, whose numerators are small
    /// differences of large numbers, and in greater depths the latter grows, but all together
    /// keeps below 2^-8 wherever a pixel spans 1/16 texel or more.
    #[inline]
    #[must_use]
    pub fn lambda(&self, offset: u32) -> i32 {
        let down = self.rule.length(self.down(offset));
        let longer = self.length_across.max(down);
        self.footprint
            .lambda(self.rule.log2(longer), self.q(offset))
    }

    /// The longer step at a pixel.
    #[inline]
    pub(crate) fn long_axis(&self, offset: u32) -> LongAxis {
        let down = self.down(offset);
        let lengths = [self.length_across, self.rule.length(down)];
        let logarithms = lengths.map(|length| self.rule.log2(length));
        self.footprint
            .long_axis([self.across, down], logarithms, self.q(offset))
    }
}

/// The longer axis of a footprint.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LongAxis {
    /// The logarithm of its length in level-0 texels.
    pub(crate) lambda: i32,
    /// The logarithm of its length in lengths of the shorter one.
    pub(crate) excess: i32,
    /// Its length and direction, in repeats, limited to 64.
    pub(crate) step: Uv,
}

impl Footprint {
    /// The longer step at the mean of the corners.
    #[inline]
    pub(crate) fn long_axis_of_mean<R: Rule>(
        &self,
        triangle: &TriangleSetup<'_>,
        rule: R,
    ) -> LongAxis {
        let steps = self.steps_at_mean(triangle);
        let logarithms = steps.map(|step| rule.log2(rule.length(step)));
        self.long_axis(steps, logarithms, self.mean_q())
    }

    #[inline]
    fn long_axis(
        &self,
        [across, down]: [[i64; 2]; 2],
        [along, below]: [i32; 2],
        q: u64,
    ) -> LongAxis {
        let (longer, step) = if along >= below {
            (along, across)
        } else {
            (below, down)
        };
        LongAxis {
            lambda: self.lambda(longer, q),
            excess: longer.wrapping_sub(along.min(below)),
            step: self.step(step, q),
        }
    }

    /// Numerators over the denominator: a step in repeats.
    #[inline]
    fn step(&self, [u, v]: [i64; 2], q: u64) -> Uv {
        // 1 / Q^2 and then 1 / (D Q^2), 31 bits each.
        let zeros = q.leading_zeros();
        let inverse_q = u64::from(reciprocal((q.wrapping_shl(zeros) >> 32) as u32));
        let square = inverse_q.wrapping_mul(inverse_q) >> 31;
        let (inverse_area, area_shift) = inverse(self.twice_area);
        let factor = (square.wrapping_mul(u64::from(inverse_area)) >> 31).cast_signed();
        // The numerators to 31 bits.
        let down = 33u32.saturating_sub((u.unsigned_abs() | v.unsigned_abs()).leading_zeros());
        // In texels N 2^(98 + exponent) / (D Q^2), of which Q = 2^(94 - zeros) / inverse_q and
        // D = 2^(31 + area_shift) / inverse_area: 1 / (D Q^2) = factor 2^(2 zeros - 157 -
        // area_shift). A repeat has 2^24 units.
        let up = (self.exponent + down + 2 * zeros)
            .cast_signed()
            .wrapping_sub(area_shift.cast_signed())
            .wrapping_add(98 - 157 + 24);
        let one = |n: i64, log2_size: u32| {
            let n = (n >> down).wrapping_mul(factor);
            let up = up.wrapping_sub(log2_size.cast_signed());
            let limit = 64i64 << Uv::FRACTION_BITS;
            let bits = if up < 0 {
                n >> up.unsigned_abs().min(63)
            } else if n.unsigned_abs().leading_zeros() > up.cast_unsigned() {
                n << up
            } else {
                // Beyond the limit, unless it is 0.
                n.signum().wrapping_mul(limit)
            };
            bits.clamp(-limit, limit) as i32
        };
        Uv::from_bits(one(u, self.log2_size.0), one(v, self.log2_size.1))
    }
}
