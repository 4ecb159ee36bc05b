//! Spans as long as a bound on their error allows.

use fixed::types::I16F16;

use super::chord::step;
use super::{Homogeneous, Run, RunSink, Strategy};
use crate::setup::TriangleSetup;
use crate::span::Span;
use crate::uv::Uv;

/// The longest spans whose error stays within a bound that the caller gives, in footprints.
///
/// A footprint is rho level-0 texels, the texels that a pixel spans, or one texel where rho is
/// less: what the eye sees once a mip level is chosen. The error at every pixel is at most
///
/// `bound * max(1, rho)` texels, plus three times that of [`PerPixel`](super::PerPixel) (two of
/// them in the measurement of the scanline, one in the coordinates), plus 1/32 texel for the
/// rounding of steps.
///
/// **How.** Along a scanline 1/w = q and u/w are linear, so u is a hyperbola, of which
/// `D = q^2 du/dx` is constant. On a piece of n steps between depths of ratio r, with q = a at
/// the nearer end and b at the farther one, u changes by `|du| = n D / (a b)`, and a chord is
/// off by exactly
///
/// `|du| (sqrt r - 1) / (sqrt r + 1) = |du| (a - b) / (a + b + 2 sqrt(a b)) <= |du| (a - b) / (a + 3 b)`.
///
/// The first and the last pixel of the scanline are divided in any case and give D; after that
/// each piece is tested before it is divided, in integers, by products alone. As rho is at least
/// `D / q^2`, the error in footprints is at most `n (a - b) / (a b)` times the largest
/// `s (1 - s) q` on the piece, s from 0 to 1, which is no more than `(16 a + 11 b) / 108`: a piece
/// that keeps this to the bound will do as well. So will one that keeps `D / D'` of it, where the
/// change of u down the column, times q^2, is at least D' along the scanline (it is linear along
/// it, so its ends tell). All roundings are to the safe side. A piece of one step is exact, so
/// the bound holds wherever it can be asked for; 0 gives the per-pixel result where the depth
/// varies.
///
/// Lengths are powers of two up to 1024, or 9 to 15 eighths of one, and pieces end at columns
/// that are multiples of such an eighth, and at the ends of the span. Textures of more than 512
/// texels have pieces of at most `2^19 / size` pixels, so that rounding keeps to its 1/32 texel.
///
/// **Cost.** A division for each piece and one for each scanline; two for a scanline of constant
/// depth, whatever its length. About two tests a piece, each of eight multiplications, and one
/// more integer division for a scanline of more than one piece. Deciding
/// for each piece takes fewer divisions than deciding once a scanline or once a triangle, where
/// the nearest or most distorted end decides for all.
///
/// Choose it where the error must be known, or where walls at all angles share a frame: it spends
/// divisions only where depth varies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Adaptive {
    /// In 2^-12 footprints.
    bound: u32,
    log2_width: u8,
    log2_height: u8,
}

/// Fraction bits of distances in texels.
const TEXEL_BITS: u32 = 12;

impl Adaptive {
    /// A quarter of a footprint: below what nearest sampling shows.
    pub const DEFAULT_BOUND: I16F16 = I16F16::lit("0.25");

    /// For a texture with these base-2 logarithms of width and height, as
    /// [`Texture::log2_size`](crate::texture::Texture::log2_size) gives them; the bound in
    /// footprints, with 12 fraction bits, rounded down. A negative bound counts as 0, sizes
    /// beyond [`MAX_TEXTURE_SIZE`](crate::texture::MAX_TEXTURE_SIZE) as that.
    ///
    /// It takes the size because the bound is in texels and coordinates are in repeats; a
    /// pipeline holds one texture, so the two are made together.
    #[must_use]
    pub const fn new(bound: I16F16, (log2_width, log2_height): (u32, u32)) -> Self {
        const fn at_most_12(log2: u32) -> u8 {
            if log2 < 12 { log2 as u8 } else { 12 }
        }
        let bits = bound.to_bits();
        Self {
            bound: if bits < 0 {
                0
            } else {
                bits.cast_unsigned() >> (16 - TEXEL_BITS)
            },
            log2_width: at_most_12(log2_width),
            log2_height: at_most_12(log2_height),
        }
    }

    /// In 2^-12 texels, below 2^27.
    #[inline]
    pub(super) fn bound(&self) -> u32 {
        self.bound
    }

    /// The larger distance of u and v, in 2^-12 texels, rounded up; below 2^32.
    #[inline]
    pub(super) fn distance(&self, from: Uv, to: Uv) -> u32 {
        let texels = |from: i32, to: i32, log2_size: u8| {
            // A distance in 8.24 is below 2^31, so 2^43 at the largest size.
            let down = (Uv::FRACTION_BITS - TEXEL_BITS).wrapping_sub(u32::from(log2_size)) & 31;
            let all = (1u32 << down).wrapping_sub(1);
            let distance = from.abs_diff(to);
            (distance >> down).wrapping_add(u32::from(distance & all != 0))
        };
        texels(from.u.to_bits(), to.u.to_bits(), self.log2_width).max(texels(
            from.v.to_bits(),
            to.v.to_bits(),
            self.log2_height,
        ))
    }

    /// A lower bound of a change of u and v that comes with its sign, in 2^-12 texels: the larger
    /// of the two, of those that have the same sign in both; each end's own.
    #[inline]
    fn common(&self, from: Uv, to: Uv) -> [u32; 2] {
        let lower = |bits: i32, log2_size: u8| {
            let down = (Uv::FRACTION_BITS - TEXEL_BITS).wrapping_sub(u32::from(log2_size)) & 31;
            let texels = bits.unsigned_abs() >> down;
            // A margin beyond what the slope's own arithmetic loses.
            texels.saturating_sub(texels >> 6).saturating_sub(4)
        };
        let axis = |from: i32, to: i32, log2_size: u8| {
            if (from ^ to) < 0 {
                [0; 2]
            } else {
                [lower(from, log2_size), lower(to, log2_size)]
            }
        };
        let u = axis(from.u.to_bits(), to.u.to_bits(), self.log2_width);
        let v = axis(from.v.to_bits(), to.v.to_bits(), self.log2_height);
        let least = |[a, b]: [u32; 2]| a.min(b);
        if least(u) > least(v) { u } else { v }
    }

    /// The longest piece: the rounding of its steps keeps to 1/32 texel.
    #[inline]
    fn longest(&self) -> Length {
        let log2 = 19u32.wrapping_sub(u32::from(self.log2_width.max(self.log2_height)));
        Length(8 * log2.min(10))
    }
}

/// Length of pieces: eight steps to the octave, `(8 + n % 8) / 8 * 2^(n / 8)` pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Length(u32);

impl Length {
    const ONE: Self = Self(0);

    #[inline]
    fn pixels(self) -> u32 {
        (8 + (self.0 & 7)) << ((self.0 >> 3) & 15) >> 3
    }

    /// Steps from a column to the end of its piece: down to a multiple of an eighth of the power
    /// of two.
    #[inline]
    fn steps(self, column: u32) -> u32 {
        let eighth = 1u32 << ((self.0 >> 3).saturating_sub(3) & 15);
        let end = column.wrapping_add(self.pixels()) & eighth.wrapping_neg();
        end.wrapping_sub(column)
    }

    #[inline]
    fn up(self, by: u32, most: Self) -> Self {
        Self(self.0.wrapping_add(by)).min(most)
    }

    #[inline]
    fn down(self, by: u32) -> Self {
        Self(self.0.saturating_sub(by))
    }
}

/// What is known of a scanline once its ends are.
#[derive(Clone, Copy, Debug)]
struct Scanline {
    /// The bound in 2^-12 footprints.
    bound: u32,
    /// Shifts 1/w so that the nearer end has 32 bits.
    shift: u32,
    /// Distance of the ends times 1/w at both, rounded up: `mantissa 2^exponent`.
    curve: (u32, u32),
    /// The bound times the length, rounded down, likewise.
    limit: (u32, u32),
    /// D / D' in 32nds, rounded up, 1 to 32.
    part: u32,
}

/// As `mantissa 2^exponent`, with a mantissa of 32 bits, rounded down.
#[inline]
fn normalised(n: u64) -> (u32, u32) {
    let exponent = 32u32.saturating_sub(n.leading_zeros());
    ((n >> exponent) as u32, exponent)
}

impl Scanline {
    #[inline]
    fn new(bound: u32, distance: u32, [p, q]: [i64; 2], steps: u32) -> Self {
        // Below 2^62: the sign stays clear.
        let shift = p.max(q).leading_zeros();
        let [p, q] = [p, q].map(|q| (q.wrapping_shl(shift).cast_unsigned() >> 32) + 1);
        // Both at most 2^32.
        let ends = p.saturating_mul(q);
        let (ends, e) = normalised(ends);
        let ends = u64::from(ends) + 1;
        let (curve, f) = normalised(ends.saturating_mul(u64::from(distance)));
        let curve = if distance == 0 {
            (0, 0)
        } else {
            (curve.saturating_add(1), e.wrapping_add(f))
        };
        Self {
            bound,
            shift,
            curve,
            limit: normalised(u64::from(bound).wrapping_mul(u64::from(steps))),
            part: 32,
        }
    }

    /// With the changes down the column at both ends, from [`Adaptive::common`].
    #[inline]
    fn with_slopes(self, distance: u32, [p, q]: [i64; 2], steps: u32, down: [u32; 2]) -> Self {
        let upper = |q: i64| q.wrapping_shl(self.shift).cast_unsigned() >> 32;
        let (p, q) = (upper(p), upper(q));
        let [at_p, at_q] = down.map(u64::from);
        // D' on the one hand, D times the length on the other: 64 bits, all 2^-32 units.
        let least = (p.wrapping_mul(p) >> 32)
            .wrapping_mul(at_p)
            .min((q.wrapping_mul(q) >> 32).wrapping_mul(at_q));
        let ends = (p.wrapping_add(1).saturating_mul(q.wrapping_add(1)) >> 32).wrapping_add(1);
        let across = ends.saturating_mul(u64::from(distance));
        // 16 bits of the one, as many fewer of the other.
        let shift = 48u32.saturating_sub(least.leading_zeros());
        let least = ((least >> shift) as u32).wrapping_mul(steps);
        let part = match u32::try_from(across >> shift) {
            // Below 2^27, as 16 bits times 11 are.
            Ok(across) if across < least => {
                let part = (across.wrapping_add(1) << 5).checked_div(least);
                part.map_or(32, |part| part.wrapping_add(1).min(32))
            }
            _ => 32,
        };
        Self { part, ..self }
    }

    /// Whether a chord of `steps` steps between these values of 1/w keeps the bound.
    #[inline]
    fn fits(&self, p: i64, q: i64, steps: u32) -> bool {
        let upper = |q: i64| (q.wrapping_shl(self.shift).cast_unsigned() >> 32) as u32;
        let (p, q) = (upper(p), upper(q));
        let (a, b) = if p > q { (p, q) } else { (q, p) };
        // 16 bits each from here on, all rounded down.
        let zeros = a.leading_zeros() & 31;
        let (a, b) = (u64::from((a << zeros) >> 16), u64::from((b << zeros) >> 16));
        let steps = u64::from(steps);
        // Each is short by less than 1.
        let difference = a.wrapping_sub(b).wrapping_add(1);
        let sum = a.wrapping_add(3 * b);
        // In footprints: n (a - b) (16 a + 11 b) <= 108 bound a b, of which 32nds count, with the
        // bound in 2^-10: 37 + 21 + 5 against 7 + 25 + 32 bits.
        let most = (16 * a).wrapping_add(11 * b).wrapping_add(27);
        let off = (steps.wrapping_mul(difference) << (TEXEL_BITS - 2)).wrapping_mul(most);
        let off = off.wrapping_mul(u64::from(self.part)).wrapping_add(31) >> 5;
        if off <= (108 * u64::from(self.bound >> 2)).wrapping_mul(a.wrapping_mul(b)) {
            return true;
        }
        // In texels: curve n (a - b) <= limit a b (a + 3 b), where a and b stand for 2^(16 -
        // zeros) as much: 32 + 28 against 32 + 32 bits.
        let ((curve, e), (limit, f)) = (self.curve, self.limit);
        let off = u64::from(curve).wrapping_mul(steps.wrapping_mul(difference));
        let most = u64::from(limit).wrapping_mul(a.wrapping_mul(b).wrapping_mul(sum) >> 18);
        // 16 - zeros on the left, 18 + 3 (16 - zeros) on the right.
        let left = e.wrapping_add(2u32.wrapping_mul(zeros));
        let right = f.wrapping_add(50);
        match right.checked_sub(left) {
            Some(up) => {
                let up = up.min(63);
                off <= most || off.saturating_sub(1) >> up < most
            }
            None => off <= most.checked_shr(left.wrapping_sub(right)).unwrap_or(0),
        }
    }
}

impl Strategy for Adaptive {
    type Planes = Homogeneous;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<Homogeneous> {
        Homogeneous::new(triangle)
    }

    #[inline]
    fn runs(&self, planes: &Homogeneous, span: Span, mut sink: impl RunSink) {
        let steps = span.left.abs_diff(span.right).wrapping_sub(1);
        let mut point = planes.at(span.left, span.y);
        let scale = planes.scale(point);
        let mut uv = planes.scaled(point, scale);
        if steps == 0 {
            sink.run(Run {
                offset: 0,
                len: 1,
                uv,
                step: Uv::default(),
            });
            return;
        }
        let last_point = planes.step(point, steps);
        let last_scale = planes.scale(last_point);
        let last = planes.scaled(last_point, last_scale);
        let distance = self.distance(uv, last);
        let ends = [point.q(), last_point.q()];
        let mut scanline = Scanline::new(self.bound, distance, ends, steps);
        let longest = self.longest();
        let mut offset = 0;
        // A scanline of nearly constant depth is tried whole.
        let whole = steps <= longest.pixels() && {
            let [p, q] = ends;
            scanline.fits(p, q, steps)
        };
        if !whole {
            let down = self.common(
                planes.slope_down(point, scale),
                planes.slope_down(last_point, last_scale),
            );
            scanline = scanline.with_slopes(distance, ends, steps, down);
        }
        let mut length = longest;
        // By octaves first, then by eighths.
        let mut by = 8;
        loop {
            let rest = steps.wrapping_sub(offset);
            let column = span.left.cast_unsigned().wrapping_add(offset);
            let try_length = |length: Length| {
                let steps = length.steps(column).min(rest);
                let end = planes.step(point, steps);
                let fits = steps <= 1 || scanline.fits(point.q(), end.q(), steps);
                fits.then_some((steps, end))
            };
            let (steps, end) = if whole {
                (rest, last_point)
            } else {
                let mut found = try_length(length);
                while found.is_none() && length > Length::ONE {
                    length = length.down(by);
                    found = try_length(length);
                }
                if by > 1 {
                    // Less than an octave is left.
                    for _ in 1..by {
                        let Some(longer) = try_length(length.up(1, longest)) else {
                            break;
                        };
                        length = length.up(1, longest);
                        found = Some(longer);
                    }
                    by = 1;
                }
                found.unwrap_or((1, planes.step(point, 1)))
            };
            let is_last = steps >= rest;
            let to = if is_last { last } else { planes.divide(end) };
            sink.run(Run {
                offset: offset as usize,
                len: steps.wrapping_add(u32::from(is_last)) as usize,
                uv,
                step: step(uv, to, steps),
            });
            if is_last {
                return;
            }
            offset = offset.wrapping_add(steps);
            point = end;
            uv = to;
            // Farther on longer ones may do.
            length = length.up(2, longest);
        }
    }
}
