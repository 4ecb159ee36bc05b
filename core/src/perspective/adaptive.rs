//! Spans as long as a bound on their error allows.

mod lengths;

use fixed::types::I16F16;

use lengths::{InverseBound, Lengths, Level, Shape};

use super::by_size::{BySize, Planes, one_piece};
use super::chord::step;
use super::every::{difference, short_step};
use super::homogeneous::Point;
use super::homogeneous::short::ShortPlanes;
use super::homogeneous::words::{WordLine, WordPlanes, Words};
use super::{Homogeneous, Run, RunSink, SpanSink, Strategy};
use crate::arith::{RECIPROCALS, product_unsigned};
use crate::setup::TriangleSetup;
use crate::span::{Area, Span};
use crate::uv::Uv;

/// The longest spans whose error stays within a bound that the caller gives, in footprints.
///
/// A footprint is rho level-0 texels, the texels that a pixel spans, or one texel where rho is
/// less: what the eye sees once a mip level is chosen. The error at every pixel is at most
///
/// `bound * max(1, rho)` texels, plus three times that of [`PerPixel`](super::PerPixel) (two of
/// them in the measurement of a scanline that is one piece, one in the coordinates), plus 1/32 texel for the
/// rounding of steps, plus eight units of the words of 1/w and u/w, half of one for each piece of a group.
///
/// **How.** Along a scanline 1/w = q and u/w are linear, so u is a hyperbola, of which
/// `D = q^2 du/dx` is constant. On a piece of n steps between depths of ratio r, with q = a at
/// the nearer end and b at the farther one, u changes by `|du| = n D / (a b)`, and a chord is
/// off by exactly
///
/// `|du| (sqrt r - 1) / (sqrt r + 1) = |du| (a - b) / (a + b + 2 sqrt(a b)) <= |du| (a - b) / (a + 3 b)`.
///
/// As rho is at least `D / q^2`, the error in footprints is at most `n (a - b) / (a b)` times the
/// largest `s (1 - s) q` on the piece, s from 0 to 1, which is no more than `(16 a + 11 b) / 108`.
/// With k for the change of 1/w a pixel, `a = b + n k`, both tests hold for
///
/// `n^2 <= 4 bound / (k D) q max(D, q^2)`, where `q = b + (a - b) / 4 <= 5 b / 4`,
///
/// since `a b (a + 3 b) >= 4 q^3` and `27 a b >= (16 a + 11 b) q` there, up to a ratio of depths
/// of 2. k is the triangle's, and D changes evenly from scanline to scanline; the largest that the triangle has anywhere
/// stands for all. So this is a function of q alone, and of each length the least q that allows it is found once a
/// triangle: along a scanline lengths only grow or only shrink, and how many pieces are of one length is found from how
/// far q is from where that ends.
///
/// **Lengths** are 4, 8 or 16 pixels, so that steps are found by a shift and pieces filled by loops of known length; one
/// where not even four keep the bound; and 32, 48 and 64. A scanline that keeps it from end to end, by the formula
/// above, is one piece of up to 1024 pixels, and with textures of more than 512 texels `2^19 / size`, so that rounding
/// keeps to its 1/32 texel. Where depth grows no piece reaches farther than twice as far. All roundings are to the safe side.
/// A piece of one step is exact, so the bound holds wherever it can be asked for; 0 gives the
/// per-pixel result where the depth varies.
///
/// **Cost.** A division for each piece and one for each scanline; two for a scanline of constant
/// depth, whatever its length. A few comparisons and a product for up to 16 pieces of one length. To find the least q for
/// all lengths takes somewhat more than a triangle's planes do, and is done once a triangle; once a scanline where depths
/// differ so much that words do not do. One length for each scanline or each triangle, where the nearest or most distorted
/// end decides for all, would take more divisions at the same error. Some lengths in between would save divisions, and
/// take more instructions all the same: 6, 12 and 24 pixels are not as fast to fill and to find.
///
/// A triangle of up to 16 pixels each way whose largest span keeps the bound in one piece, by its corners'
/// depths, is set up with fewer bits and has nothing to decide.
///
/// Choose it where the error must be known, or where walls at all angles share a frame: it spends
/// divisions only where depth varies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Adaptive {
    /// In 2^-12 footprints.
    bound: u32,
    inverse: InverseBound,
    log2_width: u8,
    log2_height: u8,
}

/// Fraction bits of distances in texels.
const TEXEL_BITS: u32 = 12;

impl Adaptive {
    /// A quarter of a footprint: below what nearest sampling shows.
    pub const DEFAULT_BOUND: I16F16 = I16F16::lit("0.25");

    /// For a texture with these base-2 logarithms of width and height, as
    /// [`Texture::log2_size`](crate::texture::Texture::log2_size) gives them; the bound in
    /// footprints, with 12 fraction bits, rounded down. A negative bound counts as 0, sizes
    /// beyond [`MAX_TEXTURE_SIZE`](crate::texture::MAX_TEXTURE_SIZE) as that.
    ///
    /// It takes the size because the bound is in texels and coordinates are in repeats; a
    /// pipeline holds one texture, so the two are made together.
    #[must_use]
    pub const fn new(bound: I16F16, (log2_width, log2_height): (u32, u32)) -> Self {
        const fn at_most_12(log2: u32) -> u8 {
            if log2 < 12 { log2 as u8 } else { 12 }
        }
        let bits = bound.to_bits();
        let bound = if bits < 0 {
            0
        } else {
            bits.cast_unsigned() >> (16 - TEXEL_BITS)
        };
        Self {
            bound,
            inverse: InverseBound::of(bound),
            log2_width: at_most_12(log2_width),
            log2_height: at_most_12(log2_height),
        }
    }

    /// In 2^-12 texels, below 2^27.
    #[inline]
    pub(super) fn bound(&self) -> u32 {
        self.bound
    }

    /// The larger distance of u and v, in 2^-12 texels, rounded up; below 2^32.
    #[inline]
    pub(super) fn distance(&self, from: Uv, to: Uv) -> u32 {
        let texels = |from: i32, to: i32, log2_size: u8| {
            // A distance in 8.24 is below 2^31, so 2^43 at the largest size.
            let down = (Uv::FRACTION_BITS - TEXEL_BITS).wrapping_sub(u32::from(log2_size)) & 31;
            let all = (1u32 << down).wrapping_sub(1);
            let distance = from.abs_diff(to);
            (distance >> down).wrapping_add(u32::from(distance & all != 0))
        };
        texels(from.u.to_bits(), to.u.to_bits(), self.log2_width).max(texels(
            from.v.to_bits(),
            to.v.to_bits(),
            self.log2_height,
        ))
    }

    /// Of the longer side.
    #[inline]
    fn log2_size(&self) -> u32 {
        u32::from(self.log2_width.max(self.log2_height))
    }

    /// The longest piece: the rounding of its steps keeps to 1/32 texel.
    #[inline]
    fn longest(&self) -> u32 {
        1 << 19u32.wrapping_sub(self.log2_size()).min(10)
    }

    /// Whether a chord from end to end keeps the bound.
    #[inline]
    fn is_whole(&self, ends: &Ends) -> bool {
        let (far, change) = ends.far_and_change();
        if product_unsigned(ends.steps << 10, change) <= product_unsigned(self.bound, far) {
            return true;
        }
        let distance = self.distance(ends.uv[0], ends.uv[1]);
        let mean = far.wrapping_add(change >> 2);
        product_unsigned(distance, change) <= product_unsigned(4 * self.bound, mean)
    }

    /// Whether a chord from end to end of any span keeps the bound: its length times how far the ratio of
    /// depths is from 1, over 4.
    #[inline]
    fn is_whole_everywhere(&self, triangle: &TriangleSetup<'_>) -> bool {
        let [nearest, farthest] = triangle.depths();
        product_unsigned(triangle.width() << 2, farthest.wrapping_sub(nearest))
            <= product_unsigned(self.bound, nearest)
    }

    /// The pieces of a span. Without lengths, chords from end to end keep the bound.
    #[inline]
    fn pieces<L: Line>(
        &self,
        ends: &Ends,
        lengths: Option<&Lengths>,
        line: &L,
        mut to: impl RunSink,
    ) {
        let ([q, _], [uv, last]) = (ends.q, ends.uv);
        let mut here = Place { offset: 0, q, uv };
        let mut level = lengths.map_or(Level::default(), |lengths| lengths.first(q));
        let lengths = lengths.filter(|_| ends.steps > level.pixels() && !self.is_whole(ends));
        loop {
            let rest = ends.steps.wrapping_sub(here.offset);
            let length = if lengths.is_some() {
                level.pixels()
            } else {
                self.longest()
            };
            let is_last = rest <= length;
            if L::GROUPS
                && !is_last
                && let Some(lengths) = lengths
                && let Some(log2) = level.log2_grouped()
            {
                let most = rest.wrapping_sub(1) >> log2;
                let count = lengths.count(here.q, level, log2).min(most);
                line.group(&mut here, log2, count, &mut to);
            } else {
                let steps = length.min(rest);
                let offset = here.offset.wrapping_add(steps);
                let (q, uv) = if is_last {
                    (here.q, last)
                } else {
                    line.at(offset)
                };
                to.long_run(here.run_to(uv, steps, u32::from(is_last)));
                if is_last {
                    return;
                }
                here = Place { offset, q, uv };
            }
            if let Some(lengths) = lengths {
                level = lengths.next(here.q, level);
            }
        }
    }
}

/// The ends of a span.
#[derive(Clone, Copy, Debug)]
struct Ends {
    steps: u32,
    /// 1/w.
    q: [u32; 2],
    uv: [Uv; 2],
}

impl Ends {
    /// 1/w at the farther end, and how much it changes at most: words may be half a unit off for each pixel.
    #[inline]
    fn far_and_change(&self) -> (u32, u32) {
        let [p, q] = self.q;
        let change = p.abs_diff(q);
        (p.min(q), change.saturating_add(self.steps.wrapping_add(3)))
    }
}

/// A pixel of a span, counted from its first.
#[derive(Clone, Copy, Debug)]
struct Place {
    offset: u32,
    q: u32,
    uv: Uv,
}

impl Place {
    /// A chord to a pixel so many steps farther, and so many pixels more than steps.
    #[inline]
    fn run_to(&self, uv: Uv, steps: u32, more: u32) -> Run {
        Run {
            offset: self.offset as usize,
            len: steps.wrapping_add(more) as usize,
            uv: self.uv,
            step: if steps < RECIPROCALS.len() as u32 {
                short_step(self.uv, uv, steps)
            } else {
                step(self.uv, uv, steps)
            },
        }
    }
}

/// Points along a span.
trait Line {
    /// Whether there are [groups](Self::group).
    const GROUPS: bool;

    /// 1/w and the coordinates so many pixels from the first.
    fn at(&self, pixels: u32) -> (u32, Uv);

    /// So many pieces of 4, 8 or 16 pixels, and on to what is behind them.
    fn group(&self, here: &mut Place, log2: u32, count: u32, to: &mut impl RunSink);
}

/// Points from words.
struct WordPoints<'p> {
    planes: &'p WordPlanes,
    line: WordLine,
}

impl Line for WordPoints<'_> {
    const GROUPS: bool = true;

    #[inline]
    fn at(&self, pixels: u32) -> (u32, Uv) {
        let words = self.line.at(pixels);
        (words.q, self.planes.divide(words))
    }

    #[inline]
    fn group(&self, here: &mut Place, log2: u32, count: u32, to: &mut impl RunSink) {
        let Self { planes, line } = self;
        let (offset, mut at) = (here.offset as usize, line.at(here.offset));
        let leap = line.leap(1 << (log2 & 31));
        let next = || {
            at = at.after(leap);
            let (start, end) = (here.uv, planes.divide(at));
            here.uv = end;
            (start, difference(start, end, |distance| distance >> log2))
        };
        let pieces = count as usize;
        match log2 {
            2 => to.pieces::<4>(offset, pieces, next),
            3 => to.pieces::<8>(offset, pieces, next),
            _ => to.pieces::<16>(offset, pieces, next),
        }
        here.offset = here.offset.wrapping_add(count << log2);
        here.q = at.q;
    }
}

/// Points from all bits of the planes.
struct WholePoints<'p> {
    planes: &'p Homogeneous,
    first: Point,
    shift: u32,
}

impl Line for WholePoints<'_> {
    const GROUPS: bool = false;

    #[inline]
    fn at(&self, pixels: u32) -> (u32, Uv) {
        let point = self.planes.step(self.first, pixels);
        (
            point.shifted_words(self.shift).q,
            self.planes.divide_far(point),
        )
    }

    #[inline]
    fn group(&self, _: &mut Place, _: u32, _: u32, _: &mut impl RunSink) {}
}

/// Words, and how long pieces may be, unless one is enough for every span.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredPlanes {
    words: WordPlanes,
    lengths: Option<Lengths>,
}

impl Strategy for Adaptive {
    type Planes = Planes<MeasuredPlanes>;

    #[inline]
    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<Self::Planes> {
        let is_whole = self.is_whole_everywhere(triangle);
        // One piece is enough for a small triangle, or for a span of a pixel.
        let log2_pixels = if is_whole {
            ShortPlanes::LOG2_PIXELS
        } else {
            0
        };
        Planes::with(triangle, log2_pixels, 0, |words| MeasuredPlanes {
            lengths: (!is_whole).then(|| self.lengths(&words, triangle)),
            words,
        })
    }

    #[inline]
    fn runs(&self, planes: &Self::Planes, span: Span, to: impl RunSink) {
        self.runs_by_size(planes, span, to);
    }

    #[inline]
    fn all_runs(
        &self,
        planes: &Self::Planes,
        triangle: &TriangleSetup<'_>,
        area: Area,
        to: impl SpanSink,
    ) {
        self.all_runs_by_size(planes, triangle, area, to);
    }
}

impl BySize<MeasuredPlanes> for Adaptive {
    #[inline]
    fn short_runs(&self, planes: &ShortPlanes, span: Span, to: impl RunSink) {
        one_piece(planes, span, to);
    }

    #[inline]
    fn word_runs(&self, planes: &MeasuredPlanes, span: Span, to: impl RunSink) {
        let MeasuredPlanes { words, lengths } = planes;
        let steps = span.left.abs_diff(span.right).wrapping_sub(1);
        let line = words.line(span);
        let last = line.at(steps);
        let first_uv = words.divide(line.first);
        let last_uv = if steps > 0 {
            words.divide(last)
        } else {
            first_uv
        };
        let ends = Ends {
            steps,
            q: [line.first.q, last.q],
            uv: [first_uv, last_uv],
        };
        let line = WordPoints {
            planes: words,
            line,
        };
        self.pieces(&ends, lengths.as_ref(), &line, to);
    }

    #[inline]
    fn whole_runs(&self, planes: &Homogeneous, span: Span, to: impl RunSink) {
        self.far(planes, span, to);
    }
}

impl Adaptive {
    /// Of coordinates that are `2^log2_repeats` times quotients of words, in repeats.
    #[inline]
    fn log2_texels(&self, log2_repeats: i32) -> [i32; 2] {
        [self.log2_width, self.log2_height].map(|log2| i32::from(log2).wrapping_add(log2_repeats))
    }

    /// How long pieces may be in a triangle of words.
    #[inline]
    fn lengths(&self, planes: &WordPlanes, triangle: &TriangleSetup<'_>) -> Lengths {
        let corners = triangle.sides().map(|[_, y]| {
            if triangle.is_counter_clockwise() {
                y.wrapping_neg()
            } else {
                y
            }
        });
        Lengths::new(
            self.inverse,
            &Shape {
                words: planes.words(),
                corners,
                log2_texels: self.log2_texels(WordPlanes::LOG2_REPEATS),
            },
        )
    }

    /// With all bits of the planes.
    #[cold]
    #[inline(never)]
    fn far(&self, planes: &Homogeneous, span: Span, to: impl RunSink) {
        let steps = span.left.abs_diff(span.right).wrapping_sub(1);
        let first = planes.at(span.left, span.y);
        let last = planes.step(first, steps);
        let first_uv = planes.divide_far(first);
        let last_uv = if steps > 0 {
            planes.divide_far(last)
        } else {
            first_uv
        };
        // The nearer end has 31 bits.
        let shift = first.q().max(last.q()).leading_zeros().wrapping_sub(1) & 63;
        let [at, to_last] = [first, last].map(|point| point.shifted_words(shift));
        let ends = Ends {
            steps,
            q: [at.q, to_last.q],
            uv: [first_uv, last_uv],
        };
        // What is on one line: the triangle has other depths, and words for one need not do for them.
        let lengths = (steps > 1).then(|| {
            let right = planes.leap(1).shifted_words(shift);
            Lengths::new(
                self.inverse,
                &Shape {
                    words: [at, right, Words::default()],
                    corners: [0; 2],
                    log2_texels: self.log2_texels(planes.log2_repeats()),
                },
            )
        });
        self.pieces(
            &ends,
            lengths.as_ref(),
            &WholePoints {
                planes,
                first,
                shift,
            },
            to,
        );
    }
}
