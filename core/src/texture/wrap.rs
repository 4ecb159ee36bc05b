//! What lies beyond the edges of a texture.

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
