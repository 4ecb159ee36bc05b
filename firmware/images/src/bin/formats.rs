//! Counts every texel format; the strategies' image has RGB565 in rows.
#![no_std]
#![no_main]

use images::host::exit;
use images::machine::{entry, singleton};
use images::measure::{Bench, Names, SIDE, TEXELS, noise, texture};
use multum::colour::Rgba5551;
use multum::cutout::{AlphaTest, CutOut};
use multum::embedded_graphics::image::ImageRaw;
use multum::embedded_graphics::pixelcolor::raw::RawU16;
use multum::embedded_graphics::pixelcolor::{Gray8, Rgb565};
use multum::perspective::Every;
use multum::sample::{Nearest, Sampler};
use multum::shade::Shader;
use multum::texture::{Bc1, ImageTexels, Indexed4, Indexed8, Morton, Repeat, Texels, Texture};
use multum::uv::Uv;
use scenes_in_flash::benchmark::SCENES;

#[entry]
fn main() -> ! {
    exit(run().is_some())
}

fn run() -> Option<()> {
    let mut bench = Bench::new()?;
    let bytes = singleton!(: [u8; 2 * TEXELS] = [0; 2 * TEXELS])?;
    let blocks = singleton!(: [[u8; 8]; TEXELS / 16] = [[0; 8]; TEXELS / 16])?;
    let grey = singleton!(: [Gray8; TEXELS] = [Gray8::new(0); TEXELS])?;
    let palette = singleton!(: [Rgb565; 256] = [Rgb565::new(0, 0, 0); 256])?;
    let cut_out = singleton!(: [Rgba5551; TEXELS] = [Rgba5551(0); TEXELS])?;
    for (byte, bits) in bytes.iter_mut().zip(noise()) {
        *byte = bits as u8;
    }
    for (byte, bits) in blocks.as_flattened_mut().iter_mut().zip(noise()) {
        *byte = bits as u8;
    }
    for (texel, bits) in grey.iter_mut().zip(noise()) {
        *texel = Gray8::new(bits as u8);
    }
    for (colour, bits) in palette.iter_mut().zip(noise()) {
        *colour = RawU16::new(bits).into();
    }
    for (texel, bits) in cut_out.iter_mut().zip(noise()) {
        *texel = Rgba5551(bits);
    }

    let palette = &*palette;
    let palette8 = Indexed8::new(bytes.get(..TEXELS)?, palette, SIDE, SIDE).ok()?;
    let few = palette.get(..16)?;
    let palette4 = Indexed4::new(bytes.get(..TEXELS / 2)?, few, SIDE, SIDE).ok()?;
    let blocks = Bc1::new(blocks, SIDE, SIDE).ok()?;
    let morton = Morton::new(texture()?.texels(), SIDE, SIDE).ok()?;
    let image = ImageRaw::<Rgb565>::new(bytes, SIDE);
    let image = ImageTexels::new(image).ok()?;
    let grey = Texture::new(grey, SIDE, SIDE).ok()?;
    let cut_out = CutOut {
        shader: Nearest::<_, Repeat>::new(Texture::new(cut_out, SIDE, SIDE).ok()?),
        cutout: AlphaTest,
    };
    for scene in SCENES {
        bench.scene(scene);
        nearest(&mut bench, "palette8", palette8);
        nearest(&mut bench, "palette4", palette4);
        nearest(&mut bench, "bc1", blocks);
        shaded(&mut bench, "nearest", "bc1:block", BlockByBlock(blocks));
        nearest(&mut bench, "morton", morton);
        nearest(&mut bench, "image:rgb565", image);
        nearest(&mut bench, "gray8", grey);
        shaded(&mut bench, "alpha-test", "rgba5551", cut_out);
    }
    Some(())
}

fn nearest<T: Texels<Colour: Into<Rgb565>>>(bench: &mut Bench, format: &str, texels: T) {
    shaded(bench, "nearest", format, Nearest::<_, Repeat>::new(texels));
}

fn shaded<S: Shader<Texel: Into<Rgb565>>>(
    bench: &mut Bench,
    filter: &str,
    format: &str,
    shader: S,
) {
    let names = Names {
        strategy: "every:16",
        filter,
        format,
    };
    bench.frame(names, Every::<16>, shader);
}

/// Blocks whose colours are mixed as a run enters them, whatever its step.
#[derive(Clone, Copy)]
struct BlockByBlock<'a>(Bc1<'a>);

impl Sampler for BlockByBlock<'_> {
    type Texel = Rgb565;

    fn sample(&self, uv: Uv) -> Rgb565 {
        Nearest::<_, Repeat>::new(self.0).sample(uv)
    }

    fn fill<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        Rgb565: Into<P>,
    {
        self.0.fill_block_by_block(uv, step, pixels);
    }
}
