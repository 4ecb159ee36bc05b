//! The integer arithmetic that more than one stage needs: a reciprocal, an exact interpolation and
//! a division that rounds down. A leaf: it knows no stage.

use core::num::NonZeroU32;

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
    // By contract this bit is set already; the OR only tells the compiler that head is not zero.
    const TOP: NonZeroU32 = NonZeroU32::new(1 << 15).unwrap();
    let head = TOP | (d >> 16);
    // 2^48 / d to within 2^-15 of its value: head is short by less than 1 in 2^15, the quotient
    // by at most 1 in 2^16, and the two errors have opposite signs.
    let estimate = u32::MAX / head;
    // d * estimate = 2^48 (1 + e) with -2^-16 <= e < 2^-15: the rest fits 34 bits with its sign.
    let rest = (1i64 << 48).wrapping_sub((u64::from(d) * u64::from(estimate)).cast_signed());
    // estimate (1 - e) instead of estimate / (1 + e): too small by e^2 < 2^-30, and by less than
    // one unit (at most 2^-30) from the shift.
    let correction = i64::from(estimate).wrapping_mul(rest) >> 34;
    let result = (i64::from(estimate) << 14).wrapping_add(correction);
    // 2^31 itself (for d = 2^31) would not fit the signed 32-bit factor that it is used as.
    result.min(i64::from(i32::MAX)) as u32
}

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
        let exponent = w.leading_zeros() & 31;
        Self {
            mantissa: reciprocal(w << exponent),
            exponent,
        }
    }
}

/// `a + (b - a) * n / d`, rounded to the nearest integer, for `0 <= n <= d` and `0 < d < 2^62`.
///
/// Exact: the product is never formed, the quotient is found bit by bit as in long
/// multiplication (numerator bits from the top) with a running remainder.
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

/// Quotient and remainder of `n / d`, the quotient rounded down and `0 <= remainder < d`.
#[inline]
pub(crate) fn div_floor(n: i32, d: NonZeroU32) -> (i32, u32) {
    let magnitude = n.unsigned_abs();
    let (quotient, remainder) = (magnitude / d, magnitude % d);
    if n >= 0 {
        (quotient.cast_signed(), remainder)
    } else if remainder == 0 {
        (0i32.wrapping_sub_unsigned(quotient), 0)
    } else {
        (
            (-1i32).wrapping_sub_unsigned(quotient),
            d.get().wrapping_sub(remainder),
        )
    }
}
