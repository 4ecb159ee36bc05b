//! Samplers: from a texture coordinate to a colour, at one level of detail.

use core::marker::PhantomData;

use crate::arith::{CARRIES, keep_rolled};
use crate::colour::Colour;
use crate::filter::{ImageFilter, LinearTexels};
use crate::simd::{COUNT, EIGHTS};
use crate::texture::{Repeat, Texels, Wrap, fill_seen, nearest};
use crate::uv::{Curve, Eight, Uv};
use crate::visibility::{Candidate as _, MOST, Visibility, by_stretches};

/// What a run of pixels is filled with, where that depends on the coordinate alone.
///
/// Every sampler is a [`Shader`](crate::shade::Shader), which is what a pipeline takes.
pub trait Sampler {
    /// The colour it gives.
    type Texel;

    /// The colour at a coordinate; any coordinate has one.
    fn sample(&self, uv: Uv) -> Self::Texel;

    /// Fills a run: the colours at `uv`, `uv + step` and so on, the same as [`Self::sample`] gives.
    #[inline]
    fn fill<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        Self::Texel: Into<P>,
    {
        let mut uv = uv;
        for pixel in pixels {
            *pixel = self.sample(uv).into();
            uv = uv + step;
        }
    }

    /// Fills those pixels of a run that are seen.
    #[inline]
    fn fill_seen<P>(&self, uv: Uv, step: Uv, pixels: &mut [P], seen: &mut impl Visibility)
    where
        Self::Texel: Into<P>,
    {
        let mut uv = uv;
        for pixel in seen.among(pixels) {
            pixel.write(|pixel| {
                *pixel = self.sample(uv).into();
                true
            });
            uv = uv + step;
            keep_rolled();
        }
    }

    /// The same for a run of known length.
    #[inline]
    fn piece_seen<P, const N: usize>(
        &self,
        uv: Uv,
        step: Uv,
        pixels: &mut [P; N],
        seen: &mut impl Visibility,
    ) where
        Self::Texel: Into<P>,
    {
        self.fill_seen(uv, step, pixels, seen);
    }

    /// [`Self::fill`] for a run of known length.
    #[inline]
    fn piece<P, const N: usize>(&self, uv: Uv, step: Uv, pixels: &mut [P; N])
    where
        Self::Texel: Into<P>,
    {
        self.fill(uv, step, pixels);
    }

    /// Whether it is faster to fill eight pixels at a time where each has coordinates of its own.
    #[inline]
    fn takes_eights(&self) -> bool {
        false
    }

    /// Fills eight pixels.
    #[inline]
    fn eight<P>(&self, at: Eight, pixels: &mut [P; COUNT])
    where
        Self::Texel: Into<P>,
    {
        sample_eight(self, at, pixels);
    }

    /// Fills pixels of which the coordinates are on a parabola.
    #[inline]
    fn curve<P>(&self, curve: Curve, pixels: &mut [P])
    where
        Self::Texel: Into<P>,
    {
        for (pixel, uv) in pixels.iter_mut().zip(curve) {
            *pixel = self.sample(uv).into();
        }
    }

    /// Fills those of them that are seen.
    #[inline]
    fn curve_seen<P>(&self, curve: Curve, pixels: &mut [P], seen: &mut impl Visibility)
    where
        Self::Texel: Into<P>,
    {
        sample_seen(self, curve, pixels, seen);
    }
}

/// Gives those pixels that are seen what `sampler` gives, one by one.
#[inline]
fn sample_seen<S: Sampler<Texel: Into<P>> + ?Sized, P>(
    sampler: &S,
    uvs: impl Iterator<Item = Uv>,
    pixels: &mut [P],
    seen: &mut impl Visibility,
) {
    for (pixel, uv) in seen.among(pixels).zip(uvs) {
        pixel.write(|pixel| {
            *pixel = sampler.sample(uv).into();
            true
        });
        keep_rolled();
    }
}

/// Gives eight pixels what `sampler` gives, one by one.
#[inline]
fn sample_eight<S: Sampler<Texel: Into<P>> + ?Sized, P>(
    sampler: &S,
    at: Eight,
    pixels: &mut [P; COUNT],
) {
    for (pixel, uv) in pixels.iter_mut().zip(at.array()) {
        *pixel = sampler.sample(uv).into();
    }
}

/// Pixels whose texels are read whether they are seen or not.
const FEW: usize = if CARRIES { 8 } else { 4 };

/// The texel that the coordinate lies in; `U` and `V` say what lies beyond the edges.
#[derive(Clone, Copy, Debug)]
pub struct Nearest<T, U = Repeat, V = U> {
    texture: T,
    wrap: PhantomData<(U, V)>,
}

impl<T, U: Wrap, V: Wrap> Nearest<T, U, V> {
    /// Samples `texture`.
    #[must_use]
    pub const fn new(texture: T) -> Self {
        Self {
            texture,
            wrap: PhantomData,
        }
    }
}

impl<T: Texels, U: Wrap, V: Wrap> Sampler for Nearest<T, U, V> {
    type Texel = T::Colour;

    #[inline]
    fn sample(&self, uv: Uv) -> T::Colour {
        if const { U::REPEATS && V::REPEATS } {
            self.texture.nearest_repeating(uv)
        } else {
            nearest::<_, U, V>(&self.texture, uv)
        }
    }

    #[inline]
    fn fill<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        T::Colour: Into<P>,
    {
        if const { U::REPEATS && V::REPEATS } {
            self.texture.fill_few_repeating(uv, step, pixels);
        } else {
            let mut uv = uv;
            for pixel in pixels {
                *pixel = self.sample(uv).into();
                uv = uv + step;
            }
        }
    }

    #[inline]
    fn fill_seen<P>(&self, uv: Uv, step: Uv, pixels: &mut [P], seen: &mut impl Visibility)
    where
        T::Colour: Into<P>,
    {
        if const { U::REPEATS && V::REPEATS } {
            self.texture.fill_few_seen_repeating(uv, step, pixels, seen);
        } else {
            fill_seen::<_, U, V, _>(&self.texture, uv, step, pixels, seen);
        }
    }

    #[inline]
    fn piece<P, const N: usize>(&self, uv: Uv, step: Uv, pixels: &mut [P; N])
    where
        T::Colour: Into<P>,
    {
        if const { U::REPEATS && V::REPEATS } {
            self.texture.piece_repeating(uv, step, pixels);
        } else {
            self.fill(uv, step, pixels);
        }
    }

    #[inline]
    fn takes_eights(&self) -> bool {
        (const { EIGHTS && U::REPEATS && V::REPEATS }) && self.texture.takes_eights()
    }

    #[inline(always)]
    fn eight<P>(&self, at: Eight, pixels: &mut [P; COUNT])
    where
        T::Colour: Into<P>,
    {
        if const { U::REPEATS && V::REPEATS } {
            self.texture.eight_repeating(at, pixels);
        } else {
            sample_eight(self, at, pixels);
        }
    }

    #[inline]
    fn curve<P>(&self, curve: Curve, pixels: &mut [P])
    where
        T::Colour: Into<P>,
    {
        if const { U::REPEATS && V::REPEATS } {
            self.texture.curve_repeating(curve, pixels);
        } else {
            for (pixel, uv) in pixels.iter_mut().zip(curve) {
                *pixel = self.sample(uv).into();
            }
        }
    }

    #[inline]
    fn curve_seen<P>(&self, curve: Curve, pixels: &mut [P], seen: &mut impl Visibility)
    where
        T::Colour: Into<P>,
    {
        let first = seen.stretch(0, pixels.len().min(MOST));
        if first.len() == pixels.len() {
            self.curve(curve, pixels);
            return;
        }
        by_stretches(first, pixels, seen, |first, pixels| {
            self.curve(curve.after(first), pixels);
        });
    }

    #[inline]
    fn piece_seen<P, const N: usize>(
        &self,
        uv: Uv,
        step: Uv,
        pixels: &mut [P; N],
        seen: &mut impl Visibility,
    ) where
        T::Colour: Into<P>,
    {
        if const { N <= FEW } {
            // All, rather than a loop over so few.
            let mut texels = [T::Colour::default(); N];
            self.piece::<T::Colour, N>(uv, step, &mut texels);
            for (pixel, texel) in seen.among(pixels).zip(texels) {
                pixel.write(|pixel| {
                    *pixel = texel.into();
                    true
                });
            }
            return;
        }
        if const { U::REPEATS && V::REPEATS } {
            self.texture.piece_seen_repeating(uv, step, pixels, seen);
        } else {
            fill_seen::<_, U, V, _>(&self.texture, uv, step, pixels, seen);
        }
    }
}

/// The four texels around the coordinate, weighted by their nearness: bilinear filtering (OpenGL
/// 4.6, section 8.14.3, `LINEAR`).
///
/// Where a channel's four values span c, it is off by at most `c 2^-9` and the rounding to the
/// channel's bits. With [`LinearTexels5`](crate::filter::LinearTexels5) in the place of `F` it takes less
/// time and is off by up to `c / 32 + 1`.
///
/// A texture of 2^k x 1 texels is one of one dimension: a scale of colours by a value in u, such as a
/// heat map.
///
/// ```
/// use multum::embedded_graphics::pixelcolor::{Rgb565, RgbColor};
/// use multum::sample::{Bilinear, Sampler};
/// use multum::texture::{Clamp, Texture};
/// use multum::uv::Uv;
///
/// static COLD_TO_HOT: [Rgb565; 4] = [Rgb565::BLUE, Rgb565::GREEN, Rgb565::YELLOW, Rgb565::RED];
/// let scale = Bilinear::<_, Clamp>::new(Texture::new(&COLD_TO_HOT, 4, 1)?);
/// let at = |value: f32| scale.sample(Uv::from_bits((value * 16_777_216.0) as i32, 0));
/// assert_eq!(at(0.0), Rgb565::BLUE);
/// // Half way between the centres of the first two texels.
/// assert_eq!(at(0.25), Rgb565::new(0, 32, 16));
/// assert_eq!(at(1.0), Rgb565::RED);
/// # Ok::<(), multum::error::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Bilinear<T, U = Repeat, V = U, F = LinearTexels> {
    texture: T,
    choices: PhantomData<(U, V, F)>,
}

impl<T, U: Wrap, V: Wrap, F: ImageFilter> Bilinear<T, U, V, F> {
    /// Samples `texture`.
    #[must_use]
    pub const fn new(texture: T) -> Self {
        Self {
            texture,
            choices: PhantomData,
        }
    }
}

impl<T, U, V, F> Sampler for Bilinear<T, U, V, F>
where
    T: Texels<Colour: Colour>,
    U: Wrap,
    V: Wrap,
    F: ImageFilter + Default,
{
    type Texel = T::Colour;

    #[inline]
    fn sample(&self, uv: Uv) -> T::Colour {
        F::default().texel::<_, U, V>(&self.texture, uv)
    }

    #[inline]
    fn fill<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        T::Colour: Into<P>,
    {
        F::default().fill::<_, U, V, _>(&self.texture, uv, step, pixels);
    }

    #[inline]
    fn piece<P, const N: usize>(&self, uv: Uv, step: Uv, pixels: &mut [P; N])
    where
        T::Colour: Into<P>,
    {
        F::default().piece::<_, U, V, _, N>(&self.texture, uv, step, pixels);
    }

    #[inline]
    fn fill_seen<P>(&self, uv: Uv, step: Uv, pixels: &mut [P], seen: &mut impl Visibility)
    where
        T::Colour: Into<P>,
    {
        F::default().fill_seen::<_, U, V, _>(&self.texture, uv, step, pixels, seen);
    }

    #[inline]
    fn piece_seen<P, const N: usize>(
        &self,
        uv: Uv,
        step: Uv,
        pixels: &mut [P; N],
        seen: &mut impl Visibility,
    ) where
        T::Colour: Into<P>,
    {
        F::default().piece_seen::<_, U, V, _, N>(&self.texture, uv, step, pixels, seen);
    }
}
