//! Which pixels of a run are seen: what a depth test tells those who fill it.

use core::ops::Range;

use crate::simd::EIGHTS;

/// Which pixels of a run are seen, asked from left to right, each once.
pub trait Visibility {
    /// The next pixels that are seen, one behind the other, of those from number `from` up to `to`: all of them are to
    /// be written. Empty, at `to`, where none is; the one behind them is still to be asked for.
    fn stretch(&mut self, from: usize, to: usize) -> Range<usize>;

    /// Whether the first `N` pixels are all seen, as far as it takes one step to tell: all are to be written then. None
    /// counts as asked for if not.
    #[inline]
    fn is_whole<const N: usize>(&mut self) -> bool {
        false
    }

    /// The pixels of the run, each to be written if it is seen. All count as asked for.
    fn among<'s, P>(
        &'s mut self,
        pixels: &'s mut [P],
    ) -> impl ExactSizeIterator<Item = impl Candidate<'s, P>>;
}

/// A pixel that may be seen.
pub trait Candidate<'p, P: 'p> {
    /// Calls `write` if the pixel is seen; `write` says whether something is to be seen there.
    fn write(self, write: impl FnOnce(&'p mut P) -> bool);
}

/// The first stretch of `N` pixels that are seen; `None`, if all are, as most often.
#[inline]
pub(crate) fn first_stretch<const N: usize>(seen: &mut impl Visibility) -> Option<Range<usize>> {
    if const { EIGHTS } && seen.is_whole::<N>() {
        return None;
    }
    let first = seen.stretch(0, N);
    (first.len() != N).then_some(first)
}

/// The most pixels of a stretch that [`by_stretches`] finds.
pub(crate) const MOST: usize = 64;

/// Hands over the stretches of a run that are seen, of no more than 64 pixels, each with the number of its first: one
/// that is known, which may be empty, and those behind it.
#[inline]
pub(crate) fn by_stretches<P>(
    known: Range<usize>,
    pixels: &mut [P],
    seen: &mut impl Visibility,
    mut fill: impl FnMut(usize, &mut [P]),
) {
    let len = pixels.len();
    let mut stretch = known;
    loop {
        let Range { start: first, end } = stretch;
        if let Some(pixels) = pixels.get_mut(stretch)
            && !pixels.is_empty()
        {
            fill(first, pixels);
        }
        if end >= len {
            return;
        }
        stretch = seen.stretch(end, end.saturating_add(MOST).min(len));
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Pixels by number.
    pub(crate) struct Seen<'s>(pub(crate) &'s [bool]);

    /// One of them.
    pub(crate) struct MaySee<'p, P>(&'p mut P, bool);

    impl<'p, P> Candidate<'p, P> for MaySee<'p, P> {
        fn write(self, write: impl FnOnce(&'p mut P) -> bool) {
            if self.1 {
                write(self.0);
            }
        }
    }

    impl Visibility for Seen<'_> {
        fn stretch(&mut self, from: usize, to: usize) -> Range<usize> {
            let first = (from..to).find(|&i| self.0[i]).unwrap_or(to);
            let end = (first..to).find(|&i| !self.0[i]).unwrap_or(to);
            first..end
        }

        fn among<'s, P>(
            &'s mut self,
            pixels: &'s mut [P],
        ) -> impl ExactSizeIterator<Item = impl Candidate<'s, P>> {
            let both = pixels.iter_mut().zip(self.0);
            both.map(|(pixel, &is_seen)| MaySee(pixel, is_seen))
        }
    }

    /// Of `N` pixels: all, none, and others.
    pub(crate) fn patterns<const N: usize>() -> impl Iterator<Item = [bool; N]> {
        (0..200u64).map(|round| {
            // Steps of the golden ratio.
            let bits = round.wrapping_mul(0x9e37_79b9_7f4a_7c15);
            core::array::from_fn(|i| match round {
                0 => true,
                1 => false,
                _ => bits >> (i / (1 + round as usize % 5) % 64) & 1 == 1,
            })
        })
    }

    #[test]
    fn stretches_are_all_that_is_seen() {
        for pattern in patterns::<150>() {
            let (mut found, mut longest) = ([false; 150], 0);
            let mut seen = Seen(&pattern);
            by_stretches(0..0, &mut [(); 150], &mut seen, |first, pixels| {
                found[first..][..pixels.len()].fill(true);
                longest = longest.max(pixels.len());
            });
            assert_eq!(found, pattern);
            assert!(longest <= MOST);
        }
    }
}
