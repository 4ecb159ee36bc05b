//! Textures in memory, and what happens beyond their edges.

use crate::error::Error;

/// Largest side of a texture in texels: 12 of the 24 fraction bits of a coordinate choose the
/// texel, 12 are left to step precisely.
pub const MAX_TEXTURE_SIZE: u32 = 4096;

/// A borrowed picture whose sides are powers of two.
///
/// Row by row from the top, without gaps. Texel (i, j) covers u from `i / width` to
/// `(i + 1) / width` and v alike, as in OpenGL, Vulkan and Direct3D.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Texture<'a, C> {
    texels: &'a [C],
    log2_width: u8,
    log2_height: u8,
}

impl<'a, C> Texture<'a, C> {
    /// Checks the sizes. In a `static` the compiler does the checking.
    ///
    /// # Errors
    ///
    /// [`Error::TextureSize`] unless both sides are powers of two, 1 to [`MAX_TEXTURE_SIZE`];
    /// [`Error::BufferLength`] unless there are exactly `width * height` texels.
    pub const fn new(texels: &'a [C], width: u32, height: u32) -> Result<Self, Error> {
        if !width.is_power_of_two()
            || !height.is_power_of_two()
            || width > MAX_TEXTURE_SIZE
            || height > MAX_TEXTURE_SIZE
        {
            return Err(Error::TextureSize { width, height });
        }
        let needed = width as usize * height as usize;
        if texels.len() != needed {
            return Err(Error::BufferLength {
                needed,
                given: texels.len(),
            });
        }
        Ok(Self {
            texels,
            log2_width: width.trailing_zeros() as u8,
            log2_height: height.trailing_zeros() as u8,
        })
    }

    /// Texels in a row.
    #[must_use]
    pub const fn width(&self) -> u32 {
        1 << self.log2_width
    }

    /// Rows.
    #[must_use]
    pub const fn height(&self) -> u32 {
        1 << self.log2_height
    }

    /// The texels, row by row.
    #[must_use]
    pub const fn texels(&self) -> &'a [C] {
        self.texels
    }

    /// Base-2 logarithms of width and height.
    #[inline]
    #[must_use]
    pub const fn log2_size(&self) -> (u32, u32) {
        (self.log2_width as u32, self.log2_height as u32)
    }
}

/// What lies beyond the edges of a texture, along one axis.
pub trait Wrap {
    /// Whether texel `i` is texel `i mod 2^log2_size`: then the bits of a coordinate above the
    /// binary point do not matter.
    const REPEATS: bool = false;

    /// The texel that stands for texel `i` of an axis of `2^log2_size` texels; always below
    /// `2^log2_size`.
    fn wrap(i: i32, log2_size: u32) -> u32;
}

/// The texture again: `i mod n`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Repeat;

impl Wrap for Repeat {
    const REPEATS: bool = true;

    #[inline]
    fn wrap(i: i32, log2_size: u32) -> u32 {
        i.cast_unsigned() & last(log2_size)
    }
}

/// The edge texel (OpenGL's clamp to edge).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Clamp;

impl Wrap for Clamp {
    #[inline]
    fn wrap(i: i32, log2_size: u32) -> u32 {
        i.max(0).cast_unsigned().min(last(log2_size))
    }
}

/// The texture back to front, then again: OpenGL's mirrored repeat.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Mirror;

impl Wrap for Mirror {
    #[inline]
    fn wrap(i: i32, log2_size: u32) -> u32 {
        // In odd repeats all bits are flipped, and n - 1 - i is ~i modulo n.
        let odd = (i >> (log2_size & 31)) & 1;
        (i ^ odd.wrapping_neg()).cast_unsigned() & last(log2_size)
    }
}

#[inline]
fn last(log2_size: u32) -> u32 {
    (1u32 << (log2_size & 31)).wrapping_sub(1)
}
