//! What filters get wrong: each one's picture of a frame against the ideal, in which a pixel is the mean
//! of the texture over its square. Only textures are compared: which triangle a pixel shows is the
//! same in both.

use serde::Serialize;

use crate::choice::Perspective;
use crate::compare::{Visible, colour_error};
use crate::error::Error;
use crate::filtering::{Filtering, Format, Minify, Within};
use crate::frame::Frame;
use crate::reference::Planes;
use crate::reference::ideal::{Energy, supersampled};
use crate::reference::lod::Choice;
use crate::shaded::{pixels, store};

/// A picture by its channels of 8 bits; `None` where nothing is drawn.
type Drawn = Vec<Option<[f64; 4]>>;

/// One filter's picture and what is wrong with it.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The filter.
    pub filtering: Filtering,
    /// What the core draws, 8 bits a channel.
    pub pixels: Vec<[u8; 3]>,
    /// The numbers.
    pub numbers: Numbers,
}

/// A filter in numbers; energies are mean squares in squared 8-bit units.
#[derive(Clone, Debug, Serialize)]
pub struct Numbers {
    /// The filter's name.
    pub filter: String,
    /// Energy of the difference from the ideal: the sum of the next three.
    pub error: f64,
    /// Of detail that the ideal does not have: moire, sparkling.
    pub aliasing: f64,
    /// Of the ideal's detail that is missing.
    pub blur: f64,
    /// Of differences of mean colours of 8x8 pixels.
    pub shift: f64,
    /// Largest difference from the same filter in float64, in 8-bit units.
    pub from_float64: f64,
    /// The value that 99 % of the pixels do not exceed.
    pub from_float64_p99: f64,
}

/// A frame's ideal and all filters.
#[derive(Clone, Debug)]
pub struct Study {
    /// The ideal picture, 8 bits a channel.
    pub ideal: Vec<[u8; 3]>,
    /// Energy of the ideal's own detail, to compare with.
    pub signal: f64,
    /// The filters, from the plainest on.
    pub outcomes: Vec<Outcome>,
}

/// The filters that a study compares: all by their names, and the safest level.
fn filters() -> impl Iterator<Item = Minify> {
    let safest = Minify {
        image: Within::Linear,
        choice: Choice::Safest,
        taps: 1,
    };
    let named = Minify::ALL.into_iter().map(|(_, minify)| minify);
    named.chain([safest])
}

/// Draws a frame with every filter; all else is as in `how`. `samples` make a pixel of the ideal.
/// `done` is called after each picture.
///
/// # Errors
///
/// [`Error::Core`] for a frame or texture that the core refuses.
pub fn study(
    frame: &Frame,
    perspective: Perspective,
    how: &Filtering,
    samples: u32,
    mut done: impl FnMut(),
) -> Result<Study, Error> {
    let shown: Vec<_> = frame
        .triangles()
        .map(|(_, t)| t.is_shown(frame.cull))
        .collect();
    let width = frame.viewport.width() as usize;
    let plain = Filtering::default();
    let visible = Visible::find(frame, &shown, &plain)?;
    let ideal = ideal(frame, &visible, samples)?;
    done();
    let mut outcomes = Vec::new();
    let mut signal = 0.0;
    for min in filters() {
        let filtering = Filtering {
            min,
            mag: min.image,
            ..*how
        };
        let pixels = pixels(frame, perspective, frame.viewport.height(), &filtering)?.rgb();
        let exact = Visible::find(frame, &shown, &filtering)?;
        let off = colour_error(&pixels, &exact);
        let drawn: Drawn = pixels
            .iter()
            .map(|&[r, g, b]| Some([r.into(), g.into(), b.into(), 0.0]))
            .collect();
        let energy = Energy::between(&drawn, &ideal, width).unwrap_or_default();
        signal = energy.signal;
        outcomes.push(Outcome {
            numbers: Numbers {
                filter: min.to_string(),
                error: energy.error,
                aliasing: energy.aliasing,
                blur: energy.blur,
                shift: energy.shift,
                from_float64: off.max,
                from_float64_p99: off.p99,
            },
            filtering,
            pixels,
        });
        done();
    }
    let rounded = ideal
        .iter()
        .zip(&visible.colour)
        .map(|(ideal, background)| {
            ideal.map_or(*background, |[r, g, b, _]| {
                [r, g, b].map(|c| c.round() as u8)
            })
        });
    Ok(Study {
        ideal: rounded.collect(),
        signal,
        outcomes,
    })
}

/// How many pictures a study draws.
#[must_use]
pub fn pictures() -> usize {
    filters().count() + 1
}

/// The mean of the texture over each pixel.
fn ideal(frame: &Frame, visible: &Visible, samples: u32) -> Result<Drawn, Error> {
    let whole = Filtering {
        format: Format::Rgb888,
        ..Filtering::default()
    };
    let stored = store(frame, &whole)?;
    let finest: Vec<_> = stored
        .iter()
        .map(|s| s.reference().swap_remove(0))
        .collect();
    let triangles: Vec<_> = frame
        .batches
        .iter()
        .zip(&finest)
        .flat_map(|(batch, level)| {
            let wrap = [batch.wrap; 2];
            let of =
                move |t: &crate::frame::ScreenTriangle| (Planes::new(&t.corners()), level, wrap);
            batch.triangles.iter().map(of)
        })
        .collect();
    let width = frame.viewport.width() as usize;
    let pixel = |(i, triangle): (usize, &Option<usize>)| {
        let (planes, level, wrap) = triangles.get((*triangle)?)?;
        let (x, y) = ((i % width) as u32, (i / width) as u32);
        Some(supersampled(planes.as_ref()?, x, y, level, *wrap, samples))
    };
    Ok(visible.triangle.iter().enumerate().map(pixel).collect())
}
