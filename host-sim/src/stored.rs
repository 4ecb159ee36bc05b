//! Textures as a chip stores them: a picture enters, its pyramid in some format leaves, for the core
//! to sample and as plain numbers for the reference.

use multum::colour::{Rgba5551, Rgba8888};
use multum::embedded_graphics::pixelcolor::{Gray8, GrayColor, Rgb565, Rgb888, RgbColor};
use multum::pyramid::average::Average;
use multum::pyramid::build::{build, build_indexed, coarser_texels};
use multum::pyramid::{self, Pyramid, level_size, levels};
use multum::texture::{Bc1, Indexed4, Indexed8, Morton, Texture};

use crate::any::AnyTexels;
use crate::encode;
use crate::error::Error;
use crate::filtering::Format;
use crate::picture::Picture;
use crate::reference::filter::Level;

/// A complete pyramid in memory.
#[derive(Clone, Debug)]
pub struct Stored {
    width: u32,
    height: u32,
    texels: Texels,
}

/// The levels of a pyramid, one after the other.
#[derive(Clone, Debug)]
pub(crate) enum Texels {
    Rgb565(Vec<Rgb565>),
    Rgb888(Vec<Rgb888>),
    Gray8(Vec<Gray8>),
    Rgba5551(Vec<Rgba5551>),
    Rgba8888(Vec<Rgba8888>),
    Palette8(Indexed),
    Palette4(Indexed),
    Bc1(Vec<[u8; 8]>),
    Morton(Vec<Rgb565>),
}

/// Level 0 as indices, the others as colours.
#[derive(Clone, Debug)]
pub(crate) struct Indexed {
    /// As the format packs them.
    pub(crate) indices: Vec<u8>,
    pub(crate) palette: Vec<Rgb565>,
    pub(crate) coarser: Vec<Rgb565>,
}

/// A pyramid for the core, by its colour.
#[derive(Clone, Debug)]
pub enum AnyPyramid<'a> {
    /// In whatever way it is stored.
    Rgb565(Box<Pyramid<AnyTexels<'a>>>),
    /// 24 bits.
    Rgb888(Pyramid<Texture<'a, Rgb888>>),
    /// 8 bits.
    Gray8(Pyramid<Texture<'a, Gray8>>),
    /// 16 bits with alpha.
    Rgba5551(Pyramid<Texture<'a, Rgba5551>>),
    /// 32 bits with alpha.
    Rgba8888(Pyramid<Texture<'a, Rgba8888>>),
}

fn core(error: multum::error::Error) -> Error {
    Error::core("texture", error)
}

/// An RGB565 colour of 8-bit channels, each to the nearest.
fn rgb565(rgb: [u8; 3]) -> Rgb565 {
    Picture::of_colour(rgb).rgb565()[0]
}

impl Stored {
    /// Stores a picture and builds its levels as a chip would.
    ///
    /// # Errors
    ///
    /// [`Error::Core`] for a picture that the core refuses.
    pub fn new(picture: &Picture, format: Format, average: Average) -> Result<Self, Error> {
        let (width, height) = (picture.width(), picture.height());
        /// Level 0 at the start of a buffer for all, and the others built.
        fn built<C: multum::colour::Colour>(
            mut texels: Vec<C>,
            (width, height): (u32, u32),
            average: Average,
        ) -> Result<Vec<C>, Error> {
            texels.resize(pyramid::texels(width, height), C::default());
            build(&mut texels, width, height, average).map_err(core)?;
            Ok(texels)
        }
        let size = (width, height);
        let indexed = |colours, pack: fn(&[u8], u32) -> Vec<u8>| {
            let encode::Indexed { palette, indices } = encode::indexed(picture, colours);
            Indexed {
                indices: pack(&indices, width),
                palette: palette.into_iter().map(rgb565).collect(),
                coarser: vec![Rgb565::default(); coarser_texels(width, height)],
            }
        };
        let rgb888 = || {
            let pixels = picture.pixels().iter();
            built(
                pixels.map(|&[r, g, b]| Rgb888::new(r, g, b)).collect(),
                size,
                average,
            )
        };
        let texels = match format {
            Format::Rgb565 => Texels::Rgb565(built(picture.rgb565(), size, average)?),
            Format::Rgb888 => Texels::Rgb888(rgb888()?),
            Format::Gray8 => {
                let luma = encode::gray8(picture).into_iter().map(Gray8::new).collect();
                Texels::Gray8(built(luma, size, average)?)
            }
            Format::Rgba5551 => {
                let texels = encode::rgba5551(picture).into_iter().map(Rgba5551);
                Texels::Rgba5551(built(texels.collect(), size, average)?)
            }
            Format::Rgba8888 => {
                let texels = encode::rgba8888(picture).into_iter().map(Rgba8888);
                Texels::Rgba8888(built(texels.collect(), size, average)?)
            }
            Format::Palette8 => {
                let mut indexed = indexed(256, |indices, _| indices.to_vec());
                let Indexed {
                    indices,
                    palette,
                    coarser,
                } = &mut indexed;
                let finest = Indexed8::new(indices, palette, width, height).map_err(core)?;
                build_indexed(finest, coarser, average).map_err(core)?;
                Texels::Palette8(indexed)
            }
            Format::Palette4 => {
                let mut indexed = indexed(16, encode::pack4);
                let Indexed {
                    indices,
                    palette,
                    coarser,
                } = &mut indexed;
                let finest = Indexed4::new(indices, palette, width, height).map_err(core)?;
                build_indexed(finest, coarser, average).map_err(core)?;
                Texels::Palette4(indexed)
            }
            Format::Bc1 => {
                // Averaged before compression: the encoder sees what each level should be.
                let texels = rgb888()?;
                let mut blocks = Vec::new();
                for (at, (width, height)) in places(width, height) {
                    let level = &texels[at..at + (width * height) as usize];
                    let pixels = level.iter().map(|c| [c.r(), c.g(), c.b()]).collect();
                    let bytes = encode::bc1(&Picture::new(width, height, pixels)?);
                    blocks.extend(bytes.as_chunks::<8>().0);
                }
                Texels::Bc1(blocks)
            }
            Format::Morton => {
                let rows = built(picture.rgb565(), size, average)?;
                let mut texels = rows.clone();
                for (at, (width, height)) in places(width, height) {
                    let level = at..at + (width * height) as usize;
                    Morton::arrange(&rows[level.clone()], &mut texels[level], width, height)
                        .map_err(core)?;
                }
                Texels::Morton(texels)
            }
        };
        Ok(Self {
            width,
            height,
            texels,
        })
    }

    /// 24-bit levels that are given, the finest first: they need not be averages.
    ///
    /// # Errors
    ///
    /// [`Error::Core`] unless each has half the sides of the one before, down to one texel.
    pub fn of_levels(given: &[Picture]) -> Result<Self, Error> {
        let first = given.first().ok_or_else(|| {
            core(multum::error::Error::LevelsMissing {
                needed: 1,
                given: 0,
            })
        })?;
        let (width, height) = (first.width(), first.height());
        let needed = levels(width, height);
        for (number, level) in (0..).zip(given) {
            if (level.width(), level.height()) != level_size(width, height, number) {
                return Err(core(multum::error::Error::LevelSize {
                    level: number,
                    width: level.width(),
                    height: level.height(),
                }));
            }
        }
        if given.len() as u32 != needed {
            return Err(core(multum::error::Error::LevelsMissing {
                needed,
                given: given.len() as u32,
            }));
        }
        let pixels = given.iter().flat_map(Picture::pixels);
        Ok(Self {
            width,
            height,
            texels: Texels::Rgb888(pixels.map(|&[r, g, b]| Rgb888::new(r, g, b)).collect()),
        })
    }

    /// Bytes in a chip's memory, palettes included.
    #[must_use]
    pub fn bytes(&self) -> usize {
        match &self.texels {
            Texels::Rgb565(t) | Texels::Morton(t) => 2 * t.len(),
            Texels::Rgb888(t) => 3 * t.len(),
            Texels::Gray8(t) => t.len(),
            Texels::Rgba5551(t) => 2 * t.len(),
            Texels::Rgba8888(t) => 4 * t.len(),
            Texels::Palette8(t) | Texels::Palette4(t) => {
                t.indices.len() + 2 * (t.palette.len() + t.coarser.len())
            }
            Texels::Bc1(t) => 8 * t.len(),
        }
    }

    /// Sides of the finest level.
    #[must_use]
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// For those who store it elsewhere.
    pub(crate) fn texels(&self) -> &Texels {
        &self.texels
    }

    /// For the core.
    ///
    /// # Errors
    ///
    /// [`Error::Core`] if the core refuses it.
    pub fn pyramid(&self) -> Result<AnyPyramid<'_>, Error> {
        let (width, height) = (self.width, self.height);
        /// Any pyramid level by level.
        fn any<'a, T: Copy>(
            pyramid: &Pyramid<T>,
            level: impl Fn(T) -> AnyTexels<'a>,
        ) -> Result<AnyPyramid<'a>, Error> {
            let levels: Vec<_> = pyramid.iter().map(|t| level(*t)).collect();
            Pyramid::from_levels(&levels)
                .map(|p| AnyPyramid::Rgb565(Box::new(p)))
                .map_err(core)
        }
        match &self.texels {
            Texels::Rgb565(t) => any(
                &Pyramid::<Texture<'_, _>>::new(t, width, height).map_err(core)?,
                AnyTexels::Direct,
            ),
            Texels::Morton(t) => any(
                &Pyramid::<Morton<'_, _>>::new(t, width, height).map_err(core)?,
                AnyTexels::Morton,
            ),
            Texels::Bc1(t) => any(
                &Pyramid::<Bc1<'_>>::new(t, width, height).map_err(core)?,
                AnyTexels::Bc1,
            ),
            Texels::Palette8(t) => {
                let finest = Indexed8::new(&t.indices, &t.palette, width, height);
                self.indexed(t, AnyTexels::Indexed8(finest.map_err(core)?))
            }
            Texels::Palette4(t) => {
                let finest = Indexed4::new(&t.indices, &t.palette, width, height);
                self.indexed(t, AnyTexels::Indexed4(finest.map_err(core)?))
            }
            Texels::Rgb888(t) => Pyramid::<Texture<'_, _>>::new(t, width, height)
                .map(AnyPyramid::Rgb888)
                .map_err(core),
            Texels::Gray8(t) => Pyramid::<Texture<'_, _>>::new(t, width, height)
                .map(AnyPyramid::Gray8)
                .map_err(core),
            Texels::Rgba5551(t) => Pyramid::<Texture<'_, _>>::new(t, width, height)
                .map(AnyPyramid::Rgba5551)
                .map_err(core),
            Texels::Rgba8888(t) => Pyramid::<Texture<'_, _>>::new(t, width, height)
                .map(AnyPyramid::Rgba8888)
                .map_err(core),
        }
    }

    fn indexed<'a>(
        &self,
        stored: &'a Indexed,
        finest: AnyTexels<'a>,
    ) -> Result<AnyPyramid<'a>, Error> {
        let mut all = vec![finest];
        let first = (self.width * self.height) as usize;
        for (at, (width, height)) in places(self.width, self.height).skip(1) {
            let at = at - first;
            let level = &stored.coarser[at..at + (width * height) as usize];
            all.push(AnyTexels::Direct(
                Texture::new(level, width, height).map_err(core)?,
            ));
        }
        Pyramid::from_levels(&all)
            .map(|p| AnyPyramid::Rgb565(Box::new(p)))
            .map_err(core)
    }

    /// For the reference: the same texels as plain numbers, in units of each channel's own bits
    /// (0 to 31 or 63 for RGB565), from the format's definition and not by the core.
    ///
    /// # Panics
    ///
    /// Never: sizes were checked when it was made.
    #[must_use]
    pub fn reference(&self) -> Vec<Level> {
        places(self.width, self.height)
            .map(|(at, (width, height))| {
                let texel = |x: u32, y: u32| self.plain(at, (width, height), x, y);
                let texels = (0..height).flat_map(|y| (0..width).map(move |x| texel(x, y)));
                Level::new(width, height, texels.collect())
                    .expect("as many texels as the sides say")
            })
            .collect()
    }

    /// One texel as plain numbers, of the level whose first texel is number `at`.
    fn plain(&self, at: usize, (width, height): (u32, u32), x: u32, y: u32) -> [f64; 4] {
        let number = at + (y * width + x) as usize;
        let rgb = |c: Rgb565| [c.r().into(), c.g().into(), c.b().into(), 0.0];
        let first = (self.width * self.height) as usize;
        match &self.texels {
            Texels::Rgb565(t) => rgb(t[number]),
            Texels::Rgb888(t) => {
                let c = t[number];
                [c.r().into(), c.g().into(), c.b().into(), 0.0]
            }
            Texels::Gray8(t) => [t[number].luma().into(), 0.0, 0.0, 0.0],
            Texels::Rgba5551(t) => {
                let bits = u32::from(t[number].0);
                [bits >> 11, bits >> 6 & 31, bits >> 1 & 31, bits & 1].map(f64::from)
            }
            Texels::Rgba8888(t) => t[number].0.map(f64::from),
            Texels::Palette8(t) if at == 0 => rgb(t.palette[usize::from(t.indices[number])]),
            Texels::Palette4(t) if at == 0 => {
                let row = y as usize * (width as usize).div_ceil(2);
                let pair = t.indices[row + x as usize / 2];
                let index = if x.is_multiple_of(2) {
                    pair >> 4
                } else {
                    pair & 15
                };
                rgb(t.palette[usize::from(index)])
            }
            Texels::Palette8(t) | Texels::Palette4(t) => rgb(t.coarser[number - first]),
            Texels::Bc1(t) => {
                let before = places(self.width, self.height)
                    .take_while(|(place, _)| *place < at)
                    .map(|(_, (w, h))| (w.div_ceil(4) * h.div_ceil(4)) as usize)
                    .sum::<usize>();
                let block = (y / 4 * width.div_ceil(4) + x / 4) as usize;
                bc1(t[before + block], x % 4, y % 4)
            }
            Texels::Morton(t) => {
                let (mut place, mut bit) = (0, 0);
                for i in 0..12 {
                    for (side, c) in [(width, x), (height, y)] {
                        if side >> i > 1 {
                            place |= (c >> i & 1) << bit;
                            bit += 1;
                        }
                    }
                }
                rgb(t[at + place as usize])
            }
        }
    }
}

/// A texel of a BC1 block in RGB565 units, mixed colours rounded to the nearest: as the format is
/// defined.
fn bc1(block: [u8; 8], x: u32, y: u32) -> [f64; 4] {
    let end = |i: usize| u32::from(block[i]) + 256 * u32::from(block[i + 1]);
    let (first, second) = (end(0), end(2));
    let channels = |c: u32| [c / 2048, c / 32 % 64, c % 32].map(f64::from);
    let (a, b) = (channels(first), channels(second));
    let index = block[4 + y as usize] >> (2 * x) & 3;
    let mix = |weight: f64| [0, 1, 2].map(|i| (a[i] * (1.0 - weight) + b[i] * weight).round());
    let [r, g, b] = match (index, first > second) {
        (0, _) => a,
        (1, _) => b,
        (2, true) => mix(1.0 / 3.0),
        (3, true) => mix(2.0 / 3.0),
        (2, false) => mix(0.5),
        _ => [0.0; 3],
    };
    [r, g, b, 0.0]
}

/// Where each level starts, in texels, and its sides.
fn places(width: u32, height: u32) -> impl Iterator<Item = (usize, (u32, u32))> {
    let mut at = 0;
    (0..levels(width, height)).map(move |number| {
        let (width, height) = level_size(width, height, number);
        let here = at;
        at += width as usize * height as usize;
        (here, (width, height))
    })
}
