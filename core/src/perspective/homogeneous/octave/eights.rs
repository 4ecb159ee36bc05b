//! The points of an octave, eight at a time.

use fixed::types::I8F24;

use super::Octave;
use crate::arith::reciprocals_of_30_bits;
use crate::simd::{LongWalk, U32x8, U64x8, Walk};
use crate::uv::Eight;

/// Its points, and those that would be behind its last, of which the coordinates are of no use.
#[derive(Clone, Copy, Debug)]
pub(in crate::perspective) struct Eights {
    q: Walk,
    /// As [`Octave`] has them.
    uv: LongWalk,
    first_u: U32x8,
    first_v: U32x8,
}

/// From the point on.
impl IntoIterator for Octave {
    type Item = Eight;
    type IntoIter = Eights;

    #[inline(always)]
    fn into_iter(self) -> Eights {
        let [uv, uv_step] = [self.uv, self.uv_step].map(i64::cast_unsigned);
        let first = |c: I8F24| U32x8::splat(c.to_bits().cast_unsigned());
        Eights {
            q: Walk::new(self.q, self.q_step),
            uv: LongWalk::new(uv, uv_step),
            first_u: first(self.first.u),
            first_v: first(self.first.v),
        }
    }
}

/// u and v at the next eight, without end; the same bits as [`Octave::here`].
impl Iterator for Eights {
    type Item = Eight;

    #[inline(always)]
    fn next(&mut self) -> Option<Eight> {
        // Products have no sign here: u/w and v/w are made greater by 2^31, and the products less by as many inverses.
        const SIGNS: u64 = 1 << 63 | 1 << 31;
        let inverses = reciprocals_of_30_bits(self.q.next_words());
        let over_w = self.uv.next().xor(U64x8::splat(SIGNS));
        let beyond = inverses.up::<31>();
        let ratio = |over_w: U64x8| over_w.times(inverses).minus(beyond).uppers();
        Some(Eight {
            u: self.first_u.plus(ratio(over_w.uppers_twice())),
            v: self.first_v.plus(ratio(over_w)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::COUNT;
    use crate::uv::Uv;

    #[test]
    fn points_are_those_one_by_one() {
        let mut state = 1u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state ^ state >> 15
        };
        // Signs of u/w and v/w: of the first point, and of the last where it differs.
        let mut seen = [0; 4];
        for round in 0..20_000 {
            let q = next() >> 3 | 1 << 29;
            let eights = 1 + next() % 4;
            let most = (0x1fff_ffff - (q & 0x1fff_ffff)) / (eights * COUNT as u32);
            let mut word = || (next().cast_signed() >> (next() % 20)) >> 1;
            let pack = |u: i32, v: i32| (i64::from(u) << 32).wrapping_add(i64::from(v));
            let mut octave = Octave {
                q,
                q_step: match round % 3 {
                    0 => most,
                    1 => 0,
                    _ => most >> 1,
                },
                uv: pack(word(), word()),
                uv_step: pack(word() >> 6, word() >> 6),
                first: Uv::from_bits(word() >> 3, word() >> 3),
            };
            if round % 2 == 1 {
                // From the other end.
                octave.skip(eights * COUNT as u32 - 1);
                octave.q_step = octave.q_step.wrapping_neg();
                octave.uv_step = octave.uv_step.wrapping_neg();
            }
            seen[(octave.uv >> 62 & 2 | octave.uv >> 31 & 1) as usize] += 1;
            let mut skipped = octave;
            for eight in octave.into_iter().take(eights as usize) {
                for uv in eight.array() {
                    assert_eq!(uv, octave.here(), "{round}: {octave:?}");
                    octave.next();
                }
                skipped.skip(COUNT as u32);
                assert_eq!((skipped.q, skipped.uv), (octave.q, octave.uv));
            }
        }
        assert!(seen.iter().all(|&count| count > 1_000), "{seen:?}");
    }
}
