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
    pub(in crate::perspective) q: u32,
    /// With 31 bits and a sign.
    pub(in crate::perspective) u: i32,
    pub(in crate::perspective) v: i32,
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

    /// The upper words once the values are shifted up so far.
    #[inline]
    pub(in crate::perspective) fn shifted_words(&self, shift: u32) -> Words {
        let Weights { q, u, v } = self.0;
        let upper = |value: i64| (value.wrapping_shl(shift) >> 32) as i32;
        Words {
            q: upper(q).cast_unsigned(),
            u: upper(u),
            v: upper(v),
        }
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
    /// How far up they are shifted, see [`Point::shifted_words`].
    pub(in crate::perspective) const SHIFT: u32 = 2;

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

/// Words along a span, at any pixel: they do not gain an error from one to the next.
#[derive(Clone, Copy, Debug)]
pub(in crate::perspective) struct WordLine {
    pub(in crate::perspective) first: Words,
    /// From one pixel to the next, and what is left of it, in 2^-11.
    pub(in crate::perspective) step: Words,
    rest: Words,
}

impl WordLine {
    /// So many pixels from the first, below 2^11: up to two and a half units too low, or half a
    /// unit a pixel to either side in a small triangle.
    #[inline]
    pub(in crate::perspective) fn at(&self, pixels: u32) -> Words {
        let Words { q, u, v } = self.rest.times(pixels.cast_signed());
        self.first
            .after(self.step.times(pixels.cast_signed()))
            .after(Words {
                q: q >> 11,
                u: u >> 11,
                v: v >> 11,
            })
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

    /// The words along a span, at any pixel. `None` as of [`Self::ends`].
    #[inline]
    pub(in crate::perspective) fn line(&self, span: Span) -> Option<WordLine> {
        match self.words {
            WordPlanes::None => None,
            WordPlanes::Large => {
                let first = self.at(span.left, span.y).words();
                let leap = self.leap(1);
                let rest = |value: i64| ((value >> 19) as i32) & 0x7ff;
                Some(WordLine {
                    first,
                    step: leap.words(),
                    rest: Words {
                        q: rest(leap.0.q).cast_unsigned(),
                        u: rest(leap.0.u),
                        v: rest(leap.0.v),
                    },
                })
            }
            WordPlanes::Small {
                pixel: [x, y],
                at,
                right,
                down,
            } => Some(WordLine {
                first: at
                    .after(right.times(span.left.wrapping_sub(x)))
                    .after(down.times(span.y.wrapping_sub(y))),
                step: right,
                rest: Words { q: 0, u: 0, v: 0 },
            }),
        }
    }

    /// How words that are shifted up so far change from one row to the next; `None` if that is
    /// more than they hold.
    #[inline]
    pub(in crate::perspective) fn words_down(&self, shift: u32) -> Option<Words> {
        let Weights { q, u, v } = &self.planes;
        let steps = [q, u, v].map(Plane::step_y);
        let fit = |step: i64| (step ^ (step >> 63)).leading_zeros() > shift.wrapping_add(1);
        let [q, u, v] = steps;
        steps
            .into_iter()
            .all(fit)
            .then(|| Point(Weights { q, u, v }).shifted_words(shift))
    }

    /// The base-2 logarithm of the repeats that a word of u/w stands for where it is 1/w.
    #[inline]
    pub(in crate::perspective) fn log2_unit(&self) -> i32 {
        8 - self.down.cast_signed()
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
