//! Texels for eight pixels at a time, where both axes repeat. Part of [`Texture`](super::Texture) and
//! [`SizedTexture`](super::SizedTexture).
//!
//! ```text
//!   u, its whole repeats lost: upper half   [ column | fraction ]    number of a texel:
//!   v                                       [ row    | fraction ]    [ 0 | row | column ]
//! ```
//!
//! The number must fit, as it does up to 256 by 256 texels.

use fixed::types::I8F24;

use super::packed::U_UP;
use crate::colour::{Colour, EightMixed, LANE_BITS, MixesEights};
use crate::simd::{COUNT, U16x8, Walk};
use crate::uv::{Eight, Uv};

/// Of a number, and of a coordinate's upper half.
const BITS: u32 = u16::BITS;

/// Base-2 logarithm of the longest side that leaves a coordinate's upper half the bits of a weight.
const MOST: u32 = BITS - LANE_BITS;

/// Eights of one level that are kept until those of another are mixed with them.
const KEPT: usize = 2;

/// The most pixels that are mixed from two levels at a time.
pub(crate) const BLENDED: usize = KEPT * COUNT;

/// Whether numbers fit.
pub(super) const fn fit((log2_width, log2_height): (u32, u32)) -> bool {
    log2_width.wrapping_add(log2_height) <= BITS
}

/// Gives `pixels` the texels at `uv`, `uv + step` and so on, of a texture of which the numbers [fit].
#[inline(always)]
pub(super) fn fill<P>(
    log2_size: (u32, u32),
    pixel: impl Fn(u16) -> P,
    (uv, step): (Uv, Uv),
    pixels: &mut [P],
) {
    let up = |coordinate: I8F24| (coordinate.to_bits() << U_UP).cast_unsigned();
    let mut u = Walk::new(up(uv.u), up(step.u));
    let mut v = Walk::new(up(uv.v), up(step.v));
    let (rolls, rest) = pixels.as_chunks_mut::<COUNT>();
    for pixels in rolls {
        let numbers = next(log2_size, &mut u, &mut v);
        for (to, number) in pixels.iter_mut().zip(numbers) {
            *to = pixel(number);
        }
    }
    for (to, number) in rest.iter_mut().zip(next(log2_size, &mut u, &mut v)) {
        *to = pixel(number);
    }
}

/// The numbers of the next eight texels.
#[inline(always)]
fn next((log2_width, log2_height): (u32, u32), u: &mut Walk, v: &mut Walk) -> [u16; COUNT] {
    let row = v.next().down(BITS.wrapping_sub(log2_height)).up(log2_width);
    row.or(u.next().down(BITS.wrapping_sub(log2_width))).array()
}

/// The numbers of the texels at coordinates, of a texture of which they [fit].
#[inline(always)]
pub(super) fn numbers(
    (log2_width, log2_height): (u32, u32),
    Eight { u, v }: Eight,
) -> [u16; COUNT] {
    let column = u.up(U_UP).down_by(u32::BITS.wrapping_sub(log2_width));
    let row = v.down_by(Uv::FRACTION_BITS.wrapping_sub(log2_height));
    let number = row.up(log2_width).or(column);
    // Without what is above a row: whole repeats.
    let texels = 1u32 << log2_width.wrapping_add(log2_height);
    number.and(texels.wrapping_sub(1)).lower_halves()
}

/// Gives `pixels` what `M` makes of the four texels around `uv`, `uv + step` and so on; `false`, and
/// nothing is written, if the texture is too large. `texel` takes numbers modulo that of all
/// texels.
#[inline(always)]
pub(super) fn fill_fours<C: Colour + Into<P>, P, M: MixesEights>(
    log2_size: (u32, u32),
    texel: impl Fn(u16) -> C + Copy,
    (uv, step): (Uv, Uv),
    pixels: &mut [P],
) -> bool {
    let Some(mut eights) = Eights::new(log2_size, uv, step) else {
        return false;
    };
    let (rolls, rest) = pixels.as_chunks_mut::<COUNT>();
    for pixels in rolls {
        write(pixels, eights.next::<C, M>(texel).colours());
    }
    if !rest.is_empty() {
        write(rest, eights.next::<C, M>(texel).colours());
    }
    true
}

/// The same of two textures, by a weight of [`BLEND_BITS`](crate::colour::BLEND_BITS), for no more than [`BLENDED`] pixels:
/// each with its size, its texels and where they are looked for.
#[inline(always)]
pub(super) fn fill_between<C: Colour + Into<P>, P, M: MixesEights>(
    [fine, coarse]: [((u32, u32), impl Fn(u16) -> C + Copy, Uv); 2],
    weight: u32,
    step: Uv,
    pixels: &mut [P],
) -> bool {
    // One after the other: registers hold the walk over one texture.
    let (log2_size, texel, uv) = fine;
    let Some(mut eights) = Eights::new(log2_size, uv, step) else {
        return false;
    };
    let mut kept = [M::Mixed::<C>::default(); KEPT];
    for eight in kept.iter_mut().take(pixels.len().div_ceil(COUNT)) {
        *eight = eights.next::<C, M>(texel);
    }
    let (log2_size, texel, uv) = coarse;
    let Some(mut eights) = Eights::new(log2_size, uv, step) else {
        return false;
    };
    for (pixels, fine) in pixels.chunks_mut(COUNT).zip(kept) {
        let coarse = eights.next::<C, M>(texel);
        write(pixels, fine.lerp(coarse, weight).colours());
    }
    true
}

/// Gives up to eight pixels as many of the colours.
#[inline(always)]
fn write<C: Into<P>, P>(pixels: &mut [P], colours: [C; COUNT]) {
    if let Some(eight) = pixels.first_chunk_mut() {
        *eight = colours.map(Into::into);
    } else {
        for (pixel, colour) in pixels.iter_mut().zip(colours) {
            *pixel = colour.into();
        }
    }
}

/// Along one axis, from the centre of the first of two texels.
#[inline(always)]
fn walk(from: I8F24, step: I8F24, log2_size: u32) -> Walk {
    let half = (1i32 << (Uv::FRACTION_BITS.wrapping_sub(log2_size) & 31)) >> 1;
    let up = |coordinate: i32| (coordinate << U_UP).cast_unsigned();
    Walk::new(up(from.to_bits().wrapping_sub(half)), up(step.to_bits()))
}

/// The walk over a texture.
struct Eights {
    u: Walk,
    v: Walk,
    log2_width: u32,
    log2_height: u32,
}

/// Where eight pixels lie.
struct Fours {
    /// Of the texels around each: upper left, upper right, lower left, lower right.
    numbers: [U16x8; 4],
    /// Weights along u and v.
    between: [U16x8; 2],
}

impl Eights {
    /// `None` if the texture is too large.
    #[inline(always)]
    fn new(log2_size: (u32, u32), uv: Uv, step: Uv) -> Option<Self> {
        let (log2_width, log2_height) = log2_size;
        let fits = log2_width <= MOST && log2_height <= MOST && fit(log2_size);
        fits.then(|| Self {
            u: walk(uv.u, step.u, log2_width),
            v: walk(uv.v, step.v, log2_height),
            log2_width,
            log2_height,
        })
    }

    /// The means for the next eight pixels.
    #[inline(always)]
    fn next<C: Colour, M: MixesEights>(&mut self, texel: impl Fn(u16) -> C) -> M::Mixed<C> {
        let Fours { numbers, between } = self.fours::<M>();
        M::Mixed::new(numbers, texel, between)
    }

    #[inline(always)]
    fn fours<M: MixesEights>(&mut self) -> Fours {
        // Below 16, as the compiler does not see.
        let (log2_width, log2_height) = (self.log2_width & 15, self.log2_height & 15);
        let fraction = |walk: &Walk, log2_size: u32| {
            if const { M::BITS <= LANE_BITS } {
                let down = (BITS - M::BITS).wrapping_sub(log2_size);
                walk.tops(0).down(down).and((1 << M::BITS) - 1)
            } else {
                walk.tops(log2_size).down(BITS - M::BITS)
            }
        };
        let between = [
            fraction(&self.u, log2_width),
            fraction(&self.v, log2_height),
        ];
        let (u, v) = (self.u.next(), self.v.next());
        let row = 1u16 << log2_width;
        let left = u.down(BITS - log2_width);
        let right = left.plus(U16x8::splat(1)).and(row.wrapping_sub(1));
        let upper = v.down(BITS - log2_height).up(log2_width);
        // Below the last row it is the first, as `texel` takes numbers modulo that of all texels.
        let lower = upper.plus(U16x8::splat(row));
        Fours {
            numbers: [
                upper.or(left),
                upper.or(right),
                lower.or(left),
                lower.or(right),
            ],
            between,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::{Repeat, Texture, nearest};

    /// Whatever the size, and however many pixels there are beyond whole eights.
    #[test]
    fn texels_are_those_of_pixels_by_themselves() {
        let texels: [u16; 1 << 16] = core::array::from_fn(|number| number as u16);
        let mut state = 1u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state ^ state >> 15).cast_signed()
        };
        for log2_size in (0..=12).flat_map(|width| (0..=12).map(move |height| (width, height))) {
            let (log2_width, log2_height) = log2_size;
            if !fit(log2_size) {
                assert!(log2_width + log2_height > 16);
                continue;
            }
            let texels = texels.get(..1 << (log2_width + log2_height));
            let texture = Texture::new(
                texels.unwrap_or_default(),
                1 << log2_width,
                1 << log2_height,
            )
            .expect("powers of two");
            for _ in 0..20 {
                let [u, v] = [0; 2].map(|_| {
                    Walk::new(random().cast_unsigned(), random().cast_unsigned()).next_words()
                });
                let eight = Eight { u, v };
                let found = numbers(log2_size, eight);
                for (number, uv) in found.into_iter().zip(eight.array()) {
                    let expected = nearest::<_, Repeat, Repeat>(&texture, uv);
                    assert_eq!(
                        texture.texels()[usize::from(number)],
                        expected,
                        "{log2_size:?} {uv:?}"
                    );
                }
            }
            for length in 0..=33 {
                let (uv, step) = (Uv::from_bits(random(), random()), random() >> (length % 16));
                let step = Uv::from_bits(step, random() >> (length % 13));
                let mut pixels = [u16::MAX; 40];
                let (here, beyond) = pixels.split_at_mut(length);
                fill(
                    texture.log2_size(),
                    |number| texture.texels()[usize::from(number)],
                    (uv, step),
                    here,
                );
                for (pixel, colour) in here.iter().enumerate() {
                    let uv = uv.after(step, pixel);
                    assert_eq!(
                        *colour,
                        nearest::<_, Repeat, Repeat>(&texture, uv),
                        "{log2_size:?} {uv:?}"
                    );
                }
                assert!(beyond.iter().all(|&colour| colour == u16::MAX));
            }
        }
    }
}
