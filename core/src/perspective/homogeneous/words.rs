//! Divisions from single words of the planes: for triangles whose depths do not differ much.

use super::{Homogeneous, Point, Weights};
use crate::arith::{leading_zeros_from, multiply_high, reciprocal};
use crate::setup::{Plane, TriangleSetup};
use crate::span::Span;
use crate::uv::Uv;

/// Bits that 1/w may lose where it is least: of 30 or 31, so that depths differ by up to 64 or 128.
const BITS: u32 = 6;

/// 1/w, u/w and v/w at a point, or how they change, without their lower words.
#[derive(Clone, Copy, Debug)]
pub(in crate::perspective) struct Words {
    /// With 32 bits.
    pub(in crate::perspective) q: u32,
    /// With 31 bits and a sign.
    pub(in crate::perspective) u: i32,
    pub(in crate::perspective) v: i32,
}

impl Point {
    /// The upper words once the values are shifted up so far.
    #[inline]
    pub(in crate::perspective) fn shifted_words(&self, shift: u32) -> Words {
        let Weights { q, u, v } = self.0;
        let upper = |value: i64| (value.wrapping_shl(shift) >> 32) as i32;
        Words {
            q: upper(q).cast_unsigned(),
            u: upper(u),
            v: upper(v),
        }
    }

    /// Whether a change is all in words that are shifted up so far, with a bit to spare.
    #[inline]
    fn fits(&self, shift: u32) -> bool {
        let Weights { q, u, v } = self.0;
        let fits = |step: i64| (step ^ (step >> 63)).leading_zeros() > shift.wrapping_add(1);
        fits(q) && fits(u) && fits(v)
    }

    /// The upper words.
    #[inline]
    pub(in crate::perspective) fn words(&self) -> Words {
        let Weights { q, u, v } = self.0;
        Words {
            q: (q >> 30) as u32,
            u: (u >> 30) as i32,
            v: (v >> 30) as i32,
        }
    }
}

impl Words {
    /// Farther to the right by a leap.
    #[inline]
    pub(in crate::perspective) fn after(self, leap: Self) -> Self {
        Self {
            q: self.q.wrapping_add(leap.q),
            u: self.u.wrapping_add(leap.u),
            v: self.v.wrapping_add(leap.v),
        }
    }

    /// How far they can be shifted up until 1/w has its highest bit.
    #[inline]
    pub(super) fn zeros(self) -> u32 {
        leading_zeros_from(0, self.q)
    }

    /// Shifted up, by less than 32 bits.
    #[inline]
    pub(super) fn up(self, bits: u32) -> Self {
        Self {
            q: self.q.wrapping_shl(bits),
            u: self.u.wrapping_shl(bits),
            v: self.v.wrapping_shl(bits),
        }
    }

    /// So many times the change.
    #[inline]
    fn times(self, n: i32) -> Self {
        Self {
            q: self.q.wrapping_mul(n.cast_unsigned()),
            u: self.u.wrapping_mul(n),
            v: self.v.wrapping_mul(n),
        }
    }
}

/// What lies behind words, in 2^-16.
#[derive(Clone, Copy, Debug)]
struct Parts {
    q: u16,
    u: u16,
    v: u16,
}

impl Parts {
    /// Of a point's values.
    #[inline]
    fn new(Point(Weights { q, u, v }): Point) -> Self {
        let part = |value: i64| (value >> 14) as u16;
        Self {
            q: part(q),
            u: part(u),
            v: part(v),
        }
    }
}

/// Words along a span, at any pixel: they do not gain an error from one to the next.
#[derive(Clone, Copy, Debug)]
pub(in crate::perspective) struct WordLine {
    pub(in crate::perspective) first: Words,
    /// From one pixel to the next, and what lies behind.
    pub(in crate::perspective) step: Words,
    part: Parts,
}

impl WordLine {
    /// So many pixels from the first, below 2^11: less than a unit and a half below the first's.
    #[inline]
    pub(in crate::perspective) fn at(&self, pixels: u32) -> Words {
        self.first.after(self.change(pixels, 0))
    }

    /// The change over one pixel, shifted up by up to 15 bits and rounded to nearest.
    #[inline]
    pub(super) fn step_up(&self, bits: u32) -> Words {
        let behind = |part: u16| (u32::from(part).wrapping_shl(bits).wrapping_add(1 << 15)) >> 16;
        let Parts { q, u, v } = self.part;
        self.step.up(bits).after(Words {
            q: behind(q),
            u: behind(u).cast_signed(),
            v: behind(v).cast_signed(),
        })
    }

    /// The change over so many pixels, up to 64, rounded to nearest.
    #[inline]
    pub(in crate::perspective) fn leap(&self, pixels: u32) -> Words {
        self.change(pixels, 1 << 15)
    }

    /// With so much added, in 2^-16, before the rest is cut off.
    #[inline]
    fn change(&self, pixels: u32, added: i32) -> Words {
        let pixels = pixels.cast_signed();
        let behind = |part: u16| i32::from(part).wrapping_mul(pixels).wrapping_add(added) >> 16;
        let Parts { q, u, v } = self.part;
        self.step.times(pixels).after(Words {
            q: behind(q).cast_unsigned(),
            u: behind(u),
            v: behind(v),
        })
    }
}

/// The planes of a triangle in words.
#[derive(Clone, Copy, Debug)]
pub struct WordPlanes {
    /// The first corner's.
    pixel: [i32; 2],
    /// There, and the changes to the right and down.
    words: [Words; 3],
    /// Behind those; half a unit more at the pixel, as what is left of sums is cut off.
    parts: [Parts; 3],
    /// Whether the change down is all in its words.
    down_fits: bool,
    /// See [`Homogeneous`].
    pub(super) first: Uv,
    /// Two less than there, as words don't have these bits.
    pub(super) down: u32,
}

impl WordPlanes {
    /// Of planes that use all their bits, with coordinates within 32 repeats. `None` unless the depths of
    /// the corners do not differ much, see [`BITS`].
    #[inline]
    pub(super) fn new(of: &Homogeneous, inverses: [i32; 3]) -> Option<Self> {
        let [p, q, r] = inverses;
        if p.min(q).min(r) < 1 << (30 - BITS) {
            return None;
        }
        let point = |each: fn(&Plane) -> i64| {
            let Weights { q, u, v } = &of.planes;
            Point(Weights {
                q: each(q),
                u: each(u),
                v: each(v),
            })
        };
        let half = |value: i64| value.wrapping_add(1 << 29);
        let Weights { q, u, v } = point(Plane::at_pixel).0;
        let down = point(Plane::step_y);
        let points = [
            Point(Weights {
                q: half(q),
                u: half(u),
                v: half(v),
            }),
            point(Plane::step_x),
            down,
        ];
        Some(Self {
            pixel: of.planes.q.pixel(),
            words: points.each_ref().map(Point::words),
            parts: points.map(Parts::new),
            down_fits: !of.are_steep,
            first: of.first,
            down: of.down.wrapping_sub(2) & 31,
        })
    }

    /// At a pixel of the triangle, rounded to nearest but for a sixteenth of a unit.
    #[inline]
    fn at(&self, x: i32, y: i32) -> Words {
        let [from_x, from_y] = self.pixel;
        // 2^12 at most, so that products of parts have 29 bits.
        let (x, y) = (x.wrapping_sub(from_x), y.wrapping_sub(from_y));
        let [first, right, down] = self.parts;
        let sum = |first: u16, right: u16, down: u16| {
            i32::from(first)
                .wrapping_add(i32::from(right).wrapping_mul(x))
                .wrapping_add(i32::from(down).wrapping_mul(y))
                >> 16
        };
        let behind = Words {
            q: sum(first.q, right.q, down.q).cast_unsigned(),
            u: sum(first.u, right.u, down.u),
            v: sum(first.v, right.v, down.v),
        };
        let [first, right, down] = self.words;
        first
            .after(right.times(x))
            .after(down.times(y))
            .after(behind)
    }
}

impl WordPlanes {
    /// The words along a span, at any pixel.
    #[inline]
    pub(in crate::perspective) fn line(&self, span: Span) -> WordLine {
        let ([_, step, _], [_, part, _]) = (self.words, self.parts);
        WordLine {
            first: self.at(span.left, span.y),
            step,
            part,
        }
    }

    /// How words change from one row to the next; `None` if that is more than they hold.
    #[inline]
    pub(in crate::perspective) fn down(&self) -> Option<Words> {
        let [_, _, down] = self.words;
        self.down_fits.then_some(down)
    }

    /// The base-2 logarithm of the repeats that a word of u/w stands for where it is 1/w.
    #[inline]
    pub(in crate::perspective) fn log2_unit(&self) -> i32 {
        6 - self.down.cast_signed()
    }

    /// u and v at a point of the triangle; see [`Homogeneous::divide`].
    #[inline]
    pub(in crate::perspective) fn divide(&self, at: Words) -> Uv {
        let Words { q, u, v } = at.up(at.zeros());
        let inverse = reciprocal(q).cast_signed();
        let coordinate =
            |value: i32, first: i32| first.wrapping_add(multiply_high(value, inverse) >> self.down);
        Uv::from_bits(
            coordinate(u, self.first.u.to_bits()),
            coordinate(v, self.first.v.to_bits()),
        )
    }
}

impl Homogeneous {
    /// How words that are shifted up so far change from one row to the next; `None` if that is
    /// more than they hold.
    #[inline]
    pub(in crate::perspective) fn words_down(&self, shift: u32) -> Option<Words> {
        let Weights { q, u, v } = &self.planes;
        let down = Point(Weights {
            q: q.step_y(),
            u: u.step_y(),
            v: v.step_y(),
        });
        let fits = !self.are_steep && down.fits(shift);
        fits.then(|| down.shifted_words(shift))
    }

    /// See [`WordPlanes::log2_unit`].
    #[inline]
    pub(in crate::perspective) fn log2_unit(&self) -> i32 {
        8 - self.down.cast_signed()
    }
}

/// The planes of a triangle that is not small.
#[derive(Clone, Copy, Debug)]
pub(in crate::perspective) enum Large<'p> {
    /// Words will do.
    Words(&'p WordPlanes),
    /// They won't.
    Whole(&'p Homogeneous),
}

/// Planes with all their bits, and their words if these will do.
#[derive(Clone, Copy, Debug)]
pub struct WithWords {
    pub(in crate::perspective) planes: Homogeneous,
    words: Option<WordPlanes>,
}

impl WithWords {
    /// `None` if u or v spans 128 repeats or more.
    #[inline]
    pub(in crate::perspective) fn new(triangle: &TriangleSetup<'_>) -> Option<Self> {
        Homogeneous::biased(triangle, 0, |planes, words| Self { planes, words })
    }

    /// Those to divide by.
    #[inline]
    pub(in crate::perspective) fn large(&self) -> Large<'_> {
        let whole = Large::Whole(&self.planes);
        self.words.as_ref().map_or(whole, Large::Words)
    }
}

#[cfg(test)]
mod tests {
    use fixed::types::{I16F16, I24F8};

    use super::*;
    use crate::project::ScreenVertex;
    use crate::setup::Cull;

    /// How far words are from the values of 64 bits, in 2^-30 units.
    fn off(Words { q, u, v }: Words, Point(exact): Point) -> [i64; 3] {
        let off = |word: i32, value: i64| {
            // Words are counted modulo 2^32.
            let difference = (i64::from(word) << 30).wrapping_sub(value);
            difference.wrapping_shl(2) >> 2
        };
        [
            off(q.cast_signed(), exact.q),
            off(u, exact.u),
            off(v, exact.v),
        ]
    }

    #[test]
    fn words_are_rounded_to_nearest() {
        const UNIT: i64 = 1 << 30;
        let vertex = |[x, y]: [i32; 2], w: i32, uv: [i32; 2]| {
            let [x, y] = [x, y].map(I24F8::from_bits);
            ScreenVertex::new(x, y, I16F16::from_bits(w), uv.map(I16F16::from_bits))
                .expect("a vertex on the screen")
        };
        for far in [1, 2, 3, 5] {
            let vertices = [
                vertex([-1000, 77], 70_001, [5, 99_999]),
                vertex([10_003, 61_234], 70_001 * far, [77_777, -3]),
                vertex([80_111, 3], 81_003, [123_456, 65_432]),
            ];
            let triangle = TriangleSetup::new(&vertices, Cull::Off).expect("an area");
            let WithWords { planes, words } = WithWords::new(&triangle).expect("few repeats");
            let words = words.expect("like depths");
            for y in [0, 1, 100, 239] {
                let (left, right) = (0, 1 << 9);
                let line = words.line(Span { y, left, right });
                for [least, most, pixels] in [[-9, 9, 0], [-25, 9, 1], [-25, 9, 300]] {
                    // Sixteenths: rounded to nearest at the first pixel, cut from there.
                    let words = line.at(pixels as u32);
                    let exact = planes.at(left + pixels, y);
                    for off in off(words, exact) {
                        let sixteenths = off * 16;
                        assert!(
                            (least.into()..=i64::from(most)).contains(&(sixteenths / UNIT)),
                            "{far} {y} {pixels}: {off}"
                        );
                    }
                }
                for pixels in [1, 16, 64] {
                    for off in off(line.leap(pixels), planes.leap(pixels)) {
                        // Parts are cut to 2^-16.
                        assert!(off.abs() <= UNIT / 2 + UNIT / 1024, "{far} {pixels}: {off}");
                    }
                }
            }
        }
    }
}
