//! What a user chooses at run time, and the types of the core that stand for it.

use std::fmt;
use std::str::FromStr;

use multum::fixed::types::I16F16;
use multum::perspective::{Adaptive, AffineWithin, Subdivided};

/// How texture coordinates are corrected for perspective.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Perspective {
    /// Not at all.
    Affine,
    /// Where that keeps a bound, in footprints, and else a division every 16 pixels.
    AffineWithin(I16F16),
    /// A division every so many pixels: 4, 8, 16, 32 or 64.
    Every(u32),
    /// A division at every pixel.
    Exact,
    /// The longest pieces whose error keeps a bound, in footprints.
    Adaptive(I16F16),
    /// One division a scanline where its depth is constant.
    ConstantZ,
    /// One division a column where its depth is constant.
    ConstantZColumns,
    /// Parabolas over pieces of 16 or 32 pixels.
    Quadratic(u32),
    /// No division: reciprocals predicted from the last pixels.
    Extrapolated,
    /// Affine pieces of triangles split in the world, to a bound in texels.
    Subdivided(I16F16),
}

impl Perspective {
    /// All choices, those with a bound by their defaults.
    pub const ALL: [Self; 15] = [
        Self::Affine,
        Self::AffineWithin(AffineWithin::DEFAULT_BOUND),
        Self::Every(64),
        Self::Every(32),
        Self::Every(16),
        Self::Every(8),
        Self::Every(4),
        Self::Exact,
        Self::Adaptive(Adaptive::DEFAULT_BOUND),
        Self::ConstantZ,
        Self::ConstantZColumns,
        Self::Quadratic(16),
        Self::Quadratic(32),
        Self::Extrapolated,
        Self::Subdivided(Subdivided::DEFAULT_BOUND),
    ];
}

/// A bound of 0 or more.
fn bound(s: &str) -> Option<I16F16> {
    s.parse::<I16F16>().ok().filter(|bound| *bound >= 0)
}

impl FromStr for Perspective {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        let with_bound = || match s.split_once(':')? {
            ("affine-within", n) => bound(n).map(Self::AffineWithin),
            ("adaptive", n) => bound(n).map(Self::Adaptive),
            ("subdivided", n) => bound(n).map(Self::Subdivided),
            _ => None,
        };
        Self::ALL
            .into_iter()
            .find(|choice| choice.to_string() == s)
            .or_else(with_bound)
            .ok_or_else(|| {
                let names: Vec<_> = Self::ALL.iter().map(Self::to_string).collect();
                format!(
                    "choose one of {}; adaptive and affine-within take a bound in footprints, \
                     subdivided one in texels, from 0 on, as adaptive:0.5",
                    names.join(", ")
                )
            })
    }
}

impl fmt::Display for Perspective {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Affine => f.write_str("affine"),
            Self::AffineWithin(bound) if *bound == AffineWithin::DEFAULT_BOUND => {
                f.write_str("affine-within")
            }
            Self::AffineWithin(bound) => write!(f, "affine-within:{bound}"),
            Self::Every(n) => write!(f, "every:{n}"),
            Self::Exact => f.write_str("exact"),
            Self::Adaptive(bound) if *bound == Adaptive::DEFAULT_BOUND => f.write_str("adaptive"),
            Self::Adaptive(bound) => write!(f, "adaptive:{bound}"),
            Self::ConstantZ => f.write_str("constant-z"),
            Self::ConstantZColumns => f.write_str("constant-z-columns"),
            Self::Quadratic(n) => write!(f, "quadratic:{n}"),
            Self::Extrapolated => f.write_str("extrapolated"),
            Self::Subdivided(bound) if *bound == Subdivided::DEFAULT_BOUND => {
                f.write_str("subdivided")
            }
            Self::Subdivided(bound) => write!(f, "subdivided:{bound}"),
        }
    }
}

/// Evaluates `$body` with `$name` bound to the core's strategy for a [`Perspective`], for a
/// texture with the base-2 logarithms `$size` of width and height.
macro_rules! with_strategy {
    ($choice:expr, $size:expr, $name:ident => $body:expr) => {{
        use multum::perspective::{
            Adaptive, Affine, AffineWithin, ConstantZ, ConstantZColumns, Every, Extrapolated,
            PerPixel, Quadratic, Subdivided,
        };
        match $choice {
            $crate::choice::Perspective::Affine => {
                let $name = Affine;
                $body
            }
            $crate::choice::Perspective::AffineWithin(bound) => {
                let $name = AffineWithin::new(Every::<16>, bound);
                $body
            }
            $crate::choice::Perspective::Every(4) => {
                let $name = Every::<4>;
                $body
            }
            $crate::choice::Perspective::Every(8) => {
                let $name = Every::<8>;
                $body
            }
            $crate::choice::Perspective::Every(32) => {
                let $name = Every::<32>;
                $body
            }
            $crate::choice::Perspective::Every(64) => {
                let $name = Every::<64>;
                $body
            }
            $crate::choice::Perspective::Every(_) => {
                let $name = Every::<16>;
                $body
            }
            $crate::choice::Perspective::Exact => {
                let $name = PerPixel;
                $body
            }
            $crate::choice::Perspective::Adaptive(bound) => {
                let $name = Adaptive::new(bound, $size);
                $body
            }
            $crate::choice::Perspective::ConstantZ => {
                let $name = ConstantZ;
                $body
            }
            $crate::choice::Perspective::ConstantZColumns => {
                let columns =
                    vec![std::cell::Cell::new(0); multum::viewport::MAX_VIEWPORT as usize];
                let $name = ConstantZColumns::new(&columns);
                $body
            }
            $crate::choice::Perspective::Quadratic(32) => {
                let $name = Quadratic::<32>;
                $body
            }
            $crate::choice::Perspective::Quadratic(_) => {
                let $name = Quadratic::<16>;
                $body
            }
            $crate::choice::Perspective::Extrapolated => {
                let $name = Extrapolated;
                $body
            }
            $crate::choice::Perspective::Subdivided(bound) => {
                let $name = Subdivided::new(bound, $size);
                $body
            }
        }
    }};
}

/// Evaluates `$body` with `$wrap` as the core's type for a [`Beyond`](crate::reference::Beyond).
macro_rules! with_wrap {
    ($choice:expr, $wrap:ident => $body:expr) => {
        match $choice {
            $crate::reference::Beyond::Repeat => {
                type $wrap = multum::texture::Repeat;
                $body
            }
            $crate::reference::Beyond::Clamp => {
                type $wrap = multum::texture::Clamp;
                $body
            }
            $crate::reference::Beyond::Mirror => {
                type $wrap = multum::texture::Mirror;
                $body
            }
        }
    };
}

pub(crate) use {with_strategy, with_wrap};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        for choice in Perspective::ALL {
            assert_eq!(choice.to_string().parse(), Ok(choice));
        }
        for name in [
            "adaptive:0.5",
            "adaptive:0",
            "subdivided:2",
            "affine-within:1",
        ] {
            let choice: Perspective = name.parse().expect("a bound");
            assert_eq!(choice.to_string(), name);
        }
        for name in [
            "",
            "every:3",
            "adaptive:",
            "adaptive:-1",
            "adaptive:x",
            "exact:1",
        ] {
            assert!(name.parse::<Perspective>().is_err(), "{name}");
        }
    }
}
