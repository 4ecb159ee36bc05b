//! Counts what is done before a pixel is drawn: vertices, clipping, and building pyramids.
#![no_std]
#![no_main]

use core::hint::black_box;

use images::filters::unbuilt;
use images::host::exit;
use images::machine::{entry, singleton};
use images::measure::{Bench, SIDE, TEXELS};
use multum::camera::{Camera, Perspective};
use multum::clip::{ClipVertex, ClipVolume, transform};
use multum::embedded_graphics::pixelcolor::raw::RawU16;
use multum::embedded_graphics::prelude::RawData;
use multum::fixed::types::I16F16;
use multum::project::ScreenVertex;
use multum::pyramid::average::Average;
use multum::pyramid::build::build;
use multum::viewport::Viewport;
use scenes_in_flash::baked::spot::SCENE;
use scenes_in_flash::benchmark::{HEIGHT, WIDTH};
use scenes_in_flash::draw::NO_VERTEX;

const VERTICES: usize = SCENE.vertices();
/// Most triangles of the mesh.
const TRIANGLES: usize = 2 * VERTICES;
type Triangles = heapless::Vec<[ClipVertex; 3], TRIANGLES>;

#[entry]
fn main() -> ! {
    exit(run().is_some())
}

fn run() -> Option<()> {
    let mut bench = Bench::new()?;
    let part = SCENE.parts.first()?;
    let vertices = singleton!(: [ClipVertex; VERTICES] = [NO_VERTEX; VERTICES])?;
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

/// A line of the geometry stage: by the number of what was done.
fn row(bench: &mut Bench, name: &str, count: u64, number: usize, hash: u64) {
    bench.line(["spot", name, "-", "-", "-"], count, [number, 0], hash);
}

/// The lower halves of a vertex.
fn words(v: &ClipVertex) -> [u16; 5] {
    [v.x, v.y, v.w, v.u, v.v].map(|c| c.to_bits() as u16)
}
