//! Points along a span of which 1/w has its highest bit: divisions without a shift of their own.

mod eights;

use core::num::NonZeroU32;

use fixed::types::I8F24;

use super::words::{WordLine, WordPlanes};
use crate::arith::{add_multiply_high, div_rem, reciprocal_of_30_bits};
use crate::uv::Uv;

/// The most points, as a power of two: words gain an error of half a unit a step and more, so they start
/// afresh from time to time.
const LOG2_MOST: u32 = 7;

/// Consecutive points of a span of which 1/w is between two powers of two, where the three words can
/// be shifted by the same number of bits each.
#[derive(Clone, Copy, Debug)]
pub(in crate::perspective) struct Octave {
    /// 1/w with 30 bits, and its change to the right.
    q: u32,
    q_step: u32,
    /// u/w in the upper half, v/w in the lower, one addition for both: so that times `2^30 / q` they are in
    /// 2^-24 repeats.
    uv: i64,
    uv_step: i64,
    /// What coordinates are counted from.
    first: Uv,
}

impl WordPlanes {
    /// The points from a pixel of the line on, and how many there are: of the `rest`, which is not
    /// 0, at least one.
    #[inline]
    pub(in crate::perspective) fn octave(
        &self,
        line: &WordLine,
        pixel: u32,
        rest: u32,
    ) -> (Octave, u32) {
        let first = line.at(pixel);
        let zeros = first.zeros();
        let (first, step) = (first.up(zeros), line.step_up(zeros));
        // What a reciprocal is found from.
        let (q, q_step) = (first.q & !3, step.q.wrapping_add(2) & !3);
        let count = if is_steep(line.step.q.cast_signed(), zeros) {
            1
        } else {
            rest.min(points(q, q_step))
        };
        let pack = |u: i32, v: i32| (i64::from(u) << 32).wrapping_add(i64::from(v));
        let octave = Octave {
            q: q >> 2,
            q_step: (q_step.cast_signed() >> 2).cast_unsigned(),
            uv: pack(first.u, first.v),
            uv_step: pack(step.u, step.v),
            first: self.first,
        };
        (octave, count)
    }
}

/// Whether a change has more than 32 bits when it is shifted up so far: no two points of an octave are
/// so different.
#[inline]
fn is_steep(step: i32, zeros: u32) -> bool {
    step.wrapping_shl(zeros).wrapping_shr(zeros) != step
}

/// How many points there are until 1/w loses its highest bit or gains another, the first with them; at
/// most `2^LOG2_MOST`.
#[inline]
fn points(q: u32, step: u32) -> u32 {
    let (room, change) = if step.cast_signed() < 0 {
        (q & (u32::MAX >> 1), step.wrapping_neg())
    } else {
        (!q, step)
    };
    // Nearly always.
    if room >> LOG2_MOST >= change {
        1 << LOG2_MOST
    } else {
        steps(room, change).wrapping_add(1)
    }
}

/// How often a change fits.
#[cold]
#[inline(never)]
fn steps(room: u32, change: u32) -> u32 {
    NonZeroU32::new(change).map_or(0, |change| div_rem(room, change).0)
}

impl Octave {
    /// u and v at the point; see [`Homogeneous::divide`](super::Homogeneous::divide).
    #[inline]
    pub(in crate::perspective) fn here(&self) -> Uv {
        self.here_by(reciprocal_of_30_bits(self.q))
    }

    /// 1/w, with 30 bits.
    #[inline]
    pub(in crate::perspective) fn q(&self) -> u32 {
        self.q
    }

    /// u and v at the point by `2^60 / q`, 31 bits.
    #[inline]
    pub(in crate::perspective) fn here_by(&self, inverse: u32) -> Uv {
        let inverse = inverse.cast_signed();
        let coordinate =
            |first: I8F24, over_w: i32| add_multiply_high(first.to_bits(), over_w, inverse);
        Uv::from_bits(
            coordinate(self.first.u, (self.uv >> 32) as i32),
            coordinate(self.first.v, self.uv as i32),
        )
    }

    /// On to the next point.
    #[inline]
    pub(in crate::perspective) fn next(&mut self) {
        self.q = self.q.wrapping_add(self.q_step);
        self.uv = self.uv.wrapping_add(self.uv_step);
    }

    /// On by so many points.
    #[inline]
    pub(in crate::perspective) fn skip(&mut self, points: u32) {
        let uv = self.uv_step.wrapping_mul(i64::from(points));
        self.q = self.q.wrapping_add(self.q_step.wrapping_mul(points));
        self.uv = self.uv.wrapping_add(uv);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steep_changes_are_told() {
        for (step, zeros, expected) in [
            (0, 31, false),
            (1, 30, false),
            (1, 31, true),
            (-1, 31, false),
            (-2, 31, true),
            (i32::MAX, 0, false),
            (i32::MAX, 1, true),
            (i32::MIN, 0, false),
            (0x00ff_ffff, 7, false),
            (0x00ff_ffff, 8, true),
        ] {
            assert_eq!(is_steep(step, zeros), expected, "{step:#x} {zeros}");
        }
    }

    /// All points have the highest bit, and one more would not.
    #[test]
    fn an_octave_ends_where_its_highest_bit_does() {
        const MOST: u32 = 1 << LOG2_MOST;
        let mut state = 1u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state ^ state >> 15
        };
        let ends = [1 << 31, (1 << 31) + 1, u32::MAX - 1, u32::MAX];
        let steps = [
            0,
            1,
            u32::MAX,
            1 << 23,
            (1 << 23) - 1,
            1 << 31,
            (1 << 31) - 1,
        ];
        let cases = ends.into_iter().flat_map(|q| steps.map(|step| (q, step)));
        let (mut whole, mut cut) = (0, 0);
        let random = (0..100_000).map(|i| {
            let step = (next().cast_signed() >> (i % 32)).cast_unsigned();
            (next() | 1 << 31, step)
        });
        for (q, step) in cases.chain(random) {
            let count = points(q, step);
            assert!((1..=MOST).contains(&count), "{q:#x} {step:#x}: {count}");
            let at = |n: u32| i64::from(q) + i64::from(step.cast_signed()) * i64::from(n);
            let is_normalised = |n: u32| (1 << 31..1 << 32).contains(&at(n));
            // They are linear: the last tells of all.
            assert!(is_normalised(count - 1), "{q:#x} {step:#x}: {count}");
            if count < MOST {
                cut += 1;
                assert!(!is_normalised(count), "{q:#x} {step:#x}: {count}");
            } else {
                whole += 1;
            }
        }
        assert!(whole > 10_000 && cut > 10_000, "{whole} {cut}");
    }
}
