//! Mip pyramids: a texture and its halves down to one texel (Williams, "Pyramidal Parametrics",
//! SIGGRAPH 1983), level after level in one buffer.
//!
//! The buffer can be computed by the compiler and lie in flash ([`constant`]), be filled at start-up
//! ([`build`]), or come baked from a PC. [`Pyramid`] checks it once; samplers then pick levels
//! without a check.

pub mod average;
pub mod build;
pub mod constant;

use crate::error::Error;
use crate::texture::{Bc1, Indexed, MAX_TEXTURE_SIZE, Morton, Texels, Texture};

/// Most levels that a pyramid can have: those of [`MAX_TEXTURE_SIZE`].
pub const MAX_LEVELS: usize = MAX_TEXTURE_SIZE.trailing_zeros() as usize + 1;

/// Levels of a complete pyramid over a texture of this size, down to 1x1.
///
/// Sides that are not powers of two, which no pyramid has, are rounded down to one.
#[must_use]
pub const fn levels(width: u32, height: u32) -> u32 {
    let longer = if width > height { width } else { height };
    match longer.checked_ilog2() {
        Some(log2) => log2 + 1,
        None => 1,
    }
}

/// Sides of a level: each half of the one before, but at least 1.
#[must_use]
pub const fn level_size(width: u32, height: u32, level: u32) -> (u32, u32) {
    const fn side(side: u32, level: u32) -> u32 {
        let side = match side.checked_shr(level) {
            Some(side) => side,
            None => 0,
        };
        if side == 0 { 1 } else { side }
    }
    (side(width, level), side(height, level))
}

/// Texels of a complete pyramid: `(4^(k + 1) - 1) / 3` for a square of side `2^k`; `usize::MAX` for
/// more than that.
#[must_use]
pub const fn texels(width: u32, height: u32) -> usize {
    let mut sum = 0;
    let mut level = 0;
    while level < levels(width, height) {
        let (width, height) = level_size(width, height, level);
        sum = usize::saturating_add(sum, (width as usize).saturating_mul(height as usize));
        level += 1;
    }
    sum
}

/// A complete pyramid in some format.
///
/// It holds where each level is, and refers to the texels: some 160 bytes, which lie in flash if
/// it is a `static`. Samplers borrow it.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pyramid<T> {
    /// Level 0 first; what is left over repeats the last.
    levels: [T; MAX_LEVELS],
    /// The number of the last level.
    last: u8,
}

impl<T> Pyramid<T> {
    /// The number of the coarsest level, of one texel.
    #[inline]
    #[must_use]
    pub const fn last(&self) -> u32 {
        self.last as u32
    }

    /// A level; numbers beyond the last give the last.
    #[inline]
    #[must_use]
    pub fn level(&self, number: u32) -> &T {
        let [.., last] = &self.levels;
        self.levels.get(number as usize).unwrap_or(last)
    }

    /// All levels, the finest first.
    pub fn iter(&self) -> impl Iterator<Item = &T> {
        self.levels.iter().take(usize::from(self.last) + 1)
    }
}

impl<T: Texels> Pyramid<T> {
    /// Puts levels together, the finest first: any format, wherever the levels lie.
    ///
    /// # Errors
    ///
    /// [`Error::LevelsMissing`] unless they go down to 1x1 and not beyond; [`Error::LevelSize`] for
    /// the first that does not have half the sides of the one before.
    pub fn from_levels(levels: &[T]) -> Result<Self, Error> {
        let given = levels.len() as u32;
        let Some(first) = levels.first() else {
            return Err(Error::LevelsMissing { needed: 1, given });
        };
        let (log2_width, log2_height) = first.log2_size();
        let needed = log2_width.max(log2_height).wrapping_add(1);
        if given != needed || levels.len() > MAX_LEVELS {
            return Err(Error::LevelsMissing { needed, given });
        }
        for (number, level) in (0..).zip(levels) {
            let (width, height) = level.log2_size();
            let expected = |log2: u32| log2.saturating_sub(number);
            if (width, height) != (expected(log2_width), expected(log2_height)) {
                return Err(Error::LevelSize {
                    level: number,
                    width: 1 << (width & 31),
                    height: 1 << (height & 31),
                });
            }
        }
        let mut all = [*levels.last().unwrap_or(first); MAX_LEVELS];
        for (to, level) in all.iter_mut().zip(levels) {
            *to = *level;
        }
        Ok(Self {
            levels: all,
            last: given.wrapping_sub(1) as u8,
        })
    }
}

/// Writes `new` for a format whose levels lie in one slice, the finest first.
macro_rules! in_one_slice {
    ($format:ty, $unit:ty, $length:expr, ($($palette:ident: $colours:ty)?)) => {
        /// Checks a complete pyramid whose levels lie one after the other, the finest first. In a
        /// `static` the compiler does the checking.
        ///
        /// # Errors
        ///
        /// [`Error::TextureSize`] unless both sides are powers of two, 1 to [`MAX_TEXTURE_SIZE`];
        /// [`Error::BufferLength`] unless the slice has exactly all levels; what the format's own
        /// `new` returns for a level.
        pub const fn new(
            all: &'a [$unit],
            $($palette: $colours,)?
            width: u32,
            height: u32,
        ) -> Result<Self, Error> {
            if !width.is_power_of_two()
                || !height.is_power_of_two()
                || width > MAX_TEXTURE_SIZE
                || height > MAX_TEXTURE_SIZE
            {
                return Err(Error::TextureSize { width, height });
            }
            let count = levels(width, height);
            let mut needed = 0;
            let mut number = 0;
            while number < count {
                let (width, height) = level_size(width, height, number);
                needed += $length(width, height);
                number += 1;
            }
            let given = all.len();
            if given != needed {
                return Err(Error::BufferLength { needed, given });
            }
            // From the finest on; each level overwrites the rest of the table.
            let (first, mut rest) = all.split_at($length(width, height));
            let mut table = match <$format>::new(first, $($palette,)? width, height) {
                Ok(level) => [level; MAX_LEVELS],
                Err(error) => return Err(error),
            };
            let mut number = 1;
            while number < count {
                let (width, height) = level_size(width, height, number);
                let (level, after) = rest.split_at($length(width, height));
                let level = match <$format>::new(level, $($palette,)? width, height) {
                    Ok(level) => level,
                    Err(error) => return Err(error),
                };
                let mut place = number as usize;
                while place < MAX_LEVELS {
                    table[place] = level;
                    place += 1;
                }
                rest = after;
                number += 1;
            }
            Ok(Self {
                levels: table,
                last: (count - 1) as u8,
            })
        }
    };
}

/// Texels of one level.
const fn area(width: u32, height: u32) -> usize {
    width as usize * height as usize
}

impl<'a, C: Copy> Pyramid<Texture<'a, C>> {
    in_one_slice!(Texture<'a, C>, C, area, ());
}

impl<'a, C: Copy> Pyramid<Morton<'a, C>> {
    in_one_slice!(Morton<'a, C>, C, area, ());
}

impl<'a, C: Copy, const BITS: u32> Pyramid<Indexed<'a, C, BITS>> {
    in_one_slice!(
        Indexed<'a, C, BITS>,
        u8,
        Indexed::<'a, C, BITS>::bytes,
        (palette: &'a [C])
    );
}

impl<'a> Pyramid<Bc1<'a>> {
    in_one_slice!(Bc1<'a>, [u8; 8], Bc1::blocks, ());
}
