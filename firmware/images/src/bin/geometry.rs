//! Counts what is done before a pixel is drawn: vertices, clipping, and building pyramids; and what a mesh
//! takes that is drawn in bands.
#![no_std]
#![no_main]

use core::hint::black_box;

use images::filters::unbuilt;
use images::host::exit;
use images::machine::{entry, singleton};
use images::measure::{Bench, SIDE, TEXELS, texture};
use multum::camera::{Camera, Perspective};
use multum::clip::{ClipVertex, ClipVolume, transform};
use multum::corner::{Corner, ProjectedVertex, project};
use multum::depth::NoDepth;
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::embedded_graphics::pixelcolor::raw::RawU16;
use multum::embedded_graphics::prelude::RawData;
use multum::fixed::types::I16F16;
use multum::hash::FrameHash;
use multum::perspective::Affine;
use multum::project::ScreenVertex;
use multum::pyramid::average::Average;
use multum::pyramid::build::build;
use multum::sample::Nearest;
use multum::setup::Cull;
use multum::sink::Band;
use multum::texture::{Repeat, Texture};
use multum::viewport::{MAX_VIEWPORT, Viewport};
use scenes_in_flash::baked::spot::SCENE;
use scenes_in_flash::benchmark::{HEIGHT, WIDTH};

const VERTICES: usize = SCENE.vertices();
/// Most triangles of the mesh.
const TRIANGLES: usize = 2 * VERTICES;
/// Rows of a band.
const ROWS: u32 = 16;
const BAND: usize = WIDTH as usize * ROWS as usize;
type Triangles = heapless::Vec<[ClipVertex; 3], TRIANGLES>;

#[entry]
fn main() -> ! {
    exit(run().is_some())
}

fn run() -> Option<()> {
    let mut bench = Bench::new()?;
    let part = SCENE.parts.first()?;
    let vertices = singleton!(: [ClipVertex; VERTICES] = [ClipVertex::NONE; VERTICES])?;
    let screen = singleton!(: [Option<ScreenVertex>; VERTICES] = [None; VERTICES])?;
    let triangles = singleton!(: Triangles = Triangles::new())?;

    let viewport = Viewport::new(WIDTH, HEIGHT).ok()?;
    let lens = Perspective::new(SCENE.fov_y, WIDTH as f32 / HEIGHT as f32, SCENE.near).ok()?;
    let camera = Camera::look_at(SCENE.eye, SCENE.look, SCENE.up, lens).ok()?;
    let to_clip = camera.to_clip(&part.stand).ok()?;
    let given = part.mesh.vertices().len();
    let count = bench.count(|| _ = transform(&part.mesh, &to_clip, vertices));
    let vertices = vertices.get(..given)?;
    let hash = bench.hash(vertices.iter().flat_map(words));
    row(&mut bench, "transform", count, given, hash);

    let count = bench.count(|| {
        for (to, from) in screen.iter_mut().zip(vertices) {
            *to = ScreenVertex::project(from, viewport);
        }
    });
    let xy = |v: &ScreenVertex| [v.x(), v.y()].map(|c| c.to_bits() as u16);
    let hash = bench.hash(screen.iter().flatten().flat_map(xy));
    row(&mut bench, "project", count, given, hash);

    let volume = ClipVolume::new(viewport, lens.near());
    let projected = singleton!(: [ProjectedVertex; VERTICES] = [ProjectedVertex::NONE; VERTICES])?;
    let count = bench.count(|| _ = project(&part.mesh, &to_clip, &volume, projected));
    let known = projected.iter().filter_map(|v| v.screen(&volume));
    let hash = bench.hash(known.flat_map(|v| xy(&v)));
    row(&mut bench, "transform+project", count, given, hash);
    let projected = projected.get(..given)?;

    let pixels = singleton!(: [Rgb565; BAND] = [Rgb565::new(0, 0, 0); BAND])?;
    let mut drawing = Drawing {
        volume,
        triangles: part.mesh.triangles(),
        texture: texture()?,
        pixels,
    };
    drawing.count(&mut bench, vertices, ["draw:beside", "draw:bands"])?;
    let names = ["draw:beside:projected", "draw:bands:projected"];
    drawing.count(&mut bench, projected, names)?;

    // A near plane that is in front of the mesh, and one through its middle.
    let depths = || vertices.iter().map(|v| v.w);
    let (nearest, farthest) = (depths().min()?, depths().max()?);
    let middle = I16F16::from_bits(nearest.to_bits().midpoint(farthest.to_bits()));
    for (name, near, cut) in [("clip:inside", nearest, false), ("clip:near", middle, true)] {
        let volume = ClipVolume::new(viewport, near);
        let corners = |indices: [u16; 3]| {
            let [a, b, c] = indices.map(|i| vertices.get(usize::from(i)).copied());
            Some([a?, b?, c?])
        };
        let chosen = |triangle: &[ClipVertex; 3]| {
            let inside = triangle.iter().filter(|v| v.w >= near).count();
            if cut { inside % 3 != 0 } else { inside == 3 }
        };
        triangles.clear();
        for triangle in part.mesh.triangles().iter().copied().filter_map(corners) {
            if chosen(&triangle) {
                // There is room for all.
                _ = triangles.push(triangle);
            }
        }
        let count = bench.count(|| {
            for triangle in &*triangles {
                black_box(&volume.clip(triangle));
            }
        });
        let mut sum = 0;
        for triangle in &*triangles {
            for word in volume.clip(triangle).iter().flat_map(words) {
                sum = u32::rotate_left(sum, 5) ^ u32::from(word);
            }
        }
        let hash = bench.hash([sum as u16, (sum >> 16) as u16].into_iter());
        row(&mut bench, name, count, triangles.len(), hash);
    }

    let texels = unbuilt()?;
    for (name, average) in [("light", Average::Light), ("stored", Average::Stored)] {
        let count = bench.count(|| _ = build(texels, SIDE, SIDE, average));
        let coarser = texels.iter().skip(TEXELS);
        let hash = bench.hash(coarser.map(|texel| RawU16::from(*texel).into_inner()));
        let names = ["pyramid", name, "-", "-", "rgb565"];
        bench.line(names, count, [TEXELS, 0], hash);
    }
    Some(())
}

/// A mesh, and a band to draw it to.
struct Drawing {
    volume: ClipVolume,
    triangles: &'static [[u16; 3]],
    texture: Texture<'static, Rgb565>,
    pixels: &'static mut [Rgb565; BAND],
}

impl Drawing {
    /// A line for a band that the mesh lies beside, and one for all bands of a frame: affine, nearest
    /// texel, back faces culled.
    fn count<V: Corner>(
        &mut self,
        bench: &mut Bench,
        vertices: &[V],
        [beside, bands]: [&str; 2],
    ) -> Option<()> {
        const BELOW: u32 = MAX_VIEWPORT - ROWS;
        for (name, tops) in [(beside, BELOW..MAX_VIEWPORT), (bands, 0..HEIGHT)] {
            let mut hash = FrameHash::new();
            let mut count = 0;
            for top in tops.step_by(ROWS as usize) {
                let pixels = &mut self.pixels[..];
                let mut band = Band::new(pixels, WIDTH, ROWS, WIDTH as usize, top).ok()?;
                band.clear(Rgb565::new(0, 0, 0));
                let mut pipeline = Pipeline {
                    strategy: Affine,
                    sampler: Nearest::<_, Repeat>::new(self.texture),
                    depth: NoDepth,
                    cull: Cull::Back,
                };
                count += bench.count(|| {
                    _ = pipeline.draw(&mut band, &self.volume, vertices, self.triangles);
                });
                hash.add(&band);
            }
            row(bench, name, count, self.triangles.len(), hash.value());
        }
        Some(())
    }
}

/// A line of the geometry stage: by the number of what was done.
fn row(bench: &mut Bench, name: &str, count: u64, number: usize, hash: u64) {
    bench.line(["spot", name, "-", "-", "-"], count, [number, 0], hash);
}

/// The lower halves of a vertex.
fn words(v: &ClipVertex) -> [u16; 5] {
    [v.x, v.y, v.w, v.u, v.v].map(|c| c.to_bits() as u16)
}
