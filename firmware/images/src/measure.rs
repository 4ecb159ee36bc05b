//! Draws whole frames and prints what they took, for the images that count instructions.

use cortex_m::Peripherals;
use multum::depth::Depth;
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::hash::FrameHash;
use multum::perspective::Strategy;
use multum::project::ScreenVertex;
use multum::shade::Shader;
use multum::sink::Band;
use scenes_in_flash::benchmark::{HEIGHT, MOST_TRIANGLES, Scene, WIDTH, corners};

use crate::counter::Counter;
use crate::host::Output;

/// Pixels of a frame.
pub const PIXELS: usize = WIDTH as usize * HEIGHT as usize;

/// The core whose code this is.
const CORE: &str = if cfg!(feature = "m0") { "m0" } else { "m4" };

/// A scene's triangles.
pub type Triangles = heapless::Vec<[ScreenVertex; 3], MOST_TRIANGLES>;

/// Takes a scene's triangles from flash.
pub fn unpack(scene: &Scene, to: &mut Triangles) {
    to.clear();
    for triangle in scene.triangles.iter().filter_map(corners) {
        // There is room for the largest scene.
        _ = to.push(triangle);
    }
}

/// Random numbers: Numerical Recipes' generator, its upper bits.
pub fn noise() -> impl Iterator<Item = u16> {
    let mut state: u32 = 1;
    core::iter::repeat_with(move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 16) as u16
    })
}

/// A counter, a frame to draw to, and a way to tell.
pub struct Bench {
    counter: Counter,
    output: Output,
    pixels: &'static mut [Rgb565],
}

impl Bench {
    /// Draws to `pixels`. `None`, after a message, if the timer does not count instructions.
    pub fn new(pixels: &'static mut [Rgb565]) -> Option<Self> {
        let mut output = Output::new();
        let Some(counter) = Peripherals::take().and_then(|all| Counter::new(all.SYST)) else {
            output.text("error: the timer does not count instructions\n");
            return None;
        };
        output.text("# instructions per tick: ");
        output.decimal(counter.instructions_per_tick()).text("\n");
        Some(Self {
            counter,
            output,
            pixels,
        })
    }

    /// Draws one frame and prints its line: the names, instructions per pixel and per triangle,
    /// and the frame's hash. The band is made before the count starts.
    #[inline(never)]
    pub fn frame<P, S, D>(
        &mut self,
        names: &[&str],
        triangles: &Triangles,
        mut pipeline: Pipeline<P, S, D>,
    ) where
        P: Strategy,
        S: Shader<Texel: Into<Rgb565>>,
        D: Depth,
    {
        let Ok(mut band) = Band::new(&mut *self.pixels, WIDTH, HEIGHT, WIDTH as usize, 0) else {
            return;
        };
        band.clear(Rgb565::new(0, 0, 0));
        let count = self.counter.instructions(|| {
            for triangle in triangles {
                pipeline.draw_triangle(&mut band, triangle);
            }
        });
        let mut hash = FrameHash::new();
        hash.add(&band);
        self.line(names, count, [PIXELS, triangles.len()], hash.value());
    }

    /// Counts what `work` takes.
    pub fn count(&mut self, work: impl FnOnce()) -> u64 {
        self.counter.instructions(work)
    }

    /// Prints a line: the names, the count by each number of parts, and a hash.
    pub fn line(&mut self, names: &[&str], count: u64, parts: [usize; 2], hash: u64) {
        self.output.text(CORE);
        for name in names {
            self.output.text(" ").text(name);
        }
        for parts in parts.map(|parts| parts as u64) {
            let Some(hundredths) = (count * 100 + parts / 2).checked_div(parts) else {
                continue;
            };
            let (whole, rest) = ((hundredths / 100) as u32, (hundredths % 100) as u32);
            self.output.text(" ").decimal(whole).text(".");
            self.output.decimal(rest / 10).decimal(rest % 10);
        }
        self.output.text(" ").hex(hash).text("\n");
    }
}
