//! Draws the benchmark scenes as whole frames and prints what each took, for the images that count
//! instructions. `firmware/run` says what a line means.

use multum::depth::{Depth, NoDepth, Z16};
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::embedded_graphics::pixelcolor::raw::RawU16;
use multum::fixed::types::I16F16;
use multum::hash::FrameHash;
use multum::perspective::Strategy;
use multum::project::ScreenVertex;
use multum::setup::Cull;
use multum::shade::Shader;
use multum::sink::Band;
use multum::texture::{SizedTexture, Texture};
use scenes_in_flash::benchmark::{HEIGHT, MOST_TRIANGLES, Scene, WIDTH, corners};

use crate::counter::Counter;
use crate::host::Output;
use crate::machine::singleton;
use crate::marker;

/// Columns of the textures, and rows.
pub const SIDE: u32 = 256;
/// Texels of the textures.
pub const TEXELS: usize = SIDE as usize * SIDE as usize;

const PIXELS: usize = WIDTH as usize * HEIGHT as usize;

type Triangles = heapless::Vec<[ScreenVertex; 3], MOST_TRIANGLES>;

/// Random numbers: Numerical Recipes' generator, its upper bits.
pub fn noise() -> impl Iterator<Item = u16> {
    let mut state: u32 = 1;
    core::iter::repeat_with(move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 16) as u16
    })
}

/// The texture of most rows: noise. Once.
#[must_use]
pub fn texture() -> Option<Texture<'static, Rgb565>> {
    Texture::new(noisy_texels()?, SIDE, SIDE).ok()
}

/// A texture with its size in its type.
pub type SizedNoise = SizedTexture<'static, Rgb565, SIDE, TEXELS>;

/// The same texels. Once, and not with [`texture`].
#[must_use]
pub fn sized_texture() -> Option<SizedNoise> {
    Some(SizedTexture::new(noisy_texels()?))
}

fn noisy_texels() -> Option<&'static [Rgb565; TEXELS]> {
    let texels = singleton!(: [Rgb565; TEXELS] = [Rgb565::new(0, 0, 0); TEXELS])?;
    for (texel, bits) in texels.iter_mut().zip(noise()) {
        *texel = RawU16::new(bits).into();
    }
    Some(texels)
}

/// What a row is of, besides its scene and depth test.
#[derive(Clone, Copy)]
pub struct Names<'a> {
    /// How perspective is corrected.
    pub strategy: &'a str,
    /// The filter and its level rate.
    pub filter: &'a str,
    /// The texels.
    pub format: &'a str,
}

/// A counter, a scene, a frame to draw it to, and a way to tell.
pub struct Bench {
    counter: Counter,
    output: Output,
    scene: &'static str,
    triangles: &'static mut Triangles,
    pixels: &'static mut [Rgb565],
    depths: &'static mut [u16],
}

impl Bench {
    /// `None`, after a message, if the timer does not count instructions. Once.
    pub fn new() -> Option<Self> {
        let mut output = Output::new();
        let Some(counter) = Counter::new() else {
            output.text("error: the timer does not count instructions\n");
            return None;
        };
        output.text("# instructions per tick: ");
        output.decimal(counter.instructions_per_tick()).text("\n");
        Some(Self {
            counter,
            output,
            scene: "",
            triangles: singleton!(: Triangles = Triangles::new())?,
            pixels: singleton!(: [Rgb565; PIXELS] = [Rgb565::new(0, 0, 0); PIXELS])?,
            depths: singleton!(: [u16; PIXELS] = [0; PIXELS])?,
        })
    }

    /// Takes a scene's triangles from flash; the frames to come are of it.
    pub fn scene(&mut self, scene: &Scene) {
        self.scene = scene.name;
        self.triangles.clear();
        for triangle in scene.triangles.iter().filter_map(corners) {
            // There is room for the largest scene.
            _ = self.triangles.push(triangle);
        }
    }

    /// A frame without a depth test.
    pub fn frame<P, S>(&mut self, names: Names<'_>, strategy: P, sampler: S)
    where
        P: Strategy,
        S: Shader<Texel: Into<Rgb565>>,
    {
        let pipeline = Pipeline {
            strategy,
            sampler,
            depth: NoDepth,
            cull: Cull::Off,
        };
        self.draw(names, "none", pipeline);
    }

    /// A frame with a depth test that every pixel passes.
    pub fn tested<P, S>(&mut self, names: Names<'_>, strategy: P, sampler: S)
    where
        P: Strategy,
        S: Shader<Texel: Into<Rgb565>>,
    {
        let depths = core::mem::take(&mut self.depths);
        if let Ok(band) = Band::new(&mut *depths, WIDTH, HEIGHT, WIDTH as usize, 0) {
            let mut depth = Z16::new(band, I16F16::ONE);
            depth.clear();
            let pipeline = Pipeline {
                strategy,
                sampler,
                depth,
                cull: Cull::Off,
            };
            self.draw(names, "z16", pipeline);
        }
        self.depths = depths;
    }

    /// Draws one frame and prints its line. The band is made before the count starts.
    #[inline(never)]
    fn draw<P, S, D>(&mut self, names: Names<'_>, depth: &str, mut pipeline: Pipeline<P, S, D>)
    where
        P: Strategy,
        S: Shader<Texel: Into<Rgb565>>,
        D: Depth,
    {
        let Ok(mut band) = Band::new(&mut *self.pixels, WIDTH, HEIGHT, WIDTH as usize, 0) else {
            return;
        };
        band.clear(Rgb565::new(0, 0, 0));
        let triangles = &*self.triangles;
        let count = self.counter.instructions(|| {
            marker::frame_begins();
            for triangle in triangles {
                pipeline.draw_triangle(&mut band, triangle);
            }
            marker::frame_ends();
        });
        let mut hash = FrameHash::new();
        hash.add(&band);
        let Names {
            strategy,
            filter,
            format,
        } = names;
        let names = [self.scene, strategy, filter, depth, format];
        self.line(names, count, [PIXELS, self.triangles.len()], hash.value());
    }

    /// Counts what `work` takes.
    pub fn count(&mut self, work: impl FnOnce()) -> u64 {
        self.counter.instructions(work)
    }

    /// The hash of 16-bit words, as if each were a pixel. Takes the words of a frame, no more.
    pub fn hash(&mut self, words: impl Iterator<Item = u16>) -> u64 {
        self.pixels.fill(Rgb565::new(0, 0, 0));
        for (pixel, word) in self.pixels.iter_mut().zip(words) {
            *pixel = RawU16::new(word).into();
        }
        let mut hash = FrameHash::new();
        if let Ok(band) = Band::new(&mut *self.pixels, WIDTH, HEIGHT, WIDTH as usize, 0) {
            hash.add(&band);
        }
        hash.value()
    }

    /// Prints a line: the chip, the names, the count by each number of parts (`-` by none), and a
    /// hash.
    pub fn line(&mut self, names: [&str; 5], count: u64, parts: [usize; 2], hash: u64) {
        self.output.text(env!("CHIP"));
        for name in names {
            self.output.text(" ").text(name);
        }
        for parts in parts.map(|parts| parts as u64) {
            let Some(hundredths) = (count * 100 + parts / 2).checked_div(parts) else {
                self.output.text(" -");
                continue;
            };
            let (whole, rest) = ((hundredths / 100) as u32, (hundredths % 100) as u32);
            self.output.text(" ").decimal(whole).text(".");
            self.output.decimal(rest / 10).decimal(rest % 10);
        }
        self.output.text(" ").hex(hash).text("\n");
    }
}
