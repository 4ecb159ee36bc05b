//! Reciprocals of eight numbers at a time: the same bits.

use crate::simd::{U32x8, U64x8};

/// How many heads there are, `2^15 ..= 2^16 - 1`.
const HEADS: usize = 1 << 15;

/// [`quotient_of_half`](super::quotient_of_half) of each, in 128 KB, which a PC has: eight loads take less than eight
/// divisions.
static QUOTIENTS: [u32; HEADS] = {
    let mut all = [0; HEADS];
    let mut head = 0;
    while head < HEADS {
        all[head] = u32::MAX / (HEADS + head) as u32;
        head += 1;
    }
    all
};

/// [`reciprocal_of_30_bits`](super::reciprocal_of_30_bits) of each. Of other numbers, useless ones.
#[inline(always)]
pub(crate) fn reciprocals_of_30_bits(d: U32x8) -> U64x8 {
    #[cfg(test)]
    (0..crate::simd::COUNT).for_each(|_| super::count::add());
    let heads = d.minus(U32x8::splat(1 << 29)).down::<14>();
    let heads = heads.and(HEADS as u16 - 1);
    let estimates =
        U64x8::new((heads.array()).map(|head| QUOTIENTS[usize::from(head) & (HEADS - 1)].into()));
    // `estimate (2^47 - d estimate) / 2^32`, of which the factor has 47 bits: of its halves.
    let left = U64x8::splat(1 << 47).minus(d.twice().times(estimates));
    let lower = left.times(estimates).down::<32>();
    left.uppers_twice().times(estimates).plus(lower)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arith::reciprocal_of_30_bits;
    use crate::simd::{COUNT, Walk};

    /// Of every divisor where overflow checks are off, of each 251st elsewhere, and around the first and the last.
    #[test]
    fn reciprocals_are_those_one_by_one() {
        const LEAST: u32 = 1 << 29;
        let step = if cfg!(debug_assertions) { 251 } else { 1 };
        let check = |first: u32, step: u32| {
            let found = reciprocals_of_30_bits(Walk::new(first, step).next_words()).array();
            for (number, found) in found.into_iter().enumerate() {
                let d = first + step * number as u32;
                assert_eq!(found, u64::from(reciprocal_of_30_bits(d)), "{d:#x}");
            }
        };
        let eight = step * COUNT as u32;
        for first in (LEAST..2 * LEAST - eight).step_by(eight as usize) {
            check(first, step);
        }
        for near in [
            LEAST,
            LEAST + (1 << 14) - 4,
            2 * LEAST - 8,
            2 * LEAST - (1 << 14) - 4,
        ] {
            check(near, 1);
        }
    }
}
