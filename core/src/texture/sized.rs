//! A texture whose size is part of its type: the inner loop has it as constants.

use fixed::types::I8F24;

use super::apart;
use super::eights;
use super::packed::{self, PIECE};
use super::turning::{turned, turning_by_constant};
use super::{Repeat, around, log2_sides};
use super::{Texels, fill_seen, nearest, piece_stretches};
use crate::arith::{CARRIES, NARROW, SHIFTS_OPERANDS, keep_rolled, stepwise};
use crate::colour::{Colour, Fractions, MixesEights, WEIGHT_BITS};
use crate::simd::{COUNT, EIGHTS};
use crate::uv::{Curve, Eight, Uv};
use crate::visibility::{Candidate as _, Visibility};

/// A borrowed picture of `WIDTH` columns and `TEXELS / WIDTH` rows, both powers of two up to
/// [`MAX_TEXTURE_SIZE`](super::MAX_TEXTURE_SIZE), which the compiler checks.
///
/// It draws what a [`Texture`](super::Texture) of the same texels draws, with an instruction less a
/// pixel on a Cortex-M4 and none for sizes; and with another less, and on a Cortex-M0+ with three, where a run stays in
/// one row, as those of upright pictures do. Each size that a program uses has inner loops of its own in its image.
///
/// ```
/// use multum::embedded_graphics::pixelcolor::Rgb565;
/// use multum::sample::Nearest;
/// use multum::texture::SizedTexture;
///
/// static BRICKS: [Rgb565; 64 * 32] = [Rgb565::new(21, 9, 5); 64 * 32];
/// let sampler = Nearest::<_>::new(SizedTexture::<_, 64, _>::new(&BRICKS));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SizedTexture<'a, C, const WIDTH: u32, const TEXELS: usize> {
    texels: &'a [C; TEXELS],
}

impl<'a, C, const WIDTH: u32, const TEXELS: usize> SizedTexture<'a, C, WIDTH, TEXELS> {
    const LOG2_SIZE: (u32, u32) = {
        assert!(WIDTH != 0 && TEXELS.is_multiple_of(WIDTH as usize));
        match log2_sides(WIDTH, (TEXELS / WIDTH as usize) as u32) {
            Ok((width, height)) => (width as u32, height as u32),
            Err(_) => panic!("width and height are powers of two up to 4096"),
        }
    };

    /// Row by row from the top, without gaps.
    #[must_use]
    pub const fn new(texels: &'a [C; TEXELS]) -> Self {
        const { Self::LOG2_SIZE };
        Self { texels }
    }
}

impl<C: Copy + Default, const WIDTH: u32, const TEXELS: usize> Texels
    for SizedTexture<'_, C, WIDTH, TEXELS>
{
    type Colour = C;

    #[inline]
    fn log2_size(&self) -> (u32, u32) {
        Self::LOG2_SIZE
    }

    #[inline]
    fn texel(&self, column: u32, row: u32) -> C {
        let index = (row << Self::LOG2_SIZE.0) | column;
        self.texels[index as usize & (TEXELS - 1)]
    }

    #[inline]
    fn nearest_repeating(&self, uv: Uv) -> C {
        self.at(Self::place(uv))
    }

    #[inline]
    fn fill_repeating<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        C: Into<P>,
    {
        if pixels.len() < ROLL {
            self.fill_apart(uv, step, pixels);
        } else {
            self.fill_long(uv, step, pixels);
        }
    }

    #[inline]
    fn piece_repeating<P, const N: usize>(&self, uv: Uv, step: Uv, pixels: &mut [P; N])
    where
        C: Into<P>,
    {
        if const { !CARRIES } {
            self.fill_many(uv, step, pixels);
            return;
        }
        match packed::pack(Self::LOG2_SIZE.1, uv, step, N) {
            Some([at, step]) => {
                self.fill_packed(at, Self::turning(step), pixels);
            }
            None => self.fill_apart_called(uv, step, pixels),
        }
    }

    #[inline]
    fn fours_repeating<I: ExactSizeIterator>(
        &self,
        uv: Uv,
        step: Uv,
        items: I,
        mut each: impl FnMut(I::Item, [C; 4], Fractions),
    ) {
        let half = |log2: u32| (1i32 << (Uv::FRACTION_BITS - log2)) >> 1;
        let (log2_width, log2_height) = Self::LOG2_SIZE;
        // From the centre of the upper left texel.
        let from = uv
            + Uv::from_bits(
                half(log2_width).wrapping_neg(),
                half(log2_height).wrapping_neg(),
            );
        let packed = (const { CARRIES } && items.len() <= PIECE)
            .then(|| packed::pack(log2_height, from, step, items.len()));
        if let Some([at, step]) = packed.flatten() {
            visit_fours(*self, at, step, items, each);
        } else {
            let mut uv = uv;
            for item in items {
                let (texels, between) = around::<_, Repeat, Repeat>(self, uv);
                each(item, texels, between);
                uv = uv + step;
            }
        }
    }

    #[inline(always)]
    fn eights_repeating<P, M: MixesEights>(&self, uv: Uv, step: Uv, pixels: &mut [P]) -> bool
    where
        C: Colour + Into<P>,
    {
        let texel = |number: u16| self.texels[usize::from(number) & (TEXELS - 1)];
        eights::fill_fours::<_, _, M>(Self::LOG2_SIZE, texel, (uv, step), pixels)
    }

    #[inline]
    fn takes_eights(&self) -> bool {
        Self::BY_EIGHTS
    }

    #[inline(always)]
    fn eight_repeating<P>(&self, at: Eight, pixels: &mut [P; COUNT])
    where
        C: Into<P>,
    {
        let numbers = eights::numbers(Self::LOG2_SIZE, at);
        for (pixel, number) in pixels.iter_mut().zip(numbers) {
            *pixel = self.texels[usize::from(number) & (TEXELS - 1)].into();
        }
    }

    #[inline]
    fn curve_repeating<P>(&self, curve: Curve, pixels: &mut [P])
    where
        C: Into<P>,
    {
        let packed = const { CARRIES }
            .then(|| packed::pack_curve(Self::LOG2_SIZE.1, curve, pixels.len()))
            .flatten();
        match packed {
            Some(packed) => self.fill_curve_packed(packed, pixels),
            None => self.fill_curve(curve, pixels),
        }
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
        Self::visit_apart(uv, step, seen.among(pixels), |pixel, place| {
            pixel.write(|pixel| {
                *pixel = self.at(place).into();
                true
            });
        });
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
        if const { EIGHTS } {
            piece_stretches(self, uv, step, pixels, seen);
            return;
        }
        if const { !CARRIES } {
            self.fill_few_seen_repeating(uv, step, pixels, seen);
            return;
        }
        let packed = const { N > packed::SHORT && N <= PIECE }
            .then(|| packed::pack(Self::LOG2_SIZE.1, uv, step, N));
        let Some([mut at, step]) = packed.flatten() else {
            fill_seen::<_, Repeat, Repeat, _>(self, uv, step, pixels, seen);
            return;
        };
        for pixel in seen.among(pixels) {
            pixel.write(|pixel| {
                *pixel = self.rotated((at >> 32) as u32).into();
                true
            });
            at = at.wrapping_add(step);
        }
    }
}

/// Four texels and the place between them, pixel by pixel, where v stays within 0..1.
#[inline(never)]
fn visit_fours<C: Copy + Default, const WIDTH: u32, const TEXELS: usize, I: Iterator>(
    texture: SizedTexture<'_, C, WIDTH, TEXELS>,
    mut at: u64,
    step: u64,
    items: I,
    mut each: impl FnMut(I::Item, [C; 4], Fractions),
) {
    let rotation = SizedTexture::<C, WIDTH, TEXELS>::ROTATION;
    // Nothing where there is one column only.
    let column = (1u32 << rotation) & !1;
    let texel = |index: u32| texture.texels[index as usize & (TEXELS - 1)];
    let step = SizedTexture::<C, WIDTH, TEXELS>::turning(step);
    for item in items {
        let here = turned(at, step, rotation);
        let right = turned(at.wrapping_add(u64::from(column) << 32), step, rotation);
        let four = [
            texel(here),
            texel(right),
            texel(here.wrapping_add(WIDTH)),
            texel(right.wrapping_add(WIDTH)),
        ];
        let fraction = |word: u32| word >> (32 - WEIGHT_BITS);
        each(
            item,
            four,
            Fractions {
                u: fraction(here),
                v: fraction(at as u32),
            },
        );
        at = at.wrapping_add(step);
    }
}

/// Pixels of one turn of a loop: so many copies of its body.
const ROLL: usize = 16;

/// The same along a row.
const ROW_ROLL: usize = 8;

/// A coordinate with its fraction at the top of the word.
#[inline]
fn whole_repeats_lost(coordinate: I8F24) -> u32 {
    (coordinate.to_bits() << packed::U_UP).cast_unsigned()
}

/// So many of the highest bits, at most 12.
#[inline]
const fn top_bits(word: u32, bits: u32) -> u32 {
    if bits == 0 { 0 } else { word >> (32 - bits) }
}

impl<C: Copy + Default, const WIDTH: u32, const TEXELS: usize> SizedTexture<'_, C, WIDTH, TEXELS> {
    /// Hands over `N` texels; returns what the next one would be at.
    #[inline]
    fn visit_packed<const N: usize>(
        &self,
        at: u64,
        step: u64,
        mut each: impl FnMut(usize, C),
    ) -> u64 {
        let mut at = at;
        for number in 0..N {
            each(number, self.packed(at, step));
            at = at.wrapping_add(step);
        }
        at
    }

    /// How far a packed coordinate's upper word is rotated right.
    const ROTATION: u32 = (32 - Self::LOG2_SIZE.0) & 31;

    /// A packed step, for [`Self::packed`].
    #[inline]
    fn turning(step: u64) -> u64 {
        turning_by_constant(step, Self::ROTATION)
    }

    /// The texel at a packed coordinate of a run with that step.
    #[inline]
    fn packed(&self, at: u64, step: u64) -> C {
        self.texels[turned(at, step, Self::ROTATION) as usize & (TEXELS - 1)]
    }

    /// Of a packed coordinate's upper word. On a Cortex-M4 the rotation and the mask are one instruction, the load
    /// is another.
    #[inline]
    fn rotated(&self, word: u32) -> C {
        self.texels[word.rotate_right(Self::ROTATION) as usize & (TEXELS - 1)]
    }

    #[inline]
    fn fill_packed<P, const N: usize>(&self, at: u64, step: u64, pixels: &mut [P; N]) -> u64
    where
        C: Into<P>,
    {
        self.visit_packed::<N>(at, step, |number, texel| {
            if let Some(pixel) = pixels.get_mut(number) {
                *pixel = texel.into();
            }
        })
    }

    /// A part of a run, packed.
    #[inline]
    fn fill_part<P>(&self, mut at: u64, step: u64, pixels: &mut [P])
    where
        C: Into<P>,
    {
        let step = Self::turning(step);
        let (rolls, rest) = pixels.as_chunks_mut::<ROLL>();
        for pixels in rolls {
            at = self.fill_packed(at, step, pixels);
        }
        for pixel in rest {
            *pixel = self.packed(at, step).into();
            at = at.wrapping_add(step);
        }
    }

    /// The same for small processors, of which its loop takes all registers.
    #[inline(never)]
    fn fill_part_apart<P>(&self, at: u64, step: u64, pixels: &mut [P])
    where
        C: Into<P>,
    {
        self.fill_part(at, step, pixels);
    }

    #[inline(never)]
    fn fill_long<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        C: Into<P>,
    {
        if step.v == Uv::default().v {
            self.fill_along_row(uv, step, pixels);
            return;
        }
        if const { Self::BY_EIGHTS } {
            self.fill_apart_called(uv, step, pixels);
            return;
        }
        if const { !CARRIES } {
            self.fill_many(uv, step, pixels);
            return;
        }
        packed::in_parts(
            Self::LOG2_SIZE.1,
            uv,
            step,
            pixels,
            |_, [at, step], pixels| {
                if const { NARROW } {
                    self.fill_part_apart(at, step, pixels);
                } else {
                    self.fill_part(at, step, pixels);
                }
            },
            |uv, pixels| self.fill_apart_called(uv, step, pixels),
        );
    }

    /// A run that stays in one row of the texture: those of upright pictures do.
    #[inline]
    fn fill_along_row<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        C: Into<P>,
    {
        let [row, mut u, step] = [uv.v, uv.u, step.u].map(whole_repeats_lost);
        let start = top_bits(row, Self::LOG2_SIZE.1) as usize * WIDTH as usize;
        let Some(row) = self.texels.get(start..start + WIDTH as usize) else {
            return;
        };
        let at = |u: u32| row[top_bits(u, Self::LOG2_SIZE.0) as usize & (WIDTH as usize - 1)];
        let (rolls, rest) = pixels.as_chunks_mut::<ROW_ROLL>();
        for pixels in rolls {
            u = stepwise(u);
            for pixel in pixels {
                *pixel = at(u).into();
                u = u.wrapping_add(step);
            }
        }
        for pixel in rest {
            *pixel = at(u).into();
            u = u.wrapping_add(step);
            keep_rolled();
        }
    }

    /// Whether runs are filled eight pixels at a time. Pieces of 16 are not: that takes 14 % fewer instructions, and
    /// a quarter more time.
    const BY_EIGHTS: bool = EIGHTS && eights::fit(Self::LOG2_SIZE);

    /// Whether u and v make the upper word of a packed coordinate by one instruction, and that the texel by two.
    const JOINS: bool = SHIFTS_OPERANDS && Self::LOG2_SIZE.1 <= packed::MAX_LOG2_HEIGHT;

    /// How far up u and v of a [`Place`] are shifted.
    const UP: (u32, u32) = (
        if Self::JOINS || NARROW {
            packed::U_UP
        } else {
            0
        },
        if NARROW { packed::U_UP } else { 0 },
    );

    #[inline]
    fn place(uv: Uv) -> Place {
        let (u, v) = (uv.u.to_bits(), uv.v.to_bits());
        Place {
            u: u << Self::UP.0,
            v: v << Self::UP.1,
        }
    }

    #[inline]
    fn at(&self, Place { u, v }: Place) -> C {
        if const { Self::JOINS } {
            self.rotated(packed::upper_word(Self::LOG2_SIZE.1, u, v))
        } else if const { NARROW } {
            self.shifted(u.cast_unsigned(), v.cast_unsigned())
        } else {
            nearest::<_, Repeat, Repeat>(self, Uv::from_bits(u, v))
        }
    }

    /// Of coordinates with their fractions at the top.
    #[inline]
    fn shifted(&self, u: u32, v: u32) -> C {
        let (log2_width, log2_height) = Self::LOG2_SIZE;
        // Of words the compiler would make masks, which take instructions of their own.
        let both = u64::from(top_bits(v, log2_height)) << 32 | u64::from(u);
        self.texels[(both >> (32 - log2_width)) as usize & (TEXELS - 1)]
    }

    /// Hands over `uv`, `uv + step` and so on, each with one of `items`.
    #[inline]
    fn visit_apart<I: Iterator>(uv: Uv, step: Uv, items: I, mut each: impl FnMut(I::Item, Place)) {
        let (mut place, step) = (Self::place(uv), Self::place(step));
        for item in items {
            each(item, place);
            place = place.after(step);
            keep_rolled();
        }
    }

    /// Pixel by pixel, u and v in words of their own.
    #[inline]
    fn fill_apart<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        C: Into<P>,
    {
        Self::visit_apart(uv, step, pixels.iter_mut(), |pixel, place| {
            *pixel = self.at(place).into();
        });
    }

    /// The same for many.
    #[inline]
    fn fill_many<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        C: Into<P>,
    {
        let (mut place, step) = (Self::place(uv), Self::place(step));
        let mut next = || {
            let texel = self.at(place).into();
            place = place.after(step);
            texel
        };
        let (rolls, rest) = pixels.as_chunks_mut::<{ apart::ROLL }>();
        for pixels in rolls {
            for pixel in pixels {
                *pixel = next();
            }
        }
        for pixel in rest {
            *pixel = next();
            keep_rolled();
        }
    }

    /// Pixels of which the coordinates are on a parabola, packed.
    #[inline(never)]
    fn fill_curve_packed<P>(&self, [mut at, step, change]: [u64; 3], pixels: &mut [P])
    where
        C: Into<P>,
    {
        let mut step = Self::turning(step);
        packed::by_fours(pixels, || {
            let texel = self.packed(at, step).into();
            step = step.wrapping_add(change);
            at = at.wrapping_add(step);
            texel
        });
    }

    /// The same, u and v in words of their own.
    #[inline(never)]
    fn fill_curve<P>(&self, curve: Curve, pixels: &mut [P])
    where
        C: Into<P>,
    {
        let [mut place, step, change] = [curve.uv, curve.step, curve.change].map(Self::place);
        let mut step = step.before(change);
        for pixel in pixels {
            *pixel = self.at(place).into();
            step = step.after(change);
            place = place.after(step);
            keep_rolled();
        }
    }

    /// The same for a piece in which v leaves 0..1.
    #[inline(never)]
    fn fill_apart_called<P>(self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        C: Into<P>,
    {
        if const { Self::BY_EIGHTS } {
            let pixel = |number: u16| self.texels[usize::from(number) & (TEXELS - 1)].into();
            eights::fill(Self::LOG2_SIZE, pixel, (uv, step), pixels);
        } else {
            self.fill_apart(uv, step, pixels);
        }
    }
}

/// A coordinate, u and v in words of their own.
#[derive(Clone, Copy)]
struct Place {
    /// Shifted up so far that whole repeats are lost, where that is of use.
    u: i32,
    v: i32,
}

impl Place {
    #[inline]
    fn before(self, step: Self) -> Self {
        Self {
            u: self.u.wrapping_sub(step.u),
            v: self.v.wrapping_sub(step.v),
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

#[cfg(test)]
mod tests {
    use super::*;

    extern crate std;

    fn check<const WIDTH: u32, const TEXELS: usize>(next: &mut impl FnMut() -> i32) {
        let texels: std::vec::Vec<u16> = (0..TEXELS).map(|texel| texel as u16).collect();
        let texels: &[u16; TEXELS] = texels.as_slice().try_into().expect("as many as it has");
        let texture = SizedTexture::<_, WIDTH, TEXELS>::new(texels);
        let (_, log2_height) = texture.log2_size();
        for case in 0..2_000 {
            // Any, and beside edges of texels.
            let uv = match case % 3 {
                0 => Uv::from_bits(next(), next()),
                1 => Uv::from_bits(next() & !0xfff, next() & !0xfff),
                _ => Uv::from_bits(next() | 0xfff, next() | 0xfff),
            };
            let (u, v) = (uv.u.to_bits(), uv.v.to_bits());
            let joined = texture.rotated(packed::upper_word(log2_height, u << packed::U_UP, v));
            let expected = nearest::<_, Repeat, Repeat>(&texture, uv);
            assert_eq!(joined, expected, "{WIDTH} columns, {uv:?}");
        }
    }

    /// As an Armv7-M finds them.
    #[test]
    fn texels_of_joined_coordinates_are_the_same() {
        let mut state = 1u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state ^ state >> 15).cast_signed()
        };
        check::<1, 1>(&mut next);
        check::<1, 256>(&mut next);
        check::<2, 4>(&mut next);
        check::<16, 2048>(&mut next);
        check::<64, 64>(&mut next);
        check::<256, 65_536>(&mut next);
        check::<256, 256>(&mut next);
        check::<4096, 4096>(&mut next);
        check::<4096, 16_384>(&mut next);
    }
}
