//! Vectors, number by number.

use core::array::from_fn;

use super::COUNT;
use crate::colour::LANE_BITS;

/// Eight numbers of 16 bits.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(
    test,
    allow(unreachable_pub, reason = "it stands in for one that is not")
)]
pub struct U16x8([u16; COUNT]);

impl U16x8 {
    /// What a function gives for each.
    #[inline(always)]
    pub(crate) fn through(self, each: impl Fn(u16) -> u16) -> Self {
        Self(self.0.map(each))
    }

    #[inline(always)]
    pub(crate) const fn new(numbers: [u16; COUNT]) -> Self {
        Self(numbers)
    }

    #[inline(always)]
    pub(crate) const fn splat(number: u16) -> Self {
        Self([number; COUNT])
    }

    #[inline(always)]
    pub(crate) const fn array(self) -> [u16; COUNT] {
        self.0
    }

    #[inline(always)]
    fn with(self, other: Self, f: impl Fn(u16, u16) -> u16) -> Self {
        let mut result = self;
        for (a, b) in result.0.iter_mut().zip(other.0) {
            *a = f(*a, b);
        }
        result
    }

    #[inline(always)]
    pub(crate) fn and(self, mask: u16) -> Self {
        Self(self.0.map(|number| number & mask))
    }

    #[inline(always)]
    pub(crate) fn or(self, other: Self) -> Self {
        self.with(other, |a, b| a | b)
    }

    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        self.with(other, u16::wrapping_add)
    }

    #[inline(always)]
    pub(crate) fn minus(self, other: Self) -> Self {
        self.with(other, u16::wrapping_sub)
    }

    /// Lower halves of products.
    #[inline(always)]
    pub(crate) fn times(self, other: Self) -> Self {
        self.with(other, u16::wrapping_mul)
    }

    /// Upper halves of products.
    #[inline(always)]
    pub(crate) fn times_high(self, other: Self) -> Self {
        self.with(other, |a, b| ((u32::from(a) * u32::from(b)) >> 16) as u16)
    }

    /// `a x + b y`, of numbers below 2^15.
    #[inline(always)]
    pub(crate) fn dot(pair: [Self; 2], by: [Self; 2]) -> U32x8 {
        let mut sums = [0u32; COUNT];
        for (Self(numbers), Self(by)) in pair.into_iter().zip(by) {
            for ((sum, number), by) in sums.iter_mut().zip(numbers).zip(by) {
                *sum = sum.wrapping_add(u32::from(number) * u32::from(by));
            }
        }
        U32x8(sums)
    }

    /// Whether each is greater than its counterpart.
    #[inline(always)]
    pub(crate) fn is_above(self, other: Self) -> bool {
        self.0.iter().zip(other.0).all(|(&a, b)| a > b)
    }

    /// So many bits up; 0 if all are lost.
    #[inline(always)]
    pub(crate) fn up(self, bits: u32) -> Self {
        Self(self.0.map(|number| number.checked_shl(bits).unwrap_or(0)))
    }

    /// So many bits down; 0 if all are lost.
    #[inline(always)]
    pub(crate) fn down(self, bits: u32) -> Self {
        Self(self.0.map(|number| number.checked_shr(bits).unwrap_or(0)))
    }

    /// From `self` to `other` by a weight in `0 ..= 2^12`, rounded down.
    #[inline(always)]
    pub(crate) fn lerp(self, other: Self, weight: u32) -> Self {
        self.with(other, |a, b| lerp(a.into(), b.into(), weight) as u16)
    }

    /// From `self` to `other` by a weight in `0 ..= 2^`[`LANE_BITS`], rounded to the nearest, halves up. Of up to 8 bits.
    #[inline(always)]
    pub(crate) fn to(self, other: Self, weight: Self) -> Self {
        let change = self.with(other, |a, b| b.wrapping_sub(a));
        let part = change.with(weight, |change, weight| {
            let product = change.wrapping_mul(weight);
            let rounded = product.wrapping_add(1 << (LANE_BITS - 1));
            (rounded.cast_signed() >> LANE_BITS).cast_unsigned()
        });
        self.plus(part)
    }
}

#[inline(always)]
const fn lerp(from: u32, to: u32, weight: u32) -> u32 {
    let change = to.wrapping_sub(from).wrapping_mul(weight).cast_signed();
    from.wrapping_add_signed(change >> 12)
}

/// Eight numbers of 32 bits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct U32x8([u32; COUNT]);

impl U32x8 {
    #[inline(always)]
    fn with(self, other: Self, f: impl Fn(u32, u32) -> u32) -> Self {
        let mut result = self;
        for (a, b) in result.0.iter_mut().zip(other.0) {
            *a = f(*a, b);
        }
        result
    }

    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        self.with(other, u32::wrapping_add)
    }

    #[inline(always)]
    pub(crate) fn minus(self, other: Self) -> Self {
        self.with(other, u32::wrapping_sub)
    }

    #[inline(always)]
    pub(crate) fn or(self, other: Self) -> Self {
        self.with(other, |a, b| a | b)
    }

    #[inline(always)]
    pub(crate) fn and(self, mask: u32) -> Self {
        Self(self.0.map(|number| number & mask))
    }

    #[inline(always)]
    pub(crate) const fn splat(number: u32) -> Self {
        Self([number; COUNT])
    }

    /// So many bits down, to below 2^15: greater numbers become anything.
    #[inline(always)]
    pub(crate) fn down<const BITS: i32>(self) -> U16x8 {
        U16x8(self.0.map(|number| (number >> (BITS & 31)) as u16))
    }

    /// From `self` to `other`, of up to 17 bits, by a weight in `0 ..= 2^12`, rounded down.
    #[inline(always)]
    pub(crate) fn lerp(self, other: Self, weight: u32) -> Self {
        self.with(other, |a, b| lerp(a, b, weight))
    }

    /// So many bits up; 0 if all are lost.
    #[inline(always)]
    pub(crate) fn up(self, bits: u32) -> Self {
        Self(self.0.map(|number| number.checked_shl(bits).unwrap_or(0)))
    }

    /// So many bits down; 0 if all are lost.
    #[inline(always)]
    pub(crate) fn down_by(self, bits: u32) -> Self {
        Self(self.0.map(|number| number.checked_shr(bits).unwrap_or(0)))
    }

    /// Lower halves.
    #[inline(always)]
    pub(crate) fn lower_halves(self) -> [u16; COUNT] {
        self.0.map(|number| number as u16)
    }

    #[inline(always)]
    pub(crate) const fn array(self) -> [u32; COUNT] {
        self.0
    }

    /// Each in both halves of a number of 64 bits.
    #[inline(always)]
    pub(crate) fn twice(self) -> U64x8 {
        U64x8(self.0.map(twice))
    }
}

#[inline(always)]
fn twice(number: u32) -> u64 {
    u64::from(number) << 32 | u64::from(number)
}

impl Default for U16x8 {
    #[inline(always)]
    fn default() -> Self {
        Self::splat(0)
    }
}

impl Default for U32x8 {
    #[inline(always)]
    fn default() -> Self {
        Self::splat(0)
    }
}

/// Eight numbers of 64 bits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct U64x8([u64; COUNT]);

impl U64x8 {
    #[inline(always)]
    pub(crate) const fn new(numbers: [u64; COUNT]) -> Self {
        Self(numbers)
    }

    #[cfg(test)]
    pub(crate) const fn array(self) -> [u64; COUNT] {
        self.0
    }

    #[inline(always)]
    pub(crate) const fn splat(number: u64) -> Self {
        Self([number; COUNT])
    }

    #[inline(always)]
    fn with(self, other: Self, f: impl Fn(u64, u64) -> u64) -> Self {
        let mut result = self;
        for (a, b) in result.0.iter_mut().zip(other.0) {
            *a = f(*a, b);
        }
        result
    }

    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        self.with(other, u64::wrapping_add)
    }

    #[inline(always)]
    pub(crate) fn minus(self, other: Self) -> Self {
        self.with(other, u64::wrapping_sub)
    }

    #[inline(always)]
    pub(crate) fn xor(self, other: Self) -> Self {
        self.with(other, |a, b| a ^ b)
    }

    /// Products of lower halves.
    #[inline(always)]
    pub(crate) fn times(self, other: Self) -> Self {
        let lower = |number| u64::from(number as u32);
        self.with(other, |a, b| lower(a) * lower(b))
    }

    #[inline(always)]
    pub(crate) fn up<const BITS: i32>(self) -> Self {
        Self(self.0.map(|number| number << (BITS & 63)))
    }

    #[inline(always)]
    pub(crate) fn down<const BITS: i32>(self) -> Self {
        Self(self.0.map(|number| number >> (BITS & 63)))
    }

    /// Upper halves, each in both halves of a number.
    #[inline(always)]
    pub(crate) fn uppers_twice(self) -> Self {
        Self(self.0.map(|number| twice((number >> 32) as u32)))
    }

    /// Upper halves.
    #[inline(always)]
    pub(crate) fn uppers(self) -> U32x8 {
        U32x8(self.0.map(|number| (number >> 32) as u32))
    }
}

/// Words that each differ from the last by a step, eight at a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walk {
    /// The next eight.
    words: [u32; COUNT],
    /// Eight steps.
    stride: u32,
}

impl Walk {
    #[inline(always)]
    pub(crate) fn new(first: u32, step: u32) -> Self {
        Self {
            words: from_fn(|number| first.wrapping_add(step.wrapping_mul(number as u32))),
            stride: step.wrapping_mul(COUNT as u32),
        }
    }

    /// The upper halves of the next eight, so many bits of which are lost at the top.
    #[inline(always)]
    pub(crate) fn tops(&self, up: u32) -> U16x8 {
        U16x8(self.words.map(|word| (word << (up & 31) >> 16) as u16))
    }

    /// The upper halves of the next eight.
    #[inline(always)]
    pub(crate) fn next(&mut self) -> U16x8 {
        let tops = self.tops(0);
        self.next_words();
        tops
    }

    /// The next eight.
    #[inline(always)]
    pub(crate) fn next_words(&mut self) -> U32x8 {
        let words = U32x8(self.words);
        self.words = self.words.map(|word| word.wrapping_add(self.stride));
        words
    }
}

/// The same of 64 bits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LongWalk {
    next: u64,
    step: u64,
}

impl LongWalk {
    #[inline(always)]
    pub(crate) const fn new(first: u64, step: u64) -> Self {
        Self { next: first, step }
    }

    /// The next eight.
    #[inline(always)]
    pub(crate) fn next(&mut self) -> U64x8 {
        let far = |number: usize| self.step.wrapping_mul(number as u64);
        let words = from_fn(|number| self.next.wrapping_add(far(number)));
        self.next = self.next.wrapping_add(far(COUNT));
        U64x8(words)
    }
}
