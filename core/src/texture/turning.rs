//! The rotation that finds a texel in a packed run, in bits of the run's step that are 0. Part of
//! [`packed`](super::packed).
//!
//! A Cortex-M0+ has one register less than a packed run takes: what is not in one is read once a pixel. It rotates by
//! a register's lowest bits, whatever the others are, so that the step's lower word serves for both. The place takes up
//! the rotations with the steps:
//!
//! ```text
//!   lower word of a step    [ rest of v's step ][ 0 | rotation ]      bits of 0: 8 and the height's
//!   of the n-th place       [ rest of v ][ n times the rotation ]     no carry as long as there is room
//! ```

use core::hint::black_box;

use crate::arith::NARROW;
use crate::viewport::MAX_VIEWPORT;

/// Whether it is there, or apart.
const TURNS: bool = NARROW;

/// A packed step, with the rotation if it is to be there.
#[inline]
pub(super) fn turning(step: u64, rotation: u32) -> u64 {
    if const { TURNS } {
        with_rotation(step, rotation)
    } else {
        step
    }
}

/// The same for a rotation that the compiler knows: it would be kept apart after all.
#[inline]
pub(super) fn turning_by_constant(step: u64, rotation: u32) -> u64 {
    if const { TURNS } {
        let low = black_box(with_rotation(step, rotation) as u32);
        step & !u64::from(u32::MAX) | u64::from(low)
    } else {
        step
    }
}

/// The word of which the lowest bits are the number of the texel in a packed place, in a run with that
/// [step](turning).
#[inline]
pub(super) fn turned(at: u64, step: u64, rotation: u32) -> u32 {
    let by = if const { TURNS } {
        rotation_of(step)
    } else {
        rotation
    };
    ((at >> 32) as u32).rotate_right(by)
}

/// How many pixels a packed run has at most.
#[inline]
pub(super) fn most_pixels(log2_height: u32) -> usize {
    if const { TURNS } {
        most_rotations(log2_height)
    } else {
        usize::MAX
    }
}

#[inline]
fn with_rotation(step: u64, rotation: u32) -> u64 {
    step | u64::from(rotation)
}

/// To be taken modulo 32.
#[inline]
fn rotation_of(step: u64) -> u32 {
    step as u32
}

/// How many rotations of up to 31 there is room for. Where there is one row only, v counts for nothing, nor does what is
/// carried into it.
#[inline]
fn most_rotations(log2_height: u32) -> usize {
    if log2_height == 0 {
        MAX_VIEWPORT as usize
    } else {
        8 << (log2_height & 31)
    }
}

#[cfg(test)]
mod tests {
    use super::super::packed::{MAX_LOG2_HEIGHT, pack};
    use super::*;
    use crate::uv::Uv;

    /// Runs as long as there is room for, from anywhere: texels are what they are with the rotation apart.
    #[test]
    fn rotations_do_not_reach_the_places() {
        let mut state = 1u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state ^ state >> 15).cast_signed()
        };
        let mut runs = 0;
        for log2_height in 0..=MAX_LOG2_HEIGHT {
            let most = most_rotations(log2_height);
            for log2_width in 0..=12 {
                let rotation = (32 - log2_width) % 32;
                let texels = (1u32 << (log2_width + log2_height)) - 1;
                for _ in 0..100 {
                    let uv = Uv::from_bits(next(), next());
                    // So slow that v stays within 0..1, mostly.
                    let step = Uv::from_bits(next() >> 4, next() >> (11 + log2_height));
                    let Some([start, step]) = pack(log2_height, uv, step, most) else {
                        continue;
                    };
                    runs += 1;
                    let turning = with_rotation(step, rotation);
                    let (mut plain, mut at) = (start, start);
                    for pixel in 0..most {
                        let word = ((at >> 32) as u32).rotate_right(rotation_of(turning));
                        let expected = ((plain >> 32) as u32).rotate_right(rotation);
                        let case = (log2_width, log2_height, pixel);
                        assert_eq!(word & texels, expected & texels, "{case:?}");
                        if log2_height > 0 {
                            // The weights of bilinear filters are in these.
                            let spare = 8 + log2_height;
                            assert_eq!(word, expected, "{case:?}");
                            assert_eq!(at >> spare, plain >> spare, "{case:?}");
                        }
                        at = at.wrapping_add(turning);
                        plain = plain.wrapping_add(step);
                    }
                }
            }
        }
        assert!(runs > 7_000, "{runs}");
    }
}
