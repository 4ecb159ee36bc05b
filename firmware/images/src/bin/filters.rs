//! Counts every filter and level rate.
#![no_std]
#![no_main]

use images::filters::{levels, linear_nearest_level, nearest_level, trilinear};
use images::host::exit;
use images::machine::entry;
use images::measure::{Bench, Names};
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::filter::{LinearTexels, LinearTexels5};
use multum::lod::{EachPiece, EachPixel, EachSpan, EachTriangle};
use multum::mipmap::Anisotropic;
use multum::perspective::Every;
use multum::sample::Bilinear;
use multum::shade::Shader;
use multum::texture::Repeat;
use scenes_in_flash::benchmark::SCENES;

#[entry]
fn main() -> ! {
    exit(run().is_some())
}

fn run() -> Option<()> {
    let (mut bench, levels) = (Bench::new()?, levels()?);
    // The strategies' image has the nearest texel of one level.
    let bilinear = || Bilinear::<_, Repeat>::new(*levels.level(0));
    let bilinear_5 = || Bilinear::<_, Repeat, Repeat, LinearTexels5>::new(*levels.level(0));
    for scene in SCENES {
        bench.scene(scene);
        both(&mut bench, "bilinear", bilinear);
        both(&mut bench, "bilinear:5", bilinear_5);
        plain(
            &mut bench,
            "nearest-mip-nearest:triangle",
            nearest_level(&levels, EachTriangle),
        );
        both(&mut bench, "nearest-mip-nearest:span", || {
            nearest_level(&levels, EachSpan)
        });
        both(&mut bench, "nearest-mip-nearest:piece", || {
            nearest_level(&levels, EachPiece)
        });
        plain(
            &mut bench,
            "nearest-mip-nearest:pixel",
            nearest_level(&levels, EachPixel),
        );
        both(&mut bench, "linear-mip-nearest:piece", || {
            linear_nearest_level(&levels)
        });
        both(&mut bench, "trilinear:piece", || {
            trilinear(&levels, LinearTexels, EachPiece)
        });
        both(&mut bench, "trilinear:5:piece", || {
            trilinear(&levels, LinearTexels5, EachPiece)
        });
        let each_pixel = trilinear(&levels, LinearTexels, EachPixel);
        plain(&mut bench, "trilinear:pixel", each_pixel);
        let anisotropic = Anisotropic::<4, _>::new(trilinear(&levels, LinearTexels, EachPiece));
        plain(&mut bench, "anisotropic:4:piece", anisotropic);
    }
    Some(())
}

const fn names(filter: &str) -> Names<'_> {
    Names {
        strategy: "every:16",
        filter,
        format: "rgb565",
    }
}

fn plain(bench: &mut Bench, filter: &str, shader: impl Shader<Texel = Rgb565>) {
    bench.frame(names(filter), Every::<16>, shader);
}

fn both<S: Shader<Texel = Rgb565>>(bench: &mut Bench, filter: &str, shader: impl Fn() -> S) {
    bench.frame(names(filter), Every::<16>, shader());
    bench.tested(names(filter), Every::<16>, shader());
}
