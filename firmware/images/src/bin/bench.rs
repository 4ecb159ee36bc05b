//! Counts the instructions of the benchmark scenes; `firmware/run` says how.
#![no_std]
#![no_main]

use cortex_m::{Peripherals, singleton};
use cortex_m_rt::entry;
use images::counter::Counter;
use images::host::{Output, exit};
use multum::depth::{Depth, NoDepth, Z16};
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::embedded_graphics::pixelcolor::raw::RawU16;
use multum::fixed::types::I16F16;
use multum::hash::FrameHash;
use multum::perspective::{Affine, Every, PerPixel, Strategy};
use multum::project::ScreenVertex;
use multum::sample::Nearest;
use multum::setup::Cull;
use multum::sink::Band;
use multum::texture::{Repeat, Texture};
use scenes_in_flash::benchmark::{HEIGHT, MOST_TRIANGLES, SCENES, Scene, WIDTH, corners};

const PIXELS: usize = WIDTH as usize * HEIGHT as usize;
const SIDE: u32 = 256;
const TEXELS: usize = SIDE as usize * SIDE as usize;

type Triangles = heapless::Vec<[ScreenVertex; 3], MOST_TRIANGLES>;

/// The core whose code this is.
const CORE: &str = if cfg!(feature = "m0") { "m0" } else { "m4" };

#[entry]
fn main() -> ! {
    let mut output = Output::new();
    let counter = Peripherals::take().and_then(|all| Counter::new(all.SYST));
    let pixels = singleton!(: [Rgb565; PIXELS] = [Rgb565::new(0, 0, 0); PIXELS]);
    let depths = singleton!(: [u16; PIXELS] = [0; PIXELS]);
    let texels = singleton!(: [Rgb565; TEXELS] = [Rgb565::new(0, 0, 0); TEXELS]);
    let triangles = singleton!(: Triangles = Triangles::new());
    let (Some(counter), Some(pixels), Some(depths)) = (counter, pixels, depths) else {
        output.text("error: the timer does not count instructions\n");
        exit(false);
    };
    let (Some(texels), Some(triangles)) = (texels, triangles) else {
        exit(false);
    };
    noise(texels);
    let Ok(texture) = Texture::new(&*texels, SIDE, SIDE) else {
        exit(false);
    };
    output.text("# instructions per tick: ");
    output.decimal(counter.instructions_per_tick()).text("\n");
    let mut bench = Bench {
        counter,
        output,
        texture,
        pixels,
        depths,
    };
    for scene in SCENES {
        triangles.clear();
        for triangle in scene.triangles.iter().filter_map(corners) {
            // There is room for the largest scene.
            _ = triangles.push(triangle);
        }
        bench.scene(scene, triangles);
    }
    exit(true)
}

/// Random texels: Numerical Recipes' generator, its upper bits.
fn noise(texels: &mut [Rgb565]) {
    let mut state: u32 = 1;
    for texel in texels {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        *texel = RawU16::new((state >> 16) as u16).into();
    }
}

struct Bench {
    counter: Counter,
    output: Output,
    texture: Texture<'static, Rgb565>,
    pixels: &'static mut [Rgb565],
    depths: &'static mut [u16],
}

impl Bench {
    fn scene(&mut self, scene: &Scene, triangles: &Triangles) {
        self.without_depth(scene, triangles, "affine", Affine);
        self.without_depth(scene, triangles, "every:16", Every::<16>);
        self.without_depth(scene, triangles, "exact", PerPixel);
        let depths = core::mem::take(&mut self.depths);
        if let Ok(band) = Band::new(&mut *depths, WIDTH, HEIGHT, WIDTH as usize, 0) {
            let mut depth = Z16::new(band, I16F16::ONE);
            depth.clear();
            self.line(scene, triangles, ["every:16", "z16"], Every::<16>, depth);
        }
        self.depths = depths;
    }

    fn without_depth<P: Strategy>(
        &mut self,
        scene: &Scene,
        triangles: &Triangles,
        name: &str,
        strategy: P,
    ) {
        self.line(scene, triangles, [name, "none"], strategy, NoDepth);
    }

    /// Draws one frame and prints its line. The band and the pipeline are made before the count
    /// starts.
    #[inline(never)]
    fn line<P: Strategy, D: Depth>(
        &mut self,
        scene: &Scene,
        triangles: &Triangles,
        names: [&str; 2],
        strategy: P,
        depth: D,
    ) {
        let Ok(mut band) = Band::new(&mut *self.pixels, WIDTH, HEIGHT, WIDTH as usize, 0) else {
            return;
        };
        band.clear(Rgb565::new(0, 0, 0));
        let mut pipeline = Pipeline {
            strategy,
            sampler: Nearest::<_, Repeat>::new(self.texture),
            depth,
            cull: Cull::Off,
        };
        let count = self.counter.instructions(|| {
            for triangle in triangles {
                pipeline.draw_triangle(&mut band, triangle);
            }
        });
        let mut hash = FrameHash::new();
        hash.add(&band);
        self.output.text(CORE).text(" ").text(scene.name);
        for name in names {
            self.output.text(" ").text(name);
        }
        for parts in [PIXELS as u64, triangles.len() as u64] {
            let Some(hundredths) = (count * 100 + parts / 2).checked_div(parts) else {
                continue;
            };
            let (whole, rest) = ((hundredths / 100) as u32, (hundredths % 100) as u32);
            self.output.text(" ").decimal(whole).text(".");
            self.output.decimal(rest / 10).decimal(rest % 10);
        }
        self.output.text(" ").hex(hash.value()).text("\n");
    }
}
