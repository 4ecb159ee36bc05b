//! What the integration tests share: sinks that watch what is drawn, references written from the
//! rules and not from the core, and seeded random numbers.

pub mod colours;
pub mod exact;
pub mod frame;
pub mod homogeneous;
pub mod random;

use multum::depth::NoDepth;
use multum::draw::Pipeline;
use multum::fixed::types::{I16F16, I24F8};
use multum::perspective::Affine;
use multum::project::ScreenVertex;
use multum::sample::Sampler;
use multum::setup::Cull;
use multum::uv::Uv;

/// A screen position in subpixels (1/256 px), x right and y down.
pub type Point = [i32; 2];

/// The guard band in subpixels: coordinates keep to plus and minus this.
pub const GUARD: i32 = 1024 * 256;

/// Gives every pixel one value.
#[derive(Clone, Copy, Debug)]
pub struct Flat(pub u8);

impl Sampler for Flat {
    type Texel = u8;

    fn sample(&self, _: Uv) -> u8 {
        self.0
    }
}

/// Gives every pixel its texture coordinates, so that they can be compared without a texture.
#[derive(Clone, Copy, Debug)]
pub struct Coordinates;

impl Sampler for Coordinates {
    type Texel = Uv;

    fn sample(&self, uv: Uv) -> Uv {
        uv
    }
}

/// The pipeline for tests of coverage alone.
#[must_use]
pub fn flat(value: u8) -> Pipeline<Affine, Flat, NoDepth> {
    Pipeline {
        strategy: Affine,
        sampler: Flat(value),
        depth: NoDepth,
        cull: Cull::Off,
    }
}

/// A vertex at a point, with depth 1 and no texture coordinates.
///
/// # Panics
///
/// Beyond the guard band.
#[must_use]
pub fn at([x, y]: Point) -> ScreenVertex {
    ScreenVertex::new(
        I24F8::from_bits(x),
        I24F8::from_bits(y),
        I16F16::ONE,
        [I16F16::ZERO; 2],
    )
    .expect("a point inside the guard band")
}
