//! The integer arithmetic that more than one stage needs: a reciprocal, an exact interpolation and
//! a division that rounds down. A leaf: it knows no stage.

mod eights;
mod zeros;

use core::hint::black_box;
use core::num::NonZeroU32;

use fixed::types::I16F16;

pub(crate) use eights::reciprocals_of_30_bits;
pub(crate) use zeros::{leading_zeros, leading_zeros_from, leading_zeros_long};

/// `2^62 / d` for a normalised divisor, as 31 bits.
///
/// `d` has its top bit set: `2^31 <= d < 2^32`. One 32-bit division gives 16 bits of the quotient,
/// one Newton step doubles them (Hennessy and Patterson, *Computer Architecture*, appendix J.6), so
/// the relative error lies between `-2^-29` and 0 and the result in `2^30 - 2 .. 2^31`. It is the
/// same integer on every target. A divisor that is not normalised gives a useless number, not a
/// panic.
#[inline]
#[must_use]
pub(crate) fn reciprocal(d: u32) -> u32 {
    reciprocal_of_30_bits(d >> 2)
}

/// [`reciprocal`] where one is found seldom: no copy of it where it is much code.
#[inline]
#[must_use]
pub(crate) fn reciprocal_apart(d: u32) -> u32 {
    if NARROW {
        narrow::reciprocal_called(d)
    } else {
        reciprocal(d)
    }
}

/// [`quotient_of_half`] where one is found seldom: no copy of it where it is much code.
#[inline]
#[must_use]
pub(crate) fn quotient_apart(h: u32) -> u32 {
    if NARROW {
        narrow::quotient_called(h)
    } else {
        wide::quotient(h)
    }
}

/// `2^60 / d` for `2^29 <= d < 2^30`: what [`reciprocal`] gives for four times that.
#[inline]
#[must_use]
pub(crate) fn reciprocal_of_30_bits(d: u32) -> u32 {
    #[cfg(test)]
    count::add();
    // 2^46 / d to within 2^-15 of its value: the head is short by less than 1 in 2^15, the quotient
    // by at most 1 in 2^16, and the two errors have opposite signs.
    let estimate = quotient_of_half(d >> 14);
    if LONG {
        return long::refined(estimate, d);
    }
    // d estimate = 2^46 (1 + e) with -2^-16 <= e < 2^-15, of which 2^46 is 0 modulo 2^32, and the rest
    // fits 32 bits with its sign.
    let rest = d.wrapping_mul(estimate).cast_signed();
    // estimate (1 - e) instead of estimate / (1 + e): too small by e^2 < 2^-30.
    if NARROW {
        narrow::refined(estimate, rest)
    } else {
        wide::refined(estimate, rest)
    }
}

/// `(2^32 - 1) / h`, rounded down, for `2^15 <= h < 2^16`: 17 bits.
#[inline]
#[must_use]
pub(crate) fn quotient_of_half(h: u32) -> u32 {
    if NARROW {
        narrow::quotient(h)
    } else {
        wide::quotient(h)
    }
}

/// `a b / 2^18`, rounded down, for a within 2^28 and a [quotient](quotient_of_half).
#[inline]
#[must_use]
pub(crate) fn times_quotient(a: i32, b: i32) -> i32 {
    if NARROW {
        narrow::times_quotient(a, b)
    } else if LONG {
        long::product_down::<18>(a, b)
    } else {
        wide::product_down::<18>(a, b)
    }
}

/// `2^42 / (d + 2^9)` for a divisor `8/9 2^25 .. 8/7 2^26`, as 16 to 18 bits: off by less than 2^-15.3 of
/// itself. A useless number for other divisors.
#[inline]
#[must_use]
pub(crate) fn short_reciprocal(d: u32) -> i32 {
    #[cfg(test)]
    count::add();
    // The nearest multiple of 2^10. It is off by up to 1 in 2^15.8 where it is least, and the quotient is short by
    // less than 1 in 2^15.8 where that is.
    let head = NonZeroU32::MIN.saturating_add(d >> 10);
    let quotient = if NARROW {
        narrow::short_quotient(head.get())
    } else {
        u32::MAX / head
    };
    quotient.cast_signed()
}

/// `a b / 2^19`, rounded down, for what is within 2^23 then, and `0 <= b < 2^18`.
#[inline]
#[must_use]
pub(crate) fn times_short_reciprocal(a: i32, b: i32) -> i32 {
    if NARROW {
        narrow::product_in_halves::<11>(a, b) >> 8
    } else if LONG {
        long::product_down::<19>(a, b)
    } else {
        wide::product_down::<19>(a, b)
    }
}

/// `a b / 2^9`, rounded down, for 24 bits and 17.
#[inline]
#[must_use]
pub(crate) fn short_product_unsigned(a: u32, b: u32) -> u32 {
    if NARROW {
        narrow::short_product_unsigned(a, b)
    } else {
        ((u64::from(a) * u64::from(b)) >> 9) as u32
    }
}

/// `a b / 2^18`, rounded down, for a within 2^25 and b within 2^16.
#[inline]
#[must_use]
pub(crate) fn short_product(a: i32, b: i32) -> i32 {
    if NARROW {
        narrow::product_in_halves::<10>(a, b) >> 8
    } else if LONG {
        long::product_down::<18>(a, b)
    } else {
        wide::product_down::<18>(a, b)
    }
}

/// `a + b c / 2^32`, rounded down, for `0 <= c`: one instruction on a Cortex-M4.
#[inline]
#[must_use]
pub(crate) fn add_multiply_high(a: i32, b: i32, c: i32) -> i32 {
    a.wrapping_add(multiply_high(b, c))
}

/// The upper word of a product, `a b / 2^32` rounded down, for `0 <= b`.
#[inline]
#[must_use]
pub(crate) fn multiply_high(a: i32, b: i32) -> i32 {
    if NARROW {
        narrow::multiply_high(a, b)
    } else {
        wide::multiply_high(a, b)
    }
}

/// Whether the target multiplies to 32 bits only and has no division: Armv6-M (Cortex-M0+), told
/// by its lack of atomic exchanges. Both ways give the same bits.
pub(crate) const NARROW: bool = cfg!(all(target_arch = "arm", not(target_has_atomic = "32")));

/// Whether the processor adds with a carry and rotates, as all do but RISC-V's: whether it pays to keep two
/// numbers in one of 64 bits.
pub(crate) const CARRIES: bool = cfg!(not(any(target_arch = "riscv32", target_arch = "riscv64")));

/// Whether an instruction shifts or rotates one of its operands by a constant: Armv7-M.
pub(crate) const SHIFTS_OPERANDS: bool = cfg!(all(target_arch = "arm", target_has_atomic = "32"));

/// Whether there are no more than 13 registers for values: Arm's, of 32 bits.
pub(crate) const FEW_REGISTERS: bool = cfg!(target_arch = "arm");

/// Whether registers have 64 bits.
pub(crate) const LONG: bool = cfg!(target_pointer_width = "64");

/// Counts reciprocals, so that tests can compare what strategies say of their divisions with what
/// they make.
#[cfg(test)]
pub(crate) mod count {
    extern crate std;

    use core::cell::Cell;

    std::thread_local! {
        static RECIPROCALS: Cell<u32> = const { Cell::new(0) };
    }

    pub(super) fn add() {
        RECIPROCALS.with(|n| n.set(n.get().wrapping_add(1)));
    }

    /// How many this thread made since the last call.
    pub(crate) fn take() -> u32 {
        RECIPROCALS.with(Cell::take)
    }
}

/// For registers of 64 bits.
mod long {
    /// `(estimate 2^46 - estimate rest) / 2^32`, rounded down, where the rest is `d estimate - 2^46`.
    #[inline]
    pub(super) fn refined(estimate: u32, d: u32) -> u32 {
        let estimate = u64::from(estimate);
        let left = (1u64 << 47).wrapping_sub(u64::from(d).wrapping_mul(estimate));
        (left.wrapping_mul(estimate) >> 32) as u32
    }

    /// `a b / 2^BITS`, rounded down, where that has 32 bits.
    #[inline]
    pub(super) fn product_down<const BITS: u32>(a: i32, b: i32) -> i32 {
        ((i64::from(a) * i64::from(b)) >> BITS) as i32
    }
}

/// For processors that multiply to 64 bits.
mod wide {
    use core::num::NonZeroU32;

    /// `(2^32 - 1) / h`, rounded down, for `2^15 <= h < 2^16`.
    #[inline]
    pub(super) fn quotient(h: u32) -> u32 {
        // By contract this bit is set already; the OR only tells the compiler that h is not zero.
        const TOP: NonZeroU32 = NonZeroU32::new(1 << 15).unwrap();
        u32::MAX / (TOP | h)
    }

    /// `(estimate 2^46 - estimate rest) / 2^32`, rounded down: one instruction on a Cortex-M4.
    #[inline]
    pub(super) fn refined(estimate: u32, rest: i32) -> u32 {
        let product = i64::from(rest) * i64::from(estimate.cast_signed());
        let whole = i64::from((estimate << 14).cast_signed()) << 32;
        ((whole.wrapping_sub(product) >> 32) as i32).cast_unsigned()
    }

    /// See [`super::quotient`].
    #[inline]
    pub(super) fn long_quotient(n: i32, d: NonZeroU32) -> i64 {
        // Below zero, of one less than the magnitude: so both are rounded down.
        let sign = n >> 31;
        let whole = ((n ^ sign).cast_unsigned() / d).cast_signed() ^ sign;
        let rest = n
            .cast_unsigned()
            .wrapping_sub(whole.cast_unsigned().wrapping_mul(d.get()));
        // Digits of 13, 13 and 6 bits.
        let (high, rest) = ((rest << 13) / d, (rest << 13) % d);
        let (middle, rest) = ((rest << 13) / d, (rest << 13) % d);
        let part = high << 19 | middle << 6 | ((rest << 6) / d);
        i64::from(whole) << 32 | i64::from(part)
    }

    #[inline]
    pub(super) fn multiply_high(a: i32, b: i32) -> i32 {
        ((i64::from(a) * i64::from(b)) >> 32) as i32
    }

    /// `a b / 2^BITS`, rounded down, for b within `2^(BITS - 1)`: its upper word.
    #[inline]
    pub(super) fn product_down<const BITS: u32>(a: i32, b: i32) -> i32 {
        multiply_high(a, b << (32 - BITS))
    }
}

/// In a loop, no instruction, but small processors' compilers would unroll it by four: a waste where
/// it turns a few times only.
#[inline]
pub(crate) fn keep_rolled() {
    if cfg!(target_pointer_width = "32") {
        black_box(());
    }
}

/// With [`keep_rolled`] in a loop: what it reads of this value is read there. The compiler of a small
/// processor would copy it before the loop, to the stack, as it is more than registers hold.
#[inline]
pub(crate) fn keep_in_place<T>(value: &T) {
    if cfg!(target_pointer_width = "32") {
        black_box(value);
    }
}

/// A number that a loop steps on from what it was, once in so many steps: the compiler of a small processor would add
/// multiples of the step to it instead, more of them than registers hold. Takes two instructions.
#[inline]
pub(crate) fn stepwise(number: u32) -> u32 {
    if cfg!(target_pointer_width = "32") {
        black_box(number)
    } else {
        number
    }
}

/// The same bits from products of 32 bits and no division.
mod narrow {
    use core::num::NonZeroU32;

    use super::{keep_rolled, leading_zeros, leading_zeros_from};

    /// Bit by bit: for the short quotients of a triangle's edges as fast as the compiler's library,
    /// and a third of its size.
    #[inline(never)]
    pub(super) fn div_rem(n: u32, d: NonZeroU32) -> (u32, u32) {
        let (mut part, mut bit) = (d.get(), 1u32);
        while part <= n >> 1 {
            part <<= 1;
            bit <<= 1;
            keep_rolled();
        }
        let (mut quotient, mut rest) = (0, n);
        while bit > 0 {
            if rest >= part {
                rest = rest.wrapping_sub(part);
                quotient |= bit;
            }
            part >>= 1;
            bit >>= 1;
            keep_rolled();
        }
        (quotient, rest)
    }

    /// See [`super::quotient`], and what is left.
    #[inline(never)]
    pub(super) fn long_quotient(n: u32, d: NonZeroU32) -> (i64, u32) {
        // The divisor with 20 bits, of which 16 have an inverse. What others take off a quotient is below 4: so
        // it is never too large, and short of a digit of 11 bits by less than a quarter.
        let up = leading_zeros(d.get()).wrapping_sub(12) & 31;
        let inverse = quotient_called(d.get() << up >> 4).wrapping_sub(4);
        let (whole, mut rest) = div_rem(n, d);
        let mut part = 0;
        for bits in [11, 11, 10] {
            // Below 2^11 times the divisor.
            let n = rest << bits;
            let mut digit = (n << up >> (bits + 4)).wrapping_mul(inverse) >> (32 - bits);
            rest = n.wrapping_sub(digit.wrapping_mul(d.get()));
            if rest >= d.get() {
                rest = rest.wrapping_sub(d.get());
                digit = digit.wrapping_add(1);
            }
            part = part << bits | digit;
        }
        (i64::from(whole) << 32 | i64::from(part), rest)
    }

    /// Of a number of up to 19 bits, the last 8 of them 0.
    #[derive(Clone, Copy, Debug, Default)]
    pub(super) struct ShortReciprocal {
        /// `2^32 / h` of the number's 16 highest bits.
        inverse: u32,
        /// From a dividend down to what the inverse is multiplied with.
        down: u32,
    }

    impl ShortReciprocal {
        // A function of its own: a triangle has three edges.
        #[inline(never)]
        pub(super) fn new(divisor: NonZeroU32) -> Self {
            let zeros = leading_zeros_from(13, divisor.get());
            Self {
                inverse: quotient_called(divisor.get() << zeros >> 16),
                down: 30u32.wrapping_sub(zeros),
            }
        }

        /// `n / divisor`, below 2^13.
        #[inline]
        pub(super) fn quotient(&self, n: u32, divisor: NonZeroU32) -> u32 {
            // n 2^zeros is below 2^45. 15 bits of it times 17 of the inverse: what is cut off makes less than
            // a half, and what the inverse is short of less than an eighth.
            let quotient = (n >> (self.down & 31)).wrapping_mul(self.inverse) >> 18;
            let rest = n.wrapping_sub(quotient.wrapping_mul(divisor.get()));
            quotient.wrapping_add(u32::from(rest >= divisor.get()))
        }
    }

    /// `2^31 / h` in the middle of 128 intervals of `h` = 2^15 .. 2^16.
    static MIDDLES: [u16; 128] = {
        let mut table = [0; 128];
        let mut i = 0;
        while i < table.len() {
            let h = (128 + i as u32) * 256 + 128;
            table[i] = ((1u32 << 31) / h) as u16;
            i += 1;
        }
        table
    };

    /// `(2^32 - 1) / h`, rounded down, for `2^15 <= h < 2^16`.
    #[inline]
    pub(super) fn quotient(h: u32) -> u32 {
        let middle = MIDDLES
            .get(((h >> 8) & 127) as usize)
            .map_or(0, |&m| u32::from(m));
        // A Newton step: half an interval off is 2^-8, squared 2^-16, two units of the quotient.
        // |off| < 2^24, and all is rounded down, so that it stays below the true quotient.
        let off = (1u32 << 31)
            .wrapping_sub(middle.wrapping_mul(h))
            .cast_signed();
        let more = middle.cast_signed().wrapping_mul(off >> 9) >> 21;
        let mut quotient = (middle << 1).wrapping_add_signed(more);
        let mut rest = u32::MAX.wrapping_sub(quotient.wrapping_mul(h));
        // A few times at most; a number that breaks the contract must end too.
        let mut tries = 0;
        while rest >= h && tries < 8 {
            rest = rest.wrapping_sub(h);
            quotient = quotient.wrapping_add(1);
            tries += 1;
        }
        quotient
    }

    #[inline(never)]
    pub(super) fn quotient_called(h: u32) -> u32 {
        quotient(h)
    }

    #[inline(never)]
    pub(super) fn reciprocal_called(d: u32) -> u32 {
        super::reciprocal(d)
    }

    /// The first of the intervals of [`SHORT_MIDDLES`].
    const FIRST_MIDDLE: u32 = 113;

    /// `2^30 / h` in the middle of intervals of 256, which hold all heads of [`super::short_reciprocal`].
    static SHORT_MIDDLES: [u16; 180] = {
        let mut table = [0; 180];
        let mut i = 0;
        while i < table.len() {
            let h = (FIRST_MIDDLE + i as u32) * 256 + 128;
            table[i] = ((1u32 << 30) / h) as u16;
            i += 1;
        }
        table
    };

    /// The same for `113 2^8 <= h < 293 2^8`.
    #[inline]
    pub(super) fn short_quotient(h: u32) -> u32 {
        let interval = (h >> 8).wrapping_sub(FIRST_MIDDLE);
        let middle = SHORT_MIDDLES
            .get(interval as usize)
            .map_or(0, |&m| u32::from(m));
        // A Newton step as above: half an interval off is 2^-7.8, squared 2^-15.6, three units of the quotient.
        let off = (1u32 << 30)
            .wrapping_sub(middle.wrapping_mul(h))
            .cast_signed();
        let more = middle.cast_signed().wrapping_mul(off >> 8) >> 20;
        let mut quotient = (middle << 2).wrapping_add_signed(more);
        let mut rest = u32::MAX.wrapping_sub(quotient.wrapping_mul(h));
        let mut tries = 0;
        while rest >= h && tries < 8 {
            rest = rest.wrapping_sub(h);
            quotient = quotient.wrapping_add(1);
            tries += 1;
        }
        quotient
    }

    /// `(estimate 2^46 - estimate rest) / 2^32`, rounded down, for what is left of a reciprocal's
    /// estimate of 17 bits.
    #[inline]
    pub(super) fn refined(estimate: u32, rest: i32) -> u32 {
        let rest = rest.wrapping_neg();
        // rest estimate / 2^16, whose upper half is wanted: two products of halves, and the rest for the
        // highest bit. Halves are added apart: the sum of all has 33 bits.
        let (high, low) = (rest >> 16, rest & 0xffff);
        let part = (estimate & 0xffff).cast_signed();
        let lows = low.wrapping_mul(part).cast_unsigned() >> 16;
        let behind = (high.wrapping_mul(part))
            .wrapping_add(lows.cast_signed())
            .wrapping_add(low);
        (estimate << 14).wrapping_add_signed(high.wrapping_add(behind >> 16))
    }

    #[inline]
    pub(super) fn multiply_high(a: i32, b: i32) -> i32 {
        (product(a, b) >> 32) as i32
    }

    /// `a b / 2^BITS`, rounded down, where that is within 2^31, and b within `2^(31 - BITS)`.
    #[inline]
    pub(super) fn product_in_halves<const BITS: u32>(a: i32, b: i32) -> i32 {
        let low = a & ((1 << BITS) - 1);
        (a >> BITS)
            .wrapping_mul(b)
            .wrapping_add(low.wrapping_mul(b) >> BITS)
    }

    /// See [`super::times_quotient`]: the lower product has 32 bits.
    #[inline]
    pub(super) fn times_quotient(a: i32, b: i32) -> i32 {
        let low = (a & 0x7fff).wrapping_mul(b).cast_unsigned() >> 15;
        (a >> 15).wrapping_mul(b).wrapping_add_unsigned(low) >> 3
    }

    /// See [`super::short_product_unsigned`].
    #[inline]
    pub(super) fn short_product_unsigned(a: u32, b: u32) -> u32 {
        (a >> 9)
            .wrapping_mul(b)
            .wrapping_add((a & 0x1ff).wrapping_mul(b) >> 9)
    }

    /// A function of its own: a call takes a fifth of its instructions, a copy of it 70 bytes.
    #[inline(never)]
    pub(super) fn product_called(a: i32, b: i32) -> i64 {
        product(a, b)
    }

    /// Four products of halves (Warren, *Hacker's Delight*, section 8-2): a half is added to what has less than 32
    /// bits by as much.
    #[inline]
    pub(super) fn product(a: i32, b: i32) -> i64 {
        let (a_high, a_low) = (a >> 16, a & 0xffff);
        let (b_high, b_low) = (b >> 16, b & 0xffff);
        let lows = a_low.wrapping_mul(b_low).cast_unsigned();
        let cross = (a_low.wrapping_mul(b_high)).wrapping_add_unsigned(lows >> 16);
        let middle = (a_high.wrapping_mul(b_low)).wrapping_add(cross & 0xffff);
        let high = (a_high.wrapping_mul(b_high))
            .wrapping_add(cross >> 16)
            .wrapping_add(middle >> 16);
        i64::from(high) << 32 | i64::from(middle.cast_unsigned() << 16 | lows & 0xffff)
    }

    /// Three products, of which none leaves its word.
    #[inline]
    pub(super) fn product_with_short(a: i64, b: i32) -> i64 {
        let (high, low) = ((a >> 32) as i32, a as u32);
        let lowest = ((low & 0xffff).cast_signed()).wrapping_mul(b);
        let middle = ((low >> 16).cast_signed()).wrapping_mul(b);
        // The middle one counts 2^16 times.
        let upper = high.wrapping_mul(b).wrapping_add(middle >> 16);
        let word = |high: i32, low: u32| i64::from(high) << 32 | i64::from(low);
        word(upper, (middle << 16).cast_unsigned()).wrapping_add(i64::from(lowest))
    }

    /// Products of what stays whole, and of the rest, which have 28 bits.
    #[inline]
    pub(super) fn over_subpixels([right, down]: [i32; 2], [x, y]: [i32; 2]) -> i32 {
        let sum = |right: i32, down: i32| right.wrapping_mul(x).wrapping_add(down.wrapping_mul(y));
        sum(right >> 8, down >> 8).wrapping_add(sum(right & 0xff, down & 0xff) >> 8)
    }

    /// See [`product_called`].
    #[inline(never)]
    pub(super) fn product_unsigned(a: u32, b: u32) -> u64 {
        let (a_high, a_low) = (a >> 16, a & 0xffff);
        let (b_high, b_low) = (b >> 16, b & 0xffff);
        let lows = a_low.wrapping_mul(b_low);
        let cross = a_low.wrapping_mul(b_high).wrapping_add(lows >> 16);
        let middle = a_high.wrapping_mul(b_low).wrapping_add(cross & 0xffff);
        let high = (a_high.wrapping_mul(b_high))
            .wrapping_add(cross >> 16)
            .wrapping_add(middle >> 16);
        u64::from(high) << 32 | u64::from(middle << 16 | lows & 0xffff)
    }
}

/// `2^32 / n`, rounded up, but below 2^31, for the lengths of short pieces; those of 0 and 1 are
/// not there.
pub(crate) static RECIPROCALS: [i32; 64] = {
    let mut table = [0; 64];
    let mut n = 2;
    while n < table.len() {
        let reciprocal = (1u64 << 32).div_ceil(n as u64);
        table[n] = if reciprocal > i32::MAX as u64 {
            i32::MAX
        } else {
            reciprocal as i32
        };
        n += 1;
    }
    table
};

/// `1 / w` of a positive 16.16 number, as mantissa and exponent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Inverse {
    /// `2^62 / (w << exponent)`, 31 bits, `w << exponent` being normalised.
    pub(crate) mantissa: u32,
    /// Leading zeros of `w`: 1/w is proportional to `mantissa << exponent`.
    pub(crate) exponent: u32,
}

impl Inverse {
    /// The inverse of the raw bits of a 16.16 number, `w >= 1`.
    #[inline]
    pub(crate) fn new(w: u32) -> Self {
        let exponent = if zeros::COUNTS_ZEROS {
            w.leading_zeros() & 31
        } else {
            leading_zeros(w)
        };
        Self {
            mantissa: reciprocal_apart(w << exponent),
            exponent,
        }
    }
}

/// `1 / w` of three corners, but for a factor that they have in common: the largest uses 31 bits,
/// all are rounded down. A corner 2^31 times farther than the nearest gets 0.
///
/// Each is the product of the other two corners' w: no division.
#[inline]
pub(crate) fn shared_inverses(w: [I16F16; 3]) -> [u32; 3] {
    let [a, b, c] = w.map(|w| w.to_bits().cast_unsigned());
    let products = [
        product_unsigned(b, c),
        product_unsigned(c, a),
        product_unsigned(a, b),
    ];
    let [p, q, r] = products;
    let all = p | q | r;
    let high = (all >> 32) as u32;
    if high > 0 {
        // Numbers of 31 bits make products of 62: two zeros at least.
        let up = high.leading_zeros().wrapping_sub(1) & 31;
        let down = 32u32.wrapping_sub(up) & 31;
        products.map(|p| {
            let (high, low) = ((p >> 32) as u32, p as u32);
            (high << up) | (low >> down)
        })
    } else {
        let zeros = (all as u32).leading_zeros() & 31;
        products.map(|p| (p as u32) << zeros >> 1)
    }
}

/// Two factors of up to 32 bits.
#[inline]
#[must_use]
pub(crate) fn product_unsigned(a: u32, b: u32) -> u64 {
    if NARROW {
        narrow::product_unsigned(a, b)
    } else {
        u64::from(a) * u64::from(b)
    }
}

/// Two factors with their signs: for what is done once a triangle or once a run.
#[inline]
#[must_use]
pub(crate) fn product(a: i32, b: i32) -> i64 {
    if NARROW {
        narrow::product_called(a, b)
    } else {
        i64::from(a) * i64::from(b)
    }
}

/// A product of 96 bits, its upper 64 and its lower 32, for `0 <= b`.
#[inline]
#[must_use]
pub(crate) fn long_product(a: i64, b: i32) -> (i64, u32) {
    let (high, low) = ((a >> 32) as i32, a as u32);
    if NARROW && high == low.cast_signed() >> 31 {
        let product = product(low.cast_signed(), b);
        return (product >> 32, product as u32);
    }
    let low = product_unsigned(low, b.cast_unsigned());
    let high = product(high, b).wrapping_add((low >> 32).cast_signed());
    (high, low as u32)
}

/// The lower 64 bits of such a number, shifted down by less than 32.
#[inline]
#[must_use]
pub(crate) fn shifted_down((high, low): (i64, u32), shift: u32) -> i64 {
    let (top, middle) = ((high >> 32) as u32, high as u32);
    // Words by themselves, because processors of 32 bits take thrice the time where a shift may
    // be more than a word.
    let [right, left] = [shift & 31, 31 - (shift & 31)];
    let word = |high: u32, low: u32| (high << 1 << left) | (low >> right);
    let (upper, lower) = (word(top, middle), word(middle, low));
    i64::from(upper.cast_signed()) << 32 | i64::from(lower)
}

/// A product modulo 2^64 with a factor of `-2^15 .. 2^15`.
#[inline]
#[must_use]
pub(crate) fn product_with_short(a: i64, b: i32) -> i64 {
    if NARROW {
        narrow::product_with_short(a, b)
    } else {
        a.wrapping_mul(i64::from(b))
    }
}

/// What changes by so much over a pixel to the right and down changes by over so many subpixels, below
/// 2^19, each way: rounded down, modulo 2^32.
#[inline]
#[must_use]
pub(crate) fn over_subpixels([right, down]: [i32; 2], [x, y]: [i32; 2]) -> i32 {
    if NARROW {
        narrow::over_subpixels([right, down], [x, y])
    } else {
        let sum = i64::from(right).wrapping_mul(i64::from(x));
        (sum.wrapping_add(i64::from(down).wrapping_mul(i64::from(y))) >> 8) as i32
    }
}

/// `a + (b - a) * n / d`, rounded to the nearest integer, for `0 <= n <= d` and `0 < d < 2^62`.
///
/// Exact: the product is never formed, the quotient is found bit by bit as in long
/// multiplication (numerator bits from the top) with a running remainder.
#[inline(never)]
pub(crate) fn interpolate(a: i32, b: i32, n: u64, d: u64) -> i32 {
    debug_assert!(n <= d && d > 0 && d < 1 << 62);
    // Holds by contract; written down because the loops below rely on it to end.
    let (n, d) = (n.min(d), d.max(1));
    let distance = b.abs_diff(a);
    let mut quotient: u32 = 0;
    let mut remainder: u64 = 0;
    let mut bit = 32u32.saturating_sub(distance.leading_zeros());
    while bit > 0 {
        bit -= 1;
        // remainder < d and n <= d, so this is below 3d and at most two subtractions restore it.
        remainder = (remainder << 1).wrapping_add(if distance >> bit & 1 == 1 { n } else { 0 });
        quotient <<= 1;
        while remainder >= d {
            remainder = remainder.wrapping_sub(d);
            quotient = quotient.wrapping_add(1);
        }
    }
    if remainder << 1 >= d {
        quotient = quotient.wrapping_add(1);
    }
    if b >= a {
        a.wrapping_add_unsigned(quotient)
    } else {
        a.wrapping_sub_unsigned(quotient)
    }
}

/// Divides several numbers by one of up to 19 bits, the last 8 of them 0, where quotients have up to 13.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Divider {
    divisor: NonZeroU32,
    /// Only where there is no division.
    reciprocal: narrow::ShortReciprocal,
}

impl Divider {
    /// By a number below 2^19.
    #[inline]
    pub(crate) fn new(divisor: NonZeroU32) -> Self {
        Self {
            divisor,
            reciprocal: if NARROW {
                narrow::ShortReciprocal::new(divisor)
            } else {
                narrow::ShortReciprocal::default()
            },
        }
    }

    /// Rounded down, if it is below 2^13.
    #[inline]
    pub(crate) fn quotient(&self, n: u32) -> u32 {
        if NARROW {
            self.reciprocal.quotient(n, self.divisor)
        } else {
            n / self.divisor
        }
    }
}

/// Quotient and remainder.
#[inline]
pub(crate) fn div_rem(n: u32, d: NonZeroU32) -> (u32, u32) {
    if NARROW {
        narrow::div_rem(n, d)
    } else {
        (n / d, n % d)
    }
}

/// `n / d` as 32.32, rounded down, for `|n| < 2^28` and `d <= 2^19`. A useless number for other divisors.
#[inline]
pub(crate) fn quotient(n: i32, d: NonZeroU32) -> i64 {
    if NARROW {
        let (quotient, rest) = narrow::long_quotient(n.unsigned_abs(), d);
        if n >= 0 {
            quotient
        } else {
            // Away from zero.
            quotient.wrapping_add(i64::from(rest > 0)).wrapping_neg()
        }
    } else if cfg!(target_pointer_width = "64") {
        (i64::from(n) << 32)
            .checked_div_euclid(i64::from(d.get()))
            .unwrap_or_default()
    } else {
        wide::long_quotient(n, d)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn narrow_arithmetic_gives_the_same_bits() {
        for h in 1 << 15..1 << 16 {
            assert_eq!(narrow::quotient(h), u32::MAX / h, "h = {h:#x}");
        }
        for d in (1 << 8..1 << 19)
            .step_by(1 << 8)
            .filter_map(NonZeroU32::new)
        {
            let reciprocal = narrow::ShortReciprocal::new(d);
            for whole in 0..1 << 13 {
                for off in [0, 1, d.get() / 2, d.get() - 1] {
                    if let Ok(n) = u32::try_from(whole * u64::from(d.get()) + u64::from(off)) {
                        assert_eq!(reciprocal.quotient(n, d), n / d, "{n} / {d}");
                    }
                }
            }
        }
        let mut state = 1u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state ^ state >> 15).cast_signed()
        };
        let pairs = (0..1_000_000).map(|_| (next(), next()));
        let ends = [i32::MIN, -65536, -65535, -1, 0, 1, 65535, 65536, i32::MAX];
        for (a, b) in pairs.chain(ends.into_iter().flat_map(|a| ends.map(|b| (a, b)))) {
            let found = narrow::multiply_high(a, b);
            assert_eq!(found, wide::multiply_high(a, b), "{a} * {b}");
            assert_eq!(
                narrow::product(a, b),
                i64::from(a) * i64::from(b),
                "{a} * {b}"
            );
            let (n, d) = (a.cast_unsigned(), b.cast_unsigned());
            for d in [d, d >> 8, d >> 16, d >> 24]
                .into_iter()
                .filter_map(NonZeroU32::new)
            {
                assert_eq!(narrow::div_rem(n, d), (n / d, n % d), "{n} / {d}");
            }
            let long = i64::from(a) << 32 | i64::from(b.cast_unsigned());
            for short in [a >> 16, b >> 16] {
                assert_eq!(
                    narrow::product_with_short(long, short),
                    long.wrapping_mul(i64::from(short)),
                    "{long} * {short}"
                );
            }
            let (a, b) = (a.cast_unsigned(), b.cast_unsigned());
            assert_eq!(
                narrow::product_unsigned(a, b),
                u64::from(a) * u64::from(b),
                "{a} * {b}"
            );
        }
    }

    /// Of every estimate there is, with the rests that divisors leave: the least and the greatest of each.
    #[test]
    fn refinements_give_the_same_bits() {
        for head in 1u32 << 15..1 << 16 {
            let estimate = u32::MAX / head;
            for part in [0, 1, 0x1fff, 0x2000, 0x3ffe, 0x3fff] {
                let d = head << 14 | part;
                let rest = d.wrapping_mul(estimate).cast_signed();
                let expected = wide::refined(estimate, rest);
                let found = [narrow::refined(estimate, rest), long::refined(estimate, d)];
                assert_eq!(found, [expected; 2], "{estimate:#x} {rest:#x}");
            }
        }
    }

    /// Checks what [`reciprocal`] promises for one divisor, without a division: with
    /// `r = 2^62 / d (1 + e)`, `e = (r d - 2^62) / 2^62`, and `-2^-29 < e < 2^-29` means
    /// `|2^62 - r d| < 2^33`.
    fn check_reciprocal(d: u32) {
        let r = reciprocal(d);
        let short = (1i128 << 62) - i128::from(r) * i128::from(d);
        assert!(short.abs() < 1 << 33, "d = {d:#x}: r = {r:#x}");
        assert!(
            ((1 << 30) - 2..1 << 31).contains(&r),
            "d = {d:#x}: r = {r:#x}"
        );
    }

    #[test]
    fn reciprocal_at_a_stride_and_near_powers_of_two() {
        // The stride is a prime, so that the low bits take all values too: 8.5 million divisors.
        for d in ((1u32 << 31)..=u32::MAX).step_by(251) {
            check_reciprocal(d);
        }
        // Around the ends, and where one bit more is set: there `head` changes or is exact.
        for bit in 0..=31 {
            let near = (1u32 << 31) | (1 << bit);
            for distance in 0..=0xffff {
                check_reciprocal(near.saturating_add(distance));
                check_reciprocal((near - 1 - distance) | 1 << 31);
            }
        }
        for distance in 0..=0xf_ffff {
            check_reciprocal((1 << 31) + distance);
            check_reciprocal(u32::MAX - distance);
        }
    }

    /// Every divisor there is: some 10 s where overflow checks are off, too long elsewhere.
    #[cfg(not(debug_assertions))]
    #[test]
    fn reciprocal_everywhere() {
        // All divisors that differ in their last two bits only have the same.
        for d in ((1u32 << 31)..=u32::MAX).step_by(4) {
            let r = reciprocal(d);
            assert!(r >= (1 << 30) - 2 && r < 1 << 31);
            for d in [d, d | 3] {
                assert_eq!(reciprocal(d), r);
                let short = (1i64 << 62).wrapping_sub_unsigned(u64::from(r) * u64::from(d));
                assert!(short.abs() < 1 << 33);
            }
        }
    }

    /// The divisors of [`short_reciprocal`], of which 10 bits are cut.
    const SHORT_DIVISORS: core::ops::Range<u32> = (8 << 25) / 9..(8 << 26) / 7;

    #[test]
    fn short_reciprocals_everywhere() {
        for head in SHORT_DIVISORS.start >> 10..=SHORT_DIVISORS.end >> 10 {
            for d in [head << 10, (head << 10) + 0x3ff] {
                let r = i64::from(short_reciprocal(d));
                let off = (1i64 << 42) - r * i64::from(d + (1 << 9));
                // 2^-15.3 of 2^42.
                assert!(off.abs() < (1 << 26) * 163 / 100, "{d:#x}: {r:#x}");
            }
            assert_eq!(narrow::short_quotient(head + 1), u32::MAX / (head + 1));
        }
    }

    #[test]
    fn short_products_are_the_same() {
        let mut numbers = Numbers(0x5ca1_ab1e_0000_0001);
        for round in 0..500_000u32 {
            let mut within = |limit: i32| match numbers.next() % 9 {
                0 => 1 - limit,
                1 => limit - 1,
                _ => (numbers.next() % (2 * limit as u64 - 1)) as i32 + 1 - limit,
            };
            let (b, c) = (within(1 << 17) + (1 << 17), within(1 << 16));
            // As large as the result allows, and less.
            let a = within(1 << 25);
            let most = ((1i64 << 42) / i64::from(b.max(1))).min(1 << 30) as i32;
            let long = within(most) >> (round % 8);
            let exact = |a: i32, b: i32| i64::from(a) * i64::from(b);
            let found = [
                long::product_down::<19>(long, b),
                wide::product_down::<19>(long, b),
                narrow::product_in_halves::<11>(long, b) >> 8,
            ];
            let expected = exact(long, b) >> 19;
            assert_eq!(i64::from(times_short_reciprocal(long, b)), expected);
            assert_eq!(found.map(i64::from), [expected; 3], "{long} {b}");
            let found = [
                long::product_down::<18>(a, c),
                wide::product_down::<18>(a, c),
                narrow::product_in_halves::<10>(a, c) >> 8,
            ];
            let expected = exact(a, c) >> 18;
            assert_eq!(i64::from(short_product(a, c)), expected);
            assert_eq!(found.map(i64::from), [expected; 3], "{a} {c}");
            let quotient = (b & 0xffff) | 0x1_0000;
            let a = within(1 << 28);
            let found = [
                long::product_down::<18>(a, quotient),
                wide::product_down::<18>(a, quotient),
                narrow::times_quotient(a, quotient),
            ];
            let expected = exact(a, quotient) >> 18;
            assert_eq!(i64::from(times_quotient(a, quotient)), expected);
            assert_eq!(found.map(i64::from), [expected; 3], "{a} {quotient}");
            let [a, c] = [(a, 24), (b, 17)].map(|(n, bits)| n.cast_unsigned() & ((1 << bits) - 1));
            let found = [
                short_product_unsigned(a, c),
                narrow::short_product_unsigned(a, c),
            ];
            let expected = (u64::from(a) * u64::from(c)) >> 9;
            assert_eq!(found.map(u64::from), [expected; 2], "{a} {c}");
        }
    }

    /// An unnormalised divisor gives some number.
    #[test]
    fn reciprocal_of_nonsense_does_not_panic() {
        for bit in 0..32 {
            for d in [(1 << bit) - 1, 1 << bit, u32::MAX << bit] {
                _ = reciprocal(d);
                _ = short_reciprocal(d);
                if d >= 1 << 10 {
                    _ = narrow::short_quotient(d >> 10);
                }
            }
        }
    }

    #[test]
    fn inverse_normalises() {
        for w in (0..31)
            .flat_map(|bit| [1u32 << bit, (1 << bit) | 1, (2 << bit) - 1])
            .chain([0x7fff_fffe])
        {
            let inverse = Inverse::new(w);
            // 2^62 / (w 2^exponent), off by less than 2^-29 of it.
            let short = (1i128 << 62)
                - ((i128::from(inverse.mantissa) * i128::from(w)) << inverse.exponent);
            assert!(short.abs() < 1 << 33, "w = {w:#x}");
        }
    }

    /// xorshift64 (Marsaglia, "Xorshift RNGs", 2003): enough variety for a unit test.
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> u64 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            self.0
        }

        /// Of any length, up to `bits` bits.
        fn short(&mut self, bits: u64) -> u64 {
            let length = 1 + self.next() % bits;
            self.next() >> (64 - length)
        }
    }

    /// The nearest integer to the rational number: at most half a unit off, `2 |r d - exact| <= d`,
    /// and of two equally near ones the farther from `a`.
    fn check_interpolate(a: i32, b: i32, n: u64, d: u64) {
        let result = interpolate(a, b, n, d);
        let (n, d) = (i128::from(n), i128::from(d));
        let exact = i128::from(a) * d + (i128::from(b) - i128::from(a)) * n;
        let off = 2 * (i128::from(result) * d - exact);
        assert!(off.abs() <= d, "{a} to {b}, {n} / {d}: {result}");
        let away = if b >= a { off } else { -off };
        assert!(
            away > -d,
            "{a} to {b}, {n} / {d}: {result} is a tie, but towards a"
        );
    }

    #[test]
    fn interpolation_is_exact() {
        let mut numbers = Numbers(0x1234_5678_9abc_def1);
        for _ in 0..500_000 {
            let d = numbers.short(62).clamp(1, (1 << 62) - 1);
            let n = numbers.short(62) % (d + 1);
            let mut end = || (numbers.short(32) as u32).cast_signed();
            check_interpolate(end(), end(), n, d);
        }
        let ends = [i32::MIN, i32::MIN + 1, -1, 0, 1, i32::MAX - 1, i32::MAX];
        let divisors = [1u64, 2, 3, 4, (1 << 61) - 1, (1 << 62) - 2, (1 << 62) - 1];
        for a in ends {
            for b in ends {
                for d in divisors {
                    for n in [0, 1, d / 2, d.div_ceil(2), d - 1, d] {
                        check_interpolate(a, b, n, d);
                    }
                }
                // The ends come out as they are: a vertex on the plane is cut to itself.
                assert_eq!(interpolate(a, b, 0, 7), a);
                assert_eq!(interpolate(a, b, 7, 7), b);
            }
        }
    }

    #[test]
    fn sums_over_subpixels_are_the_same() {
        let mut numbers = Numbers(0x0bad_cafe_0dd5_eed5);
        let ends = [i32::MIN, -257, -1, 0, 255, 256, i32::MAX];
        let far = [1 - (1 << 19), -1, 0, 127, (1 << 19) - 1];
        let check = |over: [i32; 2], far: [i32; 2]| {
            assert_eq!(
                narrow::over_subpixels(over, far),
                over_subpixels(over, far),
                "{over:?} {far:?}"
            );
        };
        for _ in 0..500_000 {
            let over = [0; 2].map(|_| numbers.next() as i32);
            check(over, [0; 2].map(|_| numbers.next() as i32 >> 12));
        }
        for over in ends.into_iter().flat_map(|a| ends.map(|b| [a, b])) {
            for far in far.into_iter().flat_map(|a| far.map(|b| [a, b])) {
                check(over, far);
            }
        }
    }

    #[test]
    fn quotients_are_rounded_down_alike() {
        let check = |n: i32, d: u32| {
            let exact = ((i128::from(n) << 32).div_euclid(i128::from(d))) as i64;
            let divisor = NonZeroU32::new(d).expect("a divisor");
            assert_eq!(quotient(n, divisor), exact, "{n} / {d}");
            assert_eq!(wide::long_quotient(n, divisor), exact, "{n} / {d}");
            let (narrow, rest) = narrow::long_quotient(n.unsigned_abs(), divisor);
            let n = u64::from(n.unsigned_abs()) << 32;
            let d = u64::from(d);
            assert_eq!(narrow, (n / d).cast_signed(), "{n} / {d}");
            assert_eq!(u64::from(rest), n % d, "{n} / {d}");
        };
        let mut numbers = Numbers(0xfeed_beef_cafe_0001);
        for _ in 0..2_000_000 {
            let n = (numbers.short(28) as u32).cast_signed();
            let d = (numbers.short(19) as u32).max(1);
            check(n, d);
            check(n.wrapping_neg(), d);
        }
        // Digits are farthest off where the bits that have no inverse are all ones.
        let steep =
            (1..=19).flat_map(|bits| [1, 15, 31].map(|less| (1u32 << bits).saturating_sub(less)));
        for d in steep
            .chain([1, 2, 3, 1 << 19])
            .chain((1 << 15..1 << 16).map(|d| d << 3 | 7))
        {
            let d = d.max(1);
            let most = (1i64 << 28).min(i64::from(d) << 11) as i32;
            for n in [most - 1, d.cast_signed() - 1, d.cast_signed(), 1, 0] {
                check(n, d);
                check(n.wrapping_neg(), d);
            }
        }
    }

    #[test]
    fn long_products_and_shifts() {
        let mut numbers = Numbers(0x0123_4567_89ab_cdef);
        for _ in 0..500_000 {
            let a = (numbers.short(64) >> 1).cast_signed();
            let a = if numbers.next() & 1 == 0 {
                a
            } else {
                a.wrapping_neg()
            };
            let b = (numbers.short(31) as u32).cast_signed();
            let exact = i128::from(a) * i128::from(b);
            let (high, low) = long_product(a, b);
            assert_eq!(i128::from(high) << 32 | i128::from(low), exact, "{a} * {b}");
            for shift in [0, 1, 17, 31] {
                assert_eq!(shifted_down((high, low), shift), (exact >> shift) as i64);
            }
        }
    }
}
