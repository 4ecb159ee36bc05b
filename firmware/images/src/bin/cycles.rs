//! The frames whose executed addresses are traced, to count cycles.
#![no_std]
#![no_main]

use images::filters::{levels, trilinear};
use images::host::exit;
use images::machine::entry;
use images::measure::{Bench, Names, sized_texture};
use multum::filter::LinearTexels;
use multum::lod::EachPiece;
use multum::perspective::{Adaptive, Affine, Every, PerPixel};
use multum::sample::{Bilinear, Nearest};
use multum::texture::{Repeat, Texels};
use scenes_in_flash::benchmark::SCENES;

#[entry]
fn main() -> ! {
    exit(run().is_some())
}

fn run() -> Option<()> {
    let (mut bench, levels) = (Bench::new()?, levels()?);
    let texture = sized_texture()?;
    let nearest = || Nearest::<_, Repeat>::new(texture);
    let adaptive = Adaptive::new(Adaptive::DEFAULT_BOUND, texture.log2_size());
    for scene in SCENES {
        bench.scene(scene);
        bench.frame(names("affine", "nearest"), Affine, nearest());
        bench.frame(names("every:16", "nearest"), Every::<16>, nearest());
        bench.frame(names("adaptive", "nearest"), adaptive, nearest());
        bench.frame(names("exact", "nearest"), PerPixel, nearest());
        bench.tested(names("every:16", "nearest"), Every::<16>, nearest());
        let bilinear = Bilinear::<_, Repeat>::new(texture);
        bench.frame(names("every:16", "bilinear"), Every::<16>, bilinear);
        let trilinear = trilinear(&levels, LinearTexels, EachPiece);
        let of_levels = Names {
            format: "rgb565",
            ..names("every:16", "trilinear:piece")
        };
        bench.frame(of_levels, Every::<16>, trilinear);
    }
    Some(())
}

const fn names<'a>(strategy: &'a str, filter: &'a str) -> Names<'a> {
    Names {
        strategy,
        filter,
        format: "rgb565:sized",
    }
}
