//! How many lines of memory a span reads from a texture that is stored row by row or in Morton order:
//! what a cache, or a flash that is read in lines, has to fetch. Counted, since no emulator here
//! has a cache.

use std::collections::HashSet;

use multum::depth::NoDepth;
use multum::draw::Pipeline;
use multum::fixed::types::{I16F16, I24F8};
use multum::perspective::Affine;
use multum::project::ScreenVertex;
use multum::sample::Nearest;
use multum::setup::Cull;
use multum::sink::PixelSink;
use multum::span::{Area, Span};
use multum::texture::{Morton, Repeat, Texels, Texture};
use serde::Serialize;

/// Side of the texture in texels.
pub const SIDE: u32 = 256;

/// Bytes of a texel: RGB565.
const TEXEL: u32 = 2;

/// Sizes of lines in bytes: of the RP2040's flash cache, a Cortex-M7's data cache, a PC's.
pub const LINES: [u32; 3] = [8, 32, 64];

/// What one direction of spans costs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Cost {
    /// Angle of the spans in the texture, in degrees: 0 along its rows.
    pub degrees: u32,
    /// Lines of each of [`LINES`] that a pixel needs, row by row: distinct ones in its span, over
    /// the span's pixels.
    pub rows: [f64; 3],
    /// The same in Morton order.
    pub morton: [f64; 3],
}

/// Remembers the place of every texel that is read, span by span.
struct Places {
    width: i32,
    height: i32,
    spans: Vec<Vec<u32>>,
}

impl PixelSink for Places {
    type Pixel = u32;

    fn area(&self) -> Area {
        Area {
            width: self.width,
            top: 0,
            bottom: self.height,
        }
    }

    fn span(&mut self, span: Span) -> Option<&mut [u32]> {
        let length = span.left.abs_diff(span.right) as usize;
        self.spans.push(vec![0; length]);
        self.spans.last_mut().map(Vec::as_mut_slice)
    }
}

/// Counts for a frame of 320x240 that one triangle fills at a texel a pixel, its texture turned by
/// so many degrees.
///
/// # Errors
///
/// The core's, never for these sizes.
pub fn cost(degrees: u32) -> Result<Cost, multum::error::Error> {
    let identity: Vec<u32> = (0..SIDE * SIDE).collect();
    let rows = Texture::new(&identity, SIDE, SIDE)?;
    let morton = Morton::new(&identity, SIDE, SIDE)?;
    Ok(Cost {
        degrees,
        rows: lines(&places(rows, degrees)),
        morton: lines(&places(morton, degrees)),
    })
}

/// Where the texels of each span lie.
fn places<T: Texels<Colour = u32>>(texture: T, degrees: u32) -> Vec<Vec<u32>> {
    let mut sink = Places {
        width: 320,
        height: 240,
        spans: Vec::new(),
    };
    let (sine, cosine) = f64::from(degrees).to_radians().sin_cos();
    let corner = |x: f64, y: f64| {
        // A texel a pixel.
        let (u, v) = (cosine * x - sine * y, sine * x + cosine * y);
        ScreenVertex::new(
            I24F8::from_num(x),
            I24F8::from_num(y),
            I16F16::ONE,
            [u, v].map(|c| I16F16::from_num(c / f64::from(SIDE))),
        )
    };
    // It covers the frame.
    let corners = [(0.0, 0.0), (0.0, 480.0), (640.0, 0.0)];
    if let [Some(a), Some(b), Some(c)] = corners.map(|(x, y)| corner(x, y)) {
        let mut pipeline = Pipeline {
            strategy: Affine,
            sampler: Nearest::<_, Repeat>::new(texture),
            depth: NoDepth,
            cull: Cull::Off,
        };
        pipeline.draw_triangle(&mut sink, &[a, b, c]);
    }
    sink.spans
}

/// Distinct lines of a span for each of its pixels, in the mean over all pixels.
fn lines(spans: &[Vec<u32>]) -> [f64; 3] {
    let pixels: usize = spans.iter().map(Vec::len).sum();
    LINES.map(|bytes| {
        let distinct = |span: &Vec<u32>| {
            let lines: HashSet<_> = span.iter().map(|place| place * TEXEL / bytes).collect();
            lines.len()
        };
        let sum: usize = spans.iter().map(distinct).sum();
        sum as f64 / pixels.max(1) as f64
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Along rows, a line of 32 bytes serves 16 texels; across, each pixel needs its own, and 256
    /// rows come round again after 256 pixels. In Morton order a line is 4x4 texels, and both
    /// directions are alike.
    #[test]
    fn straight_spans_read_as_many_lines_as_can_be_counted_by_hand() {
        let along = cost(0).expect("a frame");
        // 256 texels, and then the same again: 16 lines a span of 320.
        assert_eq!(along.rows[1], 16.0 / 320.0);
        assert_eq!(along.morton[1], 64.0 / 320.0);
        let across = cost(90).expect("a frame");
        assert_eq!(across.rows[1], 256.0 / 320.0);
        assert_eq!(across.morton[1], 64.0 / 320.0);
    }
}
