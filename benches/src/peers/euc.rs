//! euc: `Pipeline` with `rasterizer::Triangles`, which weighs the corners at every pixel of a
//! triangle's box. It takes clip coordinates; they are prepared, since a vertex shader would get
//! them from a matrix and not from the screen.

use euc::buffer::Buffer2d;
use euc::rasterizer::{BackfaceCullingDisabled, Triangles};
use euc::{DepthStrategy, Pipeline, Target};
use multum::embedded_graphics::pixelcolor::Rgb565;

use crate::drawing::{Drawing, EMPTY};
use crate::scene::{Corner, HEIGHT, Scene, WIDTH};
use crate::texture::{SIDE, finest};

/// Clip coordinates and texture coordinates.
type Vertex = ([f32; 4], (f32, f32));

struct Textured {
    texels: &'static [Rgb565],
}

impl Pipeline for Textured {
    type Vertex = Vertex;
    type VsOut = (f32, f32);
    type Pixel = Rgb565;

    #[inline]
    fn vert(&self, vertex: &Vertex) -> ([f32; 4], (f32, f32)) {
        *vertex
    }

    #[inline]
    fn frag(&self, &(u, v): &(f32, f32)) -> Rgb565 {
        // Coordinates are not negative.
        let texel = |c: f32| (c * SIDE as f32) as usize & (SIDE as usize - 1);
        self.texels[texel(v) * SIDE as usize + texel(u)]
    }

    #[inline]
    fn get_depth_strategy(&self) -> DepthStrategy {
        DepthStrategy::None
    }
}

struct Euc {
    vertices: Vec<Vertex>,
    textured: Textured,
    target: Buffer2d<Rgb565>,
}

pub(super) fn drawing(scene: &Scene) -> Box<dyn Drawing> {
    Box::new(Euc {
        vertices: scene.corners.iter().flatten().map(clip).collect(),
        textured: Textured { texels: finest() },
        target: Buffer2d::new([WIDTH as usize, HEIGHT as usize], EMPTY),
    })
}

/// From the screen back to clip space, where y is up and x and y are -w to w.
fn clip(corner: &Corner) -> Vertex {
    let ([x, y], w) = (corner.position, corner.w);
    let (x, y) = (2.0 * x / WIDTH as f32 - 1.0, 1.0 - 2.0 * y / HEIGHT as f32);
    let [u, v] = corner.uv;
    ([x * w, y * w, 0.0, w], (u, v))
}

impl Drawing for Euc {
    fn clear(&mut self) {
        self.target.clear(EMPTY);
    }

    fn draw(&mut self) {
        let (vertices, target) = (&self.vertices, &mut self.target);
        self.textured
            .draw::<Triangles<'_, Buffer2d<f32>, BackfaceCullingDisabled>, _>(
                vertices, target, None,
            );
    }

    fn pixels(&self) -> &[Rgb565] {
        self.target.as_ref()
    }
}
