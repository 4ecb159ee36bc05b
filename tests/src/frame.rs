//! Sinks that watch: which pixels were drawn, how often, and whether the spans keep to the rules
//! of [`PixelSink`].

use multum::sink::PixelSink;
use multum::span::{Area, Span};

/// What happens when a pixel is drawn a second time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overdraw {
    /// The test fails at once.
    Panics,
    /// It is counted.
    Counts,
}

/// A frame that counts how often each pixel is handed out.
#[derive(Debug)]
pub struct Frame<P> {
    width: i32,
    height: i32,
    overdraw: Overdraw,
    pixels: Vec<P>,
    counts: Vec<u32>,
}

impl<P: Copy> Frame<P> {
    /// `width` x `height` pixels, each `blank`.
    ///
    /// # Panics
    ///
    /// For a negative size.
    #[must_use]
    pub fn new(width: i32, height: i32, blank: P, overdraw: Overdraw) -> Self {
        let size = usize::try_from(width * height).expect("a size");
        Self {
            width,
            height,
            overdraw,
            pixels: vec![blank; size],
            counts: vec![0; size],
        }
    }

    fn index(&self, x: i32, y: i32) -> usize {
        assert!((0..self.width).contains(&x) && (0..self.height).contains(&y));
        (y * self.width + x) as usize
    }

    /// The pixel in column `x` and row `y`.
    #[must_use]
    pub fn pixel(&self, x: i32, y: i32) -> P {
        self.pixels[self.index(x, y)]
    }

    /// How often it was drawn.
    #[must_use]
    pub fn count(&self, x: i32, y: i32) -> u32 {
        self.counts[self.index(x, y)]
    }

    /// All columns and rows.
    pub fn positions(&self) -> impl Iterator<Item = (i32, i32)> + use<P> {
        let width = self.width;
        (0..width * self.height).map(move |i| (i % width, i / width))
    }

    /// Back to no pixel drawn; the pixels keep their values.
    pub fn forget(&mut self) {
        self.counts.fill(0);
    }
}

impl Frame<u8> {
    /// The frame as text, a character a pixel and a line a row.
    #[must_use]
    pub fn picture(&self) -> String {
        self.pixels
            .chunks(self.width as usize)
            .map(|row| row.iter().map(|&c| char::from(c)).collect::<String>() + "\n")
            .collect()
    }
}

impl<P> PixelSink for Frame<P> {
    type Pixel = P;

    fn area(&self) -> Area {
        Area {
            width: self.width,
            top: 0,
            bottom: self.height,
        }
    }

    fn span(&mut self, span: Span) -> Option<&mut [P]> {
        let Span { y, left, right } = span;
        assert!((0..self.height).contains(&y), "{span:?} beyond the frame");
        assert!(
            0 <= left && left < right && right <= self.width,
            "{span:?} beyond the frame"
        );
        let start = (y * self.width + left) as usize;
        let range = start..start + (right - left) as usize;
        for count in &mut self.counts[range.clone()] {
            *count += 1;
            assert!(
                *count == 1 || self.overdraw == Overdraw::Counts,
                "{span:?} draws a pixel again"
            );
        }
        Some(&mut self.pixels[range])
    }
}

/// Takes one triangle at a time and remembers its span on each row: fast enough for millions.
#[derive(Debug)]
pub struct Spans {
    width: i32,
    row: Vec<u8>,
    spans: Vec<(i32, i32)>,
    drawn: usize,
}

impl Spans {
    /// A frame of `width` x `height` pixels.
    ///
    /// # Panics
    ///
    /// For a negative size.
    #[must_use]
    pub fn new(width: i32, height: i32) -> Self {
        let cells = |n: i32| usize::try_from(n).expect("a size");
        Self {
            width,
            row: vec![0; cells(width)],
            spans: vec![(0, 0); cells(height)],
            drawn: 0,
        }
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> (i32, i32) {
        (self.width, self.spans.len() as i32)
    }

    /// First column and column after the last in a row; (0, 0) if nothing was drawn there.
    #[must_use]
    pub fn span(&self, row: i32) -> (i32, i32) {
        self.spans[row as usize]
    }

    /// Rows with a span.
    #[must_use]
    pub fn drawn(&self) -> usize {
        self.drawn
    }

    /// Ready for the next triangle.
    pub fn clear(&mut self) {
        self.spans.fill((0, 0));
        self.drawn = 0;
    }
}

impl PixelSink for Spans {
    type Pixel = u8;

    fn area(&self) -> Area {
        Area {
            width: self.width,
            top: 0,
            bottom: self.spans.len() as i32,
        }
    }

    fn span(&mut self, span: Span) -> Option<&mut [u8]> {
        let Span { y, left, right } = span;
        assert!(
            0 <= left && left < right && right <= self.width,
            "{span:?} beyond the frame"
        );
        let row = &mut self.spans[y as usize];
        assert_eq!(*row, (0, 0), "{span:?} is the second one in its row");
        *row = (left, right);
        self.drawn += 1;
        Some(&mut self.row[left as usize..right as usize])
    }
}
