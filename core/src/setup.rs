//! Triangle setup: three snapped vertices become an oriented triangle and the means to lay planes
//! through values at its corners. What leaves is exact in the positions, except for one common
//! factor: the reciprocal of the area, whose error moves every plane alike.

use fixed::types::{I16F16, I24F8};

use crate::arith::{
    NARROW, leading_zeros, leading_zeros_from, long_product, over_subpixels, product,
    product_with_short, quotient_apart, reciprocal_apart, shifted_down, short_product_unsigned,
    times_quotient,
};
use crate::project::{ScreenVertex, first_centre};
use crate::viewport::{SUBPIXEL_BITS, SUBPIXELS};

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

/// Bits behind the point with which [`TriangleSetup::slants`] finds gradients fast in a short
/// triangle.
pub(crate) const SHORT_BITS: u32 = 30;

/// A linear function of the screen, modulo 2^32.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Slant {
    /// At the centre of pixel (0, 0).
    pub(crate) origin: i32,
    /// Change over a pixel to the right.
    pub(crate) right: i32,
    /// Change over a pixel down.
    pub(crate) down: i32,
}

impl Slant {
    /// From the value at a pixel, and the changes over a pixel.
    #[inline]
    fn through([x, y]: [i32; 2], at_pixel: i32, [right, down]: [i32; 2]) -> Self {
        Self {
            origin: at_pixel
                .wrapping_sub(right.wrapping_mul(x))
                .wrapping_sub(down.wrapping_mul(y)),
            right,
            down,
        }
    }

    /// The change over so many subpixels, below 2^19.
    #[inline]
    pub(crate) fn over_subpixels(&self, far: [i32; 2]) -> i32 {
        over_subpixels([self.right, self.down], far)
    }

    /// At the centre of a pixel.
    #[inline]
    pub(crate) fn at(&self, x: i32, y: i32) -> i32 {
        self.origin
            .wrapping_add(self.down.wrapping_mul(y))
            .wrapping_add(self.right.wrapping_mul(x))
    }
}

/// A triangle that covers an area, ready for planes.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TriangleSetup<'a> {
    vertices: &'a [ScreenVertex; 3],
    /// From vertex 0 to vertices 1 and 2, in subpixels; both turned around where the triangle
    /// appears counter-clockwise, so that the area they span counts as positive.
    sides: [[i32; 2]; 2],
    /// In square subpixels, at least 1: 40 bits.
    twice_area: u64,
    /// The triangle appears counter-clockwise (y points down).
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
        let area = if NARROW && are_within([bx, by, cx, cy], 1 << 15) {
            i64::from(bx.wrapping_mul(cy).wrapping_sub(by.wrapping_mul(cx)))
        } else {
            difference_of_products([bx, cy], [by, cx])
        };
        let shown = match cull {
            Cull::Off => area != 0,
            Cull::Back => area < 0,
            Cull::Front => area > 0,
        };
        if !shown {
            return None;
        }
        let negative = area < 0;
        let turned = |side: i32| if negative { side.wrapping_neg() } else { side };
        Some(Self {
            vertices,
            sides: [[turned(bx), turned(by)], [turned(cx), turned(cy)]],
            twice_area: area.unsigned_abs(),
            negative,
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
    pub const fn twice_area(&self) -> u64 {
        self.twice_area
    }

    /// u and v of the first corner, 16.16, and by how much those of the second and third exceed them: of
    /// u, and of v.
    #[inline]
    pub(crate) fn coordinates(&self) -> ([i32; 2], [[i32; 2]; 2]) {
        // One word at a time: of two a processor of 64 bits makes one, and takes them out of it.
        let [a, b, c] = self.vertices;
        let [u, v] = [a.u(), a.v()].map(I16F16::to_bits);
        let beyond = |first: i32, [b, c]: [I16F16; 2]| {
            [
                b.to_bits().wrapping_sub(first),
                c.to_bits().wrapping_sub(first),
            ]
        };
        (
            [u, v],
            [beyond(u, [b.u(), c.u()]), beyond(v, [b.v(), c.v()])],
        )
    }

    /// w of the nearest and of the farthest corner, 16.16.
    #[inline]
    pub(crate) fn depths(&self) -> [u32; 2] {
        let [a, b, c] = self
            .vertices
            .each_ref()
            .map(|v| v.w().to_bits().cast_unsigned());
        [a.min(b).min(c), a.max(b).max(c)]
    }

    /// From the first corner to the second and third, in subpixels; both turned around where the triangle
    /// [is counter-clockwise](Self::is_counter_clockwise).
    #[inline]
    pub(crate) const fn sides(&self) -> [[i32; 2]; 2] {
        self.sides
    }

    /// Width of the triangle's box, in subpixels: below 2^20.
    #[inline]
    pub(crate) fn width(&self) -> u32 {
        let [[bx, _], [cx, _]] = self.sides;
        side(bx, cx)
    }

    /// Height of the triangle's box, in subpixels: below 2^20.
    #[inline]
    pub(crate) fn height(&self) -> u32 {
        let [[_, by], [_, cy]] = self.sides;
        side(by, cy)
    }

    /// Width and height of the triangle's box together, in subpixels: below 2^20.
    #[inline]
    #[must_use]
    pub(crate) fn extent(&self) -> u32 {
        self.width().wrapping_add(self.height())
    }

    /// Whether the corners appear counter-clockwise.
    #[inline]
    pub(crate) const fn is_counter_clockwise(&self) -> bool {
        self.negative
    }

    /// Of twice the area.
    #[inline]
    fn inverse_area(&self) -> (u32, u32) {
        inverse(self.twice_area)
    }

    /// The plane through three values at the corners, each `0 <= value < 2^31`.
    // A function of its own: several planes a triangle do not need its code as often.
    #[inline(never)]
    #[must_use]
    pub fn plane(&self, values: [i32; 3]) -> Plane {
        let ([first, ..], inverse) = (values, self.inverse_area());
        // A difference has 32 bits with its sign, an extent 21: no overflow.
        let [x, y] = self.slopes(values, 0);
        self.plane_from_first(
            i64::from(first) << Plane::FRACTION_BITS,
            over_area(x, inverse),
            over_area(y, inverse),
        )
    }

    /// How two coordinates exceed those of the first corner, with so many bits behind the point, 24 to
    /// [`SHORT_BITS`]: those of the second and third corners do by so much, less than 128 repeats in
    /// 16.16, and less than one with [`SHORT_BITS`]; `most` are the [`magnitudes`] of all.
    ///
    /// Gradients are too small by 2^-29 of themselves, and rounded to nearest. With [`SHORT_BITS`], those of
    /// corners less than 16 pixels from the first may be off by 2^-15 of themselves, and are rounded down; coordinates are moved
    /// up by 2^-15 of `most` then, so that none that was on a texel's edge comes out before it. At pixel (0, 0) the
    /// result is cut to a unit.
    #[inline]
    pub(crate) fn slants(&self, beyond_first: [[i32; 2]; 2], most: u32, bits: u32) -> [Slant; 2] {
        if bits == SHORT_BITS
            && let Some(gradients) = self.short_gradients(beyond_first)
        {
            let edge = most >> (31 - SHORT_BITS);
            return gradients.map(|(right, down)| {
                let slant = self.short_slant(right, down);
                Slant {
                    origin: slant.origin.wrapping_add_unsigned(edge),
                    ..slant
                }
            });
        }
        let inverse = self.inverse_area();
        if NARROW {
            beyond_first.map(|coordinate| self.narrow_slant(coordinate, inverse, bits))
        } else {
            self.wide_gradients(beyond_first, inverse)
                .map(|gradient| self.slant(gradient, bits))
        }
    }

    /// Through three values at the corners, each `0 <= value < 2^31`, doubled.
    ///
    /// Off by what [`Self::plane`] is, by half a unit, and by half a unit for each column and row from the
    /// first corner. Where corners are less than 16 pixels from the first and their values less than 2^27 from its,
    /// off by up to 2^-15 of what values span, by 2^12, and by a unit for each column and row.
    // A function of its own: it is the same for all pipelines.
    #[inline(never)]
    #[must_use]
    pub fn doubled(&self, values: [i32; 3]) -> Slant {
        if let Some(slant) = self.short_doubled(values) {
            return slant;
        }
        self.long_doubled(values)
    }

    /// The same for small triangles and values that differ little.
    #[inline]
    fn short_doubled(&self, [first, second, third]: [i32; 3]) -> Option<Slant> {
        const CUT: u32 = 11;
        let beyond = [second, third].map(|value| value.wrapping_sub(first));
        let [b, c] = beyond;
        if magnitudes([b, c, 0, 0]) >> CUT >> 16 != 0 {
            return None;
        }
        // In `short_gradients` one counts 2^14 times.
        let [(right, down)] = self.short_gradients([beyond.map(|value| value >> CUT)])?;
        let slant = self.short_slant(right >> (13 - CUT), down >> (13 - CUT));
        Some(Slant {
            origin: slant.origin.wrapping_add(first << 1),
            ..slant
        })
    }

    /// The same for any.
    #[inline(never)]
    fn long_doubled(&self, values: [i32; 3]) -> Slant {
        const CUT: u32 = Plane::FRACTION_BITS - 1;
        let Plane {
            centre,
            x,
            y,
            pixel,
        } = self.plane(values);
        let [at_pixel, right, down] =
            [centre, x, y].map(|value| (value.wrapping_add(1 << CUT >> 1) >> CUT) as i32);
        Slant::through(pixel, at_pixel, [right, down])
    }

    /// From the change over a pixel to the right and down.
    #[inline]
    fn short_slant(&self, right: i32, down: i32) -> Slant {
        let [a, ..] = self.vertices;
        let to_centre = [a.x(), a.y()].map(|c| (SUBPIXELS / 2).wrapping_sub(c.to_bits()));
        Slant {
            origin: over_subpixels([right, down], to_centre),
            right,
            down,
        }
    }

    /// Whether the triangle's box is less than so many pixels wide and high.
    #[inline]
    pub(crate) fn is_within(&self, log2_pixels: u32) -> bool {
        let [[bx, by], [cx, cy]] = self.sides;
        let across = [bx.wrapping_sub(cx), by.wrapping_sub(cy)];
        let sides = [bx, by, cx, cy, across[0], across[1]];
        are_within(sides, 1 << (log2_pixels + SUBPIXEL_BITS))
    }

    /// Of a triangle that [is within](Self::is_within) 16 pixels: 1/w, and how `N` others over w exceed those of
    /// the first corner, times a factor that all have in common.
    ///
    /// `first` is 1/w of the first corner, of 17 bits. `beyond` and `others`: by how much those of the second and
    /// third corners exceed the first's, in an eighth of its unit, below 2^17 8/7. Changes over a pixel are rounded
    /// down. `None` for triangles of less than a quarter of a pixel.
    #[inline]
    pub(crate) fn ratio_slants<const N: usize>(
        &self,
        first: u32,
        beyond: [i32; 2],
        others: [[i32; 2]; N],
    ) -> Option<RatioSlants<N>> {
        // The factor is the area over a power of two. An area has 24 bits.
        let scaled = short_product_unsigned(self.twice_area as u32, first);
        if scaled < 1 << 22 {
            return None;
        }
        let zeros = leading_zeros_from(0, scaled);
        let first = scaled << (zeros & 31) >> 6;
        let down = 9u32.wrapping_sub(zeros);
        let [[bx, by], [cx, cy]] = self.sides;
        // Sides below 2^12: sums below 2^31.
        let slant = |[b, c]: [i32; 2], down: u32| {
            let difference = |by: i32, cy: i32| b.wrapping_mul(cy).wrapping_sub(c.wrapping_mul(by));
            let [x, y] = [difference(by, cy), difference(bx, cx).wrapping_neg()];
            self.short_slant(x >> (down & 31), y >> (down & 31))
        };
        let q = slant(beyond, down.wrapping_add(1));
        Some(RatioSlants {
            first,
            zeros,
            q: Slant {
                origin: q.origin.wrapping_add_unsigned(first),
                ..q
            },
            others: others.map(|other| slant(other, down)),
        })
    }

    /// One of [`Self::slants`], for processors whose products have 32 bits.
    // A function of its own: two copies are a kilobyte.
    #[inline(never)]
    fn narrow_slant(&self, beyond_first: [i32; 2], inverse: (u32, u32), bits: u32) -> Slant {
        self.slant(self.narrow_gradient(beyond_first, inverse), bits)
    }

    /// From a gradient in 8.40.
    // A function of its own: two copies are too much for what large triangles need once.
    #[inline(never)]
    fn slant(&self, [right, down]: [i64; 2], bits: u32) -> Slant {
        let (pixel, [x, y]) = self.first_pixel();
        let at_pixel = product_with_short(right, x).wrapping_add(product_with_short(down, y));
        let cut = 40u32.wrapping_sub(bits) & 31;
        let half = 1i64 << cut >> 1;
        let [at_pixel, right, down] = [at_pixel >> SUBPIXEL_BITS, right, down]
            .map(|value| (value.wrapping_add(half) >> cut) as i32);
        Slant::through(pixel, at_pixel, [right, down])
    }

    /// How coordinates that span less than a repeat change over a pixel to the right and down, with
    /// [`SHORT_BITS`]: to within 2^-15 of that, and rounded down. `None` unless words hold all of it: for corners
    /// less than 16 pixels from the first, both ways, and changes below an eighth of a repeat a pixel.
    #[inline]
    fn short_gradients<const N: usize>(
        &self,
        beyond_first: [[i32; 2]; N],
    ) -> Option<[(i32, i32); N]> {
        let [[bx, by], [cx, cy]] = self.sides;
        let area = self.twice_area as u32;
        if !are_within([bx, by, cx, cy], 1 << 12) || area >> 24 != 0 {
            return None;
        }
        // Products have 28 bits.
        let slopes = beyond_first.map(|[b, c]| {
            [
                b.wrapping_mul(cy).wrapping_sub(c.wrapping_mul(by)),
                c.wrapping_mul(bx).wrapping_sub(b.wrapping_mul(cx)),
            ]
        });
        // 2^30 2^8 2^-16 slope / (2 area) = slope 2^up (2^48 / m) 2^-18, where 2 area = m 2^-(8 + up).
        let zeros = leading_zeros_from(8, area);
        let inverse = quotient_apart(area << (zeros & 31) >> 16).cast_signed();
        let up = zeros.wrapping_sub(8) & 31;
        let gradient = |slope: i32| times_quotient(slope << up, inverse);
        let limit = 1 << 28 >> up;
        (slopes
            .iter()
            .all(|[x, y]| are_within([*x, *y, 0, 0], limit)))
        .then(|| slopes.map(|[x, y]| (gradient(x), gradient(y))))
    }

    /// How two coordinates change over a pixel to the right and down, 8.40, rounded down.
    #[inline]
    fn wide_gradients(
        &self,
        beyond_first: [[i32; 2]; 2],
        (inverse, exponent): (u32, u32),
    ) -> [[i64; 2]; 2] {
        // 2^40 2^8 2^-16 slope / (2 area): slope (2^62 / m) 2^(1 - e). Shifted up so that the product's
        // upper words are what is wanted, as far as sides have room: slivers have less.
        let [[bx, by], [cx, cy]] = self.sides;
        let room = magnitudes([bx, by, cx, cy]).leading_zeros().wrapping_sub(1);
        let up = 33u32.saturating_sub(exponent).min(room & 31);
        // All products before the branch: a 32-bit processor's compiler sees that they are short.
        let products = beyond_first.map(|[b, c]| {
            let slopes = self.slopes([0, b, c], up);
            slopes.map(|slope| long_product(slope, inverse.cast_signed()))
        });
        let down = exponent.wrapping_add(up).wrapping_sub(1);
        if down == 32 {
            products.map(|products| products.map(|(upper, _)| upper))
        } else {
            products.map(|products| products.map(|product| shifted_far(product, down)))
        }
    }

    /// One of [`Self::wide_gradients`] for processors whose products have 32 bits.
    #[inline]
    fn narrow_gradient(&self, [b, c]: [i32; 2], (inverse, exponent): (u32, u32)) -> [i64; 2] {
        let up = u32::from(exponent == 0);
        let down = exponent.wrapping_add(up).wrapping_sub(1);
        self.slopes([0, b, c], up)
            .map(|slope| shifted_far(long_product(slope, inverse.cast_signed()), down))
    }

    /// The pixel whose centre is the first at the first corner or right of it and below, and how many
    /// subpixels it is beyond the corner: less than a pixel.
    #[inline]
    pub(crate) fn first_pixel(&self) -> ([i32; 2], [i32; 2]) {
        let [a, ..] = self.vertices;
        let corner = [a.x(), a.y()].map(I24F8::to_bits);
        (
            corner.map(first_centre),
            corner.map(|c| (SUBPIXELS / 2).wrapping_sub(c) & (SUBPIXELS - 1)),
        )
    }

    /// Planes through values at the corners, each `0 <= value < 2^31`, but for a factor that all
    /// have in common: for those of which only ratios count.
    ///
    /// The factor is twice the area over a power of two, `2^30 .. 2^31`, and for slivers less.
    #[inline]
    pub(crate) fn ratio_planes<const N: usize>(&self, values: [[i32; 3]; N]) -> RatioPlanes<N> {
        // How planes change over a subpixel, all that is above 2^32.
        let mut steep = 0;
        let [[bx, by], [cx, cy]] = self.sides;
        let (area_high, area_low) = ((self.twice_area >> 32) as u32, self.twice_area as u32);
        if area_high == 0 && area_low >> 31 == 0 {
            // The sides are shifted up, as far as they have room.
            let widest =
                bx.unsigned_abs() | by.unsigned_abs() | cx.unsigned_abs() | cy.unsigned_abs();
            let wanted = area_low.leading_zeros().wrapping_sub(1);
            let room = widest.leading_zeros().wrapping_sub(1);
            let up = wanted.min(room) & 31;
            let planes = values.map(|values| {
                let [first, ..] = values;
                let [x, y] = self.slopes(values, up);
                steep |= upper_magnitude(x) | upper_magnitude(y);
                self.plane_from_first(product(first, (area_low << up).cast_signed()), x, y)
            });
            RatioPlanes {
                planes,
                is_full: up == wanted,
                are_steep: steep >= STEEP,
            }
        } else {
            let down = 33u32.wrapping_sub(self.twice_area.leading_zeros()) & 31;
            let planes = values.map(|values| {
                let [first, ..] = values;
                let [x, y] = self.slopes(values, 0);
                // 71 bits, of which the lowest that are shifted out count for nothing.
                let first = i64::from(first);
                let high = first.wrapping_mul(i64::from(area_high)) << ((32 - down) & 63);
                let low = first.wrapping_mul(i64::from(area_low)) >> down;
                steep |= upper_magnitude(x >> down) | upper_magnitude(y >> down);
                self.plane_from_first(high.wrapping_add(low), x >> down, y >> down)
            });
            RatioPlanes {
                planes,
                is_full: true,
                are_steep: steep >= STEEP,
            }
        }
    }

    /// The slopes of a plane in x and y times `twice_area 2^up`: Cramer's rule.
    #[inline]
    fn slopes(&self, [first, second, third]: [i32; 3], up: u32) -> [i64; 2] {
        let [[bx, by], [cx, cy]] = self.sides;
        let (b, c) = (second.wrapping_sub(first), third.wrapping_sub(first));
        let [bx, by, cx, cy] = [bx, by, cx, cy].map(|side| side << up);
        [
            difference_of_products([b, cy], [c, by]),
            difference_of_products([c, bx], [b, cx]),
        ]
    }

    /// From the value at the first corner and the changes over a subpixel.
    #[inline]
    fn plane_from_first(&self, first: i64, x: i64, y: i64) -> Plane {
        let (pixel, [right, down]) = self.first_pixel();
        Plane {
            centre: first
                .wrapping_add(product_with_short(x, right))
                .wrapping_add(product_with_short(y, down)),
            x: x << SUBPIXEL_BITS,
            y: y << SUBPIXEL_BITS,
            pixel,
        }
    }
}

/// What [`TriangleSetup::ratio_slants`] finds.
pub(crate) struct RatioSlants<const N: usize> {
    /// 1/w at the first corner, `2^25 .. 2^26`: what was given times twice the area, in square subpixels, and
    /// `2^(zeros - 15)`.
    pub(crate) first: u32,
    pub(crate) zeros: u32,
    /// 1/w.
    pub(crate) q: Slant,
    /// The others, twice as large.
    pub(crate) others: [Slant; N],
}

/// Planes of which only ratios count.
pub(crate) struct RatioPlanes<const N: usize> {
    pub(crate) planes: [Plane; N],
    /// Whether the factor that they have in common has 31 bits.
    pub(crate) is_full: bool,
    /// Whether one of them changes by 2^60 or more over a pixel to the right or down, so that [`Plane::step_x`] or
    /// [`Plane::step_y`] may be far from that.
    pub(crate) are_steep: bool,
}

/// Over a subpixel, in 2^32: 2^60 over a pixel.
const STEEP: u32 = 1 << (60 - SUBPIXEL_BITS - 32);

/// The upper word's bits, without the sign.
#[inline]
fn upper_magnitude(n: i64) -> u32 {
    let upper = (n >> 32) as i32;
    (upper ^ (upper >> 31)).cast_unsigned()
}

/// Of a box, from how far two corners are from the first.
#[inline]
fn side(b: i32, c: i32) -> u32 {
    b.max(c).max(0).abs_diff(b.min(c).min(0))
}

/// The bits of all these without their signs: those of one less where one is negative.
#[inline]
pub(crate) fn magnitudes(numbers: [i32; 4]) -> u32 {
    let [a, b, c, d] = numbers.map(|n| n ^ (n >> 31));
    (a | b | c | d).cast_unsigned()
}

/// Whether all are at least `-limit` and below `limit`, a power of two.
#[inline]
fn are_within<const N: usize>(numbers: [i32; N], limit: u32) -> bool {
    let bits = |all: u32, n: i32| all | limit.wrapping_add_signed(n);
    numbers.into_iter().fold(0, bits) & limit.wrapping_mul(2).wrapping_neg() == 0
}

/// `a b - c d`.
#[inline]
fn difference_of_products([a, b]: [i32; 2], [c, d]: [i32; 2]) -> i64 {
    product(a, b).wrapping_sub(product(c, d))
}

/// `2^62 / m` and `e` of a number `m 2^(e - 31)`, not 0, of which m has 32 bits.
#[inline]
pub(crate) fn inverse(n: u64) -> (u32, u32) {
    let (high, low) = ((n >> 32) as u32, n as u32);
    // The top 32 bits: short by less than 2^-31 of the value.
    let (head, exponent) = if high == 0 {
        let zeros = leading_zeros(low);
        (low << (zeros & 31), 31u32.wrapping_sub(zeros))
    } else {
        let zeros = leading_zeros(high);
        let head = high << (zeros & 31) | low >> 1 >> (31u32.wrapping_sub(zeros) & 31);
        (head, 63u32.wrapping_sub(zeros))
    };
    (reciprocal_apart(head), exponent)
}

/// `n / (2 area)` with 31 fraction bits, rounded down, modulo 2^64; |n| < 2^52.
#[inline]
fn over_area(n: i64, (inverse, shift): (u32, u32)) -> i64 {
    // n 2^31 / (m 2^e) = n (2^62 / m) >> (31 + e), where 31 + e = 0 .. 39.
    shifted_far(long_product(n, inverse.cast_signed()), shift)
}

/// The lower 64 bits of a product that is shifted down, by less than 64.
#[inline]
fn shifted_far(product: (i64, u32), shift: u32) -> i64 {
    if shift >= 32 {
        product.0 >> (shift & 31)
    } else {
        shifted_down(product, shift)
    }
}

/// A linear function of the screen, modulo 2^64.
///
/// Those of [`TriangleSetup::plane`] have [`Self::FRACTION_BITS`] fraction bits. At pixel centres inside its triangle the value is between the values at the corners, give or
/// take its error; outside it may wrap around. Within the triangle the error is at most
///
/// - a move of the sample position towards or away from the first corner by 2^-29 of its distance, less
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
    /// At the centre of `pixel`.
    centre: i64,
    /// Change over a pixel.
    x: i64,
    y: i64,
    /// The first corner's, see [`TriangleSetup::first_pixel`].
    pixel: [i32; 2],
}

impl Plane {
    /// Bits of a value behind the binary point; corner values have none.
    pub const FRACTION_BITS: u32 = 31;

    /// The value at the centre of a pixel, at most 2^15 columns and rows from the first corner's.
    #[inline]
    #[must_use]
    pub fn at(&self, x: i32, y: i32) -> i64 {
        let [from_x, from_y] = self.pixel;
        self.centre
            .wrapping_add(product_with_short(self.x, x.wrapping_sub(from_x)))
            .wrapping_add(product_with_short(self.y, y.wrapping_sub(from_y)))
    }

    /// The first corner's pixel.
    #[inline]
    pub(crate) const fn pixel(&self) -> [i32; 2] {
        self.pixel
    }

    /// The value at the centre of that.
    #[inline]
    pub(crate) fn at_pixel(&self) -> i64 {
        self.centre
    }

    /// The change from one pixel to the next on its right, modulo 2^64: where a triangle is less than a pixel wide
    /// there, the value may change by more.
    #[inline]
    #[must_use]
    pub const fn step_x(&self) -> i64 {
        self.x
    }

    /// The change from one pixel to the next one below, modulo 2^64: where a triangle is less than a pixel high
    /// there, the value may change by more.
    #[inline]
    #[must_use]
    pub const fn step_y(&self) -> i64 {
        self.y
    }
}

#[cfg(test)]
mod tests {
    use fixed::types::I16F16;

    use super::*;

    /// All ways to find gradients, for triangles of all sizes and spans.
    #[test]
    fn gradients_of_all_arithmetic_are_the_same() {
        let mut state = 1u32;
        let mut next = |bits: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state ^ state >> 15).cast_signed() >> (32 - bits)
        };
        let (mut short, mut slivers) = (0, 0);
        for case in 0..200_000 {
            // To the guard band's limits, and to less than 128 repeats.
            let (size, span) = (4 + case % 16, 1 + case / 16 % 23);
            let vertex = |[x, y]: [i32; 2]| {
                let [x, y] = [x, y].map(I24F8::from_bits);
                ScreenVertex::new(x, y, I16F16::ONE, [I16F16::ZERO; 2]).expect("on the screen")
            };
            let vertices = [0; 3].map(|_| vertex([next(size), next(size)]));
            let Some(triangle) = TriangleSetup::new(&vertices, Cull::Off) else {
                continue;
            };
            let beyond = [[next(span), next(span)], [next(span), next(span)]];
            let inverse = triangle.inverse_area();
            let wide = triangle.wide_gradients(beyond, inverse);
            let narrow = beyond.map(|each| triangle.narrow_gradient(each, inverse));
            assert_eq!(wide, narrow, "{triangle:?} {beyond:?}");
            if span <= 17
                && let Some(found) = triangle.short_gradients(beyond)
            {
                for ((right, down), wide) in found.into_iter().zip(wide) {
                    for (found, wide) in [right, down].into_iter().zip(wide) {
                        // Rounded down, and what is compared with as well.
                        let off = (i64::from(found) << (40 - SHORT_BITS)) - wide;
                        let most = (wide.abs() >> 15) + 2 + (1 << (40 - SHORT_BITS));
                        assert!(off.abs() <= most, "{triangle:?} {beyond:?}: {off}");
                    }
                }
                short += 1;
            }
            slivers += u32::from(inverse.1 < 8);
        }
        assert!(short > 10_000 && slivers > 1_000, "{short} {slivers}");
    }
}
