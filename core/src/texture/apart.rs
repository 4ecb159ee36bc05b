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
use crate::uv::{Curve, Uv};
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

    #[inline]
    fn before(self, step: Self) -> Self {
        Self {
            u: self.u.wrapping_sub(step.u),
            v: self.v.wrapping_sub(step.v),
        }
    }
}

/// A texture's sizes, as they are needed to find a texel.
#[derive(Clone, Copy)]
struct Sizes {
    /// From v to the row.
    down: u32,
    /// The bits of u that are kept: the column's, or more.
    column: u32,
    /// From u to the column.
    rotation: u32,
}

impl Sizes {
    /// With so many bits of u behind the column.
    #[inline]
    fn new<C>(texture: &Texture<'_, C>, behind: u32) -> Self {
        Self {
            down: texture.down(),
            column: texture.column >> behind | !(u32::MAX >> behind),
            rotation: texture.rotation(),
        }
    }

    /// The number of a texel, and above it what is of no use; at the top, where more bits of u are kept, those behind the
    /// column.
    #[inline]
    fn number(self, Place { u, v }: Place) -> u32 {
        let Self {
            down,
            column,
            rotation,
        } = self;
        if const { CARRIES } {
            (u & column | v >> down).rotate_right(rotation)
        } else {
            // The rotation is as many less than 32 as a row has columns' bits.
            let row = v >> (down.wrapping_add(rotation) & 31);
            row & !(column >> rotation) | u >> rotation & column >> rotation
        }
    }
}

/// The texel at `uv`.
#[inline]
pub(super) fn nearest<C: Copy + Default>(texture: &Texture<'_, C>, uv: Uv) -> C {
    texture.numbered(Sizes::new(texture, 0).number(Place::new(uv)))
}

/// The places of a run, one after another.
struct Places<'t, C> {
    texels: &'t [C],
    sizes: Sizes,
    place: Place,
    step: Place,
}

impl<'t, C: Copy> Places<'t, C> {
    /// `uv`, `uv + step` and so on; `None` only for a texture without texels, which there is not.
    #[inline]
    fn new(texture: &Texture<'t, C>, uv: Uv, step: Uv, behind: u32) -> Option<Self> {
        let texels = texture.texels();
        // As in `Texture::numbered`.
        (!texels.is_empty()).then(|| Self {
            texels,
            sizes: Sizes::new(texture, behind),
            place: Place::new(uv),
            step: Place::new(step),
        })
    }

    /// What `decoder` makes of the texel.
    #[inline]
    fn decoded<P, D: Decoder<C, P>>(&self, decoder: D) -> P {
        let number = self.sizes.number(self.place);
        let mask = self.texels.len() - 1;
        decoder.decode(self.texels[number as usize & mask], number)
    }

    #[inline]
    fn go_on(&mut self) {
        self.place = self.place.after(self.step);
    }
}

/// Gives `pixels`, a few, what `decoder` makes of the texels at `uv`, `uv + step` and so on.
#[inline]
pub(super) fn fill_few<C: Copy, P, D: Decoder<C, P>>(
    texture: &Texture<'_, C>,
    uv: Uv,
    step: Uv,
    pixels: &mut [P],
    decoder: D,
) {
    let Some(mut places) = Places::new(texture, uv, step, D::BEHIND) else {
        return;
    };
    for pixel in pixels {
        *pixel = places.decoded(decoder);
        places.go_on();
        keep_rolled();
    }
}

/// The same for any number of pixels.
#[inline(never)]
pub(super) fn fill<C: Copy, P, D: Decoder<C, P>>(
    texture: &Texture<'_, C>,
    uv: Uv,
    step: Uv,
    pixels: &mut [P],
    decoder: D,
) {
    fill_few(texture, uv, step, pixels, decoder);
}

/// Pixels of one turn of a loop: so many copies of its body. Of more, compilers find multiples of the step first, and
/// have no registers for them.
pub(super) const ROLL: usize = 4;

/// Pixels that are worth more than one in each turn of a loop.
pub(super) const MANY: usize = 32;

/// The same for [`MANY`] and more.
#[inline(never)]
pub(super) fn fill_many<C: Copy, P, D: Decoder<C, P>>(
    texture: &Texture<'_, C>,
    uv: Uv,
    step: Uv,
    pixels: &mut [P],
    decoder: D,
) {
    let Some(mut places) = Places::new(texture, uv, step, D::BEHIND) else {
        return;
    };
    let (rolls, rest) = pixels.as_chunks_mut::<ROLL>();
    for pixels in rolls {
        for pixel in pixels {
            *pixel = places.decoded(decoder);
            places.go_on();
        }
    }
    for pixel in rest {
        *pixel = places.decoded(decoder);
        places.go_on();
        keep_rolled();
    }
}

/// The same for pixels of which the coordinates are on a parabola.
#[inline(never)]
pub(super) fn fill_curve<C: Copy, P, D: Decoder<C, P>>(
    texture: &Texture<'_, C>,
    curve: Curve,
    pixels: &mut [P],
    decoder: D,
) {
    let Some(mut places) = Places::new(texture, curve.uv, curve.step, D::BEHIND) else {
        return;
    };
    let change = Place::new(curve.change);
    places.step = places.step.before(change);
    for pixel in pixels {
        *pixel = places.decoded(decoder);
        places.step = places.step.after(change);
        places.go_on();
        keep_rolled();
    }
}

/// The same for those pixels that are seen.
#[inline]
pub(super) fn fill_seen<C: Copy, P, D: Decoder<C, P>>(
    texture: &Texture<'_, C>,
    uv: Uv,
    step: Uv,
    pixels: &mut [P],
    seen: &mut impl Visibility,
    decoder: D,
) {
    let Some(mut places) = Places::new(texture, uv, step, D::BEHIND) else {
        return;
    };
    for pixel in seen.among(pixels) {
        pixel.write(|pixel| {
            *pixel = places.decoded(decoder);
            true
        });
        places.go_on();
        keep_rolled();
    }
}
