//! One division for a scanline along which the depth does not change.

use super::by_size::BySize;
use super::homogeneous::parts::differ;
use super::homogeneous::words::WithWords;
use super::{Every, Homogeneous, Run, RunSink, Strategy, exact_ends};
use crate::setup::TriangleSetup;
use crate::span::Span;

/// One division a scanline where 1/w is constant along it, as for Doom's floors and ceilings
/// (Sanglard, *Game Engine Black Book: Doom*, "Flats").
///
/// Where 1/w differs between the ends of a span by at most 1/256 of the smaller, the span is one
/// run: the tangent of the hyperbola at its middle pixel m. At pixel x it is off by exactly
///
/// `|u(x) - u(m)| |q(x) - q(m)| / q(m)`, q being 1/w:
///
/// nothing where the depth is constant, about `|du| (r - 1) / 4` at the ends of a long span with
/// depths of ratio r, and never more than `|du| / 256`; in addition to that of
/// [`PerPixel`](super::PerPixel) and 2^-24 repeats a pixel for the step's rounding. Other spans
/// fall back to [`Every<16>`](super::Every), with its divisions and its error.
///
/// Choose it for floors and ceilings seen by a camera that does not roll; the fallback keeps the
/// rest of the scene right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ConstantZ;

impl ConstantZ {
    /// 1/w may differ by one part in 2 to this power.
    pub const TOLERANCE_BITS: u32 = 8;

    /// Steps of a span whose depth is constant within the tolerance.
    #[inline]
    fn steps(planes: &Homogeneous, span: Span) -> Option<u32> {
        let steps = span.left.abs_diff(span.right).wrapping_sub(1);
        let start = planes.at(span.left, span.y);
        let end = planes.step(start, steps);
        (!differ(start.q(), end.q(), Self::TOLERANCE_BITS)).then_some(steps)
    }
}

impl Strategy for ConstantZ {
    type Planes = WithWords;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<WithWords> {
        WithWords::new(triangle)
    }

    #[inline]
    fn runs(&self, planes: &WithWords, span: Span, mut to: impl RunSink) {
        let Some(steps) = Self::steps(&planes.planes, span) else {
            Every::<16>.large_runs(planes.large(), span, to);
            return;
        };
        let planes = &planes.planes;
        let middle = steps >> 1;
        let column = span.left.wrapping_add_unsigned(middle);
        let point = planes.at(column, span.y);
        let scale = planes.scale(point);
        let (uv, step) = (planes.scaled(point, scale), planes.slope(point, scale));
        let back = |at: i32, step: i32| at.wrapping_sub(step.wrapping_mul(middle.cast_signed()));
        to.long_run(Run {
            offset: 0,
            len: steps.wrapping_add(1) as usize,
            uv: crate::uv::Uv::from_bits(
                back(uv.u.to_bits(), step.u.to_bits()),
                back(uv.v.to_bits(), step.v.to_bits()),
            ),
            step,
        });
    }

    fn divisions(&self, planes: &WithWords, span: Span) -> u32 {
        match Self::steps(&planes.planes, span) {
            Some(_) => 1,
            None => exact_ends(|to| Every::<16>.large_runs(planes.large(), span, to)),
        }
    }
}
