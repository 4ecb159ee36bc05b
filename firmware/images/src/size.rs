//! What the images share that show what a feature takes of the flash: the caller's memory, and a
//! way from the entry to the exit on which an image does one thing.
//!
//! The image `size-nothing` does nothing there, and has no code of the core: what another has more
//! is the price of what it does. So nothing here may need a routine of the compiler's library that
//! drawing needs too, as a 64-bit product or clearing memory: it would come for nothing.

use core::hint::black_box;
use core::sync::atomic::{AtomicBool, Ordering};

use multum::camera::{Camera, Perspective};
use multum::clip::{ClipVertex, ClipVolume, transform};
use multum::corner::{ProjectedVertex, project};
use multum::depth::{Depth, NoDepth, Z16};
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::embedded_graphics::pixelcolor::raw::RawU16;
use multum::embedded_graphics::prelude::RawData;
use multum::error::Error;
use multum::filter::NearestTexel;
use multum::fixed::types::{I16F16, I24F8};
use multum::geometry::{Mesh, Vertex};
use multum::lod::{EachSpan, Lod, LongestAxis, NearestLevel};
use multum::mipmap::Mipmapped;
use multum::perspective::{Every, Strategy};
use multum::project::ScreenVertex;
use multum::pyramid::average::Average;
use multum::pyramid::{self, Pyramid};
use multum::sample::Nearest;
use multum::setup::Cull;
use multum::shade::Shader;
use multum::sink::Band;
use multum::texture::{Repeat, Texture};
use multum::transform::Transform;
use multum::viewport::Viewport;

use crate::host::{Output, exit};

const SIDE: u32 = 64;
const TEXELS: usize = SIDE as usize * SIDE as usize;
const WIDTH: u32 = 64;
const HEIGHT: u32 = 32;
const PIXELS: usize = WIDTH as usize * HEIGHT as usize;
const NEAR: I16F16 = I16F16::ONE;

/// A picture, as two bytes a texel.
static BYTES: [u8; 2 * TEXELS] = {
    let mut bytes = [0; 2 * TEXELS];
    let mut state: u32 = 1;
    let mut byte = 0;
    while byte < bytes.len() {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        bytes[byte] = (state >> 24) as u8;
        byte += 1;
    }
    bytes
};

// The image's own data, told from the core's code and tables by their names: see runner/sizes.py.

/// Its levels, computed by the compiler.
static SIZE_LEVELS: [Rgb565; pyramid::texels(SIDE, SIDE)] =
    pyramid::constant::rgb565(&BYTES, SIDE, SIDE, Average::Light);

/// The first of them alone.
static SIZE_PICTURE: [Rgb565; TEXELS] = {
    let mut texels = [Rgb565::new(0, 0, 0); TEXELS];
    let mut texel = 0;
    while texel < TEXELS {
        texels[texel] = SIZE_LEVELS[texel];
        texel += 1;
    }
    texels
};

/// Where the levels lie.
static SIZE_PYRAMID: Pyramid<Texture<'static, Rgb565>> =
    match Pyramid::<Texture<'_, _>>::new(&SIZE_LEVELS, SIDE, SIDE) {
        Ok(pyramid) => pyramid,
        Err(_) => panic!("not a pyramid"),
    };

/// x, y, w, u and v of a triangle's corners, in whole units.
static SIZE_CORNERS: [[i8; 5]; 3] = [[0, 0, 1, 0, 0], [0, 32, 1, 0, 2], [64, 32, 4, 8, 8]];

/// A triangle in clip space that the near plane cuts.
static SIZE_CLIPPED: [ClipVertex; 3] = [
    clip_vertex([-1, 1, 1, 0, 0]),
    clip_vertex([-2, -2, 0, 0, 2]),
    clip_vertex([4, -4, 4, 8, 8]),
];

static SIZE_TRIANGLES: [[u16; 3]; 1] = [[0, 1, 2]];

static SIZE_VERTICES: [Vertex; 3] = [
    Vertex::from_bits([-1 << 16, 1 << 16, -1 << 16], [0, 0]),
    Vertex::from_bits([-2 << 16, -2 << 16, 0], [0, 2 << 16]),
    Vertex::from_bits([4 << 16, -4 << 16, -4 << 16], [8 << 16, 8 << 16]),
];

static SIZE_MESH: Mesh<'static> = match Mesh::new(&SIZE_VERTICES, &SIZE_TRIANGLES) {
    Ok(mesh) => mesh,
    Err(_) => panic!("not a mesh"),
};

const fn clip_vertex([x, y, w, u, v]: [i32; 5]) -> ClipVertex {
    ClipVertex {
        x: I16F16::from_bits(x << 16),
        y: I16F16::from_bits(y << 16),
        w: I16F16::from_bits(w << 16),
        u: I16F16::from_bits(u << 16),
        v: I16F16::from_bits(v << 16),
    }
}

/// All levels.
pub const PYRAMID: &Pyramid<Texture<'static, Rgb565>> = &SIZE_PYRAMID;

/// The first level, in flash with all others.
pub const FINEST: Texture<'static, Rgb565> = texture(SIZE_LEVELS.split_at(TEXELS).0);

/// The same picture without other levels.
pub const PICTURE: Texture<'static, Rgb565> = texture(&SIZE_PICTURE);

const fn texture(texels: &'static [Rgb565]) -> Texture<'static, Rgb565> {
    match Texture::new(texels, SIDE, SIDE) {
        Ok(texture) => texture,
        Err(_) => panic!("not a texture"),
    }
}

/// The nearest texel.
#[must_use]
pub const fn nearest() -> Nearest<Texture<'static, Rgb565>, Repeat> {
    Nearest::new(FINEST)
}

/// The nearest texel of a level for each span.
pub fn level_each_span() -> impl Shader<Texel = Rgb565> {
    let lod = Lod::new(NearestLevel, LongestAxis, EachSpan);
    Mipmapped::<_, _, _, _, Repeat>::new(PYRAMID, NearestTexel, NearestTexel, lod)
}

/// The caller's memory, which all images have, whatever they need of it.
pub struct Memory {
    pixels: [Rgb565; PIXELS],
    depths: [u16; PIXELS],
    vertices: [ClipVertex; 3],
    projected: [ProjectedVertex; 3],
}

/// Does what the image is for, prints a sum over the frame and ends.
pub fn run(work: impl FnOnce(&mut Memory) -> Result<(), Error>) -> ! {
    let Some(memory) = memory() else {
        exit(false);
    };
    let done = work(memory);
    // In memory at all, though nobody should need it.
    black_box(&mut *memory);
    let sum = memory.pixels.iter().fold(0, |sum: u32, pixel| {
        sum.rotate_left(5) ^ u32::from(RawU16::from(*pixel).into_inner())
    });
    Output::new().hex(u64::from(sum)).text("\n");
    exit(done.is_ok())
}

/// The memory, once. Zero when the program starts, so that no image has code that clears it.
fn memory() -> Option<&'static mut Memory> {
    static mut MEMORY: Memory = Memory {
        pixels: [Rgb565::new(0, 0, 0); PIXELS],
        depths: [0; PIXELS],
        vertices: [ClipVertex::NONE; 3],
        projected: [ProjectedVertex::NONE; 3],
    };
    static TAKEN: AtomicBool = AtomicBool::new(false);
    if TAKEN.load(Ordering::Relaxed) {
        return None;
    }
    TAKEN.store(true, Ordering::Relaxed);
    // SAFETY: reached once, for the image has one thread and no interrupts.
    unsafe { (&raw mut MEMORY).as_mut() }
}

/// Draws a triangle that is given on the screen, without a depth test.
pub fn draw<P: Strategy, S: Shader<Texel: Into<Rgb565>>>(strategy: P, sampler: S) -> ! {
    run(|memory| {
        let (mut band, corners) = (band(&mut memory.pixels)?, corners()?);
        pipeline(strategy, sampler, NoDepth).draw_triangle(&mut band, &corners);
        Ok(())
    })
}

/// Every 16 columns, with a depth test.
pub fn draw_tested<S: Shader<Texel: Into<Rgb565>>>(sampler: S) -> ! {
    run(|memory| {
        let (mut band, corners) = (band(&mut memory.pixels)?, corners()?);
        let depth = Z16::new(self::band(&mut memory.depths)?, NEAR);
        pipeline(Every::<16>, sampler, depth).draw_triangle(&mut band, &corners);
        Ok(())
    })
}

/// Makes a band and takes a triangle, but does not draw it.
pub fn prepare() -> ! {
    run(|memory| {
        black_box((&mut band(&mut memory.pixels)?, &corners()?));
        Ok(())
    })
}

/// Every 16 columns, a triangle in clip space.
pub fn draw_clipped<S: Shader<Texel: Into<Rgb565>>>(sampler: S) -> ! {
    run(|memory| {
        let vertices = black_box(&SIZE_CLIPPED);
        let mut band = band(&mut memory.pixels)?;
        let triangles = black_box(&SIZE_TRIANGLES);
        pipeline(Every::<16>, sampler, NoDepth).draw(&mut band, &volume()?, vertices, triangles)
    })
}

/// Every 16 columns, a mesh seen by a camera.
pub fn draw_mesh<S: Shader<Texel: Into<Rgb565>>>(
    camera: impl FnOnce() -> Result<Camera, Error>,
    sampler: S,
) -> ! {
    run(|memory| {
        let mut band = band(&mut memory.pixels)?;
        let mut pipeline = pipeline(Every::<16>, sampler, NoDepth);
        mesh(camera()?, &mut memory.vertices, &mut band, &mut pipeline)
    })
}

/// The same with vertices that are projected once.
pub fn draw_mesh_projected<S: Shader<Texel: Into<Rgb565>>>(
    camera: impl FnOnce() -> Result<Camera, Error>,
    sampler: S,
) -> ! {
    run(|memory| {
        let mut band = band(&mut memory.pixels)?;
        let mesh = black_box(&SIZE_MESH);
        let to_clip = camera()?.to_clip(&black_box(Transform::IDENTITY))?;
        let volume = volume()?;
        let vertices = project(mesh, &to_clip, &volume, &mut memory.projected)?;
        let mut pipeline = pipeline(Every::<16>, sampler, NoDepth);
        pipeline.draw(&mut band, &volume, vertices, mesh.triangles())
    })
}

/// A mesh with a depth test.
pub fn draw_mesh_tested<S: Shader<Texel: Into<Rgb565>>>(
    camera: impl FnOnce() -> Result<Camera, Error>,
    sampler: S,
) -> ! {
    run(|memory| {
        let mut band = band(&mut memory.pixels)?;
        let depth = Z16::new(self::band(&mut memory.depths)?, NEAR);
        let mut pipeline = pipeline(Every::<16>, sampler, depth);
        mesh(camera()?, &mut memory.vertices, &mut band, &mut pipeline)
    })
}

/// A camera at the origin, from its matrices.
///
/// # Errors
///
/// None, for this camera.
pub fn camera() -> Result<Camera, Error> {
    Ok(Camera {
        view: black_box(Transform::IDENTITY),
        lens: Perspective::from_scales(black_box(I16F16::ONE), black_box(I16F16::ONE), NEAR)?,
    })
}

/// The same from angles and directions, in floating point.
///
/// # Errors
///
/// None, for this camera.
pub fn camera_from_angles() -> Result<Camera, Error> {
    let lens = Perspective::new(black_box(1.5), black_box(1.0), 1.0)?;
    let [eye, target, up] = black_box([[0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]);
    Camera::look_at(eye, target, up, lens)
}

fn mesh<S: Shader<Texel: Into<Rgb565>>, D: Depth>(
    camera: Camera,
    vertices: &mut [ClipVertex],
    band: &mut Band<'_, Rgb565>,
    pipeline: &mut Pipeline<Every<16>, S, D>,
) -> Result<(), Error> {
    let mesh = black_box(&SIZE_MESH);
    let to_clip = camera.to_clip(&black_box(Transform::IDENTITY))?;
    let vertices = transform(mesh, &to_clip, vertices)?;
    pipeline.draw(band, &volume()?, vertices, mesh.triangles())
}

fn pipeline<P, S, D>(strategy: P, sampler: S, depth: D) -> Pipeline<P, S, D> {
    Pipeline {
        strategy,
        sampler,
        depth,
        cull: Cull::Off,
    }
}

fn band<P: Copy>(buffer: &mut [P]) -> Result<Band<'_, P>, Error> {
    Band::new(buffer, WIDTH, HEIGHT, WIDTH as usize, 0)
}

fn volume() -> Result<ClipVolume, Error> {
    Ok(ClipVolume::new(Viewport::new(WIDTH, HEIGHT)?, NEAR))
}

/// Hidden from the compiler, which would draw the triangle itself.
fn corners() -> Result<[ScreenVertex; 3], Error> {
    let [a, b, c] = black_box(&SIZE_CORNERS).map(|corner| {
        let [x, y, w, u, v] = corner.map(i32::from);
        ScreenVertex::new(
            I24F8::from_bits(x << 8),
            I24F8::from_bits(y << 8),
            I16F16::from_bits(w << 16),
            [u, v].map(|c| I16F16::from_bits(c << 16)),
        )
    });
    match (a, b, c) {
        (Some(a), Some(b), Some(c)) => Ok([a, b, c]),
        _ => Err(Error::Overflow),
    }
}
