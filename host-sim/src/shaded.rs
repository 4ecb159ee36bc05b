//! Drawing a frame with the filters and texel formats that were chosen at run time.

use std::sync::Arc;

use multum::cutout::{AlphaTest, CutOut};
use multum::depth::{Depth, NoDepth, Z16};
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::{Rgb565, Rgb888, RgbColor};
use multum::setup::Cull;
use multum::shade::Shader;
use multum::sink::Band;

use crate::any::AnyStrategy;
use crate::any_shader::AnyShader;
use crate::choice::{Perspective, with_strategy};
use crate::error::Error;
use crate::filtering::Filtering;
use crate::frame::{Frame, ScreenTriangle};
use crate::picture::Picture;
use crate::render::{colours, in_bands};
use crate::scene::BACKGROUND;
use crate::stored::{AnyPyramid, Stored};

/// A frame's pixels, as the display has them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Pixels {
    /// For textures that have no more bits.
    Rgb565(Vec<Rgb565>),
    /// For those that have.
    Rgb888(Vec<Rgb888>),
}

impl Pixels {
    /// With 8 bits a channel, row by row from the top.
    #[must_use]
    pub fn rgb(&self) -> Vec<[u8; 3]> {
        match self {
            Self::Rgb565(pixels) => pixels.iter().map(|c| crate::compare::rgb(*c)).collect(),
            Self::Rgb888(pixels) => pixels.iter().map(|c| [c.r(), c.g(), c.b()]).collect(),
        }
    }
}

/// The textures of a frame in the format that was chosen, batch by batch.
///
/// # Errors
///
/// [`Error::Core`] for a texture that the core refuses.
pub fn store(frame: &Frame, filtering: &Filtering) -> Result<Vec<Arc<Stored>>, Error> {
    // Batches that share a picture share what is made of it.
    let mut known: Vec<(&Arc<Picture>, Arc<Stored>)> = Vec::new();
    let mut all = Vec::with_capacity(frame.batches.len());
    for batch in &frame.batches {
        let picture = &batch.picture;
        let same = known.iter().find(|(other, _)| Arc::ptr_eq(other, picture));
        let stored = if let Some((_, stored)) = same {
            Arc::clone(stored)
        } else {
            let stored = Arc::new(Stored::new(picture, filtering.format, filtering.average)?);
            known.push((picture, Arc::clone(&stored)));
            stored
        };
        all.push(stored);
    }
    Ok(all)
}

/// Draws a frame in bands of `rows` rows.
///
/// # Errors
///
/// [`Error::Core`] for a texture that the core refuses.
pub fn pixels(
    frame: &Frame,
    perspective: Perspective,
    rows: u32,
    filtering: &Filtering,
) -> Result<Pixels, Error> {
    if filtering.is_plain() {
        return colours(frame, perspective, rows).map(Pixels::Rgb565);
    }
    let textures = store(frame, filtering)?;
    with_textures(frame, perspective, rows, filtering, &textures)
}

/// The same with textures, one for each batch, in the place of the frame's own.
///
/// # Errors
///
/// [`Error::Core`] for a texture that the core refuses.
pub fn with_textures(
    frame: &Frame,
    perspective: Perspective,
    rows: u32,
    filtering: &Filtering,
    textures: &[Arc<Stored>],
) -> Result<Pixels, Error> {
    let pyramids: Vec<_> = textures
        .iter()
        .map(|stored| stored.pyramid())
        .collect::<Result<_, _>>()?;
    let painter = Painter {
        frame,
        perspective,
        rows,
        filtering,
        pyramids: &pyramids,
    };
    let has_eight_bits = |pyramid: &AnyPyramid<'_>| {
        !matches!(pyramid, AnyPyramid::Rgb565(_) | AnyPyramid::Rgba5551(_))
    };
    if pyramids.iter().any(has_eight_bits) {
        painter.paint(Rgb888::from(BACKGROUND)).map(Pixels::Rgb888)
    } else {
        painter.paint(BACKGROUND).map(Pixels::Rgb565)
    }
}

struct Painter<'a> {
    frame: &'a Frame,
    perspective: Perspective,
    rows: u32,
    filtering: &'a Filtering,
    pyramids: &'a [AnyPyramid<'a>],
}

impl Painter<'_> {
    fn paint<P>(&self, background: P) -> Result<Vec<P>, Error>
    where
        P: Copy
            + From<Rgb565>
            + From<Rgb888>
            + From<multum::embedded_graphics::pixelcolor::Gray8>
            + From<multum::colour::Rgba5551>
            + From<multum::colour::Rgba8888>,
    {
        in_bands(self.frame, self.rows, background, |band, mut depth| {
            for (batch, pyramid) in self.frame.batches.iter().zip(self.pyramids) {
                let (triangles, cull) = (&batch.triangles, self.frame.cull);
                let picture = &batch.picture;
                let size = (picture.width().ilog2(), picture.height().ilog2());
                let filtering = self.filtering;
                let wrap = batch.wrap;
                with_strategy!(self.perspective, size, strategy => {
                    let how = (AnyStrategy::new(strategy), cull);
                    let depth = depth.as_deref_mut();
                    match pyramid {
                        AnyPyramid::Rgb565(p) => {
                            draw(band, depth, how, AnyShader::filtering(filtering, p, wrap), triangles);
                        }
                        AnyPyramid::Rgb888(p) => {
                            draw(band, depth, how, AnyShader::filtering(filtering, p, wrap), triangles);
                        }
                        AnyPyramid::Gray8(p) => {
                            draw(band, depth, how, AnyShader::filtering(filtering, p, wrap), triangles);
                        }
                        AnyPyramid::Rgba5551(p) => {
                            let shader = AnyShader::filtering(filtering, p, wrap);
                            draw(band, depth, how, seen(shader), triangles);
                        }
                        AnyPyramid::Rgba8888(p) => {
                            let shader = AnyShader::filtering(filtering, p, wrap);
                            draw(band, depth, how, seen(shader), triangles);
                        }
                    }
                });
            }
            Ok(())
        })
    }
}

/// Without the pixels that alpha hides.
fn seen<C>(shader: AnyShader<'_, C>) -> CutOut<AnyShader<'_, C>, AlphaTest> {
    CutOut {
        shader,
        cutout: AlphaTest,
    }
}

fn draw<P, S>(
    band: &mut Band<'_, P>,
    depth: Option<&mut Z16<'_>>,
    (strategy, cull): (AnyStrategy<'_>, Cull),
    sampler: S,
    triangles: &[ScreenTriangle],
) where
    S: Shader<Texel: Into<P>>,
{
    match depth {
        Some(depth) => {
            let pipeline = Pipeline {
                strategy,
                sampler,
                depth,
                cull,
            };
            draw_all(band, pipeline, triangles);
        }
        None => {
            let depth = NoDepth;
            let pipeline = Pipeline {
                strategy,
                sampler,
                depth,
                cull,
            };
            draw_all(band, pipeline, triangles);
        }
    }
}

fn draw_all<P, S, D>(
    band: &mut Band<'_, P>,
    mut pipeline: Pipeline<AnyStrategy<'_>, S, D>,
    triangles: &[ScreenTriangle],
) where
    S: Shader<Texel: Into<P>>,
    D: Depth,
{
    for triangle in triangles {
        pipeline.draw_triangle(band, &triangle.vertices);
    }
}
