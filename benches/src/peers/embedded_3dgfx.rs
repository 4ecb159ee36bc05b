//! embedded-3dgfx: `draw_zbuffered_with_textures`, its function for a projected textured triangle.
//! Its coordinates are whole pixels, and there is no way without a depth buffer.

use std::convert::Infallible;

use embedded_3dgfx::draw::draw_zbuffered_with_textures;
use embedded_3dgfx::texture::{Texture, TextureManager};
use embedded_3dgfx::{DrawPrimitive, Z_MAX_VALUE, ZDepth};
use multum::embedded_graphics::Pixel;
use multum::embedded_graphics::draw_target::DrawTarget;
use multum::embedded_graphics::geometry::{OriginDimensions, Size};
use multum::embedded_graphics::pixelcolor::Rgb565;
use nalgebra::Point2;

use crate::drawing::{Drawing, EMPTY};
use crate::error::Error;
use crate::scene::{Corner, HEIGHT, PIXELS, Scene, WIDTH};
use crate::texture::{SIDE, finest};

/// A frame in memory, as embedded-graphics draws to one: a pixel outside is left out.
struct Frame(Vec<Rgb565>);

impl OriginDimensions for Frame {
    fn size(&self) -> Size {
        Size::new(WIDTH, HEIGHT)
    }
}

impl DrawTarget for Frame {
    type Color = Rgb565;
    type Error = Infallible;

    #[inline]
    fn draw_iter<I>(&mut self, pixels: I) -> Result<(), Infallible>
    where
        I: IntoIterator<Item = Pixel<Rgb565>>,
    {
        for Pixel(at, colour) in pixels {
            if let (Ok(x), Ok(y)) = (u32::try_from(at.x), u32::try_from(at.y))
                && x < WIDTH
                && let Some(pixel) = self.0.get_mut((y * WIDTH + x) as usize)
            {
                *pixel = colour;
            }
        }
        Ok(())
    }
}

struct Embedded3dgfx {
    triangles: Vec<[Corner; 3]>,
    textures: TextureManager<1>,
    texture: u32,
    frame: Frame,
    depths: Vec<ZDepth>,
}

pub(super) fn drawing(scene: &Scene) -> Result<Box<dyn Drawing>, Error> {
    let mut textures = TextureManager::new();
    let texture = textures
        .add_texture(Texture::new(finest(), SIDE, SIDE))
        .ok_or_else(|| Error::content("embedded-3dgfx", "has no room for a texture"))?;
    Ok(Box::new(Embedded3dgfx {
        triangles: scene.corners.clone(),
        textures,
        texture,
        frame: Frame(vec![EMPTY; PIXELS]),
        depths: vec![Z_MAX_VALUE; PIXELS],
    }))
}

impl Drawing for Embedded3dgfx {
    fn clear(&mut self) {
        self.frame.0.fill(EMPTY);
        self.depths.fill(Z_MAX_VALUE);
    }

    fn draw(&mut self) {
        for corners in &self.triangles {
            let whole = |c: f32| c.round() as i32;
            let triangle = DrawPrimitive::TexturedTriangleWithDepth {
                points: corners.map(|c| Point2::from(c.position.map(whole))),
                // Anything that grows with the distance, in 16.16.
                depths: corners.map(|c| c.w),
                ws: corners.map(|c| c.w),
                uvs: corners.map(|c| c.uv),
                texture_id: self.texture,
            };
            draw_zbuffered_with_textures(
                triangle,
                &mut self.frame,
                &mut self.depths,
                WIDTH as usize,
                &self.textures,
                None,
                None,
            );
        }
    }

    fn pixels(&self) -> &[Rgb565] {
        &self.frame.0
    }
}
