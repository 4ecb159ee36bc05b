//! What a user chooses about textures at run time: filters, level selection, texel format.

use std::fmt;
use std::str::FromStr;

use multum::fixed::types::I16F16;
use multum::pyramid::average::Average;

use crate::reference::filter::{Filter as ReferenceFilter, Image};
use crate::reference::lod::{Choice, Lod, Rule};

/// A filter within a level.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Within {
    /// The nearest texel.
    #[default]
    Nearest,
    /// Bilinear.
    Linear,
    /// Bilinear with 5 bits of subtexel precision.
    Linear5,
}

impl Within {
    /// What the reference calls it: the ideal of the same.
    #[must_use]
    pub fn reference(self) -> Image {
        match self {
            Self::Nearest => Image::Nearest,
            Self::Linear | Self::Linear5 => Image::Linear,
        }
    }
}

/// How lambda is shared by pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Per {
    /// One for a triangle.
    Triangle,
    /// One for a span.
    Span,
    /// One for 16 columns of a span.
    Piece,
    /// Each its own.
    #[default]
    Pixel,
}

/// How texels are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Format {
    /// 16 bits, as the display has it.
    #[default]
    Rgb565,
    /// 24 bits.
    Rgb888,
    /// 8 bits of luma.
    Gray8,
    /// 8-bit indices into 256 colours.
    Palette8,
    /// 4-bit indices into 16 colours.
    Palette4,
    /// 16 bits, one of them alpha.
    Rgba5551,
    /// 32 bits, 8 of them alpha.
    Rgba8888,
    /// Blocks of 4x4 texels in 64 bits.
    Bc1,
    /// RGB565 in Morton order.
    Morton,
}

impl Format {
    /// What a display shows of a colour in units of the format's channels (see
    /// [`Stored::reference`](crate::stored::Stored::reference)), each rounded to the nearest, with 8
    /// bits a channel; `None` where alpha hides it.
    #[must_use]
    pub fn shown(self, colour: [f64; 4]) -> Option<[u8; 3]> {
        let [r, g, b, a] = colour.map(|c| (c + 0.5).floor().max(0.0));
        let scaled = |value: f64, max: f64| (value * 255.0 / max).round() as u8;
        match self {
            Self::Rgb888 => Some([r, g, b].map(|c| c as u8)),
            Self::Gray8 => Some([r as u8; 3]),
            Self::Rgba8888 => (a >= 128.0).then(|| [r, g, b].map(|c| c as u8)),
            Self::Rgba5551 => (a >= 1.0).then(|| {
                // On a display with 6 bits of green, whose lowest repeats the highest.
                let green = 2.0 * g + (g / 16.0).floor();
                [scaled(r, 31.0), scaled(green, 63.0), scaled(b, 31.0)]
            }),
            Self::Rgb565 | Self::Palette8 | Self::Palette4 | Self::Bc1 | Self::Morton => {
                Some([scaled(r, 31.0), scaled(g, 63.0), scaled(b, 31.0)])
            }
        }
    }
}

/// Within a level and between levels, where a pixel spans texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Minify {
    /// Within a level.
    pub image: Within,
    /// Between levels.
    pub choice: Choice,
    /// Samples along the footprint's long axis; 1 is isotropic.
    pub taps: u32,
}

impl Minify {
    /// All that have a name, with what they are.
    pub const ALL: [(&'static str, Self); 11] = [
        ("nearest", Self::of(Within::Nearest, Choice::Base, 1)),
        ("bilinear", Self::of(Within::Linear, Choice::Base, 1)),
        ("bilinear:5", Self::of(Within::Linear5, Choice::Base, 1)),
        (
            "nearest-mip-nearest",
            Self::of(Within::Nearest, Choice::Nearest, 1),
        ),
        (
            "linear-mip-nearest",
            Self::of(Within::Linear, Choice::Nearest, 1),
        ),
        (
            "nearest-mip-linear",
            Self::of(Within::Nearest, Choice::Linear, 1),
        ),
        ("trilinear", Self::of(Within::Linear, Choice::Linear, 1)),
        ("trilinear:5", Self::of(Within::Linear5, Choice::Linear, 1)),
        ("aniso:2", Self::of(Within::Linear, Choice::Linear, 2)),
        ("aniso:4", Self::of(Within::Linear, Choice::Linear, 4)),
        ("aniso:8", Self::of(Within::Linear, Choice::Linear, 8)),
    ];

    const fn of(image: Within, choice: Choice, taps: u32) -> Self {
        Self {
            image,
            choice,
            taps,
        }
    }

    /// Whether it reads levels other than the finest.
    #[must_use]
    pub fn has_levels(&self) -> bool {
        self.choice != Choice::Base
    }
}

/// All choices about textures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filtering {
    /// Where a pixel spans texels.
    pub min: Minify,
    /// Where it does not.
    pub mag: Within,
    /// How a footprint's size is measured.
    pub rule: Rule,
    /// How often.
    pub per: Per,
    /// Added to lambda, in levels.
    pub bias: I16F16,
    /// How texels are stored.
    pub format: Format,
    /// How levels are averaged.
    pub average: Average,
}

impl Default for Filtering {
    /// The nearest texel of level 0.
    fn default() -> Self {
        Self {
            min: Minify::of(Within::Nearest, Choice::Base, 1),
            mag: Within::Nearest,
            rule: Rule::LongestAxis,
            per: Per::Pixel,
            bias: I16F16::ZERO,
            format: Format::Rgb565,
            average: Average::Stored,
        }
    }
}

impl Filtering {
    /// A filter by its name with the magnification that goes with it, all else by default.
    #[must_use]
    pub fn named(min: Minify) -> Self {
        Self {
            min,
            mag: min.image,
            ..Self::default()
        }
    }

    /// Whether it is the nearest texel of level 0 in RGB565 whatever lambda is: what needs
    /// nothing of a triangle but its coordinates.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        let nearest = self.min.image == Within::Nearest && self.mag == Within::Nearest;
        nearest && !self.min.has_levels() && self.min.taps == 1 && self.format == Format::Rgb565
    }

    /// The same in the words of the reference.
    #[must_use]
    pub fn reference(&self) -> ReferenceFilter {
        ReferenceFilter {
            min: self.min.image.reference(),
            mag: self.mag.reference(),
            lod: Lod {
                rule: self.rule,
                choice: self.min.choice,
                bias: self.bias.to_num(),
                ..Lod::default()
            },
            taps: self.min.taps,
        }
    }
}

impl fmt::Display for Filtering {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.min, name_of(&FORMATS, self.format))
    }
}

/// The texel formats by name.
pub const FORMATS: [(&str, Format); 9] = [
    ("rgb565", Format::Rgb565),
    ("rgb888", Format::Rgb888),
    ("gray8", Format::Gray8),
    ("palette8", Format::Palette8),
    ("palette4", Format::Palette4),
    ("rgba5551", Format::Rgba5551),
    ("rgba8888", Format::Rgba8888),
    ("bc1", Format::Bc1),
    ("morton", Format::Morton),
];

/// Magnification filters by name.
pub const IMAGES: [(&str, Within); 3] = [
    ("nearest", Within::Nearest),
    ("linear", Within::Linear),
    ("linear:5", Within::Linear5),
];

/// Rules by name.
pub const RULES: [(&str, Rule); 2] = [
    ("longest", Rule::LongestAxis),
    ("euclidean", Rule::Euclidean),
];

/// Level choices by name.
pub const CHOICES: [(&str, Choice); 3] = [
    ("nearest", Choice::Nearest),
    ("safest", Choice::Safest),
    ("linear", Choice::Linear),
];

/// Rates by name.
pub const RATES: [(&str, Per); 4] = [
    ("triangle", Per::Triangle),
    ("span", Per::Span),
    ("piece", Per::Piece),
    ("pixel", Per::Pixel),
];

/// Averages by name.
pub const AVERAGES: [(&str, Average); 2] = [("stored", Average::Stored), ("light", Average::Light)];

/// What a name of a table stands for.
///
/// # Errors
///
/// A text that lists the names.
pub fn by_name<T: Copy>(table: &[(&'static str, T)], name: &str) -> Result<T, String> {
    let found = table.iter().find(|(known, _)| *known == name);
    found.map(|(_, value)| *value).ok_or_else(|| {
        let names: Vec<_> = table.iter().map(|(known, _)| *known).collect();
        format!("choose one of {}", names.join(", "))
    })
}

/// The name of a value in a table; a description if it has none.
pub fn name_of<T: Copy + PartialEq + fmt::Debug>(table: &[(&'static str, T)], value: T) -> String {
    let found = table.iter().find(|(_, known)| *known == value);
    found.map_or_else(|| format!("{value:?}"), |(name, _)| (*name).to_owned())
}

impl FromStr for Minify {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        by_name(&Self::ALL, s)
    }
}

impl fmt::Display for Minify {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((name, _)) = Self::ALL.iter().find(|(_, known)| known == self) {
            f.write_str(name)
        } else {
            let image = name_of(&IMAGES, self.image);
            write!(f, "{image}-mip-{}", name_of(&CHOICES, self.choice))?;
            if self.taps > 1 {
                write!(f, "-aniso:{}", self.taps)?;
            }
            Ok(())
        }
    }
}
