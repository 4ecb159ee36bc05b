//! Counts pieces of other lengths, and other bounds of those that choose their lengths, on a texture
//! whose sides are part of its type.
#![no_std]
#![no_main]

use images::host::exit;
use images::machine::entry;
use images::measure::{Bench, Names, sized_texture};
use multum::fixed::types::I16F16;
use multum::perspective::{Adaptive, Every};
use multum::sample::Nearest;
use multum::texture::{Repeat, Texels};
use scenes_in_flash::benchmark::SCENES;

/// Bounds in footprints, by name.
const BOUNDS: [(&str, I16F16); 3] = [
    ("adaptive:0.0625", I16F16::lit("0.0625")),
    ("adaptive:0.5", I16F16::lit("0.5")),
    ("adaptive:1", I16F16::ONE),
];

#[entry]
fn main() -> ! {
    exit(run().is_some())
}

fn run() -> Option<()> {
    let (mut bench, texture) = (Bench::new()?, sized_texture()?);
    let nearest = Nearest::<_, Repeat>::new(texture);
    for scene in SCENES {
        bench.scene(scene);
        bench.frame(names("every:4"), Every::<4>, nearest);
        bench.frame(names("every:8"), Every::<8>, nearest);
        bench.frame(names("every:32"), Every::<32>, nearest);
        bench.frame(names("every:64"), Every::<64>, nearest);
        for (name, bound) in BOUNDS {
            let adaptive = Adaptive::new(bound, texture.log2_size());
            bench.frame(names(name), adaptive, nearest);
        }
    }
    Some(())
}

const fn names(strategy: &str) -> Names<'_> {
    Names {
        strategy,
        filter: "nearest",
        format: "rgb565:sized",
    }
}
