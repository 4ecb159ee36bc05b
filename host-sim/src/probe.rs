//! One triangle drawn alone by the core, with a record of every pixel it was asked for: its
//! coordinates and its texel.

use multum::depth::NoDepth;
use multum::draw::Pipeline;
use multum::project::ScreenVertex;
use multum::sample::Sampler;
use multum::setup::Cull;
use multum::sink::PixelSink;
use multum::span::{Area, Span};
use multum::texture::Texture;
use multum::uv::Uv;
use multum::viewport::Viewport;

use crate::any::AnyNearest;
use crate::choice::{Perspective, with_strategy};
use crate::reference::Beyond;

/// What the core did at one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Probed {
    /// The coordinates that the sampler was given.
    pub uv: Uv,
    /// The texel that it chose, counted row by row from the top left.
    pub texel: u32,
    /// Whether the pixel was written at all.
    pub drawn: bool,
}

impl Probed {
    /// u and v in repeats.
    #[must_use]
    pub fn coordinates(&self) -> [f64; 2] {
        [self.uv.u, self.uv.v].map(|c| f64::from(c.to_bits()) / f64::from(1 << 24))
    }
}

/// A triangle's spans, top to bottom, each with its pixels from left to right.
#[derive(Clone, Debug, Default)]
pub struct Record {
    spans: Vec<Span>,
    pixels: Vec<Probed>,
    area: Option<Area>,
}

impl Record {
    /// The spans with their pixels.
    pub fn spans(&self) -> impl Iterator<Item = (Span, &[Probed])> {
        let mut rest = self.pixels.as_slice();
        self.spans.iter().map(move |&span| {
            let (pixels, after) = rest.split_at(length(span));
            rest = after;
            (span, pixels)
        })
    }

    /// What was recorded at a pixel.
    #[must_use]
    pub fn pixel(&self, x: i32, y: i32) -> Option<Probed> {
        self.spans()
            .find(|(span, _)| span.y == y && (span.left..span.right).contains(&x))
            .and_then(|(span, pixels)| pixels.get(span.left.abs_diff(x) as usize).copied())
    }
}

fn length(span: Span) -> usize {
    usize::try_from(span.right - span.left).unwrap_or(0)
}

impl PixelSink for Record {
    type Pixel = Probed;

    fn area(&self) -> Area {
        self.area.unwrap_or(Area {
            width: 0,
            top: 0,
            bottom: 0,
        })
    }

    fn span(&mut self, span: Span) -> Option<&mut [Probed]> {
        self.spans.push(span);
        let start = self.pixels.len();
        self.pixels.resize(start + length(span), Probed::default());
        self.pixels.get_mut(start..)
    }
}

/// A sampler that also tells where it was asked.
struct Probe<'a>(AnyNearest<Texture<'a, u32>>);

impl Sampler for Probe<'_> {
    type Texel = Probed;

    fn sample(&self, uv: Uv) -> Probed {
        Probed {
            uv,
            texel: self.0.sample(uv),
            drawn: true,
        }
    }
}

/// The numbers of the texels of a texture, to sample from.
#[must_use]
pub fn texel_numbers(width: u32, height: u32) -> Vec<u32> {
    (0..width * height).collect()
}

/// Draws both sides of a triangle into an empty frame.
#[must_use]
pub fn probe(
    vertices: &[ScreenVertex; 3],
    viewport: Viewport,
    perspective: Perspective,
    texture: Texture<'_, u32>,
    wrap: Beyond,
) -> Record {
    let mut record = Record {
        area: Some(Area {
            width: viewport.width().cast_signed(),
            top: 0,
            bottom: viewport.height().cast_signed(),
        }),
        ..Record::default()
    };
    with_strategy!(perspective, texture.log2_size(), strategy => {
        let mut pipeline = Pipeline {
            strategy,
            sampler: Probe(AnyNearest { texture, wrap }),
            depth: NoDepth,
            cull: Cull::Off,
        };
        pipeline.draw_triangle(&mut record, vertices);
    });
    record
}
