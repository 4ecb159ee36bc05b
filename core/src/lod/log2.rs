//! Base-2 logarithms in fixed point. A leaf.

use crate::arith::{leading_zeros_from, leading_zeros_long};

/// Fraction bits of logarithms, and of lambda.
pub const FRACTION_BITS: u32 = 16;

/// The logarithm of nothing: below that of every number, and far from overflow when others are
/// added.
pub const NOTHING: i32 = -(1 << 26);

/// Intervals of the mantissa.
const INTERVALS: usize = 64;

/// Fraction bits of [`BULGE`].
const BULGE_BITS: u32 = 19;

/// `log2(1 + i / 64) - i / 64`, what the logarithm exceeds its chord by: below 0.0861, so that 16
/// bits hold it with 19 fraction bits.
static BULGE: [u16; INTERVALS + 1] = {
    let mut table = [0; INTERVALS + 1];
    let mut i = 0;
    while i < INTERVALS {
        let line = (i << BULGE_BITS) / INTERVALS;
        table[i] = (logarithm(INTERVALS + i) - line) as u16;
        i += 1;
    }
    table
};

/// `log2(n / 64)` with [`BULGE_BITS`] fraction bits, rounded down, for 64 to 127: squaring
/// doubles the logarithm, and every squaring tells a bit (Knuth, *The Art of Computer Programming*,
/// volume 2, section 1.2.2, exercise 25).
const fn logarithm(n: usize) -> usize {
    // 1.31 to 2.62 when squared.
    let mut x = (n as u64) << 25;
    let mut result = 0;
    let mut bit = 0;
    while bit < BULGE_BITS {
        x = (x * x) >> 31;
        result <<= 1;
        if x >> 32 != 0 {
            result |= 1;
            x >>= 1;
        }
        bit += 1;
    }
    result
}

/// The base-2 logarithm of a number, with [`FRACTION_BITS`] fraction bits; [`NOTHING`] for 0.
///
/// Linear between 64 values to the octave. The chord lies below the curve by at most
/// `2^-12 / 8 / ln 2 = 4.4e-5`; table and interpolation are low by less than 2^-19 each, and both
/// terms of the sum by less than 2^-16: the result is low by less than 7.9e-5, and never high.
#[inline]
#[must_use]
pub fn log2(n: u64) -> i32 {
    if n == 0 {
        return NOTHING;
    }
    let zeros = leading_zeros_long(n);
    // Without the top bit, which is the 1 of the mantissa: a fraction of 32 bits.
    let fraction = (n.wrapping_shl(zeros) >> 31) as u32;
    of_mantissa(63u32.wrapping_sub(zeros), fraction)
}

/// [`log2`] of a word.
#[inline]
#[must_use]
pub fn log2_word(n: u32) -> i32 {
    if n == 0 {
        return NOTHING;
    }
    let zeros = leading_zeros_from(0, n);
    of_mantissa(31u32.wrapping_sub(zeros), n.wrapping_shl(zeros) << 1)
}

/// The logarithm of `2^exponent (1 + fraction 2^-32)`.
#[inline]
fn of_mantissa(exponent: u32, fraction: u32) -> i32 {
    let interval = (fraction >> 26) as usize;
    let within = fraction >> 10 & 0xffff;
    let bulge = |i: usize| BULGE.get(i).copied().map_or(0, u32::from);
    let (here, next) = (bulge(interval), bulge(interval.wrapping_add(1)));
    let change = next.wrapping_sub(here).cast_signed();
    // 16 bits by 16: |change| is below 2^13.
    let more = here
        .cast_signed()
        .wrapping_add(change.wrapping_mul(within.cast_signed()) >> 16);
    let whole = exponent.wrapping_shl(FRACTION_BITS);
    (whole | fraction >> 16)
        .cast_signed()
        .wrapping_add(more >> (BULGE_BITS - FRACTION_BITS))
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;

    fn check(n: u64) {
        let exact = (n as f64).log2() * 65536.0;
        let off = f64::from(log2(n)) - exact;
        // 7.9e-5 in units of 2^-16; float64 rounds n above 2^53.
        assert!((-5.18..=0.001).contains(&off), "{n}: off by {off} / 65536");
        if let Ok(word) = u32::try_from(n) {
            assert_eq!(log2_word(word), log2(n), "{n}");
        }
    }

    #[test]
    fn logarithms_are_low_by_less_than_a_12000th() {
        for n in 1..=1 << 20 {
            check(n);
        }
        let mut state = 1u64;
        for _ in 0..1_000_000 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            check((state >> (state & 63)).max(1));
        }
        for bit in 0..64 {
            assert_eq!(log2(1 << bit), bit << 16);
            check((1 << bit) | 1);
            check((1u64 << bit).wrapping_sub(1).max(1));
        }
        check(u64::MAX);
        assert_eq!(log2(0), NOTHING);
    }
}
