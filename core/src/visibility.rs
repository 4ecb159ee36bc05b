//! Which pixels of a run are seen: what a depth test tells those who fill it.

/// Which pixels of a run are seen, asked from left to right, each once.
pub trait Visibility {
    /// Passes by those from number `from` on that are not seen. The number of the first that is, which is still
    /// to be asked for, or `to`.
    fn first(&mut self, from: usize, to: usize) -> usize;

    /// Pixels of the run that follow each other, of which the first has number `first`, each to be written if it
    /// is seen. All count as asked for.
    fn among<'s, P>(
        &'s mut self,
        first: usize,
        pixels: &'s mut [P],
    ) -> impl ExactSizeIterator<Item = impl Candidate<'s, P>>;
}

/// A pixel that may be seen.
pub trait Candidate<'p, P: 'p> {
    /// Calls `write` if the pixel is seen; `write` says whether something is to be seen there.
    fn write(self, write: impl FnOnce(&'p mut P) -> bool);
}
