//! The texel that a coordinate lies in, u and v in words of their own, where both axes repeat. Part of [`Texture`].
//!
//! ```text
//!   u, its whole repeats lost   [ column | 0 ]
//!   v, shifted down             [ whole repeats | row ]      both, rotated left by log2 width:
//!                                                            [ whole repeats of v | row | column ]
//! ```

use super::Texture;
use super::packed::U_UP;
use crate::arith::{CARRIES, keep_rolled};
use crate::uv::Uv;
use crate::visibility::{Candidate as _, Visibility};

/// Makes pixels of what a texture stores.
pub(super) trait Decoder<C, P>: Copy {
    /// How many bits of u behind the column tell which of several texels in one place is meant.
    const BEHIND: u32;

    /// A pixel of what is stored in a place; `word` has those bits at its top.
    fn decode(self, stored: C, word: u32) -> P;
}

/// Of colours.
#[derive(Clone, Copy)]
pub(super) struct Colours;

impl<C: Into<P>, P> Decoder<C, P> for Colours {
    const BEHIND: u32 = 0;

    #[inline]
    fn decode(self, colour: C, _: u32) -> P {
        colour.into()
    }
}

/// A coordinate.
#[derive(Clone, Copy)]
struct Place {
    /// Shifted up so far that whole repeats are lost.
    u: u32,
    v: u32,
}

impl Place {
    #[inline]
    fn new(uv: Uv) -> Self {
        Self {
            u: (uv.u.to_bits() << U_UP).cast_unsigned(),
            v: uv.v.to_bits().cast_unsigned(),
        }
    }

    #[inline]
    fn after(self, step: Self) -> Self {
        Self {
            u: self.u.wrapping_add(step.u),
            v: self.v.wrapping_add(step.v),
        }
    }
}

/// A texture's sizes, as they are needed to find a texel.
#[derive(Clone, Copy)]
struct Sizes {
    /// From v to the row.
    down: u32,
    /// Bits of u that are kept: the width's logarithm, or more.
    columns: u32,
    /// From u to the column.
    rotation: u32,
}

impl Sizes {
    #[inline]
    fn new<C>(texture: &Texture<'_, C>, behind: u32) -> Self {
        let (log2_width, _) = texture.log2_size();
        Self {
            down: texture.down(),
            columns: log2_width.wrapping_add(behind) & 31,
            rotation: texture.rotation(),
        }
    }

    /// The number of a texel, and above it what is of no use; at the top, where more bits of u are kept, those behind the
    /// column.
    #[inline]
    fn number(self, Place { u, v }: Place) -> u32 {
        if const { CARRIES } {
            let column = u & !(u32::MAX >> self.columns);
            (column | v >> self.down).rotate_right(self.rotation)
        } else {
            let last = (1u32 << self.columns) - 1;
            let row = v >> (self.down.wrapping_sub(self.columns) & 31) & !last;
            row | u >> self.rotation & last
        }
    }
}

/// The texel at `uv`.
#[inline]
pub(super) fn nearest<C: Copy + Default>(texture: &Texture<'_, C>, uv: Uv) -> C {
    texture.numbered(Sizes::new(texture, 0).number(Place::new(uv)))
}

/// Gives `pixels` what `decoder` makes of the texels at `uv`, `uv + step` and so on.
#[inline(never)]
pub(super) fn fill<C: Copy, P, D: Decoder<C, P>>(
    texture: &Texture<'_, C>,
    uv: Uv,
    step: Uv,
    pixels: &mut [P],
    decoder: D,
) {
    let texels = texture.texels();
    // As in `Texture::numbered`.
    if texels.is_empty() {
        return;
    }
    let mask = texels.len() - 1;
    let sizes = Sizes::new(texture, D::BEHIND);
    let (mut place, step) = (Place::new(uv), Place::new(step));
    for pixel in pixels {
        let number = sizes.number(place);
        *pixel = decoder.decode(texels[number as usize & mask], number);
        place = place.after(step);
        keep_rolled();
    }
}

/// The same for those pixels that are seen, of which the first has number `first`.
#[inline]
pub(super) fn fill_seen<C: Copy, P, D: Decoder<C, P>>(
    texture: &Texture<'_, C>,
    uv: Uv,
    step: Uv,
    (first, pixels): (usize, &mut [P]),
    seen: &mut impl Visibility,
    decoder: D,
) {
    let texels = texture.texels();
    // As in `Texture::numbered`.
    if texels.is_empty() {
        return;
    }
    let mask = texels.len() - 1;
    let sizes = Sizes::new(texture, D::BEHIND);
    let (mut place, step) = (Place::new(uv), Place::new(step));
    for pixel in seen.among(first, pixels) {
        pixel.write(|pixel| {
            let number = sizes.number(place);
            *pixel = decoder.decode(texels[number as usize & mask], number);
            true
        });
        place = place.after(step);
        keep_rolled();
    }
}
