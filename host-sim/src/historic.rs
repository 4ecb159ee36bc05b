//! Two ways to draw textures in perspective that renderers have left behind, for comparison: what
//! they cost in holes, overdraw and bookkeeping.
//!
//! [`constant_depth_lines`] walks the screen along lines of constant depth, [`forward`] walks the
//! texture and puts texels on the screen. Both work in float64 on a [`Frame`]'s numbers and share
//! nothing with the core, so what they lose is the technique's loss and not arithmetic's.
//!
//! Everything is counted for each triangle by itself and summed, hidden pixels included: a
//! pixel that a neighbour happens to fill is still a hole of this triangle.

pub mod constant_depth_lines;
pub mod forward;

use std::fmt;

use multum::embedded_graphics::pixelcolor::Rgb565;
use serde::Serialize;

use crate::choice::Perspective;
use crate::compare::{Spread, UvError, compare};
use crate::error::Error;
use crate::filtering::Filtering;
use crate::frame::{Batch, Frame, ScreenTriangle};
use crate::reference::{Coverage, Planes};
use crate::render::{colours, spans};
use crate::scene::BACKGROUND;
use constant_depth_lines as lines;

/// The colour of holes in pictures: pixels that a triangle covers and nothing was written to.
pub const HOLE: Rgb565 = Rgb565::new(31, 0, 31);

/// A technique of the past.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Technique {
    /// Lines of constant depth that all repeat one pattern of steps.
    Lines,
    /// Lines of constant depth, each a line of Bresenham's from where it enters the triangle.
    LinesFromEdges,
    /// Texels put on the screen one by one.
    Forward,
}

impl Technique {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Lines, Self::LinesFromEdges, Self::Forward];
}

impl fmt::Display for Technique {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Lines => "lines",
            Self::LinesFromEdges => "lines:from-edges",
            Self::Forward => "forward",
        })
    }
}

/// What a frame cost, and what came of it. Sums over all triangles, hidden pixels included.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Cost {
    /// Pixels that the triangles cover exactly.
    pub covered: u64,
    /// Of these, the ones that were not written.
    pub holes: u64,
    /// Pixels that one triangle wrote more than once.
    pub repeated: u64,
    /// Pixels written that the triangle does not cover.
    pub outside: u64,
    /// Writes on the screen.
    pub writes: u64,
    /// Writes that did not go to the pixel to the right of the one before: what a row in a cache
    /// or a burst to memory can not do.
    pub jumps: u64,
    /// Lines or scanlines that were set up: on the screen, or of the texture in forward mapping.
    pub lines: u64,
    /// Perspective divisions, without those that set up a triangle.
    pub divisions: u64,
    /// Texels read.
    pub texels: u64,
    /// Distance to the reference at the centre of each covered pixel that was written; of several
    /// writes, the last.
    pub uv_error: UvError,
}

/// A frame drawn with a technique.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// The pixels, holes in [`HOLE`].
    pub pixels: Vec<Rgb565>,
    /// What they cost.
    pub cost: Cost,
}

/// Draws a frame.
///
/// # Errors
///
/// [`Error::Content`] if forward mapping had to read more than [`forward::MAX_TEXELS`] texels.
pub fn draw(frame: &Frame, technique: Technique) -> Result<Drawing, Error> {
    if technique == Technique::Forward {
        forward::check_work(frame)?;
    }
    let mut canvas = Canvas::new(frame);
    for batch in &frame.batches {
        let texels = batch.picture.rgb565();
        let paint = Paint { batch, texels };
        for triangle in batch.triangles.iter().filter(|t| t.is_shown(frame.cull)) {
            let Some(planes) = Planes::new(&triangle.corners()) else {
                continue;
            };
            match technique {
                Technique::Lines => lines::draw(&mut canvas, &paint, triangle, &planes, false),
                Technique::LinesFromEdges => {
                    lines::draw(&mut canvas, &paint, triangle, &planes, true);
                }
                Technique::Forward => forward::draw(&mut canvas, &paint, triangle),
            }
            canvas.finish_triangle(batch, triangle, &planes);
        }
    }
    Ok(canvas.finish())
}

/// The same numbers for a strategy of the core, by [`compare`]; the errors are those of visible
/// pixels.
///
/// # Errors
///
/// [`Error::Core`] for a frame that the core refuses.
pub fn core_cost(frame: &Frame, perspective: Perspective) -> Result<(Vec<Rgb565>, Cost), Error> {
    let (width, height) = (frame.viewport.width(), frame.viewport.height());
    let report = compare(frame, perspective, height, &Filtering::default())?;
    let mut cost = Cost {
        holes: report.comparison.gaps as u64,
        divisions: report.comparison.divisions,
        uv_error: report.comparison.uv_error,
        ..Cost::default()
    };
    for (_, triangle) in frame.triangles() {
        for span in spans(&triangle.vertices, width, height, frame.cull) {
            cost.lines += 1;
            cost.writes += u64::from(span.left.abs_diff(span.right));
        }
        if triangle.is_shown(frame.cull)
            && let Some(coverage) = Coverage::new(triangle.grid(), 256)
        {
            coverage.for_each(width, height, |_, _| cost.covered += 1);
        }
    }
    cost.jumps = cost.lines;
    cost.texels = cost.writes;
    Ok((colours(frame, perspective, height)?, cost))
}

/// What a triangle is painted with.
struct Paint<'f> {
    batch: &'f Batch,
    texels: Vec<Rgb565>,
}

impl Paint<'_> {
    /// The colour at a coordinate in repeats.
    fn at(&self, uv: [f64; 2]) -> Rgb565 {
        let (width, height) = (self.batch.picture.width(), self.batch.picture.height());
        let column = self.batch.wrap.texel(uv[0], width);
        let row = self.batch.wrap.texel(uv[1], height);
        self.texels[(row * width + column) as usize]
    }
}

/// Where the techniques write, and where it is counted.
struct Canvas {
    width: u32,
    height: u32,
    depth: bool,
    pixels: Vec<Rgb565>,
    /// 1/w of what is seen.
    nearest: Vec<f64>,
    /// Pixels that a triangle covers and none wrote.
    holes: Vec<bool>,
    /// Pixels that a triangle wrote.
    filled: Vec<bool>,
    /// Times that this triangle wrote each pixel, and the coordinates that it wrote last.
    visits: Vec<(u32, [f64; 2])>,
    /// Pixels with visits.
    touched: Vec<usize>,
    last: Option<usize>,
    cost: Cost,
    texel_errors: Vec<f64>,
    footprint_errors: Vec<f64>,
}

impl Canvas {
    fn new(frame: &Frame) -> Self {
        let (width, height) = (frame.viewport.width(), frame.viewport.height());
        let size = width as usize * height as usize;
        Self {
            width,
            height,
            depth: frame.depth,
            pixels: vec![BACKGROUND; size],
            nearest: vec![0.0; size],
            holes: vec![false; size],
            filled: vec![false; size],
            visits: vec![(0, [0.0; 2]); size],
            touched: Vec::new(),
            last: None,
            cost: Cost::default(),
            texel_errors: Vec::new(),
            footprint_errors: Vec::new(),
        }
    }

    /// Writes a pixel, if it is on the screen.
    fn write(&mut self, paint: &Paint<'_>, [x, y]: [i64; 2], uv: [f64; 2], inverse_w: f64) {
        if !(0..i64::from(self.width)).contains(&x) || !(0..i64::from(self.height)).contains(&y) {
            return;
        }
        let i = (y * i64::from(self.width) + x) as usize;
        self.cost.writes += 1;
        if self.last.is_none_or(|last| last + 1 != i) {
            self.cost.jumps += 1;
        }
        self.last = Some(i);
        let visit = &mut self.visits[i];
        if visit.0 == 0 {
            self.touched.push(i);
        }
        *visit = (visit.0 + 1, uv);
        // A triangle's own later writes replace its earlier ones.
        if self.depth && inverse_w < self.nearest[i] && visit.0 == 1 {
            return;
        }
        self.nearest[i] = inverse_w;
        self.filled[i] = true;
        self.pixels[i] = paint.at(uv);
    }

    /// Counts what a triangle left, and forgets its visits.
    fn finish_triangle(&mut self, batch: &Batch, triangle: &ScreenTriangle, planes: &Planes) {
        let Some(coverage) = Coverage::new(triangle.grid(), 256) else {
            return;
        };
        let size = [batch.picture.width(), batch.picture.height()].map(f64::from);
        let mut inside = 0;
        coverage.for_each(self.width, self.height, |x, y| {
            let i = (y * self.width + x) as usize;
            self.cost.covered += 1;
            let (visits, uv) = self.visits[i];
            if visits == 0 {
                self.cost.holes += 1;
                self.holes[i] = true;
                return;
            }
            inside += 1;
            let exact = planes.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let off = [0, 1]
                .map(|k| ((uv[k] - exact.uv[k]) * size[k]).abs())
                .into_iter()
                .fold(0.0, f64::max);
            self.texel_errors.push(off);
            self.footprint_errors
                .push(off / exact.footprint(size).max(1.0));
        });
        self.cost.outside += self.touched.len() as u64 - inside;
        for i in self.touched.drain(..) {
            self.cost.repeated += u64::from(self.visits[i].0 > 1);
            self.visits[i].0 = 0;
        }
        self.last = None;
    }

    fn finish(mut self) -> Drawing {
        for (i, pixel) in self.pixels.iter_mut().enumerate() {
            if self.holes[i] && !self.filled[i] {
                *pixel = HOLE;
            }
        }
        self.cost.uv_error = UvError {
            texels: Spread::of(self.texel_errors),
            footprints: Spread::of(self.footprint_errors),
        };
        Drawing {
            pixels: self.pixels,
            cost: self.cost,
        }
    }
}
