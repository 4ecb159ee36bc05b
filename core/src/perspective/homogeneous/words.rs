//! Divisions from single words of the planes: for triangles whose depths do not differ much.

use super::{Homogeneous, Point, Weights};
use crate::arith::{leading_zeros, multiply_high, reciprocal};
use crate::setup::{Plane, TriangleSetup};
use crate::span::Span;
use crate::uv::Uv;

/// Bits that 1/w may lose where it is least: of 30 or 31, so that depths differ by up to 64 or 128.
const BITS: u32 = 6;

/// The same for small triangles, through which words are stepped.
const SMALL_BITS: u32 = 2;

/// Columns and rows of a small triangle.
const SMALL: i32 = 16;

/// 1/w, u/w and v/w at a point, or how they change, without their lower words.
#[derive(Clone, Copy, Debug)]
pub(in crate::perspective) struct Words {
    /// With 32 bits.
    q: u32,
    /// With 31 bits and a sign.
    u: i32,
    v: i32,
}

impl Point {
    /// The upper words of changes, rounded to the nearest.
    #[inline]
    pub(in crate::perspective) fn rounded_words(&self) -> Words {
        let half = |value: i64| value.wrapping_add(1 << 29);
        let Weights { q, u, v } = self.0;
        Self(Weights {
            q: half(q),
            u: half(u),
            v: half(v),
        })
        .words()
    }

    /// The upper words.
    #[inline]
    pub(in crate::perspective) fn words(&self) -> Words {
        let Weights { q, u, v } = self.0;
        Words {
            q: (q >> 30) as u32,
            u: (u >> 30) as i32,
            v: (v >> 30) as i32,
        }
    }
}

impl Words {
    /// Farther to the right by a leap.
    #[inline]
    pub(in crate::perspective) fn after(self, leap: Self) -> Self {
        Self {
            q: self.q.wrapping_add(leap.q),
            u: self.u.wrapping_add(leap.u),
            v: self.v.wrapping_add(leap.v),
        }
    }

    /// So many times the change.
    #[inline]
    fn times(self, n: i32) -> Self {
        Self {
            q: self.q.wrapping_mul(n.cast_unsigned()),
            u: self.u.wrapping_mul(n),
            v: self.v.wrapping_mul(n),
        }
    }
}

/// What is known of the words of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) enum WordPlanes {
    /// They would not do.
    None,
    /// They have to be found from the planes.
    Large,
    /// The triangle has so few columns and rows that words can be stepped through it.
    Small {
        /// A pixel near the triangle.
        pixel: [i32; 2],
        at: Words,
        right: Words,
        down: Words,
    },
}

impl WordPlanes {
    #[inline]
    pub(super) fn new(
        triangle: &TriangleSetup<'_>,
        planes: &Weights<Plane>,
        is_full: bool,
        inverses: [i32; 3],
    ) -> Self {
        let [p, q, r] = inverses;
        let least = p.min(q).min(r);
        if !is_full || least < 1 << (30 - BITS) {
            return Self::None;
        }
        if least < 1 << (30 - SMALL_BITS) || !triangle.fits(SMALL) {
            return Self::Large;
        }
        let point = |each: fn(&Plane) -> i64| {
            let Weights { q, u, v } = planes;
            Point(Weights {
                q: each(q),
                u: each(u),
                v: each(v),
            })
        };
        Self::Small {
            pixel: planes.q.pixel(),
            at: point(Plane::at_pixel).rounded_words(),
            right: point(Plane::step_x).rounded_words(),
            down: point(Plane::step_y).rounded_words(),
        }
    }
}

/// Where a span begins and ends, and the way between.
#[derive(Clone, Copy, Debug)]
pub(in crate::perspective) struct Ends {
    pub(in crate::perspective) first: Words,
    pub(in crate::perspective) last: Words,
    /// At the end of the first piece, and the change over a whole one; only if there is one.
    pub(in crate::perspective) anchor: Words,
    pub(in crate::perspective) leap: Words,
}

impl Homogeneous {
    /// Whether [`Self::divide_words`] is right everywhere in the triangle: the depths of its corners
    /// do not differ much, see [`BITS`], its coordinates within 32 repeats, and it is no sliver.
    #[inline]
    pub(in crate::perspective) fn in_words(&self) -> bool {
        !matches!(self.words, WordPlanes::None)
    }

    /// The words along a span, of which the first piece has so many pixels and the others `N`.
    /// `None` if words would not do: unless the depths of the corners do not differ
    /// much, see [`BITS`], the coordinates within 32 repeats, and the triangle no sliver.
    #[inline]
    pub(in crate::perspective) fn ends<const N: u32>(
        &self,
        span: Span,
        piece: u32,
    ) -> Option<Ends> {
        let len = span.left.abs_diff(span.right);
        let is_long = len > piece;
        match self.words {
            WordPlanes::None => None,
            WordPlanes::Large => {
                let first = self.at(span.left, span.y);
                let last = self.step(first, len.wrapping_sub(1)).words();
                let (mut anchor, mut leap) = (last, last);
                if is_long {
                    anchor = self.step(first, piece).words();
                    leap = self.leap(N).rounded_words();
                }
                Some(Ends {
                    first: first.words(),
                    last,
                    anchor,
                    leap,
                })
            }
            WordPlanes::Small {
                pixel: [x, y],
                at,
                right,
                down,
            } => {
                let first = at
                    .after(right.times(span.left.wrapping_sub(x)))
                    .after(down.times(span.y.wrapping_sub(y)));
                let beyond = |pixels: u32| first.after(right.times(pixels.cast_signed()));
                let last = beyond(len.wrapping_sub(1));
                let (mut anchor, mut leap) = (last, last);
                if is_long {
                    anchor = beyond(piece);
                    leap = right.times(N.cast_signed());
                }
                Some(Ends {
                    first,
                    last,
                    anchor,
                    leap,
                })
            }
        }
    }

    /// u and v at a point of the triangle; see [`Self::divide`].
    #[inline]
    pub(in crate::perspective) fn divide_words(&self, Words { q, u, v }: Words) -> Uv {
        let zeros = leading_zeros(q);
        let inverse = reciprocal(q << zeros).cast_signed();
        // `coordinate` without the bits that words don't have.
        let down = self.down.wrapping_sub(2) & 31;
        let coordinate = |value: i32, first: i32| {
            first.wrapping_add(multiply_high(value << zeros, inverse) >> down)
        };
        Uv::from_bits(
            coordinate(u, self.first.u.to_bits()),
            coordinate(v, self.first.v.to_bits()),
        )
    }
}
