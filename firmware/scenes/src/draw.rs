//! Draws a scene band by band, with the caller's buffers.

use multum::camera::{Camera, Perspective};
use multum::clip::ClipVolume;
use multum::corner::{ProjectedVertex, project};
use multum::depth::{Depth, NoDepth, Z16};
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::error::Error;
use multum::filter::LinearTexels;
use multum::hash::FrameHash;
use multum::lod::{EachPiece, LinearLevels, Lod, LongestAxis};
use multum::mipmap::Mipmapped;
use multum::perspective::Every;
use multum::sample::Nearest;
use multum::setup::Cull;
use multum::shade::Shader;
use multum::sink::Band;
use multum::texture::Repeat;
use multum::viewport::Viewport;

use crate::scene::{Scene, Skin};

/// The memory that a frame is drawn in.
#[derive(Debug)]
pub struct Buffers<'a> {
    /// Projected vertices: as many as the scene has.
    pub vertices: &'a mut [ProjectedVertex],
    /// The pixels of a band.
    pub pixels: &'a mut [Rgb565],
    /// The depths of a band; may be empty if the scene has no depth test.
    pub depths: &'a mut [u16],
}

/// Draws a scene as a frame of `width` x `height` pixels, in bands of `band_rows` rows from the
/// top, and gives the hash of the frame.
///
/// # Errors
///
/// What the core refuses: a camera, a frame size, or buffers that are too small.
pub fn frame(
    scene: &Scene,
    [width, height]: [u32; 2],
    band_rows: u32,
    buffers: Buffers<'_>,
) -> Result<FrameHash, Error> {
    let Buffers {
        vertices,
        pixels,
        depths,
    } = buffers;
    let aspect = width as f32 / height as f32;
    let lens = Perspective::new(scene.fov_y, aspect, scene.near)?;
    let camera = Camera::look_at(scene.eye, scene.look, scene.up, lens)?;
    let volume = ClipVolume::new(Viewport::new(width, height)?, lens.near());

    // Once a frame, for all bands.
    let mut free = &mut *vertices;
    for part in scene.parts {
        let to_clip = camera.to_clip(&part.stand)?;
        let filled = project(&part.mesh, &to_clip, &volume, free)?.len();
        free = free.get_mut(filled..).unwrap_or_default();
    }

    let mut hash = FrameHash::new();
    let mut top = 0;
    while top < height {
        let rows = band_rows.clamp(1, height - top);
        let stride = width as usize;
        let mut band = Band::new(&mut *pixels, width, rows, stride, top)?;
        band.clear(scene.background);
        if scene.depth {
            let depths = Band::new(&mut *depths, width, rows, stride, top)?;
            let mut depth = Z16::new(depths, lens.near());
            depth.clear();
            parts(scene, &volume, vertices, depth, &mut band)?;
        } else {
            parts(scene, &volume, vertices, NoDepth, &mut band)?;
        }
        hash.add(&band);
        top += rows;
    }
    Ok(hash)
}

/// Draws the parts one after the other; `vertices` holds theirs in the same order.
fn parts<D: Depth>(
    scene: &Scene,
    volume: &ClipVolume,
    vertices: &[ProjectedVertex],
    mut depth: D,
    band: &mut Band<'_, Rgb565>,
) -> Result<(), Error> {
    let mut vertices = vertices;
    for part in scene.parts {
        let mesh = (vertices, part.mesh.triangles());
        let how = (scene.cull, depth);
        depth = match &part.skin {
            Skin::Plain(texture) => {
                let sampler = Nearest::<_, Repeat>::new(*texture);
                draw(band, volume, mesh, how, sampler)?
            }
            Skin::Levels(pyramid) => {
                let lod = Lod::new(LinearLevels, LongestAxis, EachPiece);
                let sampler =
                    Mipmapped::<_, _, _, _>::new(pyramid, LinearTexels, LinearTexels, lod);
                draw(band, volume, mesh, how, sampler)?
            }
        };
        vertices = vertices
            .get(part.mesh.vertices().len()..)
            .unwrap_or_default();
    }
    Ok(())
}

/// Draws one part, and gives the depth test back.
fn draw<D: Depth, S: Shader<Texel = Rgb565>>(
    band: &mut Band<'_, Rgb565>,
    volume: &ClipVolume,
    (vertices, triangles): (&[ProjectedVertex], &[[u16; 3]]),
    (cull, depth): (Cull, D),
    sampler: S,
) -> Result<D, Error> {
    let mut pipeline = Pipeline {
        strategy: Every::<16>,
        sampler,
        depth,
        cull,
    };
    pipeline.draw(band, volume, vertices, triangles)?;
    Ok(pipeline.depth)
}
