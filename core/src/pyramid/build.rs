//! Pyramids built at start-up, in the caller's buffer.

use super::average::{Average, mean_colour};
use super::{MAX_LEVELS, Pyramid, level_size, levels, texels};
use crate::colour::{Colour, Fractions};
use crate::error::Error;
use crate::texture::{Indexed, Texels, Texture};
use crate::uv::Uv;

/// Fills the levels from 1 on of a pyramid whose level 0 is at the start of `buffer`, and gives the
/// pyramid.
///
/// # Errors
///
/// [`Error::TextureSize`] unless both sides are powers of two up to
/// [`MAX_TEXTURE_SIZE`](crate::texture::MAX_TEXTURE_SIZE); [`Error::BufferLength`] unless there is
/// room for exactly [`texels`]. Nothing is written then.
pub fn build<C: Colour>(
    buffer: &mut [C],
    width: u32,
    height: u32,
    average: Average,
) -> Result<Pyramid<Texture<'_, C>>, Error> {
    check(buffer.len(), texels, width, height)?;
    let (finest, coarser) = buffer.split_at_mut(width as usize * height as usize);
    let finest = Texture::new(finest, width, height)?;
    fill(&finest, coarser, average);
    Pyramid::<Texture<'_, C>>::new(buffer, width, height)
}

/// Texels of the levels from 1 on.
#[must_use]
pub const fn coarser_texels(width: u32, height: u32) -> usize {
    texels(width, height).saturating_sub((width as usize).saturating_mul(height as usize))
}

/// A level of a pyramid over palette indices: means are no colours of the palette, so that only the
/// finest level is indexed.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum IndexedOrDirect<'a, C, const BITS: u32> {
    /// Level 0.
    Indexed(Indexed<'a, C, BITS>),
    /// Levels from 1 on.
    Direct(Texture<'a, C>),
}

impl<C: Copy + Default, const BITS: u32> Texels for IndexedOrDirect<'_, C, BITS> {
    type Colour = C;

    #[inline]
    fn log2_size(&self) -> (u32, u32) {
        match self {
            Self::Indexed(level) => level.log2_size(),
            Self::Direct(level) => level.log2_size(),
        }
    }

    #[inline]
    fn texel(&self, column: u32, row: u32) -> C {
        match self {
            Self::Indexed(level) => level.texel(column, row),
            Self::Direct(level) => level.texel(column, row),
        }
    }

    #[inline]
    fn fill_repeating<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        C: Into<P>,
    {
        match self {
            Self::Indexed(level) => level.fill_repeating(uv, step, pixels),
            Self::Direct(level) => level.fill_repeating(uv, step, pixels),
        }
    }

    #[inline]
    fn fours_repeating<I: ExactSizeIterator>(
        &self,
        uv: Uv,
        step: Uv,
        items: I,
        each: impl FnMut(I::Item, [C; 4], Fractions),
    ) {
        match self {
            Self::Indexed(level) => level.fours_repeating(uv, step, items, each),
            Self::Direct(level) => level.fours_repeating(uv, step, items, each),
        }
    }
}

/// Averages an indexed texture in colour: level 0 stays as it is, the others are colours in
/// `coarser`.
///
/// # Errors
///
/// [`Error::BufferLength`] unless there is room for exactly [`coarser_texels`].
pub fn build_indexed<'a, C: Colour, const BITS: u32>(
    finest: Indexed<'a, C, BITS>,
    coarser: &'a mut [C],
    average: Average,
) -> Result<Pyramid<IndexedOrDirect<'a, C, BITS>>, Error> {
    let (log2_width, log2_height) = finest.log2_size();
    let (width, height) = (1 << (log2_width & 31), 1 << (log2_height & 31));
    check(coarser.len(), coarser_texels, width, height)?;
    fill(&finest, coarser, average);
    let mut table = [IndexedOrDirect::Indexed(finest); MAX_LEVELS];
    let mut rest: &'a [C] = coarser;
    for (number, place) in (1..levels(width, height)).zip(table.iter_mut().skip(1)) {
        let (width, height) = level_size(width, height, number);
        let (level, after) = rest.split_at((width * height) as usize);
        *place = IndexedOrDirect::Direct(Texture::new(level, width, height)?);
        rest = after;
    }
    let count = levels(width, height) as usize;
    Pyramid::from_levels(table.get(..count).unwrap_or_default())
}

fn check(
    given: usize,
    length: fn(u32, u32) -> usize,
    width: u32,
    height: u32,
) -> Result<(), Error> {
    // A texture without texels tells whether the sides are right.
    if let Err(error @ Error::TextureSize { .. }) = Texture::<()>::new(&[], width, height) {
        return Err(error);
    }
    let needed = length(width, height);
    if given == needed {
        Ok(())
    } else {
        Err(Error::BufferLength { needed, given })
    }
}

/// The levels from 1 on, each from the one before.
fn fill<C: Colour, T: Texels<Colour = C>>(finest: &T, coarser: &mut [C], average: Average) {
    let mut rest = halve(finest, coarser, average);
    let mut before = finest.log2_size();
    // What was just written, and what is still to be.
    let mut done: &mut [C] = coarser;
    while rest > 0 {
        let size = (before.0.saturating_sub(1), before.1.saturating_sub(1));
        let length = 1usize << ((size.0 + size.1) & 31);
        let Some((level, after)) = done.split_at_mut_checked(length) else {
            return;
        };
        let Ok(texture) = Texture::new(&*level, 1 << (size.0 & 31), 1 << (size.1 & 31)) else {
            return;
        };
        rest = halve(&texture, after, average);
        before = size;
        done = after;
    }
}

/// Writes the level after `finer` to the start of `to`, and gives its number of texels; 0 after the
/// last one.
fn halve<C: Colour, T: Texels<Colour = C>>(finer: &T, to: &mut [C], average: Average) -> usize {
    let (log2_width, log2_height) = finer.log2_size();
    if log2_width == 0 && log2_height == 0 {
        return 0;
    }
    // Where a side is one texel already, the same texel counts twice.
    let (right, below) = (u32::from(log2_width > 0), u32::from(log2_height > 0));
    let columns = 1u32 << (log2_width.saturating_sub(1) & 31);
    let rows = 1u32 << (log2_height.saturating_sub(1) & 31);
    let places = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    for (to, (column, row)) in to.iter_mut().zip(places) {
        let (x, y) = (column << right, row << below);
        let four = [
            (x, y),
            (x | right, y),
            (x, y | below),
            (x | right, y | below),
        ];
        *to = mean_colour(four.map(|(x, y)| finer.texel(x, y)), average);
    }
    (columns as usize).wrapping_mul(rows as usize)
}
