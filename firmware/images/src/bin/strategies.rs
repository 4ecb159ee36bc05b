//! Counts every strategy, with and without a depth test, on all scenes.
#![no_std]
#![no_main]

use core::cell::Cell;

use images::host::exit;
use images::machine::{entry, singleton};
use images::measure::{Bench, Names, texture};
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::perspective::{
    Adaptive, Affine, ConstantZ, ConstantZColumns, Every, Extrapolated, PerPixel, Quadratic,
    Strategy, Subdivided,
};
use multum::sample::Nearest;
use multum::texture::{Repeat, Texture};
use scenes_in_flash::benchmark::{SCENES, WIDTH};

const COLUMNS: usize = WIDTH as usize;

#[entry]
fn main() -> ! {
    exit(run().is_some())
}

fn run() -> Option<()> {
    let (mut bench, texture) = (Bench::new()?, texture()?);
    let columns = singleton!(: [Cell<u32>; COLUMNS] = [const { Cell::new(0) }; COLUMNS])?;
    let size = texture.log2_size();
    let adaptive = Adaptive::new(Adaptive::DEFAULT_BOUND, size);
    let subdivided = Subdivided::new(Subdivided::DEFAULT_BOUND, size);
    for scene in SCENES {
        bench.scene(scene);
        both(&mut bench, texture, "affine", Affine);
        both(&mut bench, texture, "every:4", Every::<4>);
        both(&mut bench, texture, "every:8", Every::<8>);
        both(&mut bench, texture, "every:16", Every::<16>);
        both(&mut bench, texture, "every:32", Every::<32>);
        both(&mut bench, texture, "every:64", Every::<64>);
        both(&mut bench, texture, "adaptive", adaptive);
        both(&mut bench, texture, "exact", PerPixel);
        both(&mut bench, texture, "constant-z", ConstantZ);
        let by_columns = ConstantZColumns::new(columns);
        both(&mut bench, texture, "constant-z-columns", by_columns);
        both(&mut bench, texture, "quadratic:16", Quadratic::<16>);
        both(&mut bench, texture, "quadratic:32", Quadratic::<32>);
        both(&mut bench, texture, "extrapolated", Extrapolated);
        both(&mut bench, texture, "subdivided", subdivided);
    }
    Some(())
}

fn both<P: Strategy + Copy>(
    bench: &mut Bench,
    texture: Texture<'static, Rgb565>,
    name: &str,
    strategy: P,
) {
    let names = Names {
        strategy: name,
        filter: "nearest",
        format: "rgb565",
    };
    let sampler = || Nearest::<_, Repeat>::new(texture);
    bench.frame(names, strategy, sampler());
    bench.tested(names, strategy, sampler());
}
