//! Counts affine mapping within a bound, and every 16 pixels beyond it.
#![no_std]
#![no_main]

use images::host::exit;
use images::machine::entry;
use images::measure::{Bench, Names, sized_texture};
use multum::perspective::{AffineWithin, Every};
use multum::sample::Nearest;
use multum::texture::Repeat;
use scenes_in_flash::benchmark::SCENES;

#[entry]
fn main() -> ! {
    exit(run().is_some())
}

fn run() -> Option<()> {
    let (mut bench, texture) = (Bench::new()?, sized_texture()?);
    let strategy = AffineWithin::new(Every::<16>, AffineWithin::DEFAULT_BOUND);
    let sampler = Nearest::<_, Repeat>::new(texture);
    for scene in SCENES {
        bench.scene(scene);
        let names = Names {
            strategy: "affine-within",
            filter: "nearest",
            format: "rgb565:sized",
        };
        bench.frame(names, strategy, sampler);
        bench.tested(names, strategy, sampler);
    }
    Some(())
}
