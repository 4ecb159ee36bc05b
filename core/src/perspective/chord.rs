//! Straight steps between two coordinates.

use core::num::NonZeroU32;

use crate::arith::div_rem;
use crate::uv::Uv;

/// The step that leads from one coordinate to another in `1 <= steps < 2^11` pixels.
///
/// Off by at most 2^-24 repeats: one half unit from rounding to nearest, and where `steps` is not
/// a power of two up to one half from the reciprocal of the length.
#[inline]
pub(super) fn step(from: Uv, to: Uv, steps: u32) -> Uv {
    let u = to.u.to_bits().wrapping_sub(from.u.to_bits());
    let v = to.v.to_bits().wrapping_sub(from.v.to_bits());
    let Some(length) = NonZeroU32::new(steps).filter(|_| steps > 1) else {
        return Uv::from_bits(u, v);
    };
    if steps.is_power_of_two() {
        let shift = steps.trailing_zeros();
        let each =
            |distance: i32| (i64::from(distance).wrapping_add(i64::from(steps >> 1))) >> shift;
        return Uv::from_bits(each(u) as i32, each(v) as i32);
    }
    // 2^32 / steps, rounded up; coordinates differ by less than 2^31 units.
    let reciprocal = i64::from(div_rem(u32::MAX, length).0.wrapping_add(1));
    let each = |distance: i32| {
        i64::from(distance)
            .wrapping_mul(reciprocal)
            .wrapping_add(1 << 31)
            >> 32
    };
    Uv::from_bits(each(u) as i32, each(v) as i32)
}
