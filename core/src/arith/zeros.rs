//! How far to shift a number up until its highest bit is set, on processors with and without an instruction that counts
//! the zeros before it: Armv6-M has none, and RISC-V has it in its extension Zbb.

use core::num::NonZeroU32;

use super::{NARROW, keep_rolled};

/// Whether there is such an instruction.
pub(super) const COUNTS_ZEROS: bool = !NARROW
    && cfg!(any(
        not(any(target_arch = "riscv32", target_arch = "riscv64")),
        target_feature = "zbb"
    ));

/// How far; 31 for 0.
#[inline]
#[must_use]
pub(crate) fn leading_zeros(n: u32) -> u32 {
    let n = NonZeroU32::MIN | n;
    if COUNTS_ZEROS {
        n.leading_zeros()
    } else {
        by_halves(n)
    }
}

/// The same of 64 bits; 63 for 0.
#[inline]
#[must_use]
pub(crate) fn leading_zeros_long(n: u64) -> u32 {
    // The compiler's library takes longer; its code for RISC-V does not.
    if NARROW {
        of_words(n)
    } else {
        (n | 1).leading_zeros()
    }
}

/// The same of a number that has so many at least, and few more.
#[inline]
#[must_use]
pub(crate) fn leading_zeros_from(least: u32, n: u32) -> u32 {
    if COUNTS_ZEROS {
        leading_zeros(n)
    } else {
        one_by_one(NonZeroU32::MIN | n << (least & 31)).wrapping_add(least)
    }
}

/// By halves of what is left, and the last two from a table in a word: less than the compiler's library takes, and half
/// of what its code for RISC-V does.
// On Armv6-M a function of its own: half of its instructions are the call's, but a copy takes 40 bytes.
#[cfg_attr(target_arch = "arm", inline(never))]
#[cfg_attr(not(target_arch = "arm"), inline)]
fn by_halves(n: NonZeroU32) -> u32 {
    const OF_FOUR_BITS: u32 = 0b01_01_01_01_10_10_11_00;
    let (mut zeros, mut n) = (0, n.get());
    if n >> 16 == 0 {
        n <<= 16;
        zeros += 16;
    }
    if n >> 24 == 0 {
        n <<= 8;
        zeros += 8;
    }
    if n >> 28 == 0 {
        n <<= 4;
        zeros += 4;
    }
    zeros + (OF_FOUR_BITS >> (n >> 28 << 1) & 3)
}

/// By bits, of few the fastest.
#[inline]
fn one_by_one(n: NonZeroU32) -> u32 {
    let (mut zeros, mut n) = (0, n.get().cast_signed());
    while n > 0 {
        n <<= 1;
        zeros += 1;
        keep_rolled();
    }
    zeros & 31
}

#[inline]
fn of_words(n: u64) -> u32 {
    match (n >> 32) as u32 {
        0 => leading_zeros(n as u32).wrapping_add(32),
        high => leading_zeros(high),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_ways_count_alike() {
        for zeros in 0..32 {
            // The highest bit, and others below it.
            for below in [0, 1, 0x5555_5555, 0x8000_0000, u32::MAX] {
                let n = (1 << 31 | below >> 1) >> zeros;
                let n = NonZeroU32::new(n).expect("its highest bit");
                assert_eq!(leading_zeros(n.get()), zeros);
                assert_eq!(by_halves(n), zeros, "{n:#x}");
                assert_eq!(one_by_one(n), zeros, "{n:#x}");
                for least in 0..=zeros {
                    assert_eq!(leading_zeros_from(least, n.get()), zeros, "{n:#x}");
                }
                for low in [0, 1, u32::MAX] {
                    let long = u64::from(n.get()) << 32 | u64::from(low);
                    assert_eq!((leading_zeros_long(long), of_words(long)), (zeros, zeros));
                }
                let long = u64::from(n.get());
                let expected = zeros + 32;
                assert_eq!(
                    (leading_zeros_long(long), of_words(long)),
                    (expected, expected)
                );
            }
        }
        assert_eq!((leading_zeros(0), leading_zeros_from(3, 0)), (31, 31));
        assert_eq!((leading_zeros_long(0), of_words(0)), (63, 63));
    }
}
