//! How long pieces of a scanline may be, from its two ends.

use core::num::NonZeroU32;

use crate::arith::leading_zeros;
use crate::uv::Uv;

/// Pieces of this length and more are made one by one.
pub(super) const LONG: u32 = 32;

/// The most pieces of a group, a power of two.
const GROUP: u32 = 16;

/// The ends of a span.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends {
    pub(super) steps: u32,
    /// 1/w.
    pub(super) q: [u32; 2],
    pub(super) uv: [Uv; 2],
}

impl Ends {
    /// 1/w at the nearer end and at the farther one.
    #[inline]
    pub(super) fn by_nearness(&self) -> [u32; 2] {
        let [p, q] = self.q;
        [p.max(q), p.min(q)]
    }

    /// How much 1/w changes at most: words may be half a unit off for each pixel.
    #[inline]
    pub(super) fn change(&self) -> u32 {
        let [p, q] = self.q;
        p.abs_diff(q).saturating_add(self.steps.wrapping_add(3))
    }
}

/// How long pieces of a scanline may be: `n^2 <= q max(c, t q^2)`, with q = 1/w at the piece's farther end, or a
/// quarter of the way to the nearer one, in units in which the largest has 0 bits before the point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rule {
    /// 1/w rises along the scanline.
    rises: bool,
    /// How much it does in a pixel, at least; how much it falls, at most.
    slope: u32,
    /// The largest 1/w, and the shift that gives it 32 bits.
    near: u32,
    up: u32,
    /// c, in 2^-16, and t, of 16 bits, in `2^down`.
    constant: u32,
    square: u32,
    down: u32,
}

/// A number that is not negative, rounded down: a mantissa of 16 bits, and the base-2 logarithm of its unit.
#[derive(Clone, Copy, Debug)]
struct Short {
    mantissa: u32,
    exponent: i32,
}

impl Short {
    /// `n / d`.
    #[inline]
    fn ratio(n: u32, d: u32) -> Self {
        let (n_zeros, d_zeros) = (leading_zeros(n), leading_zeros(d));
        let divisor = NonZeroU32::MIN.saturating_add((d << d_zeros) >> 16);
        // 15 to 17 bits.
        let quotient = (n << n_zeros) / divisor;
        Self {
            mantissa: quotient >> 1,
            exponent: d_zeros
                .cast_signed()
                .wrapping_sub(n_zeros.cast_signed())
                .wrapping_sub(15),
        }
    }
}

impl Rule {
    /// From the ends of a scanline, which are `distance` 2^-12 texels apart, rounded up.
    ///
    /// L steps from a to b make `k = (a - b) / L` and `D = |du| a b / L`: hence `c = 4 bound L / (a - b)` and
    /// `t = c L / (|du| a b)`.
    #[inline]
    pub(super) fn new(bound: u32, ends: &Ends, q_step: i32, distance: u32) -> Self {
        let [near, far] = ends.by_nearness();
        let up = leading_zeros(near);
        let apart = ends.change().min(near) << up;
        // 2^-12 footprints, times 4, over 2^-32.
        let footprints = Short::ratio(bound.min(1 << 20).wrapping_mul(ends.steps), apart);
        let constant_exponent = footprints.exponent.wrapping_add(22);
        // a b in 2^-31, and of that and the distance 16 bits and 15, all rounded up.
        let [a, b] = [(near << up) >> 17, (far << up) >> 16].map(|head| head.wrapping_add(1));
        let product = a.wrapping_mul(b);
        let (product_zeros, distance_zeros) = (leading_zeros(product), leading_zeros(distance));
        let product = ((product << product_zeros) >> 16).wrapping_add(1);
        let distance = ((distance << distance_zeros) >> 17).wrapping_add(1);
        let more = Short::ratio(ends.steps, product.wrapping_mul(distance));
        let square = footprints.mantissa.wrapping_mul(more.mantissa) >> 16;
        let square_exponent = constant_exponent
            .wrapping_add(more.exponent)
            .wrapping_add_unsigned(product_zeros.wrapping_add(distance_zeros))
            .wrapping_add(10 + 16);
        let exponent = constant_exponent.max(square_exponent);
        let below = |other: i32| exponent.wrapping_sub(other).min(31).cast_unsigned();
        let rises = ends.q[1] > ends.q[0];
        Self {
            rises,
            slope: if rises {
                q_step.unsigned_abs().saturating_sub(1)
            } else {
                q_step.unsigned_abs().wrapping_add(1)
            },
            near,
            up,
            constant: (footprints.mantissa << 16) >> below(constant_exponent),
            square: square >> below(square_exponent),
            down: 16i32.wrapping_sub(exponent).clamp(0, 31).cast_unsigned(),
        }
    }

    /// The square of the longest piece, given 1/w.
    #[inline]
    fn square(&self, q: u32) -> u32 {
        // 16 bits each.
        let q = (q << (self.up & 31)) >> 16;
        let texels = (q.wrapping_mul(self.square) >> 16).wrapping_mul(q);
        (texels.max(self.constant) >> 16).wrapping_mul(q) >> (self.down & 31)
    }

    /// The length of a piece, from that of the one before, or from 0, and how many such pieces there are one after
    /// another, as far as there are so many pixels.
    #[inline(never)]
    pub(super) fn next(&self, q: u32, before: u32, most: u32, pixels: u32) -> (u32, u32) {
        let mut length = before;
        if self.rises || before == 0 {
            let square = self.square_ahead(q, length);
            let mut next = longer(length);
            while next <= most && next.wrapping_mul(next) <= square {
                (length, next) = (next, longer(next));
            }
        }
        while length > 1 {
            let mut count = group(length, pixels);
            loop {
                let before = count.wrapping_sub(1).wrapping_mul(length);
                let change = before.wrapping_mul(self.slope);
                let is_right = if self.rises {
                    // The last should not have room for more.
                    let longer = longer(length);
                    count == 1
                        || longer.wrapping_mul(longer)
                            > self.square_ahead(q.saturating_add(change), length)
                } else {
                    // The last has the least room.
                    self.holds(q.saturating_sub(change), length)
                };
                if is_right {
                    return (length, count);
                }
                if count == 1 {
                    break;
                }
                count >>= 1;
            }
            length = shorter(length);
        }
        (1, 1)
    }

    /// The same for pieces of at least such a length where 1/w rises.
    #[inline]
    fn square_ahead(&self, q: u32, length: u32) -> u32 {
        let reach = length.wrapping_mul(self.slope).min(q) >> 2;
        self.square(q.saturating_add(reach).min(self.near))
    }

    /// Whether a piece may be so long where 1/w falls.
    #[inline]
    fn holds(&self, q: u32, length: u32) -> bool {
        let reach = length.wrapping_mul(self.slope);
        // No farther than to twice the depth.
        reach <= q >> 1
            && length.wrapping_mul(length)
                <= self.square(q.saturating_sub(reach).wrapping_add(reach >> 2))
    }
}

/// How many pieces of a length are made at a time, at most, in so many pixels.
#[inline]
fn group(length: u32, pixels: u32) -> u32 {
    if length < LONG {
        (pixels >> (length.trailing_zeros() & 31)).clamp(1, GROUP)
    } else {
        1
    }
}

/// The length after another, from 0 on: 4, 8, 16, 32, and from there by an eighth to a quarter more.
#[inline]
fn longer(length: u32) -> u32 {
    match length {
        0..=1 => 4,
        2..LONG => length << 1,
        _ => length.wrapping_add(length >> 5 << 3),
    }
}

/// The length before another, from 4 on: of [`LONG`] and more any, of less a power of two.
#[inline]
fn shorter(length: u32) -> u32 {
    match length {
        0..=4 => 1,
        5..=LONG => length >> 1,
        _ => length.wrapping_sub(length >> 5 << 3).max(LONG),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Random(u32);

    impl Random {
        fn next(&mut self) -> u32 {
            self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            self.0 ^ self.0 >> 15
        }

        fn below(&mut self, most: u32) -> u32 {
            ((u64::from(self.next()) * u64::from(most)) >> 32) as u32
        }
    }

    /// Against float64: never longer, and little shorter.
    #[test]
    fn lengths_are_rounded_down() {
        let mut random = Random(1);
        let mut checked = 0;
        for round in 0..200_000 {
            let near = random.next() >> (round % 4) | 1 << 27;
            let apart = (random.below(near) >> (round % 12)).max(near >> 16);
            let far = (near - apart).max(near >> 3);
            let steps = 2 + random.below(1 << (2 + round % 10));
            let distance = 1 + (random.next() >> (5 + round % 19));
            let bound = random.below(1 << (1 + round % 20));
            let rises = round % 2 == 0;
            let ends = Ends {
                steps,
                q: if rises { [far, near] } else { [near, far] },
                uv: [Uv::default(); 2],
            };
            let rule = Rule::new(bound, &ends, 0, distance);
            let q = far + random.below(near - far + 1);
            let exact = |apart: u32| {
                let [a, b, q, l] = [near, far, q, steps].map(f64::from);
                let (bound, du) = (f64::from(bound) / 4096.0, f64::from(distance) / 4096.0);
                let (k, d) = (f64::from(apart) / l, du * a * b / l);
                4.0 * bound / (k * d) * q * d.max(q * q)
            };
            let found = f64::from(rule.square(q));
            // A piece of one step is exact.
            assert!(found <= exact(near - far).max(1.0), "{round}: {found}");
            // Heads of 14 bits and more, and at an eighth of the largest 1/w six bits of t q^2.
            let least = exact(ends.change()) * (1.0 - 1.0 / 64.0 - 1.0 / 256.0) - 1.0;
            if (16.0..1e6).contains(&least) {
                checked += 1;
                assert!(found >= least, "{round}: {found}, and not {least}");
            }
        }
        assert!(checked > 50_000, "{checked}");
    }

    /// A piece may reach beyond the nearer end: 1/w counts as no more than there, where it has all its bits.
    #[test]
    fn nothing_is_nearer_than_the_nearer_end() {
        for near in [u32::MAX, u32::MAX >> 3, (1 << 30) + 12_345] {
            let ends = Ends {
                steps: 100,
                q: [near / 4, near],
                uv: [Uv::default(); 2],
            };
            let step = (near / 4 * 3 / 100).cast_signed();
            let rule = Rule::new(1 << 10, &ends, step, 1 << 20);
            let most = rule.square(near);
            assert!(most > rule.square(near / 2), "{near:#x}: {most}");
            for length in [1, 16, 1024] {
                assert_eq!(rule.square_ahead(near, length), most, "{near:#x} {length}");
            }
        }
    }

    /// Groups where 1/w falls keep the bound to the end, and where it rises are not far too short.
    #[test]
    fn lengths_are_those_of_the_rule() {
        let mut random = Random(2);
        for round in 0..20_000 {
            let near = random.next() | 1 << 31;
            let far = near / (2 + random.below(60));
            let steps = 64 + random.below(900);
            let slope = ((near - far) / steps).cast_signed();
            let rises = round % 2 == 0;
            let ends = Ends {
                steps,
                q: if rises { [far, near] } else { [near, far] },
                uv: [Uv::default(); 2],
            };
            let (bound, distance) = (1 << (5 + round % 12), 1 + random.below(1 << 24));
            let rule = Rule::new(bound, &ends, if rises { slope } else { -slope }, distance);
            let (mut offset, mut length) = (0, 0);
            let mut before = 0;
            while offset < steps {
                let q = |pixels: u32| {
                    let far = slope.cast_unsigned() * pixels;
                    if rises {
                        ends.q[0] + far
                    } else {
                        ends.q[0] - far
                    }
                };
                let count;
                (length, count) = rule.next(q(offset), length, 1024, steps - offset);
                assert!(matches!(length, 1 | 4 | 8 | 16 | LONG..), "{length}");
                assert!(count == 1 || length < LONG && count * length <= steps - offset);
                if before > 0 {
                    assert!(if rises {
                        length >= before
                    } else {
                        length <= before
                    });
                }
                let end = offset + length * count;
                if end <= steps && length > 1 {
                    // Where there is least room for it.
                    let q = if rises { q(offset) } else { q(end) };
                    let square = f64::from(rule.square(q.saturating_add(q >> 2)));
                    assert!(f64::from(length * length) <= square, "{round}: {length}");
                }
                (offset, before) = (end, length);
            }
        }
    }
}
