//! Counts the instructions of filters and texel formats; `firmware/run` says how.
#![no_std]
#![no_main]

use cortex_m::singleton;
use cortex_m_rt::entry;
use images::host::exit;
use images::measure::{Bench, PIXELS, Triangles, noise, unpack};
use multum::colour::Rgba5551;
use multum::cutout::{AlphaTest, CutOut};
use multum::depth::NoDepth;
use multum::draw::Pipeline;
use multum::embedded_graphics::image::ImageRaw;
use multum::embedded_graphics::pixelcolor::raw::RawU16;
use multum::embedded_graphics::pixelcolor::{Gray8, Rgb565};
use multum::filter::{LinearTexels, NearestTexel};
use multum::lod::{
    EachPiece, EachPixel, EachSpan, LinearLevels, Lod, LongestAxis, NearestLevel, Rate,
};
use multum::mipmap::{Anisotropic, Mipmapped};
use multum::perspective::Every;
use multum::pyramid::average::Average;
use multum::pyramid::build::build;
use multum::pyramid::{self, Pyramid};
use multum::sample::{Bilinear, Nearest, Sampler};
use multum::setup::Cull;
use multum::shade::Shader;
use multum::texture::{Bc1, ImageTexels, Indexed4, Indexed8, Morton, Repeat, Texels, Texture};
use multum::uv::Uv;
use scenes_in_flash::benchmark::{SCENES, Scene};

const SIDE: u32 = 256;
const TEXELS: usize = SIDE as usize * SIDE as usize;
const ALL_LEVELS: usize = pyramid::texels(SIDE, SIDE);

/// The scenes that are drawn: upright, at a slant, and of small triangles.
const DRAWN: [&str; 3] = ["wall", "oblique", "mesh"];

/// The same noise in all formats.
struct Textures {
    pyramid: Pyramid<Texture<'static, Rgb565>>,
    bytes: &'static [u8],
    blocks: &'static [[u8; 8]],
    grey: &'static [Gray8],
    palette: &'static [Rgb565],
    cut_out: &'static [Rgba5551],
}

#[entry]
fn main() -> ! {
    let pixels = singleton!(: [Rgb565; PIXELS] = [Rgb565::new(0, 0, 0); PIXELS]);
    let triangles = singleton!(: Triangles = Triangles::new());
    let (Some(pixels), Some(triangles)) = (pixels, triangles) else {
        exit(false);
    };
    let Some(mut bench) = Bench::new(pixels) else {
        exit(false);
    };
    let Some(textures) = textures(&mut bench) else {
        exit(false);
    };
    for scene in SCENES {
        if DRAWN.contains(&scene.name) {
            unpack(scene, triangles);
            let mut filters = Filters {
                bench: &mut bench,
                scene,
                triangles,
            };
            if filters.mipmapped(&textures.pyramid).is_none()
                || filters.formats(&textures).is_none()
            {
                exit(false);
            }
        }
    }
    exit(true)
}

/// Fills the buffers, and counts what pyramids take: `pyramid average`, per texel of level 0.
fn textures(bench: &mut Bench) -> Option<Textures> {
    let texels = singleton!(: [Rgb565; ALL_LEVELS] = [Rgb565::new(0, 0, 0); ALL_LEVELS])?;
    let bytes = singleton!(: [u8; 2 * TEXELS] = [0; 2 * TEXELS])?;
    let blocks = singleton!(: [[u8; 8]; TEXELS / 16] = [[0; 8]; TEXELS / 16])?;
    let grey = singleton!(: [Gray8; TEXELS] = [Gray8::new(0); TEXELS])?;
    let palette = singleton!(: [Rgb565; 256] = [Rgb565::new(0, 0, 0); 256])?;
    let cut_out = singleton!(: [Rgba5551; TEXELS] = [Rgba5551(0); TEXELS])?;
    for (texel, bits) in texels.iter_mut().zip(noise()).take(TEXELS) {
        *texel = RawU16::new(bits).into();
    }
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
    for (name, average) in [("light", Average::Light), ("stored", Average::Stored)] {
        let count = bench.count(|| _ = build(texels, SIDE, SIDE, average));
        bench.line(&["pyramid", name], count, [TEXELS, 1], 0);
    }
    Some(Textures {
        pyramid: build(texels, SIDE, SIDE, Average::Stored).ok()?,
        bytes,
        blocks,
        grey,
        palette,
        cut_out,
    })
}

/// One scene.
struct Filters<'a> {
    bench: &'a mut Bench,
    scene: &'a Scene,
    triangles: &'a Triangles,
}

impl Filters<'_> {
    fn frame<S: Shader<Texel: Into<Rgb565>>>(&mut self, filter: &str, format: &str, sampler: S) {
        let pipeline = Pipeline {
            strategy: Every::<16>,
            sampler,
            depth: NoDepth,
            cull: Cull::Off,
        };
        let names = [self.scene.name, "every:16", filter, "none", format];
        self.bench.frame(&names, self.triangles, pipeline);
    }

    fn nearest<T: Texels<Colour: Into<Rgb565>>>(&mut self, format: &str, texels: T) {
        self.frame("nearest", format, Nearest::<_, Repeat>::new(texels));
    }

    fn nearest_level(
        &mut self,
        name: &str,
        pyramid: &Pyramid<Texture<'_, Rgb565>>,
        rate: impl Rate,
    ) {
        let lod = Lod::new(NearestLevel, LongestAxis, rate);
        let shader = Mipmapped::<_, _, _, _, Repeat>::new(pyramid, NearestTexel, NearestTexel, lod);
        self.frame(name, "rgb565", shader);
    }

    fn mipmapped(&mut self, pyramid: &Pyramid<Texture<'_, Rgb565>>) -> Option<()> {
        let finest = *pyramid.level(0);
        self.nearest("rgb565", finest);
        self.frame("bilinear", "rgb565", Bilinear::<_, Repeat>::new(finest));
        self.nearest_level("nearest-mip-nearest:span", pyramid, EachSpan);
        self.nearest_level("nearest-mip-nearest:piece", pyramid, EachPiece);
        self.nearest_level("nearest-mip-nearest:pixel", pyramid, EachPixel);
        let (linear, rule) = (LinearTexels, LongestAxis);
        let lod = Lod::new(NearestLevel, rule, EachPiece);
        let shader = Mipmapped::<_, _, _, _, Repeat>::new(pyramid, linear, linear, lod);
        self.frame("linear-mip-nearest:piece", "rgb565", shader);
        let lod = Lod::new(LinearLevels, rule, EachPixel);
        let shader = Mipmapped::<_, _, _, _, Repeat>::new(pyramid, linear, linear, lod);
        self.frame("trilinear:pixel", "rgb565", shader);
        let lod = Lod::new(LinearLevels, rule, EachPiece);
        let shader = Mipmapped::<_, _, _, _, Repeat>::new(pyramid, linear, linear, lod);
        self.frame("trilinear:piece", "rgb565", shader);
        self.frame(
            "anisotropic:4:piece",
            "rgb565",
            Anisotropic::<4, _>::new(shader),
        );
        Some(())
    }

    fn formats(&mut self, textures: &Textures) -> Option<()> {
        let Textures { bytes, palette, .. } = textures;
        let (few, palette) = (palette.get(..16)?, *palette);
        let indices = bytes.get(..TEXELS)?;
        self.nearest(
            "palette8",
            Indexed8::new(indices, palette, SIDE, SIDE).ok()?,
        );
        let indices = bytes.get(..TEXELS / 2)?;
        self.nearest("palette4", Indexed4::new(indices, few, SIDE, SIDE).ok()?);
        let blocks = Bc1::new(textures.blocks, SIDE, SIDE).ok()?;
        self.nearest("bc1", blocks);
        self.frame("nearest", "bc1:block", BlockByBlock(blocks));
        let finest = textures.pyramid.level(0);
        self.nearest("morton", Morton::new(finest.texels(), SIDE, SIDE).ok()?);
        let image = ImageRaw::<Rgb565>::new(bytes, SIDE);
        self.nearest("image:rgb565", ImageTexels::new(image).ok()?);
        self.nearest("gray8", Texture::new(textures.grey, SIDE, SIDE).ok()?);
        let cut_out = Texture::new(textures.cut_out, SIDE, SIDE).ok()?;
        let shader = CutOut {
            shader: Nearest::<_, Repeat>::new(cut_out),
            cutout: AlphaTest,
        };
        self.frame("alpha-test", "rgba5551", shader);
        Some(())
    }
}

/// Blocks whose colours are mixed as a run enters them, whatever its step.
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
