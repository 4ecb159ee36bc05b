//! Counts the instructions of the benchmark scenes; `firmware/run` says how.
#![no_std]
#![no_main]

use cortex_m::singleton;
use cortex_m_rt::entry;
use images::host::exit;
use images::measure::{Bench, PIXELS, Triangles, noise, unpack};
use multum::depth::{Depth, NoDepth, Z16};
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::embedded_graphics::pixelcolor::raw::RawU16;
use multum::fixed::types::I16F16;
use multum::perspective::{Affine, Every, PerPixel, Strategy};
use multum::sample::Nearest;
use multum::setup::Cull;
use multum::sink::Band;
use multum::texture::{Repeat, Texture};
use scenes_in_flash::benchmark::{HEIGHT, SCENES, Scene, WIDTH};

const SIDE: u32 = 256;
const TEXELS: usize = SIDE as usize * SIDE as usize;

#[entry]
fn main() -> ! {
    let pixels = singleton!(: [Rgb565; PIXELS] = [Rgb565::new(0, 0, 0); PIXELS]);
    let depths = singleton!(: [u16; PIXELS] = [0; PIXELS]);
    let texels = singleton!(: [Rgb565; TEXELS] = [Rgb565::new(0, 0, 0); TEXELS]);
    let triangles = singleton!(: Triangles = Triangles::new());
    let (Some(pixels), Some(depths), Some(texels)) = (pixels, depths, texels) else {
        exit(false);
    };
    let (Some(triangles), Some(bench)) = (triangles, Bench::new(pixels)) else {
        exit(false);
    };
    for (texel, bits) in texels.iter_mut().zip(noise()) {
        *texel = RawU16::new(bits).into();
    }
    let Ok(texture) = Texture::new(&*texels, SIDE, SIDE) else {
        exit(false);
    };
    let mut strategies = Strategies {
        bench,
        texture,
        depths,
    };
    for scene in SCENES {
        unpack(scene, triangles);
        strategies.scene(scene, triangles);
    }
    exit(true)
}

struct Strategies {
    bench: Bench,
    texture: Texture<'static, Rgb565>,
    depths: &'static mut [u16],
}

impl Strategies {
    fn scene(&mut self, scene: &Scene, triangles: &Triangles) {
        let names = |strategy| [scene.name, strategy, "none"];
        self.frame(names("affine"), triangles, Affine, NoDepth);
        self.frame(names("every:16"), triangles, Every::<16>, NoDepth);
        self.frame(names("exact"), triangles, PerPixel, NoDepth);
        let depths = core::mem::take(&mut self.depths);
        if let Ok(band) = Band::new(&mut *depths, WIDTH, HEIGHT, WIDTH as usize, 0) {
            let mut depth = Z16::new(band, I16F16::ONE);
            depth.clear();
            let names = [scene.name, "every:16", "z16"];
            self.frame(names, triangles, Every::<16>, depth);
        }
        self.depths = depths;
    }

    fn frame<P: Strategy, D: Depth>(
        &mut self,
        names: [&str; 3],
        triangles: &Triangles,
        strategy: P,
        depth: D,
    ) {
        let pipeline = Pipeline {
            strategy,
            sampler: Nearest::<_, Repeat>::new(self.texture),
            depth,
            cull: Cull::Off,
        };
        self.bench.frame(&names, triangles, pipeline);
    }
}
