//! Projection: clip vertices become points on the subpixel grid of the screen. From here on a
//! position is an integer, and everything that follows is exact in it.

use fixed::types::{I16F16, I24F8};

use crate::clip::ClipVertex;
use crate::geometry::MAX_UV;
use crate::viewport::{GUARD, SUBPIXEL_BITS, SUBPIXELS, Viewport};

/// A vertex on the screen, snapped to 1/256 pixel.
///
/// Invariants: x and y within plus and minus [`GUARD_BAND`](crate::viewport::GUARD_BAND) pixels,
/// w positive, u and v within plus and minus [`MAX_UV`] repeats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ScreenVertex {
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    x: I24F8,
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    y: I24F8,
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    w: I16F16,
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    uv: [I16F16; 2],
}

impl ScreenVertex {
    /// A vertex given after projection: x to the right and y down from the top-left corner of the
    /// top-left pixel, in pixels; clip w; u and v in repeats. `None` if it breaks an invariant.
    #[must_use]
    pub fn new(x: I24F8, y: I24F8, w: I16F16, uv: [I16F16; 2]) -> Option<Self> {
        let on_screen = |c: I24F8| c.to_bits().unsigned_abs() <= GUARD.unsigned_abs();
        let [u, v] = uv.map(|c| c.to_bits().unsigned_abs() <= MAX_UV.unsigned_abs() << 16);
        (on_screen(x) && on_screen(y) && w > 0 && u && v).then_some(Self { x, y, w, uv })
    }

    /// Projects a clip vertex that lies inside a [`ClipVolume`](crate::clip::ClipVolume).
    ///
    /// Rounds to the nearest subpixel, halves up. What the rounding of a cut left outside the
    /// guard band is moved onto its rim. `None` if w is not positive or a texture coordinate out
    /// of range.
    #[inline(never)]
    #[must_use]
    pub fn project(vertex: &ClipVertex, viewport: Viewport) -> Option<Self> {
        let y_down = vertex.y.checked_neg()?;
        let x = snapped(vertex.x, vertex.w, viewport.width())?;
        let y = snapped(y_down, vertex.w, viewport.height())?;
        Self::new(x, y, vertex.w, [vertex.u, vertex.v])
    }

    /// To the right, in pixels.
    #[must_use]
    pub const fn x(&self) -> I24F8 {
        self.x
    }

    /// Down, in pixels.
    #[must_use]
    pub const fn y(&self) -> I24F8 {
        self.y
    }

    /// Clip w, in units.
    #[must_use]
    pub const fn w(&self) -> I16F16 {
        self.w
    }

    /// u and v, in repeats.
    #[must_use]
    pub const fn uv(&self) -> [I16F16; 2] {
        self.uv
    }
}

/// `(position / w + 1) size / 2`, to the nearest subpixel.
#[inline(never)]
fn snapped(position: I16F16, w: I16F16, size: u32) -> Option<I24F8> {
    let w = i64::from(w.to_bits());
    if w <= 0 {
        return None;
    }
    let half = i64::from(size) << (SUBPIXEL_BITS - 1);
    // floor((2 n + w) / 2 w) is n / w to nearest; 2 n is below 2^50.
    let n = i64::from(position.to_bits()) * half;
    let offset = (2 * n + w).checked_div_euclid(2 * w)?;
    let limit = i64::from(GUARD);
    let bits = (half + offset).clamp(-limit, limit);
    i32::try_from(bits).ok().map(I24F8::from_bits)
}

/// The first pixel, column or row, whose centre is at `c` or beyond.
///
/// ```text
///        pixel 0         pixel 1
///   |-------+-------|-------+-------|     centres at 128, 384, ... subpixels
///   0      128     256     384     512
///           ^ c = 128 -> 0   ^ c = 129 .. 384 -> 1
/// ```
#[inline]
pub(crate) const fn first_centre(c: i32) -> i32 {
    // ceil((c - 128) / 256)
    (c + (SUBPIXELS / 2 - 1)) >> SUBPIXEL_BITS
}
