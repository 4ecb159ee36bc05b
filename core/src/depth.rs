//! The depth test: which pixels of a run are seen.

use core::ops::Range;

use fixed::types::I16F16;

use crate::arith::{CARRIES, Inverse, SHIFTS_OPERANDS, keep_rolled, product_unsigned};
use crate::perspective::Run;
use crate::setup::{Slant, TriangleSetup};
use crate::shade::ShaderRow;
use crate::simd::{COUNT, U16x8, Walk};
use crate::sink::{Band, PixelSink};
use crate::span::Span;
use crate::uv::{Curve, Eight, Uv};
use crate::visibility::{Candidate, Visibility};

/// A depth test, and what it remembers.
pub trait Depth {
    /// What it needs of a triangle.
    type Plane;

    /// What it needs of a span.
    type Row<'r>: DepthRow
    where
        Self: 'r;

    /// Once a triangle.
    fn plane(&self, triangle: &TriangleSetup<'_>) -> Self::Plane;

    /// Once a span. `None` if the span lies outside the depth buffer: nothing is drawn then.
    fn row<'r>(&'r mut self, plane: &Self::Plane, span: Span) -> Option<Self::Row<'r>>;
}

/// Pipelines that differ in texture share one depth buffer by borrowing it in turn.
impl<D: Depth> Depth for &mut D {
    type Plane = D::Plane;
    type Row<'r>
        = D::Row<'r>
    where
        Self: 'r;

    #[inline]
    fn plane(&self, triangle: &TriangleSetup<'_>) -> D::Plane {
        (**self).plane(triangle)
    }

    #[inline]
    fn row<'r>(&'r mut self, plane: &D::Plane, span: Span) -> Option<D::Row<'r>> {
        (**self).row(plane, span)
    }
}

/// Fills runs of one span.
pub trait DepthRow {
    /// Writes the pixels of `run` that pass the test. `pixels` has the run's length; `shader`
    /// gives the colours and is not asked for those of hidden pixels.
    fn fill<S: ShaderRow, P>(&mut self, run: Run, pixels: &mut [P], shader: &mut S)
    where
        S::Texel: Into<P>;

    /// The same for a run that is often long.
    #[inline]
    fn fill_long<S: ShaderRow, P>(&mut self, run: Run, pixels: &mut [P], shader: &mut S)
    where
        S::Texel: Into<P>,
    {
        self.fill(run, pixels, shader);
    }

    /// The same for runs of known length, one behind the other; `next` gives coordinates at a run's
    /// first pixel and their step.
    #[inline]
    fn pieces<S: ShaderRow, P, const N: usize>(
        &mut self,
        offset: usize,
        pieces: &mut [[P; N]],
        mut next: impl FnMut() -> (Uv, Uv),
        shader: &mut S,
    ) where
        S::Texel: Into<P>,
    {
        let mut offset = offset;
        for pixels in pieces {
            let (uv, step) = next();
            let run = Run::piece::<N>(offset, uv, step);
            self.fill(run, pixels, shader);
            offset = offset.wrapping_add(N);
        }
    }

    /// The same for pixels of which the coordinates are on a parabola.
    fn curve<S: ShaderRow, P>(
        &mut self,
        offset: usize,
        curve: Curve,
        pixels: &mut [P],
        shader: &mut S,
    ) where
        S::Texel: Into<P>;

    /// The same for pixels whose coordinates come eight at a time.
    fn eights<S: ShaderRow, P>(
        &mut self,
        offset: usize,
        pixels: &mut [[P; COUNT]],
        eights: impl IntoIterator<Item = Eight>,
        shader: &mut S,
    ) where
        S::Texel: Into<P>;

    /// The same for pixels whose coordinates come one by one, `N` in each turn of a loop: `here` gives
    /// them, and `next` goes on to the next pixel.
    fn points<S: ShaderRow, P, T, const N: usize>(
        &mut self,
        offset: usize,
        pixels: &mut [P],
        state: T,
        here: impl Fn(&T) -> Uv,
        next: impl FnMut(&mut T),
        shader: &mut S,
    ) where
        S::Texel: Into<P>;
}

/// No depth test: later triangles cover earlier ones. No state, no cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct NoDepth;

impl Depth for NoDepth {
    type Plane = ();
    type Row<'r> = Always;

    #[inline]
    fn plane(&self, _: &TriangleSetup<'_>) {}

    #[inline]
    fn row(&mut self, (): &(), _: Span) -> Option<Always> {
        Some(Always)
    }
}

/// The row of [`NoDepth`]: every pixel is seen.
#[derive(Clone, Copy, Debug)]
pub struct Always;

impl DepthRow for Always {
    #[inline]
    fn fill<S: ShaderRow, P>(&mut self, run: Run, pixels: &mut [P], shader: &mut S)
    where
        S::Texel: Into<P>,
    {
        shader.fill(run, pixels);
    }

    #[inline]
    fn pieces<S: ShaderRow, P, const N: usize>(
        &mut self,
        offset: usize,
        pieces: &mut [[P; N]],
        mut next: impl FnMut() -> (Uv, Uv),
        shader: &mut S,
    ) where
        S::Texel: Into<P>,
    {
        let mut offset = offset;
        for pixels in pieces {
            let (uv, step) = next();
            shader.piece(offset, uv, step, pixels);
            offset = offset.wrapping_add(N);
        }
    }

    #[inline]
    fn curve<S: ShaderRow, P>(
        &mut self,
        offset: usize,
        curve: Curve,
        pixels: &mut [P],
        shader: &mut S,
    ) where
        S::Texel: Into<P>,
    {
        shader.curve(offset, curve, pixels);
    }

    // A function of its own: its loop takes all registers.
    #[inline(never)]
    fn eights<S: ShaderRow, P>(
        &mut self,
        offset: usize,
        pixels: &mut [[P; COUNT]],
        eights: impl IntoIterator<Item = Eight>,
        shader: &mut S,
    ) where
        S::Texel: Into<P>,
    {
        let mut offset = offset;
        for (pixels, here) in pixels.iter_mut().zip(eights) {
            shader.eight(offset, here, pixels);
            offset = offset.wrapping_add(COUNT);
        }
    }

    #[inline]
    fn points<S: ShaderRow, P, T, const N: usize>(
        &mut self,
        offset: usize,
        pixels: &mut [P],
        state: T,
        here: impl Fn(&T) -> Uv,
        next: impl FnMut(&mut T),
        shader: &mut S,
    ) where
        S::Texel: Into<P>,
    {
        let points = Points { offset, state };
        if const { N > 1 && SHIFTS_OPERANDS } {
            points.write_all_apart::<_, _, N>(pixels, shader, here, next);
        } else {
            points.write_all::<_, _, N>(pixels, shader, here, next);
        }
    }
}

/// Pixels that have coordinates of their own each.
struct Points<T> {
    offset: usize,
    state: T,
}

impl<T> Points<T> {
    /// Writes pixels, `N` in each turn of a loop.
    #[inline(always)]
    fn write_all<S: ShaderRow<Texel: Into<P>>, P, const N: usize>(
        mut self,
        pixels: &mut [P],
        shader: &mut S,
        here: impl Fn(&T) -> Uv,
        mut next: impl FnMut(&mut T),
    ) {
        let (groups, rest) = pixels.as_chunks_mut::<N>();
        for pixels in groups {
            for pixel in pixels {
                self.write(pixel, shader, &here, &mut next);
            }
        }
        for pixel in rest {
            self.write(pixel, shader, &here, &mut next);
        }
    }

    /// The same for processors of which such a loop takes all registers: beside other code more of it would be in
    /// memory.
    #[inline(never)]
    fn write_all_apart<S: ShaderRow<Texel: Into<P>>, P, const N: usize>(
        self,
        pixels: &mut [P],
        shader: &mut S,
        here: impl Fn(&T) -> Uv,
        next: impl FnMut(&mut T),
    ) {
        self.write_all::<S, P, N>(pixels, shader, here, next);
    }

    /// Writes one and goes on to the next.
    // Always: it is the inner loop, several times over.
    #[inline(always)]
    fn write<S: ShaderRow<Texel: Into<P>>, P>(
        &mut self,
        pixel: &mut P,
        shader: &mut S,
        here: impl Fn(&T) -> Uv,
        mut next: impl FnMut(&mut T),
    ) {
        shader.write(self.offset, here(&self.state), pixel);
        next(&mut self.state);
        self.offset = self.offset.wrapping_add(1);
    }
}

/// A 16-bit depth buffer of `near / w`: linear on the screen, greater is nearer, 0 is empty.
///
/// The buffer is a band like the pixels', of the same rows. Its resolution at depth w is
/// `w^2 / (65532 near)` units. Of two equal depths the first drawn stays.
#[derive(Debug)]
pub struct Z16<'a> {
    band: Band<'a, u16>,
    /// With its highest bit in the highest, and how far up it is shifted.
    near: u32,
    zeros: u32,
}

impl<'a> Z16<'a> {
    /// What an empty depth buffer is filled with.
    pub const EMPTY: u16 = 0;

    /// A test against `band`, for depths from `near` on: pass the camera's near distance. Nearer
    /// points count as at `near`.
    #[must_use]
    pub const fn new(band: Band<'a, u16>, near: I16F16) -> Self {
        let near = near.to_bits().unsigned_abs();
        let zeros = near.leading_zeros() & 31;
        Self {
            band,
            near: near << zeros,
            zeros,
        }
    }

    /// Makes the buffer empty.
    pub fn clear(&mut self) {
        self.band.clear(Self::EMPTY);
    }

    /// `near / w` at a corner, from 2^16 to 2^31 - 2^16: a margin at both ends takes up what
    /// rounding adds, so that the upper 16 bits never wrap around.
    #[inline]
    fn value(&self, w: I16F16) -> i32 {
        // 2^62 / (w 2^exponent), where near / w is at most 1, or w counts as near.
        let w = w.to_bits().cast_unsigned().max(self.near >> self.zeros);
        let Inverse { mantissa, exponent } = Inverse::new(w);
        let ratio = product_unsigned(self.near, mantissa << 1) >> 32;
        let value = ratio as u32 >> (self.zeros.wrapping_sub(exponent) & 31);
        (value.wrapping_sub(value >> 14).wrapping_add(1 << 16)).cast_signed()
    }
}

impl Depth for Z16<'_> {
    type Plane = Slant;
    type Row<'r>
        = Z16Row<'r>
    where
        Self: 'r;

    #[inline]
    fn plane(&self, triangle: &TriangleSetup<'_>) -> Slant {
        triangle.doubled(triangle.vertices().each_ref().map(|v| self.value(v.w())))
    }

    #[inline]
    fn row<'r>(&'r mut self, plane: &Slant, span: Span) -> Option<Z16Row<'r>> {
        Some(Z16Row {
            z: plane.at(span.left, span.y).cast_unsigned(),
            step: plane.right.cast_unsigned(),
            depths: self.band.span(span)?,
        })
    }
}

/// The row of [`Z16`]: one span of the buffer, and the triangle's depth along it.
#[derive(Debug)]
pub struct Z16Row<'r> {
    /// Depth at the span's first pixel, and its change to the right; 16.16.
    z: u32,
    step: u32,
    depths: &'r mut [u16],
}

/// Pixels of a piece of a long run.
const PIECE: usize = 16;

/// A pixel, and its depth in the buffer and in the triangle.
struct Tested<'p, P> {
    pixel: &'p mut P,
    depth: &'p mut u16,
    here: u32,
}

/// Where something is nearer, draws it, and unless nothing was drawn after all puts its depth, 16.16, in the
/// other's place.
#[inline]
fn replace_seen(depth: &mut u16, here: u32, draw: impl FnOnce() -> bool) {
    let (here, before) = ((here >> 16) as u16, *depth);
    if here > before {
        // First: no register holds it while colours are found.
        *depth = here;
        if !draw() {
            *depth = before;
        }
    }
}

impl<'p, P> Candidate<'p, P> for Tested<'p, P> {
    #[inline]
    fn write(self, write: impl FnOnce(&'p mut P) -> bool) {
        replace_seen(self.depth, self.here, || write(self.pixel));
    }
}

/// Compares the depths of a run with those in the buffer.
struct Nearer<'d> {
    z: u32,
    step: u32,
    depths: &'d mut [u16],
}

impl Visibility for Nearer<'_> {
    // A function of its own: it is the same for all pipelines.
    #[inline(never)]
    fn stretch(&mut self, from: usize, to: usize) -> Range<usize> {
        let Some(depths) = self.depths.get_mut(from..to) else {
            return to..to;
        };
        let (mut z, step) = (self.z, self.step);
        let mut rest = depths.iter_mut();
        let (mut first, mut end) = (to, to);
        while let Some(depth) = rest.next() {
            let here = (z >> 16) as u16;
            if here > *depth {
                *depth = here;
                z = z.wrapping_add(step);
                first = to.wrapping_sub(rest.len()).wrapping_sub(1);
                break;
            }
            z = z.wrapping_add(step);
            keep_rolled();
        }
        while let Some(depth) = rest.next() {
            let here = (z >> 16) as u16;
            if here <= *depth {
                end = to.wrapping_sub(rest.len()).wrapping_sub(1);
                break;
            }
            *depth = here;
            z = z.wrapping_add(step);
            keep_rolled();
        }
        self.z = z;
        first..end
    }

    #[inline]
    fn is_whole<const N: usize>(&mut self) -> bool {
        let Some(depths) = self.depths.first_chunk_mut::<N>() else {
            return false;
        };
        let (eights, rest) = depths.as_chunks_mut::<COUNT>();
        if !rest.is_empty() {
            return false;
        }
        let walk = Walk::new(self.z, self.step);
        let mut is_whole = true;
        let mut here = walk;
        for eight in &*eights {
            is_whole &= here.next().is_above(U16x8::new(*eight));
        }
        if is_whole {
            let mut here = walk;
            for eight in eights {
                *eight = here.next().array();
            }
            self.z = self.z.wrapping_add(self.step.wrapping_mul(N as u32));
        }
        is_whole
    }

    #[inline]
    fn among<'s, P>(
        &'s mut self,
        pixels: &'s mut [P],
    ) -> impl ExactSizeIterator<Item = impl Candidate<'s, P>> {
        let (mut z, step) = (self.z, self.step);
        let both = pixels.iter_mut().zip(&mut *self.depths);
        self.z = z.wrapping_add(step.wrapping_mul(both.len() as u32));
        both.map(move |(pixel, depth)| {
            let here = z;
            z = z.wrapping_add(step);
            Tested { pixel, depth, here }
        })
    }
}

/// A piece of the buffer, and the triangle's depth along it.
struct Piece<'d, const N: usize> {
    z: u32,
    step: u32,
    depths: &'d mut [u16; N],
}

impl<const N: usize> Piece<'_, N> {
    /// Writes those of its pixels that are seen. Returns the depth after it.
    // A function of its own where registers are few and a call is not much beside the pixels.
    #[cfg_attr(all(target_arch = "arm", target_has_atomic = "32"), inline(never))]
    #[cfg_attr(not(all(target_arch = "arm", target_has_atomic = "32")), inline)]
    fn fill<S: ShaderRow<Texel: Into<P>>, P>(
        self,
        offset: usize,
        uv: Uv,
        uv_step: Uv,
        pixels: &mut [P; N],
        shader: &mut S,
    ) -> u32 {
        let Self { z, step, depths } = self;
        let mut nearer = Nearer { z, step, depths };
        shader.piece_seen(offset, uv, uv_step, pixels, &mut nearer);
        nearer.z
    }
}

impl Z16Row<'_> {
    /// At a pixel of the span.
    #[inline]
    fn depth(&self, offset: usize) -> u32 {
        self.z.wrapping_add(self.step.wrapping_mul(offset as u32))
    }

    /// Fills a run in pieces of known length, of which shaders find the texels faster.
    // A function of its own, so that it does not take the registers of short runs.
    #[inline(never)]
    fn fill_pieces<S: ShaderRow<Texel: Into<P>>, P>(
        mut self,
        run: Run,
        pixels: &mut [P],
        shader: &mut S,
    ) {
        let (pieces, rest) = pixels.as_chunks_mut::<PIECE>();
        let len = pieces.len().wrapping_mul(PIECE);
        let mut uv = run.uv;
        let next = || {
            let start = uv;
            uv = start.after(run.step, PIECE);
            (start, run.step)
        };
        self.pieces(run.offset, pieces, next, shader);
        let rest_of_run = Run {
            offset: run.offset.wrapping_add(len),
            len: rest.len(),
            uv,
            step: run.step,
        };
        self.fill(rest_of_run, rest, shader);
    }
}

impl DepthRow for Z16Row<'_> {
    #[inline]
    fn fill<S: ShaderRow, P>(&mut self, run: Run, pixels: &mut [P], shader: &mut S)
    where
        S::Texel: Into<P>,
    {
        let (z, step) = (self.depth(run.offset), self.step);
        if let Some(depths) = self.depths.get_mut(run.offset..) {
            let mut nearer = Nearer { z, step, depths };
            shader.fill_seen(run, pixels, &mut nearer);
        }
    }

    // Always: beside short runs a call is much.
    #[inline(always)]
    fn fill_long<S: ShaderRow, P>(&mut self, run: Run, pixels: &mut [P], shader: &mut S)
    where
        S::Texel: Into<P>,
    {
        if pixels.len() < PIECE || const { !CARRIES } {
            self.fill(run, pixels, shader);
        } else {
            // A copy: what is lent to a function is kept in memory, for runs that are short too.
            let row = Z16Row {
                depths: self.depths,
                ..*self
            };
            row.fill_pieces(run, pixels, shader);
        }
    }

    #[inline]
    fn pieces<S: ShaderRow, P, const N: usize>(
        &mut self,
        offset: usize,
        pieces: &mut [[P; N]],
        mut next: impl FnMut() -> (Uv, Uv),
        shader: &mut S,
    ) where
        S::Texel: Into<P>,
    {
        let (mut z, step) = (self.depth(offset), self.step);
        let Some(depths) = self.depths.get_mut(offset..) else {
            return;
        };
        let (depths, _) = depths.as_chunks_mut::<N>();
        let mut offset = offset;
        for (pixels, depths) in pieces.iter_mut().zip(depths) {
            let (uv, uv_step) = next();
            let piece = Piece { z, step, depths };
            z = piece.fill(offset, uv, uv_step, pixels, shader);
            offset = offset.wrapping_add(N);
        }
    }

    #[inline]
    fn curve<S: ShaderRow, P>(
        &mut self,
        offset: usize,
        curve: Curve,
        pixels: &mut [P],
        shader: &mut S,
    ) where
        S::Texel: Into<P>,
    {
        let (z, step) = (self.depth(offset), self.step);
        if let Some(depths) = self.depths.get_mut(offset..) {
            let mut nearer = Nearer { z, step, depths };
            shader.curve_seen(offset, curve, pixels, &mut nearer);
        }
    }

    #[inline]
    fn eights<S: ShaderRow, P>(
        &mut self,
        offset: usize,
        pixels: &mut [[P; COUNT]],
        eights: impl IntoIterator<Item = Eight>,
        shader: &mut S,
    ) where
        S::Texel: Into<P>,
    {
        let (mut z, step) = (self.depth(offset), self.step);
        let depths = self.depths.get_mut(offset..).unwrap_or_default();
        let (depths, _) = depths.as_chunks_mut::<COUNT>();
        let mut offset = offset;
        for ((pixels, depths), here) in pixels.iter_mut().zip(depths).zip(eights) {
            let mut nearer = Nearer { z, step, depths };
            if nearer.is_whole::<COUNT>() {
                shader.eight(offset, here, pixels);
            } else {
                let uvs = here.array();
                for ((offset, pixel), uv) in (offset..).zip(nearer.among(pixels)).zip(uvs) {
                    pixel.write(|pixel| shader.write(offset, uv, pixel));
                }
            }
            z = nearer.z;
            offset = offset.wrapping_add(COUNT);
        }
    }

    #[inline]
    fn points<S: ShaderRow, P, T, const N: usize>(
        &mut self,
        offset: usize,
        pixels: &mut [P],
        mut state: T,
        here: impl Fn(&T) -> Uv,
        mut next: impl FnMut(&mut T),
        shader: &mut S,
    ) where
        S::Texel: Into<P>,
    {
        let (mut z, step) = (self.depth(offset), self.step);
        let end = offset.wrapping_add(pixels.len());
        let Some(depths) = self.depths.get_mut(offset..end) else {
            return;
        };
        let mut offset = offset;
        // One at a time, whatever `N`: depths take the registers of the others.
        for (pixel, depth) in pixels.iter_mut().zip(depths) {
            replace_seen(depth, z, || shader.write(offset, here(&state), pixel));
            next(&mut state);
            z = z.wrapping_add(step);
            offset = offset.wrapping_add(1);
            if const { N == 1 } {
                keep_rolled();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All pixels at once are seen where each is, and depths are touched only then.
    fn check<const N: usize>(before: [u16; N], z: u32, step: u32) -> bool {
        let here = |pixel: usize| (z.wrapping_add(step.wrapping_mul(pixel as u32)) >> 16) as u16;
        let all: [u16; N] = core::array::from_fn(here);
        let mut depths = before;
        let mut nearer = Nearer {
            z,
            step,
            depths: &mut depths,
        };
        let is_whole = nearer.is_whole::<N>();
        let z_after = nearer.z;
        let is_seen = all.iter().zip(&before).all(|(here, before)| here > before);
        let told = is_seen && N.is_multiple_of(COUNT);
        assert_eq!(is_whole, told, "{before:?} {z:x} {step:x}");
        assert_eq!(depths, if told { all } else { before });
        let far = if told { N as u32 } else { 0 };
        assert_eq!(z_after, z.wrapping_add(step.wrapping_mul(far)));
        is_whole
    }

    #[test]
    fn pieces_are_seen_at_once() {
        let mut state = 1u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state ^ state >> 15
        };
        let mut seen = [0; 3];
        for round in 0..4_000 {
            let (z, step) = (next(), next() >> 12);
            let mut before: [u16; 64] = core::array::from_fn(|pixel| {
                let here = z.wrapping_add(step.wrapping_mul(pixel as u32)) >> 16;
                (here as u16).saturating_sub(1 + (next() >> 24) as u16)
            });
            // One as near as the triangle, or nearer.
            if round % 2 == 0 {
                let pixel = next() as usize % 64;
                before[pixel] = before[pixel].saturating_add((next() >> 22) as u16);
            }
            let first = |n: usize| before.get(..n).unwrap_or_default();
            check::<4>(first(4).try_into().expect("four"), z, step);
            let results = [
                check::<8>(first(8).try_into().expect("eight"), z, step),
                check::<16>(first(16).try_into().expect("sixteen"), z, step),
                check::<64>(before, z, step),
            ];
            for (seen, result) in seen.iter_mut().zip(results) {
                *seen += u32::from(result);
            }
        }
        assert!(
            seen.iter().all(|seen| (1_500..3_950).contains(seen)),
            "{seen:?}"
        );
    }
}
