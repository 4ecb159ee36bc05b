//! Counts the texture whose sides are part of its type, with the strategies that matter most.
#![no_std]
#![no_main]

use images::host::exit;
use images::machine::entry;
use images::measure::{Bench, Names, sized_texture};
use multum::filter::LinearTexels5;
use multum::perspective::{Adaptive, Affine, Every, PerPixel, Quadratic, Strategy};
use multum::sample::{Bilinear, Nearest};
use multum::texture::{Repeat, Texels};
use scenes_in_flash::benchmark::SCENES;

#[entry]
fn main() -> ! {
    exit(run().is_some())
}

fn run() -> Option<()> {
    let (mut bench, texture) = (Bench::new()?, sized_texture()?);
    let adaptive = Adaptive::new(Adaptive::DEFAULT_BOUND, texture.log2_size());
    let nearest = Nearest::<_, Repeat>::new(texture);
    let bilinear = Bilinear::<_, Repeat>::new(texture);
    let bilinear_5 = Bilinear::<_, Repeat, Repeat, LinearTexels5>::new(texture);
    for scene in SCENES {
        bench.scene(scene);
        both(&mut bench, "affine", Affine, nearest);
        both(&mut bench, "every:16", Every::<16>, nearest);
        both(&mut bench, "adaptive", adaptive, nearest);
        both(&mut bench, "quadratic:16", Quadratic::<16>, nearest);
        both(&mut bench, "exact", PerPixel, nearest);
        bench.frame(names("every:16", "bilinear"), Every::<16>, bilinear);
        bench.frame(names("every:16", "bilinear:5"), Every::<16>, bilinear_5);
    }
    Some(())
}

type Sampler = Nearest<images::measure::SizedNoise, Repeat>;

fn both<P: Strategy + Copy>(bench: &mut Bench, name: &str, strategy: P, sampler: Sampler) {
    bench.frame(names(name, "nearest"), strategy, sampler);
    bench.tested(names(name, "nearest"), strategy, sampler);
}

const fn names<'a>(strategy: &'a str, filter: &'a str) -> Names<'a> {
    Names {
        strategy,
        filter,
        format: "rgb565:sized",
    }
}
