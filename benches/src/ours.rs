//! The core's ways to draw that are measured.

use std::fmt;

use multum::depth::{NoDepth, Z16};
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::filter::{ImageFilter, LinearTexels, LinearTexels5};
use multum::fixed::types::I16F16;
use multum::lod::{EachPiece, LinearLevels, Lod, LongestAxis};
use multum::mipmap::Mipmapped;
use multum::perspective::{Adaptive, Affine, Every, PerPixel, Strategy};
use multum::project::ScreenVertex;
use multum::pyramid::Pyramid;
use multum::sample::{Bilinear, Nearest};
use multum::setup::Cull;
use multum::shade::Shader;
use multum::sink::Band;
use multum::texture::{Repeat, SizedTexture, Texels, Texture};

use crate::drawing::{Drawing, EMPTY};
use crate::error::Error;
use crate::scene::{HEIGHT, PIXELS, Scene, WIDTH};
use crate::texture::{SIDE, TEXELS, finest, pyramid};

/// A strategy, a filter and a depth test, with an RGB565 texture that repeats. Each is compiled on its
/// own, so there are only those that are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// No perspective.
    Affine,
    /// Perspective every 16 pixels.
    Every16,
    /// As often as an error of 0.25 footprints needs.
    Adaptive,
    /// At every pixel.
    Exact,
    /// Every 16 pixels, testing and writing a 16-bit depth buffer.
    Every16Z16,
    /// Every 16 pixels, four texels a pixel.
    Every16Bilinear,
    /// The same, weights of 5 bits.
    Every16Bilinear5,
    /// Every 16 pixels, four texels of each of two levels, chosen for every piece of 16 pixels.
    Every16Trilinear,
    /// The same, weights of 5 bits.
    Every16Trilinear5,
}

impl Way {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Affine,
        Self::Every16,
        Self::Adaptive,
        Self::Exact,
        Self::Every16Z16,
        Self::Every16Bilinear,
        Self::Every16Bilinear5,
        Self::Every16Trilinear,
        Self::Every16Trilinear5,
    ];

    /// Strategy, filter and depth test as `budgets.toml` names them.
    #[must_use]
    pub fn names(self) -> [&'static str; 3] {
        match self {
            Self::Affine => ["affine", "nearest", "none"],
            Self::Every16 => ["every:16", "nearest", "none"],
            Self::Adaptive => ["adaptive:0.25", "nearest", "none"],
            Self::Exact => ["exact", "nearest", "none"],
            Self::Every16Z16 => ["every:16", "nearest", "z16"],
            Self::Every16Bilinear => ["every:16", "bilinear", "none"],
            Self::Every16Bilinear5 => ["every:16", "bilinear:5", "none"],
            Self::Every16Trilinear => ["every:16", "trilinear:piece", "none"],
            Self::Every16Trilinear5 => ["every:16", "trilinear:5:piece", "none"],
        }
    }

    /// A frame drawn in this way.
    ///
    /// # Errors
    ///
    /// [`Error::Core`] if the core refuses the texture.
    pub fn drawing(self, scene: Scene) -> Result<Box<dyn Drawing>, Error> {
        let texture = SizedTexture::<_, SIDE, TEXELS>::new(finest());
        let nearest = Nearest::<_, Repeat>::new(texture);
        let every_16 = Every::<16>;
        Ok(match self {
            Self::Affine => Box::new(Plain::new(Affine, nearest, scene)),
            Self::Every16 => Box::new(Plain::new(every_16, nearest, scene)),
            Self::Adaptive => {
                let quarter = I16F16::from_bits(1 << 14);
                let adaptive = Adaptive::new(quarter, texture.log2_size());
                Box::new(Plain::new(adaptive, nearest, scene))
            }
            Self::Exact => Box::new(Plain::new(PerPixel, nearest, scene)),
            Self::Every16Z16 => Box::new(Tested {
                plain: Plain::new(every_16, nearest, scene),
                depths: vec![Z16::EMPTY; PIXELS],
            }),
            Self::Every16Bilinear => {
                let bilinear = Bilinear::<_, Repeat>::new(texture);
                Box::new(Plain::new(every_16, bilinear, scene))
            }
            Self::Every16Bilinear5 => {
                let bilinear = Bilinear::<_, Repeat, Repeat, LinearTexels5>::new(texture);
                Box::new(Plain::new(every_16, bilinear, scene))
            }
            Self::Every16Trilinear => trilinear(LinearTexels, scene)?,
            Self::Every16Trilinear5 => trilinear(LinearTexels5, scene)?,
        })
    }
}

fn trilinear(filter: impl ImageFilter + 'static, scene: Scene) -> Result<Box<dyn Drawing>, Error> {
    // Samplers borrow their pyramid, and a drawing lives about as long as the program.
    let levels = Pyramid::<Texture<'_, _>>::new(pyramid(), SIDE, SIDE)?;
    let levels = Box::leak(Box::new(levels));
    let lod = Lod::new(LinearLevels, LongestAxis, EachPiece);
    let trilinear = Mipmapped::<_, _, _, _, Repeat>::new(levels, filter, filter, lod);
    Ok(Box::new(Plain::new(Every::<16>, trilinear, scene)))
}

impl fmt::Display for Way {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [strategy, filter, depth] = self.names();
        // The levels of a pyramid differ in size.
        let format = match self {
            Self::Every16Trilinear | Self::Every16Trilinear5 => "rgb565",
            _ => "rgb565:sized",
        };
        write!(f, "{strategy} {filter} {depth} {format}")
    }
}

/// Without a depth test.
struct Plain<P, S> {
    strategy: P,
    shader: S,
    triangles: Vec<[ScreenVertex; 3]>,
    pixels: Vec<Rgb565>,
}

impl<P, S> Plain<P, S> {
    fn new(strategy: P, shader: S, scene: Scene) -> Self {
        Self {
            strategy,
            shader,
            triangles: scene.vertices,
            pixels: vec![EMPTY; PIXELS],
        }
    }
}

impl<P, S> Drawing for Plain<P, S>
where
    P: Strategy + Copy,
    S: Shader<Texel = Rgb565> + Copy,
{
    fn clear(&mut self) {
        self.pixels.fill(EMPTY);
    }

    fn draw(&mut self) {
        // As long as the frame, so there is always a band.
        let Ok(mut band) = Band::new(&mut self.pixels, WIDTH, HEIGHT, WIDTH as usize, 0) else {
            return;
        };
        let mut pipeline = Pipeline {
            strategy: self.strategy,
            sampler: self.shader,
            depth: NoDepth,
            cull: Cull::Off,
        };
        for triangle in &self.triangles {
            pipeline.draw_triangle(&mut band, triangle);
        }
    }

    fn pixels(&self) -> &[Rgb565] {
        &self.pixels
    }
}

/// With a 16-bit depth buffer.
struct Tested<P, S> {
    plain: Plain<P, S>,
    depths: Vec<u16>,
}

impl<P, S> Drawing for Tested<P, S>
where
    P: Strategy + Copy,
    S: Shader<Texel = Rgb565> + Copy,
{
    fn clear(&mut self) {
        self.plain.clear();
        self.depths.fill(Z16::EMPTY);
    }

    fn draw(&mut self) {
        let band = Band::new(&mut self.plain.pixels, WIDTH, HEIGHT, WIDTH as usize, 0);
        let depths = Band::new(&mut self.depths, WIDTH, HEIGHT, WIDTH as usize, 0);
        let (Ok(mut band), Ok(depths)) = (band, depths) else {
            return;
        };
        let mut pipeline = Pipeline {
            strategy: self.plain.strategy,
            sampler: self.plain.shader,
            // No corner of the scenes is nearer than 1.
            depth: Z16::new(depths, I16F16::ONE),
            cull: Cull::Off,
        };
        for triangle in &self.plain.triangles {
            pipeline.draw_triangle(&mut band, triangle);
        }
    }

    fn pixels(&self) -> &[Rgb565] {
        self.plain.pixels()
    }
}
