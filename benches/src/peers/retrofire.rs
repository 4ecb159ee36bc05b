//! retrofire-core: `render::raster::tri_fill` gives scanlines with 1/w, u/w and v/w, its
//! `Scanline::fragments` divides at every pixel, and `render::tex::SamplerRepeatPot` looks the texel
//! up. The closure between them does what its own render targets do, for RGB565 instead of `Color4`.

use multum::embedded_graphics::pixelcolor::Rgb565;
use retrofire_core::geom::{Vertex, vertex};
use retrofire_core::math::point::pt3;
use retrofire_core::math::vary::ZDiv;
use retrofire_core::render::raster::{ScreenPt, tri_fill};
use retrofire_core::render::tex::{SamplerRepeatPot, TexCoord, Texture, uv};
use retrofire_core::util::{Buf2, Dims};

use crate::drawing::{Drawing, EMPTY};
use crate::scene::{Corner, PIXELS, Scene, WIDTH};
use crate::texture::{SIDE, finest};

struct Retrofire {
    triangles: Vec<[Corner; 3]>,
    texture: Texture<Buf2<Rgb565>>,
    sampler: SamplerRepeatPot,
    pixels: Vec<Rgb565>,
}

pub(super) fn drawing(scene: &Scene) -> Box<dyn Drawing> {
    let texels = finest().iter().copied();
    let texture = Texture::from(Buf2::new_from(Dims(SIDE, SIDE), texels));
    Box::new(Retrofire {
        triangles: scene.corners.clone(),
        sampler: SamplerRepeatPot::new(&texture),
        texture,
        pixels: vec![EMPTY; PIXELS],
    })
}

/// As its own step from clip space to the screen leaves a vertex: 1/w as depth, u and v over w.
fn projected(corner: Corner) -> Vertex<ScreenPt, TexCoord> {
    let ([x, y], [u, v]) = (corner.position, corner.uv);
    vertex(pt3(x, y, corner.w.recip()), uv(u, v).z_div(corner.w))
}

impl Drawing for Retrofire {
    fn clear(&mut self) {
        self.pixels.fill(EMPTY);
    }

    fn draw(&mut self) {
        let (texture, sampler) = (&self.texture, &self.sampler);
        for triangle in &self.triangles {
            tri_fill(triangle.map(projected), |mut line| {
                let start = line.y * WIDTH as usize;
                let (left, right) = (line.xs.start, line.xs.end.max(line.xs.start));
                if let Some(pixels) = self.pixels.get_mut(start + left..start + right) {
                    for (fragment, pixel) in line.fragments().zip(pixels) {
                        *pixel = sampler.sample(texture, fragment.var);
                    }
                }
            });
        }
    }

    fn pixels(&self) -> &[Rgb565] {
        &self.pixels
    }
}
