//! What a frame is drawn with, by the names that counts and command lines have for it.

use std::fmt;

use multum::fixed::types::I16F16;
use serde::{Deserialize, Serialize};

use crate::choice::Perspective;
use crate::filtering::{Filtering, Minify, Per};

/// Strategy, filter, depth test and texel format.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Setting {
    /// How perspective is corrected.
    pub strategy: String,
    /// How texels are filtered, and where that is not all, how often a level is chosen.
    pub filter: String,
    /// `none` or `z16`.
    pub depth: String,
    /// `rgb565`, or `rgb565:sized` for a texture whose sides are part of its type.
    pub format: String,
}

impl Setting {
    /// Whether only formats differ.
    #[must_use]
    pub fn is_like(&self, other: &Self) -> bool {
        let names = |s: &'_ Self| [s.strategy.clone(), s.filter.clone(), s.depth.clone()];
        names(self) == names(other)
    }

    /// The plainest filter and no depth test: where strategies differ by themselves.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.filter == NEAREST && self.depth == NO_DEPTH
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.strategy)?;
        if self.filter != NEAREST {
            write!(f, " {}", self.filter)?;
        }
        if self.depth != NO_DEPTH {
            write!(f, " {}", self.depth)?;
        }
        if self.format == SIZED {
            f.write_str(", sized texture")?;
        } else if self.format != RUN_TIME {
            write!(f, ", {}", self.format)?;
        }
        Ok(())
    }
}

/// The filter that reads one texel.
pub const NEAREST: &str = "nearest";
/// No depth test.
pub const NO_DEPTH: &str = "none";
/// A depth buffer of 16 bits.
pub const Z16: &str = "z16";
/// A texture whose sides are known at run time.
pub const RUN_TIME: &str = "rgb565";
/// A texture whose sides are part of its type.
pub const SIZED: &str = "rgb565:sized";

/// Both depth modes.
pub const DEPTHS: [(&str, bool); 2] = [(NO_DEPTH, false), (Z16, true)];

/// Bounds of `adaptive`, in footprints, besides its default.
const BOUNDS: [&str; 3] = ["0.0625", "0.5", "1"];

/// All strategies, and `adaptive` with several bounds.
#[must_use]
pub fn strategies() -> Vec<Perspective> {
    let bound = |text: &&str| text.parse::<I16F16>().ok().map(Perspective::Adaptive);
    let mut all = Perspective::ALL.to_vec();
    all.extend(BOUNDS.iter().filter_map(bound));
    all
}

/// All filters with the rates that counts have, by their names there.
#[must_use]
pub fn filters() -> Vec<(String, Filtering)> {
    let rates = [
        (Per::Span, "span"),
        (Per::Piece, "piece"),
        (Per::Pixel, "pixel"),
    ];
    let mut all = Vec::new();
    for (name, minify) in Minify::ALL {
        let filtering = Filtering::named(minify);
        if !minify.has_levels() {
            all.push((name.to_owned(), filtering));
            continue;
        }
        for (per, rate) in rates {
            let is_common = per == Per::Piece || name == "nearest-mip-nearest";
            if is_common || (per == Per::Pixel && name == "trilinear") {
                let name = name.replace("aniso:", "anisotropic:");
                all.push((format!("{name}:{rate}"), Filtering { per, ..filtering }));
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::{filters, strategies};

    #[test]
    fn names_are_those_of_the_counts() {
        let names: Vec<_> = filters().into_iter().map(|(name, _)| name).collect();
        let expected = [
            "nearest",
            "bilinear",
            "bilinear:5",
            "nearest-mip-nearest:span",
            "nearest-mip-nearest:piece",
            "nearest-mip-nearest:pixel",
            "linear-mip-nearest:piece",
            "nearest-mip-linear:piece",
            "trilinear:piece",
            "trilinear:pixel",
            "trilinear:5:piece",
            "anisotropic:2:piece",
            "anisotropic:4:piece",
            "anisotropic:8:piece",
        ];
        assert_eq!(names, expected);
        let names: Vec<_> = strategies().iter().map(ToString::to_string).collect();
        assert_eq!(names.len(), 18);
        assert!(names.contains(&"adaptive:0.0625".to_owned()));
    }
}
