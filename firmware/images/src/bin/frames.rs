//! Draws the chip's scenes in bands and prints the hash of each frame.
#![no_std]
#![no_main]

use images::PLAN;
use images::host::{Output, exit};
use images::machine::{entry, singleton};
use multum::corner::ProjectedVertex;
use multum::embedded_graphics::pixelcolor::Rgb565;
use scenes_in_flash::draw::{Buffers, frame};

const VERTICES: usize = PLAN.vertices();
const PIXELS: usize = PLAN.pixels(PLAN.band_rows);
const DEPTHS: usize = PLAN.depths(PLAN.band_rows);

#[entry]
fn main() -> ! {
    let vertices = singleton!(: [ProjectedVertex; VERTICES] = [ProjectedVertex::NONE; VERTICES]);
    let pixels = singleton!(: [Rgb565; PIXELS] = [Rgb565::new(0, 0, 0); PIXELS]);
    let depths = singleton!(: [u16; DEPTHS] = [0; DEPTHS]);
    let (Some(vertices), Some(pixels), Some(depths)) = (vertices, pixels, depths) else {
        exit(false);
    };

    let mut output = Output::new();
    for scene in PLAN.scenes {
        let buffers = Buffers {
            vertices: &mut *vertices,
            pixels: &mut *pixels,
            depths: &mut *depths,
        };
        let size = [PLAN.width, PLAN.height];
        let Ok(hash) = frame(scene, size, PLAN.band_rows, buffers) else {
            output.text("error: the core refuses scene ");
            output.text(scene.name).text("\n");
            exit(false);
        };
        output.text("frame ").text(scene.name).text(" ");
        output.decimal(PLAN.width).text("x").decimal(PLAN.height);
        output.text(" ").hex(hash.value()).text("\n");
    }
    exit(true)
}
