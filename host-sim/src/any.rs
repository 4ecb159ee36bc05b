//! The core's traits for choices that are made at run time. The core has a type for every choice, so
//! that an image for a chip has only what it uses; a program that offers them all would have to
//! compile every combination. Here each trait has one implementor that decides when it is called.

use multum::colour::{Colour, Wide};
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::filter::{ImageFilter, LinearTexels, LinearTexels5, NearestTexel};
use multum::lod::footprint::{AtMean, FootprintLine, FootprintWords, Lambdas};
use multum::lod::{
    Choice, EachPiece, EachPixel, EachSpan, EachTriangle, Euclidean, FinestLevel, LinearLevels,
    LongestAxis, NearestLevel, Piece, Rate, Rule, SafestLevel,
};
use multum::perspective::{Run, RunSink, Strategy};
use multum::sample::{Nearest, Sampler};
use multum::setup::TriangleSetup;
use multum::span::Span;
use multum::texture::{Bc1, Indexed4, Indexed8, Morton, Texels, Texture, Wrap};
use multum::uv::Uv;

use crate::choice::with_wrap;
use crate::filtering::{Per, Within};
use crate::reference::Beyond;
use crate::reference::lod;

/// The nearest texel, whatever lies beyond the texture's edges.
#[derive(Clone, Copy, Debug)]
pub struct AnyNearest<T> {
    /// The texture.
    pub texture: T,
    /// What lies beyond its edges.
    pub wrap: Beyond,
}

impl<T: Texels + Copy> Sampler for AnyNearest<T> {
    type Texel = T::Colour;

    #[inline]
    fn sample(&self, uv: Uv) -> T::Colour {
        with_wrap!(self.wrap, W => Nearest::<T, W>::new(self.texture).sample(uv))
    }
}

/// A filter within a level.
#[derive(Clone, Copy, Debug)]
pub struct AnyImage(pub Within);

/// What a filter within a level gives to be mixed.
#[derive(Clone, Copy, Debug, Default)]
pub enum AnyWide<C: Colour> {
    /// Nothing yet: a sum's beginning.
    #[default]
    Nothing,
    /// Channels with their fractions.
    Channels(C::Wide),
    /// Channels that share words.
    Lanes(C::Lanes),
}

impl<C: Colour> Wide for AnyWide<C> {
    fn lerp(self, other: Self, weight: u32) -> Self {
        match (self, other) {
            (Self::Channels(a), Self::Channels(b)) => Self::Channels(a.lerp(b, weight)),
            (Self::Lanes(a), Self::Lanes(b)) => Self::Lanes(a.lerp(b, weight)),
            _ => unreachable!("one filter gives both"),
        }
    }

    fn plus(self, other: Self) -> Self {
        match (self, other) {
            (Self::Nothing, sum) | (sum, Self::Nothing) => sum,
            (Self::Channels(a), Self::Channels(b)) => Self::Channels(a.plus(b)),
            (Self::Lanes(a), Self::Lanes(b)) => Self::Lanes(a.plus(b)),
            _ => unreachable!("one filter gives both"),
        }
    }

    fn half(self, times: u32) -> Self {
        match self {
            Self::Nothing => self,
            Self::Channels(sum) => Self::Channels(sum.half(times)),
            Self::Lanes(sum) => Self::Lanes(sum.half(times)),
        }
    }
}

impl ImageFilter for AnyImage {
    type Wide<C: Colour> = AnyWide<C>;

    fn narrow<C: Colour>(wide: AnyWide<C>) -> C {
        match wide {
            AnyWide::Nothing => C::default(),
            AnyWide::Channels(wide) => C::narrow(wide),
            AnyWide::Lanes(lanes) => C::gather(lanes),
        }
    }

    fn texel<T, U, V>(&self, texture: &T, uv: Uv) -> T::Colour
    where
        T: Texels<Colour: Colour>,
        U: Wrap,
        V: Wrap,
    {
        match self.0 {
            Within::Nearest => NearestTexel.texel::<T, U, V>(texture, uv),
            Within::Linear => LinearTexels.texel::<T, U, V>(texture, uv),
            Within::Linear5 => LinearTexels5.texel::<T, U, V>(texture, uv),
        }
    }

    fn wide<T, U, V>(&self, texture: &T, uv: Uv) -> AnyWide<T::Colour>
    where
        T: Texels<Colour: Colour>,
        U: Wrap,
        V: Wrap,
    {
        match self.0 {
            Within::Nearest => AnyWide::Channels(NearestTexel.wide::<T, U, V>(texture, uv)),
            Within::Linear => AnyWide::Channels(LinearTexels.wide::<T, U, V>(texture, uv)),
            Within::Linear5 => AnyWide::Lanes(LinearTexels5.wide::<T, U, V>(texture, uv)),
        }
    }

    fn fill<T, U, V, P>(&self, texture: &T, uv: Uv, step: Uv, pixels: &mut [P])
    where
        T: Texels<Colour: Colour + Into<P>>,
        U: Wrap,
        V: Wrap,
    {
        match self.0 {
            Within::Nearest => NearestTexel.fill::<T, U, V, P>(texture, uv, step, pixels),
            Within::Linear => LinearTexels.fill::<T, U, V, P>(texture, uv, step, pixels),
            Within::Linear5 => LinearTexels5.fill::<T, U, V, P>(texture, uv, step, pixels),
        }
    }
}

/// A choice of levels.
#[derive(Clone, Copy, Debug)]
pub struct AnyChoice(pub lod::Choice);

impl Choice for AnyChoice {
    const BLENDS: bool = true;

    fn level(&self, lambda: i32) -> (u32, u32) {
        match self.0 {
            lod::Choice::Base => FinestLevel.level(lambda),
            lod::Choice::Nearest => NearestLevel.level(lambda),
            lod::Choice::Safest => SafestLevel.level(lambda),
            lod::Choice::Linear => LinearLevels.level(lambda),
        }
    }
}

/// A rule for the size of a footprint.
#[derive(Clone, Copy, Debug)]
pub struct AnyRule(pub lod::Rule);

impl Rule for AnyRule {
    type Length = i32;

    fn length(&self, step: [i64; 2]) -> i32 {
        match self.0 {
            lod::Rule::LongestAxis => LongestAxis.log2(LongestAxis.length(step)),
            lod::Rule::Euclidean => Euclidean.log2(Euclidean.length(step)),
        }
    }

    fn log2(&self, length: i32) -> i32 {
        length
    }

    type Word = i32;

    fn length_of_words(&self, step: [i32; 2]) -> i32 {
        match self.0 {
            lod::Rule::LongestAxis => LongestAxis.log2_of_word(LongestAxis.length_of_words(step)),
            lod::Rule::Euclidean => Euclidean.log2_of_word(Euclidean.length_of_words(step)),
        }
    }

    fn log2_of_word(&self, length: i32) -> i32 {
        length
    }
}

/// How often lambda is computed.
#[derive(Clone, Copy, Debug)]
pub struct AnyRate(pub Per);

/// How lambda is found.
#[derive(Clone, Copy, Debug)]
pub enum AnyLambdas {
    /// Once for the triangle.
    Mean(AtMean),
    /// For pixels of a span.
    Pixels(FootprintWords),
}

/// The same, prepared for a span.
#[derive(Clone, Debug)]
pub enum AnyLambdasRow<R: Rule> {
    /// Once for the triangle.
    Mean(AtMean),
    /// For pixels.
    Pixels(FootprintLine<R>),
}

impl Lambdas for AnyLambdas {
    type Row<'t, R: Rule> = AnyLambdasRow<R>;

    fn row<R: Rule>(&self, span: Span, rule: R) -> AnyLambdasRow<R> {
        match self {
            Self::Mean(mean) => AnyLambdasRow::Mean(mean.row(span, rule)),
            Self::Pixels(pixels) => AnyLambdasRow::Pixels(pixels.row(span, rule)),
        }
    }

    fn lambda<R: Rule>(row: &AnyLambdasRow<R>, offset: usize) -> i32 {
        match row {
            AnyLambdasRow::Mean(mean) => AtMean::lambda::<R>(mean, offset),
            AnyLambdasRow::Pixels(line) => FootprintWords::lambda(line, offset),
        }
    }
}

impl Rate for AnyRate {
    type Lambdas = AnyLambdas;

    fn lambdas<R: Rule>(
        &self,
        triangle: &TriangleSetup<'_>,
        log2_size: (u32, u32),
        rule: R,
    ) -> AnyLambdas {
        match self.0 {
            Per::Triangle => AnyLambdas::Mean(EachTriangle.lambdas(triangle, log2_size, rule)),
            Per::Span => AnyLambdas::Pixels(EachSpan.lambdas(triangle, log2_size, rule)),
            Per::Piece => AnyLambdas::Pixels(EachPiece.lambdas(triangle, log2_size, rule)),
            Per::Pixel => AnyLambdas::Pixels(EachPixel.lambdas(triangle, log2_size, rule)),
        }
    }

    fn piece(&self, span: Span, offset: usize) -> Piece {
        match self.0 {
            Per::Triangle => EachTriangle.piece(span, offset),
            Per::Span => EachSpan.piece(span, offset),
            Per::Piece => EachPiece.piece(span, offset),
            Per::Pixel => EachPixel.piece(span, offset),
        }
    }
}

/// A texture of RGB565 in one of the ways to store them.
#[derive(Clone, Copy, Debug)]
pub enum AnyTexels<'a> {
    /// Colours, row by row.
    Direct(Texture<'a, Rgb565>),
    /// Indices into 256 colours.
    Indexed8(Indexed8<'a, Rgb565>),
    /// Indices into 16 colours.
    Indexed4(Indexed4<'a, Rgb565>),
    /// Compressed blocks.
    Bc1(Bc1<'a>),
    /// Colours in Morton order.
    Morton(Morton<'a, Rgb565>),
}

/// Evaluates `$body` with the texture in the place of `$name`.
macro_rules! each_texture {
    ($texels:expr, $name:ident => $body:expr) => {
        match $texels {
            AnyTexels::Direct($name) => $body,
            AnyTexels::Indexed8($name) => $body,
            AnyTexels::Indexed4($name) => $body,
            AnyTexels::Bc1($name) => $body,
            AnyTexels::Morton($name) => $body,
        }
    };
}

impl Texels for AnyTexels<'_> {
    type Colour = Rgb565;

    fn log2_size(&self) -> (u32, u32) {
        each_texture!(self, texture => Texels::log2_size(texture))
    }

    fn texel(&self, column: u32, row: u32) -> Rgb565 {
        each_texture!(self, texture => texture.texel(column, row))
    }

    fn fill_repeating<P>(&self, uv: Uv, step: Uv, pixels: &mut [P])
    where
        Rgb565: Into<P>,
    {
        each_texture!(self, texture => texture.fill_repeating(uv, step, pixels));
    }
}

/// The runs of one triangle's spans.
type Runs<'s> = Box<dyn Fn(Span, &mut dyn FnMut(Run)) + 's>;

/// From a triangle to its runs.
type Plan<'s> = dyn Fn(&TriangleSetup<'_>) -> Option<Runs<'s>> + 's;

/// A perspective strategy behind a pointer.
pub struct AnyStrategy<'s>(Box<Plan<'s>>);

impl<'s> AnyStrategy<'s> {
    /// Behind a pointer.
    pub fn new<P: Strategy<Planes: 's> + Copy + 's>(strategy: P) -> Self {
        Self(Box::new(move |triangle| {
            let planes = strategy.planes(triangle)?;
            let runs = move |span: Span, emit: &mut dyn FnMut(Run)| {
                strategy.runs(&planes, span, emit);
            };
            Some(Box::new(runs) as Runs<'s>)
        }))
    }
}

impl<'s> Strategy for AnyStrategy<'s> {
    type Planes = Runs<'s>;

    fn planes(&self, triangle: &TriangleSetup<'_>) -> Option<Runs<'s>> {
        (self.0)(triangle)
    }

    fn runs(&self, planes: &Runs<'s>, span: Span, mut to: impl RunSink) {
        planes(span, &mut |run| to.run(run));
    }
}
