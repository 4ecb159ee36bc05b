//! Textures in memory, in the formats that chips use, and what happens beyond their edges.
//!
//! A sampler asks any of them for the texel in a column and a row ([`Texels`]); how it is stored is
//! the format's business.

mod apart;
mod bc1;
mod eights;
mod image;
mod indexed;
mod morton;
mod packed;
mod sized;
mod turning;
mod window;
mod wrap;

pub use bc1::Bc1;
pub(crate) use eights::BLENDED;
pub use image::ImageTexels;
pub use indexed::{Indexed, Indexed4, Indexed8};
pub use morton::Morton;
pub(crate) use packed::PIECE;
pub use sized::SizedTexture;
pub use window::Window;
pub use wrap::{Clamp, Mirror, Repeat, Wrap};

use self::apart::Colours;
use crate::arith::{NARROW, keep_rolled};
use crate::colour::{Colour, Fractions, MixesEights, ONE, WEIGHT_BITS};
use crate::error::Error;
use crate::simd::{COUNT, EIGHTS};
use crate::uv::{Curve, Eight, Uv};
use crate::visibility::{Candidate as _, MOST, Visibility, by_stretches, first_stretch};

const _: () = assert!(MOST <= PIECE, "a stretch is a part of a run");

/// Largest side of a texture in texels: 12 of the 24 fraction bits of a coordinate choose the
/// texel, 12 are left to step precisely.
pub const MAX_TEXTURE_SIZE: u32 = 4096;

/// A picture whose sides are powers of two, from which samplers read.
///
/// It is copied into samplers: a reference to texels and their sizes, not the texels themselves.
pub trait Texels: Copy {
    /// What a texel is.
    type Colour: Copy + Default;

    /// Base-2 logarithms of width and height, at most 12.
    fn log2_size(&self) -> (u32, u32);

    /// The texel in a column and a row; wrapping has brought both inside.
    fn texel(&self, column: u32, row: u32) -> Self::Colour;

    /// Fills a run with the texels at `uv`, `uv + step` and so on, where both axes repeat.
    ///
    /// For formats that can do better than texel by texel; the result is the same.
    #[inline]
    fn fill_repeating<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        Self::Colour: Into<P>,
    {
        let mut uv = uv;
        for pixel in pixels {
            *pixel = nearest::<_, Repeat, Repeat>(self, uv).into();
            uv = uv + step;
        }
    }

    /// The texel that a coordinate lies in, where both axes repeat.
    ///
    /// For formats that can do better than by column and row; the result is the same.
    #[inline]
    fn nearest_repeating(&self, uv: Uv) -> Self::Colour {
        nearest::<_, Repeat, Repeat>(self, uv)
    }

    /// [`Self::fill_repeating`] for a run that is often too short for more than its texels one by one.
    #[inline]
    fn fill_few_repeating<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        Self::Colour: Into<P>,
    {
        self.fill_repeating(uv, step, pixels);
    }

    /// [`Self::fill_repeating`] for no more than 64 pixels.
    #[inline]
    fn fill_part_repeating<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        Self::Colour: Into<P>,
    {
        self.fill_repeating(uv, step, pixels);
    }

    /// [`Self::piece_seen_repeating`] for a run that is too short for more than its texels one by one.
    #[inline]
    fn fill_few_seen_repeating<P>(
        &self,
        uv: Uv,
        step: Uv,
        pixels: &mut [P],
        seen: &mut impl Visibility,
    ) where
        Self::Colour: Into<P>,
    {
        fill_seen::<_, Repeat, Repeat, _>(self, uv, step, pixels, seen);
    }

    /// [`Self::fill_repeating`] for a run of known length.
    #[inline]
    fn piece_repeating<P, const N: usize>(&self, uv: Uv, step: Uv, pixels: &mut [P; N])
    where
        Self::Colour: Into<P>,
    {
        self.fill_repeating(uv, step, pixels);
    }

    /// The same for those pixels that are seen.
    #[inline]
    fn piece_seen_repeating<P, const N: usize>(
        &self,
        uv: Uv,
        step: Uv,
        pixels: &mut [P; N],
        seen: &mut impl Visibility,
    ) where
        Self::Colour: Into<P>,
    {
        piece_stretches(self, uv, step, pixels, seen);
    }

    /// Whether it is faster to fill eight pixels at a time where each has coordinates of its own: whether
    /// [`Self::eight_repeating`] is more than texel by texel.
    #[inline]
    fn takes_eights(&self) -> bool {
        false
    }

    /// Fills eight pixels, where both axes repeat.
    #[inline]
    fn eight_repeating<P>(&self, at: Eight, pixels: &mut [P; COUNT])
    where
        Self::Colour: Into<P>,
    {
        for (pixel, uv) in pixels.iter_mut().zip(at.array()) {
            *pixel = self.nearest_repeating(uv).into();
        }
    }

    /// Fills pixels of which the coordinates are on a parabola, where both axes repeat.
    #[inline]
    fn curve_repeating<P>(&self, curve: Curve, pixels: &mut [P])
    where
        Self::Colour: Into<P>,
    {
        for (pixel, uv) in pixels.iter_mut().zip(curve) {
            *pixel = self.nearest_repeating(uv).into();
        }
    }

    /// Hands over the four texels around `uv`, `uv + step` and so on and where it lies between them, each with
    /// one of `items`, where both axes repeat.
    ///
    /// For formats that can do better than texel by texel; the result is the same.
    #[inline]
    fn fours_repeating<I: ExactSizeIterator>(
        &self,
        uv: Uv,
        step: Uv,
        items: I,
        mut each: impl FnMut(I::Item, [Self::Colour; 4], Fractions),
    ) {
        let mut uv = uv;
        for item in items {
            let (texels, between) = around::<_, Repeat, Repeat>(self, uv);
            each(item, texels, between);
            uv = uv + step;
        }
    }

    /// Gives pixels what `M` makes of the four texels around `uv`, `uv + step` and so on, where both
    /// axes repeat; `false`, and nothing is written, if the format or the texture's size has no way to do that.
    #[inline]
    fn eights_repeating<P, M: MixesEights>(&self, _uv: Uv, _step: Uv, _pixels: &mut [P]) -> bool
    where
        Self::Colour: Colour + Into<P>,
    {
        false
    }

    /// The same of two levels of one picture, each with where it is looked at, mixed by a weight of
    /// [`BLEND_BITS`](crate::colour::BLEND_BITS), for no more than 16 pixels.
    #[inline]
    fn eights_between<P, M: MixesEights>(
        _levels: [(&Self, Uv); 2],
        _weight: u32,
        _step: Uv,
        _pixels: &mut [P],
    ) -> bool
    where
        Self::Colour: Colour + Into<P>,
    {
        false
    }
}

/// The texel that a coordinate lies in.
#[inline]
pub(crate) fn nearest<T: Texels, U: Wrap, V: Wrap>(texels: &T, uv: Uv) -> T::Colour {
    let (log2_width, log2_height) = texels.log2_size();
    // At most 12 bits each: the shifts stay at 12 .. 24.
    let index = |bits: i32, log2_size: u32| bits >> ((Uv::FRACTION_BITS - log2_size) & 31);
    texels.texel(
        U::wrap(index(uv.u.to_bits(), log2_width), log2_width),
        V::wrap(index(uv.v.to_bits(), log2_height), log2_height),
    )
}

/// Gives those pixels that are seen the texels that `uv`, `uv + step` and so on lie in.
#[inline]
pub(crate) fn fill_seen<T: Texels<Colour: Into<P>>, U: Wrap, V: Wrap, P>(
    texels: &T,
    uv: Uv,
    step: Uv,
    pixels: &mut [P],
    seen: &mut impl Visibility,
) {
    let mut uv = uv;
    for pixel in seen.among(pixels) {
        pixel.write(|pixel| {
            *pixel = nearest::<_, U, V>(texels, uv).into();
            true
        });
        uv = uv + step;
        keep_rolled();
    }
}

/// [`Texels::piece_seen_repeating`] with the depths tested first: the loop over texels is then the one that there is
/// without a test.
#[inline]
fn piece_stretches<T: Texels<Colour: Into<P>>, P, const N: usize>(
    texels: &T,
    uv: Uv,
    step: Uv,
    pixels: &mut [P; N],
    seen: &mut impl Visibility,
) {
    let Some(first) = first_stretch::<N>(seen) else {
        texels.piece_repeating(uv, step, pixels);
        return;
    };
    by_stretches(first, pixels, seen, |first, pixels| {
        texels.fill_part_repeating(uv.after(step, first), step, pixels);
    });
}

/// The four texels whose centres surround a coordinate, and where it lies between them.
///
/// ```text
///    texel 0     texel 1         texel centres at + 1/2: half a texel is taken off, and
///  |-----+-----|-----+-----|     what is left of the point says which texel is upper left
///        |<-f->*                 and how far it is to the next
/// ```
#[inline]
pub(crate) fn around<T: Texels, U: Wrap, V: Wrap>(
    texture: &T,
    uv: Uv,
) -> ([T::Colour; 4], Fractions) {
    let (log2_width, log2_height) = texture.log2_size();
    let (left, right, u) = neighbours::<U>(uv.u.to_bits(), log2_width);
    let (upper, lower, v) = neighbours::<V>(uv.v.to_bits(), log2_height);
    let texels = [
        texture.texel(left, upper),
        texture.texel(right, upper),
        texture.texel(left, lower),
        texture.texel(right, lower),
    ];
    (texels, Fractions { u, v })
}

/// Along one axis: the two texels, and how far the coordinate is from the first one's centre to
/// the second's, in 2^-11, rounded down.
#[inline]
fn neighbours<W: Wrap>(coordinate: i32, log2_size: u32) -> (u32, u32, u32) {
    // 12 to 24 bits behind the texel's number.
    let below = Uv::FRACTION_BITS.wrapping_sub(log2_size) & 31;
    let from_centre = coordinate.wrapping_sub((1i32 << below) >> 1);
    let first = from_centre >> below;
    let fraction = from_centre >> (below.wrapping_sub(WEIGHT_BITS) & 31);
    (
        W::wrap(first, log2_size),
        W::wrap(first.wrapping_add(1), log2_size),
        fraction.cast_unsigned() & (ONE - 1),
    )
}

/// Base-2 logarithms of sides that are powers of two up to [`MAX_TEXTURE_SIZE`].
const fn log2_sides(width: u32, height: u32) -> Result<(u8, u8), Error> {
    if !width.is_power_of_two()
        || !height.is_power_of_two()
        || width > MAX_TEXTURE_SIZE
        || height > MAX_TEXTURE_SIZE
    {
        return Err(Error::TextureSize { width, height });
    }
    Ok((width.trailing_zeros() as u8, height.trailing_zeros() as u8))
}

/// That a slice has the length that its description claims.
const fn check_length(given: usize, needed: usize) -> Result<(), Error> {
    if given == needed {
        Ok(())
    } else {
        Err(Error::BufferLength { needed, given })
    }
}

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
    /// Found from these, which a loop of pixels would do again and again. How far a word is rotated to the right
    /// until the column that is at its top is at its bottom.
    rotation: u8,
    /// How far v is shifted down to the row.
    down: u8,
    /// The bits that the column has there: at the top.
    column: u32,
}

impl<'a, C> Texture<'a, C> {
    /// Checks the sizes. In a `static` the compiler does the checking.
    ///
    /// # Errors
    ///
    /// [`Error::TextureSize`] unless both sides are powers of two, 1 to [`MAX_TEXTURE_SIZE`];
    /// [`Error::BufferLength`] unless there are exactly `width * height` texels.
    pub const fn new(texels: &'a [C], width: u32, height: u32) -> Result<Self, Error> {
        let (log2_width, log2_height) = match log2_sides(width, height) {
            Ok(sides) => sides,
            Err(error) => return Err(error),
        };
        if let Err(error) = check_length(texels.len(), width as usize * height as usize) {
            return Err(error);
        }
        Ok(Self {
            texels,
            log2_width,
            log2_height,
            rotation: (32 - log2_width) % 32,
            down: Uv::FRACTION_BITS as u8 - log2_height,
            column: !(u32::MAX >> log2_width),
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

    #[inline]
    const fn rotation(&self) -> u32 {
        self.rotation as u32 & 31
    }

    #[inline]
    const fn down(&self) -> u32 {
        self.down as u32 & 31
    }
}

impl<C: Copy + Default> Texture<'_, C> {
    /// [`Self::numbered`] for many: `None` only for a texture without texels, which there is not.
    #[inline(always)]
    fn by_number(&self) -> Option<impl Fn(u16) -> C + Copy> {
        let texels = self.texels;
        let mask = texels.len().checked_sub(1)?;
        Some(move |number: u16| texels[usize::from(number) & mask])
    }

    /// The texel of a number, of which what is above that of the last is lost.
    #[inline]
    fn numbered(&self, number: u32) -> C {
        let texels = self.texels;
        // There is one at least; it is written down because the mask proves to the compiler that no number is out of
        // bounds, but only if there is a texel.
        if texels.is_empty() {
            return C::default();
        }
        texels[number as usize & (texels.len() - 1)]
    }
}

impl<C: Copy + Default> Texels for Texture<'_, C> {
    type Colour = C;

    #[inline]
    fn log2_size(&self) -> (u32, u32) {
        Texture::log2_size(self)
    }

    #[inline]
    fn texel(&self, column: u32, row: u32) -> C {
        // Wrapping keeps it inside.
        self.numbered((row << (self.log2_width & 31)) | column)
    }

    #[inline]
    fn nearest_repeating(&self, uv: Uv) -> C {
        apart::nearest(self, uv)
    }

    #[inline]
    fn fill_few_seen_repeating<P>(
        &self,
        uv: Uv,
        step: Uv,
        pixels: &mut [P],
        seen: &mut impl Visibility,
    ) where
        C: Into<P>,
    {
        apart::fill_seen(self, uv, step, pixels, seen, Colours);
    }

    #[inline]
    fn fill_repeating<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        C: Into<P>,
    {
        packed::fill(self, uv, step, pixels, Colours);
    }

    #[inline]
    fn fill_few_repeating<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        C: Into<P>,
    {
        if pixels.len() <= packed::SHORT {
            // Nor worth a call, as in small triangles.
            apart::fill_few(self, uv, step, pixels, Colours);
        } else {
            packed::fill(self, uv, step, pixels, Colours);
        }
    }

    #[inline]
    fn fill_part_repeating<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        C: Into<P>,
    {
        packed::part(self, uv, step, pixels, Colours);
    }

    #[inline]
    fn piece_repeating<P, const N: usize>(&self, uv: Uv, step: Uv, pixels: &mut [P; N])
    where
        C: Into<P>,
    {
        if const { N > packed::SHORT && N <= PIECE } {
            packed::piece(self, uv, step, pixels, Colours);
            return;
        }
        // Not worth packing, and too many for a call each.
        let mut uv = uv;
        for pixel in pixels {
            *pixel = apart::nearest(self, uv).into();
            uv = uv + step;
        }
    }

    #[inline]
    fn piece_seen_repeating<P, const N: usize>(
        &self,
        uv: Uv,
        step: Uv,
        pixels: &mut [P; N],
        seen: &mut impl Visibility,
    ) where
        C: Into<P>,
    {
        if const { NARROW } {
            piece_stretches(self, uv, step, pixels, seen);
        } else {
            packed::fill_seen(self, uv, step, pixels, seen, Colours);
        }
    }

    #[inline]
    fn takes_eights(&self) -> bool {
        (const { EIGHTS }) && eights::fit(Texture::log2_size(self))
    }

    #[inline(always)]
    fn eight_repeating<P>(&self, at: Eight, pixels: &mut [P; COUNT])
    where
        C: Into<P>,
    {
        let numbers = eights::numbers(Texture::log2_size(self), at);
        for (pixel, number) in pixels.iter_mut().zip(numbers) {
            *pixel = self.numbered(number.into()).into();
        }
    }

    #[inline]
    fn curve_repeating<P>(&self, curve: Curve, pixels: &mut [P])
    where
        C: Into<P>,
    {
        packed::fill_curve(self, curve, pixels, Colours);
    }

    #[inline]
    fn fours_repeating<I: ExactSizeIterator>(
        &self,
        uv: Uv,
        step: Uv,
        items: I,
        each: impl FnMut(I::Item, [C; 4], Fractions),
    ) {
        packed::fours(self, uv, step, items, each);
    }

    #[inline(always)]
    fn eights_repeating<P, M: MixesEights>(&self, uv: Uv, step: Uv, pixels: &mut [P]) -> bool
    where
        C: Colour + Into<P>,
    {
        let Some(texel) = self.by_number() else {
            return false;
        };
        eights::fill_fours::<_, _, M>(Texture::log2_size(self), texel, (uv, step), pixels)
    }

    #[inline(never)]
    fn eights_between<P, M: MixesEights>(
        levels: [(&Self, Uv); 2],
        weight: u32,
        step: Uv,
        pixels: &mut [P],
    ) -> bool
    where
        C: Colour + Into<P>,
    {
        let [(fine, fine_uv), (coarse, coarse_uv)] = levels;
        let (Some(fine_texel), Some(coarse_texel)) = (fine.by_number(), coarse.by_number()) else {
            return false;
        };
        let fine = (Texture::log2_size(fine), fine_texel, fine_uv);
        let coarse = (Texture::log2_size(coarse), coarse_texel, coarse_uv);
        eights::fill_between::<_, _, M>([fine, coarse], weight, step, pixels)
    }
}
