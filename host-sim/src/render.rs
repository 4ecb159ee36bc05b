//! Drawing a frame with the core: in colour, as the device does it, and as a record of what the
//! core did at each pixel.

use std::cell::Cell;

use multum::depth::{Depth, NoDepth, Z16};
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::raw::ToBytes;
use multum::embedded_graphics::pixelcolor::{PixelColor, Rgb565};
use multum::hash::FrameHash;
use multum::perspective::{Run, RunSink, Strategy};
use multum::project::ScreenVertex;
use multum::sample::{Nearest, Sampler};
use multum::setup::{Cull, TriangleSetup};
use multum::shade::Shader;
use multum::sink::{Band, PixelSink};
use multum::span::{Area, Span};
use multum::texture::{Repeat, Texture};
use multum::uv::Uv;
use multum::viewport::Viewport;

use crate::any::AnyNearest;
use crate::choice::{Perspective, with_strategy};
use crate::error::Error;
use crate::frame::{Batch, Frame, ScreenTriangle};
use crate::reference::Beyond;
use crate::scene::BACKGROUND;

/// Draws a frame in bands of `rows` rows, top to bottom, and gives its pixels.
///
/// # Errors
///
/// [`Error::Core`] for a texture that the core refuses.
pub fn colours(frame: &Frame, perspective: Perspective, rows: u32) -> Result<Vec<Rgb565>, Error> {
    colours_with(frame, perspective, rows, &texels(frame))
}

/// The textures of a frame, batch by batch.
#[must_use]
pub fn texels(frame: &Frame) -> Vec<Vec<Rgb565>> {
    frame.batches.iter().map(|b| b.picture.rgb565()).collect()
}

/// As [`colours`], with the frame's textures from [`texels`].
///
/// # Errors
///
/// [`Error::Core`] for a texture that the core refuses.
pub fn colours_with(
    frame: &Frame,
    perspective: Perspective,
    rows: u32,
    textures: &[Vec<Rgb565>],
) -> Result<Vec<Rgb565>, Error> {
    in_bands(frame, rows, BACKGROUND, |band, mut depth| {
        for (batch, texels) in frame.batches.iter().zip(textures) {
            let texture = Texture::new(texels, batch.picture.width(), batch.picture.height())
                .map_err(core("texture"))?;
            let (triangles, wrap) = (&batch.triangles, batch.wrap);
            let how = (perspective, texture.log2_size());
            // As firmware does where textures repeat; each other mode would be compiled with every
            // strategy as well.
            if wrap == Beyond::Repeat {
                let sampler = Nearest::<_, Repeat>::new(texture);
                draw(band, &mut depth, how, sampler, frame.cull, triangles);
            } else {
                let sampler = AnyNearest { texture, wrap };
                draw(band, &mut depth, how, sampler, frame.cull, triangles);
            }
        }
        Ok(())
    })
}

/// What the core put at a pixel: the triangle, by its number in drawing order, and coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fragment {
    /// Number of the triangle.
    pub triangle: u32,
    /// The coordinates that a sampler was given.
    pub uv: Uv,
}

/// A sampler that tells where it was asked instead of what is there.
#[derive(Clone, Copy)]
struct Probe {
    triangle: u32,
}

impl Sampler for Probe {
    type Texel = Option<Fragment>;

    fn sample(&self, uv: Uv) -> Option<Fragment> {
        Some(Fragment {
            triangle: self.triangle,
            uv,
        })
    }
}

/// What is seen at each pixel in the end.
///
/// # Errors
///
/// [`Error::Core`] for a frame that the core refuses.
pub fn fragments(frame: &Frame, perspective: Perspective) -> Result<Vec<Option<Fragment>>, Error> {
    in_bands(frame, frame.viewport.height(), None, |band, mut depth| {
        for (number, (batch, triangle)) in frame.triangles().enumerate() {
            let sampler = Probe {
                triangle: number as u32,
            };
            draw(
                band,
                &mut depth,
                (perspective, log2_size(batch)),
                sampler,
                frame.cull,
                std::slice::from_ref(triangle),
            );
        }
        Ok(())
    })
}

/// The spans of one triangle as the core covers them, hidden ones included.
#[must_use]
pub fn spans(vertices: &[ScreenVertex; 3], width: u32, height: u32, cull: Cull) -> Vec<Span> {
    let mut log = SpanLog::new(width, height);
    let mut pipeline = Pipeline {
        strategy: multum::perspective::Affine,
        sampler: Probe { triangle: 0 },
        depth: NoDepth,
        cull,
    };
    pipeline.draw_triangle(&mut log, vertices);
    log.spans
}

/// A sink that keeps the spans and forgets the pixels.
struct SpanLog {
    area: Area,
    spans: Vec<Span>,
    scratch: Vec<Option<Fragment>>,
}

impl SpanLog {
    fn new(width: u32, height: u32) -> Self {
        Self {
            area: Area {
                width: width.cast_signed(),
                top: 0,
                bottom: height.cast_signed(),
            },
            spans: Vec::new(),
            scratch: vec![None; width as usize],
        }
    }
}

impl PixelSink for SpanLog {
    type Pixel = Option<Fragment>;

    fn area(&self) -> Area {
        self.area
    }

    fn span(&mut self, span: Span) -> Option<&mut [Option<Fragment>]> {
        self.spans.push(span);
        self.scratch
            .get_mut(..span.left.abs_diff(span.right) as usize)
    }
}

/// How many perspective divisions a frame takes along its spans, hidden pixels included.
#[must_use]
pub fn divisions(frame: &Frame, perspective: Perspective) -> u64 {
    let (width, height) = (frame.viewport.width(), frame.viewport.height());
    let mut sink = SpanLog::new(width, height);
    let count = Cell::new(0);
    for (batch, triangle) in frame.triangles() {
        sink.spans.clear();
        with_strategy!(perspective, log2_size(batch), strategy => {
            let mut pipeline = Pipeline {
                strategy: Counting { strategy, count: &count },
                sampler: Probe { triangle: 0 },
                depth: NoDepth,
                cull: frame.cull,
            };
            pipeline.draw_triangle(&mut sink, &triangle.vertices);
        });
    }
    count.get()
}

/// A strategy that counts another one's divisions.
struct Counting<'c, P> {
    strategy: P,
    count: &'c Cell<u64>,
}

impl<P: Strategy> Strategy for Counting<'_, P> {
    type Planes = P::Planes;

    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<P::Planes> {
        self.strategy.planes(triangle)
    }

    fn runs(&self, planes: &P::Planes, span: Span, _: impl RunSink) {
        let divisions = self.strategy.divisions(planes, span);
        self.count.set(self.count.get() + u64::from(divisions));
        // For what a strategy remembers.
        self.strategy.runs(planes, span, |_: Run| {});
    }
}

/// Of a batch's texture.
fn log2_size(batch: &Batch) -> (u32, u32) {
    (
        batch.picture.width().ilog2(),
        batch.picture.height().ilog2(),
    )
}

fn core(context: &str) -> impl Fn(multum::error::Error) -> Error + '_ {
    move |error| Error::core(context, error)
}

/// Calls `paint` for each band of a frame with a cleared band and, where the frame needs one, a
/// cleared depth buffer; puts the bands together.
pub(crate) fn in_bands<P: Copy>(
    frame: &Frame,
    rows: u32,
    background: P,
    mut paint: impl FnMut(&mut Band<'_, P>, Option<&mut Z16<'_>>) -> Result<(), Error>,
) -> Result<Vec<P>, Error> {
    let (width, height) = (frame.viewport.width(), frame.viewport.height());
    let mut pixels = vec![background; width as usize * height as usize];
    let rows = rows.clamp(1, height);
    for (i, chunk) in pixels.chunks_mut((rows * width) as usize).enumerate() {
        let top = i as u32 * rows;
        let rows = rows.min(height - top);
        let mut band = Band::new(chunk, width, rows, width as usize, top).map_err(core("band"))?;
        if frame.depth {
            let mut depths = vec![Z16::EMPTY; (rows * width) as usize];
            let depths = Band::new(&mut depths, width, rows, width as usize, top)
                .map_err(core("depth band"))?;
            paint(&mut band, Some(&mut Z16::new(depths, frame.near)))?;
        } else {
            paint(&mut band, None)?;
        }
    }
    Ok(pixels)
}

/// Draws triangles with the types that the choices stand for.
fn draw<K, S>(
    sink: &mut K,
    depth: &mut Option<&mut Z16<'_>>,
    (perspective, size): (Perspective, (u32, u32)),
    sampler: S,
    cull: Cull,
    triangles: &[ScreenTriangle],
) where
    K: PixelSink,
    S: Shader + Copy,
    S::Texel: Into<K::Pixel>,
{
    with_strategy!(perspective, size, strategy => match depth {
        Some(z) => {
            let depth: &mut Z16<'_> = z;
            draw_all(sink, &mut Pipeline { strategy, sampler, depth, cull }, triangles);
        }
        None => draw_all(sink, &mut Pipeline { strategy, sampler, depth: NoDepth, cull }, triangles),
    });
}

fn draw_all<K, P, S, D>(
    sink: &mut K,
    pipeline: &mut Pipeline<P, S, D>,
    triangles: &[ScreenTriangle],
) where
    K: PixelSink,
    P: Strategy,
    S: Shader,
    D: Depth,
    S::Texel: Into<K::Pixel>,
{
    for triangle in triangles {
        pipeline.draw_triangle(sink, &triangle.vertices);
    }
}

/// The core's hash of a frame.
///
/// # Panics
///
/// If there are not as many pixels as the frame has.
#[must_use]
pub fn hash<C>(pixels: &[C], viewport: Viewport) -> u64
where
    C: PixelColor + ToBytes<Bytes: AsRef<[u8]>>,
{
    let (width, height) = (viewport.width(), viewport.height());
    let mut pixels = pixels.to_vec();
    let band = Band::new(&mut pixels, width, height, width as usize, 0)
        .expect("a frame of the viewport's size");
    let mut hash = FrameHash::new();
    hash.add(&band);
    hash.value()
}
