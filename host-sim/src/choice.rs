//! What a user chooses at run time, and the types of the core that stand for it.

use std::fmt;
use std::str::FromStr;

/// How texture coordinates are corrected for perspective.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Perspective {
    /// Not at all.
    Affine,
    /// A division every so many pixels: 4, 8, 16, 32 or 64.
    Every(u32),
    /// A division at every pixel.
    Exact,
}

impl Perspective {
    /// All choices.
    pub const ALL: [Self; 7] = [
        Self::Affine,
        Self::Every(64),
        Self::Every(32),
        Self::Every(16),
        Self::Every(8),
        Self::Every(4),
        Self::Exact,
    ];
}

impl FromStr for Perspective {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|choice| choice.to_string() == s)
            .ok_or_else(|| {
                "choose affine, every:4, every:8, every:16, every:32, every:64 or exact".into()
            })
    }
}

impl fmt::Display for Perspective {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Affine => f.write_str("affine"),
            Self::Every(n) => write!(f, "every:{n}"),
            Self::Exact => f.write_str("exact"),
        }
    }
}

/// Evaluates `$body` with `$name` bound to the core's strategy for a [`Perspective`].
macro_rules! with_strategy {
    ($choice:expr, $name:ident => $body:expr) => {{
        use multum::perspective::{Affine, Every, PerPixel};
        match $choice {
            $crate::choice::Perspective::Affine => {
                let $name = Affine;
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
