//! Level of detail: which level of a pyramid a pixel takes.
//!
//! A triangle's texture coordinates and its place on the screen enter; what leaves is lambda, the
//! base-2 logarithm of the level-0 texels that one pixel step spans, and from it a level or two
//! (OpenGL 4.6, section 8.14). Lambda comes from the derivatives of the mapping itself, without a
//! division and whatever the perspective strategy ([`footprint`]); it depends on the pixel's place
//! alone, so that bands and runs change nothing.

pub mod footprint;
pub mod log2;

use core::cell::Cell;

use fixed::types::I16F16;

use crate::arith::leading_zeros_long;
use crate::colour::BLEND_BITS;
use crate::setup::TriangleSetup;
use crate::span::Span;
use footprint::{AtMean, FootprintWords, Lambdas};
use log2::{FRACTION_BITS, NOTHING, log2, log2_word};

/// How long the step to the next pixel is in the texture.
pub trait Rule: Copy {
    /// A length, before its logarithm is taken.
    type Length: Ord + Copy + core::fmt::Debug;

    /// The length of a step by these texels in u and v, each below 2^63 in magnitude.
    fn length(&self, step: [i64; 2]) -> Self::Length;

    /// Its base-2 logarithm, with [`FRACTION_BITS`] fraction bits; [`NOTHING`] if it is 0.
    fn log2(&self, length: Self::Length) -> i32;

    /// A length of words.
    type Word: Ord + Copy + core::fmt::Debug;

    /// The length of a step by these texels in u and v, each within 2^31 - 1.
    fn length_of_words(&self, step: [i32; 2]) -> Self::Word;

    /// See [`Self::log2`].
    fn log2_of_word(&self, length: Self::Word) -> i32;
}

/// The larger of the two distances, along u or along v: cheap, permitted by Vulkan and OpenGL, and
/// at most half an octave short of [`Euclidean`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LongestAxis;

impl Rule for LongestAxis {
    type Length = u64;

    #[inline]
    fn length(&self, [u, v]: [i64; 2]) -> u64 {
        u.unsigned_abs().max(v.unsigned_abs())
    }

    #[inline]
    fn log2(&self, length: u64) -> i32 {
        log2(length)
    }

    type Word = u32;

    #[inline]
    fn length_of_words(&self, [u, v]: [i32; 2]) -> u32 {
        u.unsigned_abs().max(v.unsigned_abs())
    }

    #[inline]
    fn log2_of_word(&self, length: u32) -> i32 {
        log2_word(length)
    }
}

/// The distance: what the specifications call ideal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Euclidean;

impl Rule for Euclidean {
    /// The logarithm: squares have more bits than there is room for.
    type Length = i32;

    #[inline]
    fn length(&self, [u, v]: [i64; 2]) -> i32 {
        let (u, v) = (u.unsigned_abs(), v.unsigned_abs());
        if u | v == 0 {
            return NOTHING;
        }
        // Both to 31 bits, so that the sum of squares fits; off by less than 2^-29 of it.
        let down = 33u32.saturating_sub(leading_zeros_long(u | v));
        let (u, v) = (u >> down, v >> down);
        let square = u.wrapping_mul(u).wrapping_add(v.wrapping_mul(v));
        (log2(square) >> 1).wrapping_add((down << FRACTION_BITS).cast_signed())
    }

    #[inline]
    fn log2(&self, length: i32) -> i32 {
        length
    }

    /// The square.
    type Word = u64;

    #[inline]
    fn length_of_words(&self, [u, v]: [i32; 2]) -> u64 {
        let square = |n: i32| u64::from(n.unsigned_abs()).wrapping_mul(n.unsigned_abs().into());
        square(u).wrapping_add(square(v))
    }

    #[inline]
    fn log2_of_word(&self, square: u64) -> i32 {
        if square == 0 {
            NOTHING
        } else {
            log2(square) >> 1
        }
    }
}

/// A level, or two with the weight of the second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Chosen {
    /// Texels are larger than pixels: this level, with the filter for magnification.
    Magnified(u32),
    /// This level.
    One(u32),
    /// Between a level and the next coarser one.
    Two {
        /// The finer level.
        finer: u32,
        /// How near the other is, in `0 .. 2^`[`BLEND_BITS`].
        weight: u32,
    },
}

/// From lambda to levels, before they are limited to those that there are.
pub trait Choice: Copy {
    /// Whether [`Self::level`] ever gives a weight: if not, no code to mix levels is in the image.
    const BLENDS: bool;

    /// The level for a lambda above 0 with [`FRACTION_BITS`] fraction bits, and the weight of the
    /// next one in 2^-[`BLEND_BITS`], rounded down.
    fn level(&self, lambda: i32) -> (u32, u32);
}

/// The finest level, always: no pyramid is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FinestLevel;

impl Choice for FinestLevel {
    const BLENDS: bool = false;

    #[inline]
    fn level(&self, _: i32) -> (u32, u32) {
        (0, 0)
    }
}

/// The nearest level, of two equally near ones the finer: `ceil(lambda + 1/2) - 1`, OpenGL's
/// `MIPMAP_NEAREST`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct NearestLevel;

impl Choice for NearestLevel {
    const BLENDS: bool = false;

    #[inline]
    fn level(&self, lambda: i32) -> (u32, u32) {
        // ceil(x + 1/2) - 1 = floor(x + 1/2 - 2^-16) in steps of 2^-16.
        let level = lambda.wrapping_add((1 << (FRACTION_BITS - 1)) - 1) >> FRACTION_BITS;
        (level.max(0).cast_unsigned(), 0)
    }
}

/// The ceiling, plus one: no texel is smaller than a pixel, not even along the diagonal that
/// [`LongestAxis`] does not measure. Never aliases, and is the blurriest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SafestLevel;

impl Choice for SafestLevel {
    const BLENDS: bool = false;

    #[inline]
    fn level(&self, lambda: i32) -> (u32, u32) {
        let ceiling = lambda.wrapping_add((1 << FRACTION_BITS) - 1) >> FRACTION_BITS;
        (ceiling.wrapping_add(1).max(0).cast_unsigned(), 0)
    }
}

/// The two levels on both sides of lambda, mixed: OpenGL's `MIPMAP_LINEAR`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LinearLevels;

impl Choice for LinearLevels {
    const BLENDS: bool = true;

    #[inline]
    fn level(&self, lambda: i32) -> (u32, u32) {
        let lambda = lambda.max(0).cast_unsigned();
        let weight = lambda >> (FRACTION_BITS - BLEND_BITS) & ((1 << BLEND_BITS) - 1);
        (lambda >> FRACTION_BITS, weight)
    }
}

/// Pixels that share a lambda: those from `start` up to `end`, taken at `at`; all are offsets from
/// the start of a span.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Piece {
    /// First pixel.
    pub start: usize,
    /// The pixel after the last.
    pub end: usize,
    /// Where lambda is taken; `None` for the triangle's mean.
    pub at: Option<usize>,
}

/// How often lambda is computed.
pub trait Rate: Copy {
    /// Whether a piece may be at the triangle's mean.
    const TAKES_TRIANGLE: bool = true;

    /// Whether a piece may be at a pixel; if not, spans are not prepared for it.
    const TAKES_PIXELS: bool = true;

    /// Whether each pixel has a piece of its own.
    const EACH_PIXEL: bool = false;

    /// How lambda is found.
    type Lambdas: Lambdas;

    /// Prepares a triangle, for a texture whose finest level has these base-2 logarithms of width and
    /// height.
    fn lambdas<R: Rule>(
        &self,
        triangle: &TriangleSetup<'_>,
        log2_size: (u32, u32),
        rule: R,
    ) -> Self::Lambdas;

    /// The piece of a span that the pixel at `offset` is in.
    fn piece(&self, span: Span, offset: usize) -> Piece;
}

/// Once a triangle, at the mean of its corners: for small triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EachTriangle;

impl Rate for EachTriangle {
    const TAKES_PIXELS: bool = false;
    type Lambdas = AtMean;

    #[inline]
    fn lambdas<R: Rule>(
        &self,
        triangle: &TriangleSetup<'_>,
        log2_size: (u32, u32),
        rule: R,
    ) -> AtMean {
        AtMean::new(triangle, log2_size, rule)
    }

    #[inline]
    fn piece(&self, _: Span, _: usize) -> Piece {
        Piece {
            start: 0,
            end: usize::MAX,
            at: None,
        }
    }
}

/// Once a span, in its middle: for floors and ceilings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EachSpan;

impl Rate for EachSpan {
    const TAKES_TRIANGLE: bool = false;
    type Lambdas = FootprintWords;

    #[inline]
    fn lambdas<R: Rule>(
        &self,
        triangle: &TriangleSetup<'_>,
        log2_size: (u32, u32),
        _: R,
    ) -> FootprintWords {
        FootprintWords::new(triangle, log2_size)
    }

    #[inline]
    fn piece(&self, span: Span, _: usize) -> Piece {
        let len = span.left.abs_diff(span.right) as usize;
        Piece {
            start: 0,
            end: len,
            at: Some(len / 2),
        }
    }
}

/// Once for every 16 columns of a span, in their middle: nearly what [`EachPixel`] gives, for a
/// fraction of its cost, where lambda changes slowly from one pixel to the next. The columns are
/// those between multiples of 16 on the screen, where [`Every`](crate::perspective::Every) divides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EachPiece;

impl EachPiece {
    /// Columns of a piece.
    pub const COLUMNS: u32 = 16;
}

impl Rate for EachPiece {
    const TAKES_TRIANGLE: bool = false;
    type Lambdas = FootprintWords;

    #[inline]
    fn lambdas<R: Rule>(
        &self,
        triangle: &TriangleSetup<'_>,
        log2_size: (u32, u32),
        _: R,
    ) -> FootprintWords {
        FootprintWords::new(triangle, log2_size)
    }

    #[inline]
    fn piece(&self, span: Span, offset: usize) -> Piece {
        // Spans lie right of column 0.
        let left = span.left.cast_unsigned();
        let len = span.left.abs_diff(span.right);
        let first = left.wrapping_add(offset as u32) & !(Self::COLUMNS - 1);
        let start = first.saturating_sub(left);
        let end = first
            .wrapping_add(Self::COLUMNS)
            .wrapping_sub(left)
            .min(len);
        Piece {
            start: start as usize,
            end: end as usize,
            at: Some((start.wrapping_add(end) / 2) as usize),
        }
    }
}

/// At every pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EachPixel;

impl Rate for EachPixel {
    const TAKES_TRIANGLE: bool = false;
    const EACH_PIXEL: bool = true;
    type Lambdas = FootprintWords;

    #[inline]
    fn lambdas<R: Rule>(
        &self,
        triangle: &TriangleSetup<'_>,
        log2_size: (u32, u32),
        _: R,
    ) -> FootprintWords {
        FootprintWords::new(triangle, log2_size)
    }

    #[inline]
    fn piece(&self, _: Span, offset: usize) -> Piece {
        Piece {
            start: offset,
            end: offset.wrapping_add(1),
            at: Some(offset),
        }
    }
}

/// Takes note of the finest level that was wanted, whether it is there or not, for a loader that
/// streams levels.
pub trait Record: Copy {
    /// A level was wanted.
    fn wanted(&self, level: u32);
}

/// Takes no note.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Unrecorded;

impl Record for Unrecorded {
    #[inline]
    fn wanted(&self, _: u32) {}
}

/// Keeps the least number; set it to `u8::MAX` before a frame.
impl Record for &Cell<u8> {
    #[inline]
    fn wanted(&self, level: u32) {
        let level = level.min(u8::MAX.into()) as u8;
        self.set(self.get().min(level));
    }
}

/// How levels are chosen. All but the limits are types: what is not used costs nothing.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Lod<C = NearestLevel, R = LongestAxis, P = EachPixel, W = Unrecorded> {
    choice: C,
    rule: R,
    rate: P,
    record: W,
    /// In 2^-16 levels.
    bias: i32,
    least: i32,
    most: i32,
    resident: u32,
}

/// Lambda within this magnitude, in levels: more than any texture has.
const MOST_LEVELS: i32 = 64;

/// In 2^-16 levels, limited.
const fn levels(n: I16F16) -> i32 {
    const LIMIT: i32 = MOST_LEVELS << 16;
    let bits = n.to_bits();
    if bits > LIMIT {
        LIMIT
    } else if bits < -LIMIT {
        -LIMIT
    } else {
        bits
    }
}

impl<C, R, P> Lod<C, R, P> {
    /// Without bias or limits, and with all levels there.
    #[must_use]
    pub const fn new(choice: C, rule: R, rate: P) -> Self {
        Self {
            choice,
            rule,
            rate,
            record: Unrecorded,
            bias: 0,
            least: -MOST_LEVELS << 16,
            most: MOST_LEVELS << 16,
            resident: 0,
        }
    }

    /// Takes note of the finest level that is wanted.
    #[must_use]
    pub fn recording(self, wanted: &Cell<u8>) -> Lod<C, R, P, &Cell<u8>> {
        Lod {
            choice: self.choice,
            rule: self.rule,
            rate: self.rate,
            record: wanted,
            bias: self.bias,
            least: self.least,
            most: self.most,
            resident: self.resident,
        }
    }
}

impl<C: Copy, R: Copy, P: Copy, W: Copy> Lod<C, R, P, W> {
    /// Adds a bias to lambda, in levels: negative is sharper. Within 64 either way.
    #[must_use]
    pub const fn with_bias(self, bias: I16F16) -> Self {
        let bias = levels(bias);
        Self { bias, ..self }
    }

    /// Limits lambda, after the bias, to `least ..= most`, in levels. Where they cross, the upper
    /// limit holds.
    #[must_use]
    pub const fn within(self, least: I16F16, most: I16F16) -> Self {
        let (least, most) = (levels(least), levels(most));
        let least = if least < most { least } else { most };
        Self {
            least,
            most,
            ..self
        }
    }

    /// The finest level that is there; finer ones are not read.
    #[must_use]
    pub const fn resident(self, finest: u32) -> Self {
        Self {
            resident: finest,
            ..self
        }
    }
}

/// What a shader needs of a [`Lod`]: one type in the place of its four.
pub trait Selection: Copy {
    /// How steps are measured.
    type Rule: Rule;

    /// Whether [`Self::choose`] ever gives two levels.
    const BLENDS: bool;

    /// See [`Rate::TAKES_TRIANGLE`].
    const TAKES_TRIANGLE: bool;

    /// See [`Rate::TAKES_PIXELS`].
    const TAKES_PIXELS: bool;

    /// See [`Rate::EACH_PIXEL`].
    const EACH_PIXEL: bool;

    /// See [`Rate::Lambdas`].
    type Lambdas: Lambdas;

    /// See [`Rate::lambdas`].
    fn lambdas(&self, triangle: &TriangleSetup<'_>, log2_size: (u32, u32)) -> Self::Lambdas;

    /// How steps are measured.
    fn rule(&self) -> Self::Rule;

    /// The levels for a lambda with [`FRACTION_BITS`] fraction bits, before bias and limits, of a
    /// pyramid that ends with level `last`. They are there, and so is the one after the finer of
    /// two.
    fn choose(&self, lambda: i32, last: u32) -> Chosen;

    /// The pixels of a span that share a lambda with the one at `offset`.
    fn piece(&self, span: Span, offset: usize) -> Piece;
}

impl<C: Choice, R: Rule, P: Rate, W: Record> Selection for Lod<C, R, P, W> {
    type Rule = R;
    const BLENDS: bool = C::BLENDS;
    const TAKES_TRIANGLE: bool = P::TAKES_TRIANGLE;
    const TAKES_PIXELS: bool = P::TAKES_PIXELS;
    const EACH_PIXEL: bool = P::EACH_PIXEL;

    type Lambdas = P::Lambdas;

    #[inline]
    fn lambdas(&self, triangle: &TriangleSetup<'_>, log2_size: (u32, u32)) -> P::Lambdas {
        self.rate.lambdas(triangle, log2_size, self.rule)
    }

    #[inline]
    fn rule(&self) -> R {
        self.rule
    }

    #[inline]
    fn choose(&self, lambda: i32, last: u32) -> Chosen {
        let lambda = lambda
            .wrapping_add(self.bias)
            .max(self.least)
            .min(self.most);
        let resident = self.resident.min(last);
        if lambda <= 0 {
            self.record.wanted(0);
            return Chosen::Magnified(resident);
        }
        let (level, weight) = self.choice.level(lambda);
        self.record.wanted(level.min(last));
        if const { C::BLENDS } && weight > 0 && level >= resident && level < last {
            Chosen::Two {
                finer: level,
                weight,
            }
        } else {
            Chosen::One(level.max(resident).min(last))
        }
    }

    #[inline]
    fn piece(&self, span: Span, offset: usize) -> Piece {
        self.rate.piece(span, offset)
    }
}
