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
use crate::colour::{Colour, LANE_BITS, MixesEights};
use crate::simd::{COUNT, U16x8, Walk};
use crate::uv::Uv;

/// Of a number, and of a coordinate's upper half.
const BITS: u32 = u16::BITS;

/// Base-2 logarithm of the longest side that leaves a coordinate's upper half the bits of a weight.
const MOST: u32 = BITS - LANE_BITS;

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

/// Gives `pixels` what `M` makes of the four texels around `uv`, `uv + step` and so on; `false`, and
/// nothing is written, if the texture is too large. `texel` takes numbers modulo that of all
/// texels.
#[inline(always)]
pub(super) fn fill_fours<C: Colour + Into<P>, P, M: MixesEights>(
    (log2_width, log2_height): (u32, u32),
    texel: impl Fn(u16) -> C + Copy,
    (uv, step): (Uv, Uv),
    pixels: &mut [P],
) -> bool {
    if log2_width > MOST || log2_height > MOST || !fit((log2_width, log2_height)) {
        return false;
    }
    let mut eights = Eights {
        u: walk(uv.u, step.u, log2_width),
        v: walk(uv.v, step.v, log2_height),
        log2_width,
        log2_height,
    };
    let (rolls, rest) = pixels.as_chunks_mut::<COUNT>();
    for pixels in rolls {
        *pixels = eights.mixed::<C, P, M>(texel);
    }
    if !rest.is_empty() {
        for (pixel, colour) in rest.iter_mut().zip(eights.mixed::<C, P, M>(texel)) {
            *pixel = colour;
        }
    }
    true
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
    /// The colours of the next eight pixels.
    #[inline(always)]
    fn mixed<C: Colour + Into<P>, P, M: MixesEights>(
        &mut self,
        texel: impl Fn(u16) -> C,
    ) -> [P; COUNT] {
        let Fours { numbers, between } = self.next::<M>();
        M::mixed(numbers, texel, between).map(Into::into)
    }

    #[inline(always)]
    fn next<M: MixesEights>(&mut self) -> Fours {
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
