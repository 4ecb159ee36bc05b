//! Divisions from single words of the planes: for triangles whose depths do not differ much.

use fixed::types::I8F24;

use super::{Homogeneous, Point, Weights};
use crate::arith::{add_multiply_high, leading_zeros_from, reciprocal};
use crate::setup::{Plane, TriangleSetup};
use crate::span::Span;
use crate::uv::Uv;

/// Bits that 1/w may lose where it is least: of 30 or 31, so that depths differ by up to 64 or 128.
const BITS: u32 = 6;

/// What words are less than what they stand for, where depth does not change: as many units of coordinates
/// are added to all, so that none on a texel's edge comes out before it. A unit and a half that counts once or
/// twice, and, at 32 repeats, a unit of the corners and two of the reciprocal.
const LOST: i32 = 4;

/// 1/w, u/w and v/w at a point, or how they change, without their lower words.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::perspective) struct Words {
    /// With 32 bits.
    pub(in crate::perspective) q: u32,
    /// With up to 31 bits and a sign.
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

/// The upper word of a value, shifted down by up to 16 bits more, and what lies behind it.
#[inline]
fn split(value: i64, down: u32) -> (i32, u16) {
    let (upper, behind) = ((value >> 30) as i32, (value >> 14) as u16);
    let both = upper.cast_unsigned() << 16 | u32::from(behind);
    let down = down & 31;
    (upper >> down, (both >> down) as u16)
}

/// Those of a point's values, where u/w and v/w are shifted down so far.
#[inline]
fn split_point(Point(Weights { q, u, v }): Point, down: u32) -> (Words, Parts) {
    let [q, u, v] = [split(q, 0), split(u, down), split(v, down)];
    let words = Words {
        q: q.0.cast_unsigned(),
        u: u.0,
        v: v.0,
    };
    let parts = Parts {
        q: q.1,
        u: u.1,
        v: v.1,
    };
    (words, parts)
}

/// What is added to parts, so that words are rounded to nearest, or up.
const NEAREST: u32 = 1 << 15;
const UP: u32 = (1 << 16) - 1;

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

    /// The change over one pixel, shifted up by up to 15 bits: 1/w rounded to nearest, the others up.
    #[inline]
    pub(super) fn step_up(&self, bits: u32) -> Words {
        let behind =
            |part: u16, added: u32| u32::from(part).wrapping_shl(bits).wrapping_add(added) >> 16;
        let Parts { q, u, v } = self.part;
        self.step.up(bits).after(Words {
            q: behind(q, NEAREST),
            u: behind(u, UP).cast_signed(),
            v: behind(v, UP).cast_signed(),
        })
    }

    /// The change over so many pixels, up to 64, rounded to nearest.
    #[inline]
    pub(in crate::perspective) fn leap(&self, pixels: u32) -> Words {
        self.change(pixels, NEAREST)
    }

    /// With so much added, in 2^-16, before the rest is cut off.
    #[inline]
    fn change(&self, pixels: u32, added: u32) -> Words {
        let behind = |part: u16| u32::from(part).wrapping_mul(pixels).wrapping_add(added) >> 16;
        let Parts { q, u, v } = self.part;
        self.step.times(pixels.cast_signed()).after(Words {
            q: behind(q),
            u: behind(u).cast_signed(),
            v: behind(v).cast_signed(),
        })
    }
}

/// The planes of a triangle in words.
///
/// Where 1/w has its highest bit, one of u/w and v/w stands for half a unit of 2^-24 repeats or less, whatever
/// a triangle spans: a reciprocal and a product give coordinates that only have to be added to the first.
#[derive(Clone, Copy, Debug)]
pub struct WordPlanes {
    /// The first corner's.
    pixel: [i32; 2],
    /// There, and the changes to the right and down.
    words: [Words; 3],
    /// Behind those; half a unit more at the pixel, as what is left of sums is cut off.
    parts: [Parts; 3],
    /// What coordinates are counted from; see [`Homogeneous`].
    pub(super) first: Uv,
}

impl WordPlanes {
    /// Of planes that use all their bits and are not steep, with coordinates within 32 repeats. `None` unless the
    /// depths of the corners do not differ much, see [`BITS`].
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
        // Two less than there, as words don't have these bits.
        let down = of.down.wrapping_sub(2);
        let half = |value: i64, down: u32| value.wrapping_add(1i64 << 29 << (down & 31));
        let Weights { q, u, v } = point(Plane::at_pixel).0;
        let at_pixel = Point(Weights {
            q: half(q, 0),
            u: half(u, down),
            v: half(v, down),
        });
        let points = [at_pixel, point(Plane::step_x), point(Plane::step_y)];
        let [at_pixel, right, down] = points.map(|point| split_point(point, down));
        let first = |c: I8F24| c.to_bits().wrapping_add(LOST);
        Some(Self {
            pixel: of.planes.q.pixel(),
            words: [at_pixel.0, right.0, down.0],
            parts: [at_pixel.1, right.1, down.1],
            first: Uv::from_bits(first(of.first.u), first(of.first.v)),
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
    /// Coordinates are quotients of words times a power of two of repeats: its logarithm.
    pub(in crate::perspective) const LOG2_REPEATS: i32 = 30 - Uv::FRACTION_BITS.cast_signed();

    /// At the first corner's pixel, and the changes to the right and down.
    #[inline]
    pub(in crate::perspective) fn words(&self) -> [Words; 3] {
        self.words
    }

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

    /// Whether what coordinates are counted from is 64 repeats or more from 0; they are within 32 of that.
    #[inline]
    pub(in crate::perspective) fn begin_far(&self) -> bool {
        let magnitude = |c: I8F24| c.to_bits() ^ c.to_bits() >> 31;
        (magnitude(self.first.u) | magnitude(self.first.v)) >> (Uv::FRACTION_BITS + 6) != 0
    }

    /// u and v at a point of the triangle; see [`Homogeneous::divide`].
    #[inline]
    pub(in crate::perspective) fn divide(&self, at: Words) -> Uv {
        let Words { q, u, v } = at.up(at.zeros());
        let inverse = reciprocal(q).cast_signed();
        let coordinate = |first: I8F24, over_w: i32| {
            I8F24::from_bits(add_multiply_high(first.to_bits(), over_w, inverse))
        };
        Uv {
            u: coordinate(self.first.u, u),
            v: coordinate(self.first.v, v),
        }
    }
}

/// The planes of a triangle that is not small.
#[derive(Clone, Copy, Debug)]
pub(in crate::perspective) enum Large<'p, W = WordPlanes> {
    /// Words will do.
    Words(&'p W),
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

    /// How far words are from the values of 64 bits, in units of words.
    fn off(Words { q, u, v }: Words, Point(exact): Point, down: u32) -> [f64; 3] {
        let off = |word: i32, value: i64, bits: u32| {
            // Words are counted modulo 2^32.
            let whole = (value >> bits) as i32;
            let part = (value & ((1 << bits) - 1)) as f64 / (1u64 << bits) as f64;
            f64::from(word.wrapping_sub(whole)) - part
        };
        [
            off(q.cast_signed(), exact.q, 30),
            off(u, exact.u, 30 + down),
            off(v, exact.v, 30 + down),
        ]
    }

    #[test]
    fn words_are_rounded() {
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
            let down = planes.down - 2;
            let words = words.expect("like depths");
            for y in [0, 1, 100, 239] {
                let (left, right) = (0, 1 << 9);
                let line = words.line(Span { y, left, right });
                for [least, most, pixels] in [[-9, 9, 0], [-25, 9, 1], [-25, 9, 300]] {
                    // Sixteenths: rounded to nearest at the first pixel, cut from there.
                    let words = line.at(pixels as u32);
                    for off in off(words, planes.at(left + pixels, y), down) {
                        let range = f64::from(least) / 16.0..=f64::from(most) / 16.0;
                        assert!(range.contains(&off), "{far} {y} {pixels}: {off}");
                    }
                }
                for pixels in [1, 16, 64] {
                    // Parts are cut to 2^-16.
                    let cut = f64::from(pixels) / 65_536.0;
                    for off in off(line.leap(pixels), planes.leap(pixels), down) {
                        assert!(off.abs() <= 0.5 + cut, "{far} {pixels}: {off}");
                    }
                }
                let [q, u, v] = off(line.step_up(0), planes.leap(1), down);
                assert!(q.abs() <= 0.5 + 1.0 / 65_536.0, "{far}: {q}");
                for off in [u, v] {
                    assert!((-1.0 / 65_536.0..1.0).contains(&off), "{far}: {off}");
                }
            }
        }
    }
}
