//! Triangle setup: three snapped vertices become an oriented triangle and the means to lay planes
//! through values at its corners. What leaves is exact in the positions, except for one common
//! factor: the reciprocal of the area, whose error moves every plane alike.

use fixed::types::I24F8;

use crate::arith::reciprocal;
use crate::project::ScreenVertex;
use crate::viewport::SUBPIXELS;

/// Which triangles to leave out, by the side they show. Front faces appear counter-clockwise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Cull {
    /// Draw both sides.
    #[default]
    Off,
    /// Leave out triangles seen from behind: right for closed meshes.
    Back,
    /// Leave out triangles seen from the front.
    Front,
}

/// A triangle that covers an area, ready for planes.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TriangleSetup<'a> {
    vertices: &'a [ScreenVertex; 3],
    /// From vertex 0 to vertices 1 and 2, in subpixels.
    sides: [[i32; 2]; 2],
    /// `2^62 / m`, where `m 2^(shift - 31)` is twice the area in square subpixels and m has 32
    /// bits.
    inverse_area: u32,
    /// 0 for an area of one half of a square subpixel, at most 39.
    shift: u32,
    /// Twice the area is negative: the triangle appears counter-clockwise (y points down).
    negative: bool,
}

impl<'a> TriangleSetup<'a> {
    /// `None` for a triangle without area, and for one that `cull` leaves out.
    #[inline]
    #[must_use]
    pub fn new(vertices: &'a [ScreenVertex; 3], cull: Cull) -> Option<Self> {
        let [a, b, c] = vertices;
        let side = |p: &ScreenVertex| {
            [
                p.x().to_bits().wrapping_sub(a.x().to_bits()),
                p.y().to_bits().wrapping_sub(a.y().to_bits()),
            ]
        };
        let [[bx, by], [cx, cy]] = [side(b), side(c)];
        // Extents below 2^20 each: twice the area has at most 40 bits.
        let area = i64::from(bx) * i64::from(cy) - i64::from(by) * i64::from(cx);
        let shown = match cull {
            Cull::Off => area != 0,
            Cull::Back => area < 0,
            Cull::Front => area > 0,
        };
        if !shown {
            return None;
        }
        let magnitude = area.unsigned_abs();
        let zeros = magnitude.leading_zeros() & 63;
        // The top 32 bits: short by less than 2^-31 of the value.
        let head = ((magnitude << zeros) >> 32) as u32;
        Some(Self {
            vertices,
            sides: [[bx, by], [cx, cy]],
            inverse_area: reciprocal(head),
            shift: 63u32.wrapping_sub(zeros),
            negative: area < 0,
        })
    }

    /// The corners, in the caller's order.
    #[inline]
    #[must_use]
    pub const fn vertices(&self) -> &'a [ScreenVertex; 3] {
        self.vertices
    }

    /// Twice the area, in square subpixels; not 0.
    #[inline]
    #[must_use]
    pub fn twice_area(&self) -> u64 {
        let [[bx, by], [cx, cy]] = self.sides;
        let area = i64::from(bx) * i64::from(cy) - i64::from(by) * i64::from(cx);
        area.unsigned_abs()
    }

    /// `2^62 / m` and `e`, where twice the area is `m 2^(e - 31)` and m has 32 bits.
    #[inline]
    pub(crate) const fn inverse_area(&self) -> (u32, u32) {
        (self.inverse_area, self.shift)
    }

    /// The plane through three values at the corners, each `0 <= value < 2^31`.
    #[inline]
    #[must_use]
    pub fn plane(&self, values: [i32; 3]) -> Plane {
        let [first, second, third] = values;
        let [[bx, by], [cx, cy]] = self.sides;
        let (b, c) = (
            i64::from(second.wrapping_sub(first)),
            i64::from(third.wrapping_sub(first)),
        );
        // Cramer's rule. A difference has 32 bits with its sign, an extent 21: no overflow.
        let x = self.over_area(b * i64::from(cy) - c * i64::from(by));
        let y = self.over_area(c * i64::from(bx) - b * i64::from(cx));
        let [a, ..] = self.vertices;
        let to_centre = |c: I24F8| i64::from((SUBPIXELS / 2).wrapping_sub(c.to_bits()));
        let origin = (i64::from(first) << Plane::FRACTION_BITS)
            .wrapping_add(x.wrapping_mul(to_centre(a.x())))
            .wrapping_add(y.wrapping_mul(to_centre(a.y())));
        Plane {
            origin,
            x: x.wrapping_mul(i64::from(SUBPIXELS)),
            y: y.wrapping_mul(i64::from(SUBPIXELS)),
        }
    }

    /// `n / (2 area)` with 31 fraction bits, rounded down, modulo 2^64; |n| < 2^52.
    #[inline]
    fn over_area(&self, n: i64) -> i64 {
        let n = if self.negative { n.wrapping_neg() } else { n };
        let (high, low) = (n >> 32, n as u32);
        let high = high.wrapping_mul(i64::from(self.inverse_area));
        let low = u64::from(low).wrapping_mul(u64::from(self.inverse_area));
        // n 2^31 / (m 2^e) = n (2^62 / m) >> (31 + e), where 31 + e = 0 .. 39. The high part is a
        // multiple of 2^32, so shifting the parts alone rounds like shifting their sum.
        if self.shift >= 32 {
            high.wrapping_add((low >> 32).cast_signed()) >> (self.shift & 31)
        } else {
            high.wrapping_shl(32 - self.shift)
                .wrapping_add((low >> self.shift).cast_signed())
        }
    }
}

/// A linear function of the screen, with [`Self::FRACTION_BITS`] fraction bits, modulo 2^64.
///
/// At pixel centres inside its triangle the value is between the values at the corners, give or
/// take its error; outside it may wrap around. Within the triangle the error is at most
///
/// - a move of the sample position towards or away from vertex 0 by 2^-29 of its distance, less
///   than 2^-18 pixel: the error of the reciprocal of the area, which all planes of a triangle
///   share, so that it bends nothing; and
/// - 2^-11 of a unit of the corner values: both gradients are rounded down to 2^-31 per subpixel,
///   and apply to at most 2^19 subpixels each.
///
/// All arithmetic is exact from there on: stepping to a pixel and evaluating at it give the same
/// bits, so a band that starts in the middle of a triangle continues it exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Plane {
    origin: i64,
    x: i64,
    y: i64,
}

impl Plane {
    /// Bits of a value behind the binary point; corner values have none.
    pub const FRACTION_BITS: u32 = 31;

    /// The value at the centre of a pixel.
    #[inline]
    #[must_use]
    pub fn at(&self, x: i32, y: i32) -> i64 {
        self.origin
            .wrapping_add(self.x.wrapping_mul(i64::from(x)))
            .wrapping_add(self.y.wrapping_mul(i64::from(y)))
    }

    /// The change from one pixel to the next on its right.
    #[inline]
    #[must_use]
    pub const fn step_x(&self) -> i64 {
        self.x
    }

    /// The change from one pixel to the next one below.
    #[inline]
    #[must_use]
    pub const fn step_y(&self) -> i64 {
        self.y
    }
}
