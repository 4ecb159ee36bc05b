//! Flags about textures, shared by all commands that draw.

use clap::Args;
use host_sim::error::Error;
use host_sim::filtering::{
    AVERAGES, CHOICES, FORMATS, Filtering, Format, IMAGES, Minify, Per, RATES, RULES, Within,
    by_name,
};
use host_sim::reference::lod::{Choice, Rule};
use multum::fixed::types::I16F16;
use multum::pyramid::average::Average;

/// How textures are stored and filtered.
#[derive(Args, Debug)]
pub(crate) struct Textures {
    /// Where a pixel spans texels: nearest, bilinear, bilinear:5 (with 5 bits of subtexel precision), nearest-mip-nearest, linear-mip-nearest, nearest-mip-linear, trilinear, trilinear:5, aniso:2, aniso:4 or aniso:8
    #[arg(long, value_name = "NAME", default_value = "nearest")]
    filter: Minify,
    /// Where it does not: nearest, linear or linear:5 [default: as --filter within a level]
    #[arg(long, value_name = "NAME", value_parser = |s: &str| by_name(&IMAGES, s))]
    mag: Option<Within>,
    /// What level selection measures: longest (axis of the texture) or euclidean
    #[arg(long, value_name = "NAME", default_value = "longest", value_parser = |s: &str| by_name(&RULES, s))]
    lod_rule: Rule,
    /// The level or levels taken: nearest, safest or linear [default: as --filter between levels]
    #[arg(long, value_name = "NAME", value_parser = |s: &str| by_name(&CHOICES, s))]
    lod_choice: Option<Choice>,
    /// How often the level is chosen: once a triangle, span, piece (of 16 columns) or pixel
    #[arg(long, value_name = "WHAT", default_value = "pixel", value_parser = |s: &str| by_name(&RATES, s))]
    lod_per: Per,
    /// Added to the level of detail, in levels: negative is sharper; -16 to 16
    #[arg(long, value_name = "LEVELS", default_value = "0", value_parser = bias, allow_hyphen_values = true)]
    lod_bias: I16F16,
    /// Texels: rgb565, rgb888, gray8, palette8, palette4, rgba5551, rgba8888, bc1 or morton
    #[arg(long, value_name = "NAME", default_value = "rgb565", value_parser = |s: &str| by_name(&FORMATS, s))]
    format: Format,
    /// How levels are averaged: stored (the numbers) or light (what they stand for in sRGB)
    #[arg(long, value_name = "WHAT", default_value = "stored", value_parser = |s: &str| by_name(&AVERAGES, s))]
    average: Average,
}

impl Textures {
    /// The choices as the library has them.
    pub(crate) fn filtering(&self) -> Result<Filtering, Error> {
        let mut min = self.filter;
        if let Some(choice) = self.lod_choice {
            if !min.has_levels() {
                return Err(Error::content(
                    "--lod-choice",
                    &format!("the filter {min} has no levels to choose from"),
                    "leave it out, or give a --filter with mip levels, such as trilinear",
                ));
            }
            min.choice = choice;
        }
        Ok(Filtering {
            min,
            mag: self.mag.unwrap_or(min.image),
            rule: self.lod_rule,
            per: self.lod_per,
            bias: self.lod_bias,
            format: self.format,
            average: self.average,
        })
    }
}

fn bias(text: &str) -> Result<I16F16, String> {
    let levels = text.parse::<I16F16>().ok();
    levels
        .filter(|n| (-16..=16).contains(n))
        .ok_or_else(|| "give levels from -16 to 16".to_owned())
}
