//! Vectors by SSE2 (Intel, *Software Developer's Manual*, volume 1, chapter 11).
//!
//! Arrays do not do: the compiler takes them apart, and bilinear filtering takes 69 instructions a pixel so, and 34 here.
#![allow(unsafe_code, reason = "instructions that not every x86 has")]

use core::arch::x86_64::{
    __m128i, _mm_add_epi16, _mm_add_epi32, _mm_add_epi64, _mm_and_si128, _mm_castps_si128,
    _mm_castsi128_ps, _mm_cmpeq_epi16, _mm_cvtsi32_si128, _mm_extract_epi16, _mm_insert_epi16,
    _mm_madd_epi16, _mm_movemask_epi8, _mm_mul_epu32, _mm_mulhi_epu16, _mm_mullo_epi16,
    _mm_or_si128, _mm_packs_epi32, _mm_set_epi16, _mm_set_epi32, _mm_set_epi64x, _mm_set1_epi16,
    _mm_set1_epi32, _mm_set1_epi64x, _mm_setzero_si128, _mm_shuffle_epi32, _mm_shuffle_ps,
    _mm_sll_epi16, _mm_sll_epi32, _mm_slli_epi32, _mm_slli_epi64, _mm_srai_epi16, _mm_srai_epi32,
    _mm_srl_epi16, _mm_srl_epi32, _mm_srli_epi32, _mm_srli_epi64, _mm_sub_epi16, _mm_sub_epi32,
    _mm_sub_epi64, _mm_subs_epu16, _mm_unpackhi_epi16, _mm_unpacklo_epi16, _mm_xor_si128,
};
use core::array::from_fn;
use core::hint::black_box;

use super::COUNT;
use crate::colour::LANE_BITS;

/// One instruction, of variables.
macro_rules! sse2 {
    ($instruction:ident $(::<$constant:tt>)? ($($operand:ident),*)) => {{
        const { assert!(cfg!(target_feature = "sse2")) };
        // SAFETY: what is here takes registers and gives one, and reaches no memory; it is unsafe only where the processor
        // may lack the instruction. One that lacks it does not run this: it is asserted that SSE2 is what all of the
        // program is built for.
        unsafe { $instruction $(::<$constant>)? ($($operand),*) }
    }};
}

/// Eight numbers of 16 bits.
#[derive(Clone, Copy, Debug)]
pub struct U16x8(__m128i);

impl U16x8 {
    /// What a function gives for each, as a texture its texels.
    #[inline(always)]
    pub(crate) fn through(self, each: impl Fn(u16) -> u16) -> Self {
        let [a, b, c, d, e, f, g, h] = self.array();
        let number = |from| i32::from(each(from));
        // Zeros that the compiler takes for something else. Of a vector that it knows it would make eight, of one number
        // each, and put them together by pairs: that is twice the instructions.
        let others = black_box(sse2!(_mm_setzero_si128()));
        let b = number(b);
        let others = sse2!(_mm_insert_epi16::<1>(others, b));
        let c = number(c);
        let others = sse2!(_mm_insert_epi16::<2>(others, c));
        let d = number(d);
        let others = sse2!(_mm_insert_epi16::<3>(others, d));
        let e = number(e);
        let others = sse2!(_mm_insert_epi16::<4>(others, e));
        let f = number(f);
        let others = sse2!(_mm_insert_epi16::<5>(others, f));
        let g = number(g);
        let others = sse2!(_mm_insert_epi16::<6>(others, g));
        let h = number(h);
        let others = sse2!(_mm_insert_epi16::<7>(others, h));
        let a = number(a);
        let first = sse2!(_mm_cvtsi32_si128(a));
        Self(sse2!(_mm_or_si128(first, others)))
    }

    #[inline(always)]
    pub(crate) fn new(numbers: [u16; COUNT]) -> Self {
        let [a, b, c, d, e, f, g, h] = numbers.map(u16::cast_signed);
        Self(sse2!(_mm_set_epi16(h, g, f, e, d, c, b, a)))
    }

    #[inline(always)]
    pub(crate) fn splat(number: u16) -> Self {
        let number = number.cast_signed();
        Self(sse2!(_mm_set1_epi16(number)))
    }

    #[inline(always)]
    pub(crate) fn array(self) -> [u16; COUNT] {
        let Self(all) = self;
        [
            sse2!(_mm_extract_epi16::<0>(all)),
            sse2!(_mm_extract_epi16::<1>(all)),
            sse2!(_mm_extract_epi16::<2>(all)),
            sse2!(_mm_extract_epi16::<3>(all)),
            sse2!(_mm_extract_epi16::<4>(all)),
            sse2!(_mm_extract_epi16::<5>(all)),
            sse2!(_mm_extract_epi16::<6>(all)),
            sse2!(_mm_extract_epi16::<7>(all)),
        ]
        .map(|number| number as u16)
    }

    #[inline(always)]
    pub(crate) fn and(self, mask: u16) -> Self {
        let (Self(a), Self(b)) = (self, Self::splat(mask));
        Self(sse2!(_mm_and_si128(a, b)))
    }

    #[inline(always)]
    pub(crate) fn or(self, other: Self) -> Self {
        let (Self(a), Self(b)) = (self, other);
        Self(sse2!(_mm_or_si128(a, b)))
    }

    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        let (Self(a), Self(b)) = (self, other);
        Self(sse2!(_mm_add_epi16(a, b)))
    }

    #[inline(always)]
    pub(crate) fn minus(self, other: Self) -> Self {
        let (Self(a), Self(b)) = (self, other);
        Self(sse2!(_mm_sub_epi16(a, b)))
    }

    /// Lower halves of products.
    #[inline(always)]
    pub(crate) fn times(self, other: Self) -> Self {
        let (Self(a), Self(b)) = (self, other);
        Self(sse2!(_mm_mullo_epi16(a, b)))
    }

    /// Upper halves of products.
    #[inline(always)]
    pub(crate) fn times_high(self, other: Self) -> Self {
        let (Self(a), Self(b)) = (self, other);
        Self(sse2!(_mm_mulhi_epu16(a, b)))
    }

    /// `a x + b y`, of numbers below 2^15.
    #[inline(always)]
    pub(crate) fn dot([a, b]: [Self; 2], [x, y]: [Self; 2]) -> U32x8 {
        let (Self(a), Self(b), Self(x), Self(y)) = (a, b, x, y);
        let (low, by) = (
            sse2!(_mm_unpacklo_epi16(a, b)),
            sse2!(_mm_unpacklo_epi16(x, y)),
        );
        let low = sse2!(_mm_madd_epi16(low, by));
        let (high, by) = (
            sse2!(_mm_unpackhi_epi16(a, b)),
            sse2!(_mm_unpackhi_epi16(x, y)),
        );
        let high = sse2!(_mm_madd_epi16(high, by));
        U32x8([low, high])
    }

    /// Whether each is greater than its counterpart.
    #[inline(always)]
    pub(crate) fn is_above(self, other: Self) -> bool {
        let (Self(a), Self(b)) = (self, other);
        let zero = sse2!(_mm_setzero_si128());
        let beyond = sse2!(_mm_subs_epu16(a, b));
        let is_none = sse2!(_mm_cmpeq_epi16(beyond, zero));
        sse2!(_mm_movemask_epi8(is_none)) == 0
    }

    /// So many bits up; 0 if all are lost.
    #[inline(always)]
    pub(crate) fn up(self, bits: u32) -> Self {
        let (Self(a), bits) = (self, bits.cast_signed());
        let bits = sse2!(_mm_cvtsi32_si128(bits));
        Self(sse2!(_mm_sll_epi16(a, bits)))
    }

    /// So many bits down; 0 if all are lost.
    #[inline(always)]
    pub(crate) fn down(self, bits: u32) -> Self {
        let (Self(a), bits) = (self, bits.cast_signed());
        let bits = sse2!(_mm_cvtsi32_si128(bits));
        Self(sse2!(_mm_srl_epi16(a, bits)))
    }

    /// From `self` to `other` by a weight in `0 ..= 2^12`, rounded down.
    #[inline(always)]
    pub(crate) fn lerp(self, other: Self, weight: u32) -> Self {
        // Numbers with a sign, each by as much less: that does not change what lies between them.
        let Self(signs) = Self::splat(1 << 15);
        let (Self(from), Self(to)) = (self, other);
        let (a, b) = (
            sse2!(_mm_xor_si128(from, signs)),
            sse2!(_mm_xor_si128(to, signs)),
        );
        let weights = pair_weights(weight);
        let change = |pairs: __m128i| {
            let change = sse2!(_mm_madd_epi16(pairs, weights));
            // Down by 12 bits, and of what remains the lower half with its sign, as packing wants it.
            let change = sse2!(_mm_slli_epi32::<4>(change));
            sse2!(_mm_srai_epi32::<16>(change))
        };
        let low = change(sse2!(_mm_unpacklo_epi16(a, b)));
        let high = change(sse2!(_mm_unpackhi_epi16(a, b)));
        let change = sse2!(_mm_packs_epi32(low, high));
        Self(sse2!(_mm_add_epi16(from, change)))
    }

    /// From `self` to `other` by a weight in `0 ..= 2^`[`LANE_BITS`], rounded to the nearest, halves up. Of up to 8 bits.
    #[inline(always)]
    pub(crate) fn to(self, other: Self, weight: Self) -> Self {
        const BITS: i32 = LANE_BITS.cast_signed();
        const HALF: u16 = 1 << (LANE_BITS - 1);
        let (Self(from), Self(to), Self(weight)) = (self, other, weight);
        let Self(half) = Self::splat(HALF);
        let change = sse2!(_mm_sub_epi16(to, from));
        let change = sse2!(_mm_mullo_epi16(change, weight));
        let rounded = sse2!(_mm_add_epi16(change, half));
        let part = sse2!(_mm_srai_epi16::<BITS>(rounded));
        Self(sse2!(_mm_add_epi16(from, part)))
    }
}

/// Of 12 bits between two numbers, `0 ..= 2^12`: one word for a dot product with pairs of both, the first of them
/// negative.
#[inline(always)]
fn pair_weights(weight: u32) -> __m128i {
    let pair = (weight << 16 | weight.wrapping_neg() & 0xffff).cast_signed();
    sse2!(_mm_set1_epi32(pair))
}

/// Eight numbers of 32 bits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct U32x8([__m128i; 2]);

impl U32x8 {
    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        let (Self([a, b]), Self([c, d])) = (self, other);
        Self([sse2!(_mm_add_epi32(a, c)), sse2!(_mm_add_epi32(b, d))])
    }

    #[inline(always)]
    pub(crate) fn splat(number: u32) -> Self {
        let number = number.cast_signed();
        Self([sse2!(_mm_set1_epi32(number)); 2])
    }

    #[inline(always)]
    pub(crate) fn minus(self, other: Self) -> Self {
        let (Self([a, b]), Self([c, d])) = (self, other);
        Self([sse2!(_mm_sub_epi32(a, c)), sse2!(_mm_sub_epi32(b, d))])
    }

    #[inline(always)]
    pub(crate) fn and(self, mask: u32) -> Self {
        let (Self([a, b]), Self([c, d])) = (self, Self::splat(mask));
        Self([sse2!(_mm_and_si128(a, c)), sse2!(_mm_and_si128(b, d))])
    }

    #[inline(always)]
    pub(crate) fn or(self, other: Self) -> Self {
        let (Self([a, b]), Self([c, d])) = (self, other);
        Self([sse2!(_mm_or_si128(a, c)), sse2!(_mm_or_si128(b, d))])
    }

    /// So many bits down, to below 2^15: greater numbers become anything.
    #[inline(always)]
    pub(crate) fn down<const BITS: i32>(self) -> U16x8 {
        let Self([low, high]) = self;
        let low = sse2!(_mm_srli_epi32::<BITS>(low));
        let high = sse2!(_mm_srli_epi32::<BITS>(high));
        U16x8(sse2!(_mm_packs_epi32(low, high)))
    }

    /// From `self` to `other`, of up to 17 bits, by a weight in `0 ..= 2^12`, rounded down.
    #[inline(always)]
    pub(crate) fn lerp(self, other: Self, weight: u32) -> Self {
        // The difference in two parts for a dot product: its two lowest bits, and the others, which count four times.
        let pair = (weight << 16 | weight << 2).cast_signed();
        let weights = sse2!(_mm_set1_epi32(pair));
        let (lower, parts) = (0xffff, 0x3_0000);
        let lower = sse2!(_mm_set1_epi32(lower));
        let parts = sse2!(_mm_set1_epi32(parts));
        let one = |from: __m128i, to: __m128i| {
            let change = sse2!(_mm_sub_epi32(to, from));
            let part = sse2!(_mm_slli_epi32::<16>(change));
            let part = sse2!(_mm_and_si128(part, parts));
            let whole = sse2!(_mm_srai_epi32::<2>(change));
            let whole = sse2!(_mm_and_si128(whole, lower));
            let both = sse2!(_mm_or_si128(part, whole));
            let change = sse2!(_mm_madd_epi16(both, weights));
            let change = sse2!(_mm_srai_epi32::<12>(change));
            sse2!(_mm_add_epi32(from, change))
        };
        let (Self([a, b]), Self([c, d])) = (self, other);
        Self([one(a, c), one(b, d)])
    }

    /// So many bits up; 0 if all are lost.
    #[inline(always)]
    pub(crate) fn up(self, bits: u32) -> Self {
        let (Self([low, high]), bits) = (self, bits.cast_signed());
        let bits = sse2!(_mm_cvtsi32_si128(bits));
        Self([
            sse2!(_mm_sll_epi32(low, bits)),
            sse2!(_mm_sll_epi32(high, bits)),
        ])
    }

    /// So many bits down; 0 if all are lost.
    #[inline(always)]
    pub(crate) fn down_by(self, bits: u32) -> Self {
        let (Self([low, high]), bits) = (self, bits.cast_signed());
        let bits = sse2!(_mm_cvtsi32_si128(bits));
        Self([
            sse2!(_mm_srl_epi32(low, bits)),
            sse2!(_mm_srl_epi32(high, bits)),
        ])
    }

    /// Lower halves.
    #[inline(always)]
    pub(crate) fn lower_halves(self) -> [u16; COUNT] {
        let Self([low, high]) = self;
        [
            sse2!(_mm_extract_epi16::<0>(low)),
            sse2!(_mm_extract_epi16::<2>(low)),
            sse2!(_mm_extract_epi16::<4>(low)),
            sse2!(_mm_extract_epi16::<6>(low)),
            sse2!(_mm_extract_epi16::<0>(high)),
            sse2!(_mm_extract_epi16::<2>(high)),
            sse2!(_mm_extract_epi16::<4>(high)),
            sse2!(_mm_extract_epi16::<6>(high)),
        ]
        .map(|number| number as u16)
    }

    #[inline(always)]
    pub(crate) fn array(self) -> [u32; COUNT] {
        let (lower, upper) = (self.lower_halves(), self.down_by(16).lower_halves());
        let both = |number: usize| u32::from(upper[number]) << 16 | u32::from(lower[number]);
        from_fn(both)
    }

    /// Each in both halves of a number of 64 bits.
    #[inline(always)]
    pub(crate) fn twice(self) -> U64x8 {
        let Self([low, high]) = self;
        U64x8([
            sse2!(_mm_shuffle_epi32::<0b01_01_00_00>(low)),
            sse2!(_mm_shuffle_epi32::<0b11_11_10_10>(low)),
            sse2!(_mm_shuffle_epi32::<0b01_01_00_00>(high)),
            sse2!(_mm_shuffle_epi32::<0b11_11_10_10>(high)),
        ])
    }
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
pub(crate) struct U64x8([__m128i; 4]);

impl U64x8 {
    #[inline(always)]
    pub(crate) fn new(numbers: [u64; COUNT]) -> Self {
        let [a, b, c, d, e, f, g, h] = numbers.map(u64::cast_signed);
        Self([
            sse2!(_mm_set_epi64x(b, a)),
            sse2!(_mm_set_epi64x(d, c)),
            sse2!(_mm_set_epi64x(f, e)),
            sse2!(_mm_set_epi64x(h, g)),
        ])
    }

    #[cfg(test)]
    pub(crate) fn array(self) -> [u64; COUNT] {
        let lower = self.up::<32>().uppers().array();
        let upper = self.uppers().array();
        from_fn(|number| u64::from(upper[number]) << 32 | u64::from(lower[number]))
    }

    #[inline(always)]
    pub(crate) fn splat(number: u64) -> Self {
        let number = number.cast_signed();
        Self([sse2!(_mm_set1_epi64x(number)); 4])
    }

    #[inline(always)]
    fn with(self, other: Self, f: impl Fn(__m128i, __m128i) -> __m128i) -> Self {
        let (Self([a, b, c, d]), Self([p, q, r, s])) = (self, other);
        Self([f(a, p), f(b, q), f(c, r), f(d, s)])
    }

    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        self.with(other, |a, b| sse2!(_mm_add_epi64(a, b)))
    }

    #[inline(always)]
    pub(crate) fn minus(self, other: Self) -> Self {
        self.with(other, |a, b| sse2!(_mm_sub_epi64(a, b)))
    }

    #[inline(always)]
    pub(crate) fn xor(self, other: Self) -> Self {
        self.with(other, |a, b| sse2!(_mm_xor_si128(a, b)))
    }

    /// Products of lower halves.
    #[inline(always)]
    pub(crate) fn times(self, other: Self) -> Self {
        self.with(other, |a, b| sse2!(_mm_mul_epu32(a, b)))
    }

    #[inline(always)]
    pub(crate) fn up<const BITS: i32>(self) -> Self {
        Self(self.0.map(|a| sse2!(_mm_slli_epi64::<BITS>(a))))
    }

    #[inline(always)]
    pub(crate) fn down<const BITS: i32>(self) -> Self {
        Self(self.0.map(|a| sse2!(_mm_srli_epi64::<BITS>(a))))
    }

    /// Upper halves, each in both halves of a number.
    #[inline(always)]
    pub(crate) fn uppers_twice(self) -> Self {
        let both = |a| sse2!(_mm_shuffle_epi32::<0b11_11_01_01>(a));
        Self(self.0.map(both))
    }

    /// Upper halves.
    #[inline(always)]
    pub(crate) fn uppers(self) -> U32x8 {
        let Self([a, b, c, d]) = self;
        let upper = |a, b| {
            let (a, b) = (sse2!(_mm_castsi128_ps(a)), sse2!(_mm_castsi128_ps(b)));
            let both = sse2!(_mm_shuffle_ps::<0b11_01_11_01>(a, b));
            sse2!(_mm_castps_si128(both))
        };
        U32x8([upper(a, b), upper(c, d)])
    }
}

/// Words that each differ from the last by a step, eight at a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walk {
    /// The next eight.
    words: [__m128i; 2],
    /// Eight steps.
    stride: __m128i,
}

impl Walk {
    #[inline(always)]
    pub(crate) fn new(first: u32, step: u32) -> Self {
        let [first, step] = [first, step].map(u32::cast_signed);
        let first = sse2!(_mm_set1_epi32(first));
        let step = sse2!(_mm_set1_epi32(step));
        // 0, 1, 2 and 3 steps.
        let (all, no) = (-1, 0);
        let odd = sse2!(_mm_set_epi32(all, no, all, no));
        let odd = sse2!(_mm_and_si128(odd, step));
        let upper = sse2!(_mm_set_epi32(all, all, no, no));
        let twice = sse2!(_mm_add_epi32(step, step));
        let upper = sse2!(_mm_and_si128(upper, twice));
        let low = sse2!(_mm_add_epi32(first, odd));
        let low = sse2!(_mm_add_epi32(low, upper));
        let four = sse2!(_mm_slli_epi32::<2>(step));
        let high = sse2!(_mm_add_epi32(low, four));
        let stride = sse2!(_mm_slli_epi32::<3>(step));
        Self {
            words: [low, high],
            stride,
        }
    }

    /// The upper halves of the next eight, so many bits of which are lost at the top.
    #[inline(always)]
    pub(crate) fn tops(&self, up: u32) -> U16x8 {
        let ([low, high], up) = (self.words, up.cast_signed());
        let up = sse2!(_mm_cvtsi32_si128(up));
        let low = sse2!(_mm_sll_epi32(low, up));
        let high = sse2!(_mm_sll_epi32(high, up));
        // Of 16 bits with their sign: none is cut.
        let low = sse2!(_mm_srai_epi32::<16>(low));
        let high = sse2!(_mm_srai_epi32::<16>(high));
        U16x8(sse2!(_mm_packs_epi32(low, high)))
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
        let Self { words, stride } = *self;
        self.words = words.map(|words| sse2!(_mm_add_epi32(words, stride)));
        U32x8(words)
    }
}

/// The same of 64 bits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LongWalk {
    /// The next two.
    pair: __m128i,
    /// Two steps.
    stride: __m128i,
}

impl LongWalk {
    #[inline(always)]
    pub(crate) fn new(first: u64, step: u64) -> Self {
        let second = first.wrapping_add(step);
        let [first, second, stride] = [first, second, step << 1].map(u64::cast_signed);
        Self {
            pair: sse2!(_mm_set_epi64x(second, first)),
            stride: sse2!(_mm_set1_epi64x(stride)),
        }
    }

    /// The next eight.
    #[inline(always)]
    pub(crate) fn next(&mut self) -> U64x8 {
        let Self { pair: a, stride } = *self;
        let b = sse2!(_mm_add_epi64(a, stride));
        let c = sse2!(_mm_add_epi64(b, stride));
        let d = sse2!(_mm_add_epi64(c, stride));
        self.pair = sse2!(_mm_add_epi64(d, stride));
        U64x8([a, b, c, d])
    }
}
