//! The inner loop of a texture that repeats along both axes: u and v in one 64-bit number, so that
//! one addition with carry steps both and one rotation gives the texel. Part of [`Texture`].
//!
//! ```text
//!   bit 63          40 39      32 31           0        upper word rotated left by log2 width:
//!   [ column | rest  ][ 0 | row ][ rest of v | 0 ]      [ rest of u ][ 0 | row | column ]
//! ```
//!
//! Nothing is lost: all 24 fraction bits of both coordinates are in it. The one thing that can go
//! wrong is that v leaves 0..1 and the carry out of its row spoils the last bit of u, so runs are
//! packed anew where it does, or filled coordinate by coordinate.

use core::mem;
use core::num::NonZeroU32;

use super::apart::{self, Decoder};
use super::turning::{most_pixels, turned, turning};
use super::{Repeat, Texture, around};
use crate::arith::{CARRIES, NARROW, div_rem, keep_rolled};
use crate::colour::{Fractions, WEIGHT_BITS};
use crate::uv::{Curve, Uv};
use crate::viewport::MAX_VIEWPORT;
use crate::visibility::{Candidate as _, Visibility};

/// The most pixels that are packed as a whole or not at all.
pub(crate) const PIECE: usize = 64;

/// The least change of v with which parts that stay within 0..1 are too short to be worth packing: a
/// sixteenth of a repeat.
const STEEP: u32 = 1 << (Uv::FRACTION_BITS - 4);

/// Pixels of one turn of a loop: so many copies of its body.
const ROLL: usize = 8;

/// Runs up to this length are not worth packing.
pub(crate) const SHORT: usize = if NARROW { 8 } else { 6 };

/// Largest base-2 logarithm of the height that leaves u its 24 bits.
pub(crate) const MAX_LOG2_HEIGHT: u32 = 8;

/// How far up u is shifted: its whole repeats are lost.
pub(crate) const U_UP: u32 = 32 - Uv::FRACTION_BITS;

/// The bits of a coordinate behind the binary point.
const FRACTION: i32 = (1 << Uv::FRACTION_BITS) - 1;

/// Fills `pixels` with what `decoder` makes of the texels at `uv`, `uv + step` and so on; both axes repeat.
#[inline(never)]
pub(crate) fn fill<C: Copy, P, D: Decoder<C, P>>(
    texture: &Texture<'_, C>,
    uv: Uv,
    step: Uv,
    pixels: &mut [P],
    decoder: D,
) {
    if pixels.len() <= PIECE {
        part(texture, uv, step, pixels, decoder);
    } else if const { CARRIES } {
        long(texture, uv, step, pixels, decoder);
    } else {
        apart::fill_many(texture, uv, step, pixels, decoder);
    }
}

/// The same for no more than [`PIECE`] pixels.
#[inline]
pub(crate) fn part<C: Copy, P, D: Decoder<C, P>>(
    texture: &Texture<'_, C>,
    uv: Uv,
    step: Uv,
    pixels: &mut [P],
    decoder: D,
) {
    if pixels.len() <= SHORT {
        // Not worth packing.
        apart::fill(texture, uv, step, pixels, decoder);
    } else {
        piece(texture, uv, step, pixels, decoder);
    }
}

/// The same for more than [`SHORT`].
#[inline]
pub(crate) fn piece<C: Copy, P, D: Decoder<C, P>>(
    texture: &Texture<'_, C>,
    uv: Uv,
    step: Uv,
    pixels: &mut [P],
    decoder: D,
) {
    if const { CARRIES } {
        packed(texture, uv, step, pixels, decoder);
    } else if pixels.len() < apart::MANY {
        apart::fill(texture, uv, step, pixels, decoder);
    } else {
        apart::fill_many(texture, uv, step, pixels, decoder);
    }
}

/// Fills those pixels that are seen; both axes repeat. More than [`PIECE`] are not packed.
#[inline]
pub(crate) fn fill_seen<C: Copy, P, D: Decoder<C, P>>(
    texture: &Texture<'_, C>,
    uv: Uv,
    step: Uv,
    pixels: &mut [P],
    seen: &mut impl Visibility,
    decoder: D,
) {
    let (_, log2_height) = texture.log2_size();
    let texels = texture.texels();
    let count = pixels.len();
    let worth = const { CARRIES } && count > SHORT && count <= PIECE && !texels.is_empty();
    match worth.then(|| pack(log2_height, uv, step, count)).flatten() {
        Some([mut at, step]) => {
            let rotation = texture.rotation();
            let step = turning(step, rotation);
            // As in `packed`.
            let mask = texels.len() - 1;
            for pixel in seen.among(pixels) {
                pixel.write(|pixel| {
                    let word = turned(at, step, rotation);
                    *pixel = decoder.decode(texels[word as usize & mask], word);
                    true
                });
                at = at.wrapping_add(step);
                keep_rolled();
            }
        }
        None => {
            apart::fill_seen(texture, uv, step, pixels, seen, decoder);
        }
    }
}

/// A run of any length.
#[inline(never)]
fn long<C: Copy, P, D: Decoder<C, P>>(
    texture: &Texture<'_, C>,
    uv: Uv,
    step: Uv,
    pixels: &mut [P],
    decoder: D,
) {
    let (_, log2_height) = texture.log2_size();
    in_parts(
        log2_height,
        uv,
        step,
        pixels,
        |uv, _, pixels| packed(texture, uv, step, pixels, decoder),
        |uv, pixels| apart::fill(texture, uv, step, pixels, decoder),
    );
}

/// Fills a run: packed, in parts in which v stays within 0..1, or else coordinate by coordinate.
#[inline]
pub(crate) fn in_parts<P>(
    log2_height: u32,
    mut uv: Uv,
    step: Uv,
    mut pixels: &mut [P],
    mut packed: impl FnMut(Uv, [u64; 2], &mut [P]),
    apart: impl FnOnce(Uv, &mut [P]),
) {
    let dv = step.v.to_bits();
    if const { !CARRIES } || log2_height > MAX_LOG2_HEIGHT || dv.unsigned_abs() >= STEEP {
        apart(uv, pixels);
        return;
    }
    let packed_step = pack_step(log2_height, step);
    loop {
        let most = pixels.len().min(most_pixels(log2_height));
        let count = within(uv.v.to_bits(), dv, most);
        let Some((here, rest)) = mem::take(&mut pixels).split_at_mut_checked(count) else {
            return;
        };
        packed(uv, [pack_place(log2_height, uv), packed_step], here);
        // Nearly always.
        if rest.is_empty() {
            return;
        }
        uv = uv.after(step, count);
        pixels = rest;
    }
}

/// How many pixels there are, of `most`, until v leaves the whole repeat that the first of them is in. The
/// change is less than [`STEEP`].
#[inline]
fn within(v: i32, dv: i32, most: usize) -> usize {
    let first = v & FRACTION;
    let room = if dv < 0 { first } else { FRACTION - first }.cast_unsigned();
    // As many as a row of a frame has: the product has 30 bits.
    let most = most.min(MAX_VIEWPORT as usize);
    let change = dv.unsigned_abs();
    if (most as u32).wrapping_sub(1).wrapping_mul(change) <= room {
        return most;
    }
    // Not 0 then.
    let steps = NonZeroU32::new(change).map_or(0, |change| div_rem(room, change).0);
    (steps as usize).wrapping_add(1)
}

/// A coordinate and the step to the next, packed; `None` if v leaves 0..1 in so many pixels, if the height leaves u
/// too few bits, or if there are more pixels than [rotations have room for](most_pixels). More than [`PIECE`] pixels
/// only where v changes by less than [`STEEP`].
#[inline]
pub(crate) fn pack(log2_height: u32, uv: Uv, step: Uv, pixels: usize) -> Option<[u64; 2]> {
    let dv = step.v.to_bits();
    let first = uv.v.to_bits() & FRACTION;
    let steps = (pixels as i32).wrapping_sub(1);
    let last = first.wrapping_add(steps.wrapping_mul(dv));
    // One less where it is negative.
    let magnitude = dv ^ (dv >> 31);
    if log2_height > MAX_LOG2_HEIGHT
        || pixels > most_pixels(log2_height)
        || (magnitude | last) & !FRACTION != 0
    {
        return None;
    }
    Some([pack_place(log2_height, uv), pack_step(log2_height, step)])
}

/// A coordinate, the step that led to it and the change of steps, packed; `None` as in [`pack`], if v turns around
/// on the way, or if there are more than [`PIECE`] pixels.
#[inline]
pub(crate) fn pack_curve(log2_height: u32, curve: Curve, pixels: usize) -> Option<[u64; 3]> {
    let Curve { uv, step, change } = curve;
    let (dv, ddv) = (step.v.to_bits(), change.v.to_bits());
    let first = uv.v.to_bits() & FRACTION;
    let steps = (pixels as i32).wrapping_sub(1);
    // As the first step and the last are below a repeat, and of one sign, so are all between: v goes one way, and the
    // sum of 64 has 30 bits.
    let last_step = dv.wrapping_add(ddv.wrapping_mul(steps));
    let steps_between = steps.wrapping_mul(steps.wrapping_sub(1)) >> 1;
    let last = first
        .wrapping_add(dv.wrapping_mul(steps))
        .wrapping_add(ddv.wrapping_mul(steps_between));
    let magnitude = |value: i32| value ^ (value >> 31);
    let magnitudes = magnitude(dv) | magnitude(ddv);
    if log2_height > MAX_LOG2_HEIGHT
        || pixels > most_pixels(log2_height).min(PIECE)
        || (magnitudes | (dv ^ last_step) | last) & !FRACTION != 0
    {
        return None;
    }
    let [step, change] = [step, change].map(|step| pack_step(log2_height, step));
    Some([
        pack_place(log2_height, uv),
        step.wrapping_sub(change),
        change,
    ])
}

/// A coordinate, packed.
#[inline]
fn pack_place(log2_height: u32, uv: Uv) -> u64 {
    let (down, up) = shifts(log2_height);
    let v = uv.v.to_bits() & FRACTION;
    words((uv.u.to_bits() << U_UP) | (v >> down), v << up)
}

/// The upper word of a coordinate, packed, from u that is shifted up by [`U_UP`], and v.
#[inline]
pub(crate) fn upper_word(log2_height: u32, u: i32, v: i32) -> u32 {
    let (down, _) = shifts(log2_height);
    (u | (v & FRACTION) >> down).cast_unsigned()
}

/// A step, packed.
#[inline]
fn pack_step(log2_height: u32, step: Uv) -> u64 {
    let (down, up) = shifts(log2_height);
    let dv = step.v.to_bits();
    words(
        (step.u.to_bits() << U_UP).wrapping_add(dv >> down),
        dv << up,
    )
}

/// How far down v is shifted, so that the lowest bit of the row is bit 0, and how far up, so that what is
/// behind it begins at the highest.
#[inline]
fn shifts(log2_height: u32) -> (u32, u32) {
    let down = Uv::FRACTION_BITS.wrapping_sub(log2_height) & 31;
    (down, 32u32.wrapping_sub(down) & 31)
}

/// From the upper word and the lower.
#[inline]
fn words(high: i32, low: i32) -> u64 {
    u64::from(high.cast_unsigned()) << 32 | u64::from(low.cast_unsigned())
}

/// Fills pixels of which the coordinates are on a parabola; both axes repeat.
#[inline(never)]
pub(crate) fn fill_curve<C: Copy, P, D: Decoder<C, P>>(
    texture: &Texture<'_, C>,
    curve: Curve,
    pixels: &mut [P],
    decoder: D,
) {
    let (_, log2_height) = texture.log2_size();
    let texels = texture.texels();
    let worth = const { CARRIES } && !texels.is_empty();
    let packed = worth.then(|| pack_curve(log2_height, curve, pixels.len()));
    let Some([mut at, step, change]) = packed.flatten() else {
        apart::fill_curve(texture, curve, pixels, decoder);
        return;
    };
    // As in `packed`.
    let mask = texels.len() - 1;
    let rotation = texture.rotation();
    let mut step = turning(step, rotation);
    by_fours(pixels, || {
        let word = turned(at, step, rotation);
        let pixel = decoder.decode(texels[word as usize & mask], word);
        step = step.wrapping_add(change);
        at = at.wrapping_add(step);
        pixel
    });
}

/// What `next` gives, one after another: four in each turn of a loop.
#[inline]
pub(super) fn by_fours<P>(pixels: &mut [P], mut next: impl FnMut() -> P) {
    let (rolls, rest) = pixels.as_chunks_mut::<4>();
    for pixels in rolls {
        for pixel in pixels {
            *pixel = next();
            // Else multiples of changes are found first, of which there are more than registers.
            keep_rolled();
        }
    }
    for pixel in rest {
        *pixel = next();
        keep_rolled();
    }
}

/// Hands over the four texels around `uv`, `uv + step` and so on and where it lies between them, each
/// with one of `items`; both axes repeat. More than [`PIECE`] are not packed.
#[inline]
pub(crate) fn fours<C: Copy + Default, I: ExactSizeIterator>(
    texture: &Texture<'_, C>,
    uv: Uv,
    step: Uv,
    items: I,
    each: impl FnMut(I::Item, [C; 4], Fractions),
) {
    let (log2_width, log2_height) = texture.log2_size();
    let half = |log2: u32| (1i32 << (Uv::FRACTION_BITS.wrapping_sub(log2) & 31)) >> 1;
    // From the centre of the upper left texel.
    let from = uv
        + Uv::from_bits(
            half(log2_width).wrapping_neg(),
            half(log2_height).wrapping_neg(),
        );
    let packed = (items.len() <= PIECE).then(|| pack(log2_height, from, step, items.len()));
    match packed.flatten() {
        Some([at, step]) => packed_fours(at, step, texture.texels(), log2_width, items, each),
        None => apart_fours(texture, uv, step, items, each),
    }
}

/// The loop of [`packed`] for four texels: the fractions of u and v are the upper
/// bits of the rotated word and of the lower one.
#[inline(never)]
fn packed_fours<C: Copy, I: Iterator>(
    mut at: u64,
    step: u64,
    texels: &[C],
    log2_width: u32,
    items: I,
    mut each: impl FnMut(I::Item, [C; 4], Fractions),
) {
    if texels.is_empty() {
        return;
    }
    let mask = texels.len() - 1;
    let rotation = 32u32.wrapping_sub(log2_width) & 31;
    let row = 1u32 << (log2_width & 31);
    // Nothing where there is one column only.
    let column = 1u32 << rotation & !1;
    let step = turning(step, rotation);
    for item in items {
        let here = turned(at, step, rotation);
        let right = turned(at.wrapping_add(u64::from(column) << 32), step, rotation);
        let texel = |index: u32| texels[index as usize & mask];
        let four = [
            texel(here),
            texel(right),
            texel(here.wrapping_add(row)),
            texel(right.wrapping_add(row)),
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

/// The loop that steps u and v apart.
#[inline(never)]
fn apart_fours<C: Copy + Default, I: Iterator>(
    texture: &Texture<'_, C>,
    mut uv: Uv,
    step: Uv,
    items: I,
    mut each: impl FnMut(I::Item, [C; 4], Fractions),
) {
    for item in items {
        let (texels, between) = around::<_, Repeat, Repeat>(texture, uv);
        each(item, texels, between);
        uv = uv + step;
    }
}

/// A run in which v stays within 0..1, packed; any other coordinate by coordinate. No more than [`PIECE`] pixels, unless the step
/// is less than [`STEEP`].
/// The loop over the packed number has, on a Cortex-M4, six instructions a pixel and no bounds check.
// A function of its own so that all it needs stays in registers.
#[inline(never)]
fn packed<C: Copy, P, D: Decoder<C, P>>(
    texture: &Texture<'_, C>,
    uv: Uv,
    step: Uv,
    pixels: &mut [P],
    decoder: D,
) {
    let (_, log2_height) = texture.log2_size();
    let texels = texture.texels();
    // At least one texel; written down because the mask proves to the compiler that no index is
    // out of bounds, but only if there is a texel.
    let packed = (!texels.is_empty()).then(|| pack(log2_height, uv, step, pixels.len()));
    let Some([mut at, step]) = packed.flatten() else {
        apart::fill(texture, uv, step, pixels, decoder);
        return;
    };
    let mask = texels.len() - 1;
    let rotation = texture.rotation();
    let step = turning(step, rotation);
    let mut next = || {
        let word = turned(at, step, rotation);
        let pixel = decoder.decode(texels[word as usize & mask], word);
        at = at.wrapping_add(step);
        pixel
    };
    let (rolls, rest) = pixels.as_chunks_mut::<ROLL>();
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
