//! Textured triangles in perspective, for microcontrollers: no heap, no floating point in the
//! pipeline, no panics, and the same pixels on every target.
//!
//! # Conventions
//!
//! - The world is right-handed with y up, as in glTF; the camera looks along -z. In clip space w
//!   is the distance along the view axis, positive in front of the camera. There is no clip z.
//! - On the screen x points right and y down, from the top-left corner of the top-left pixel;
//!   pixel centres are at +0.5.
//! - A triangle whose corners appear counter-clockwise shows its front.
//! - Texture coordinates are in repeats of the texture: u right, v down, (0, 0) at the top-left
//!   corner of texel (0, 0), 1 at the right and the lower edge. Texel centres are at
//!   `(i + 0.5) / size`, as in OpenGL, Vulkan and Direct3D.
//! - Coverage: a pixel is drawn when its centre is inside the triangle *as snapped to 1/256
//!   pixel*; on an edge, when that is a top or a left edge. Triangles that share an edge leave no
//!   gap and draw no pixel twice. Attributes are set up from the snapped positions.
//!
//! # The way of a triangle
//!
//! Each stage has a type of its own and takes the one before it; [`draw::Pipeline`] joins them.
//!
//! | stage | module | gives |
//! |---|---|---|
//! | geometry | [`geometry`], [`transform`], [`camera`] | [`geometry::Vertex`], [`camera::ToClip`] |
//! | clip | [`clip`] | [`clip::ClipVertex`], inside near plane and guard band |
//! | project | [`project`] | [`project::ScreenVertex`], snapped |
//! | setup | [`setup`] | [`setup::TriangleSetup`], [`setup::Plane`] |
//! | edge, span | [`edge`], [`span`] | [`edge::Edge`], [`span::Span`] |
//! | perspective | [`perspective`] | [`perspective::Run`]: texture coordinates and their steps |
//! | level of detail | [`lod`], [`pyramid`] | [`lod::Chosen`]: a level, or two and a weight |
//! | texture | [`shade`], [`sample`], [`mipmap`], [`filter`], [`texture`], [`colour`] | a colour |
//! | depth, sink | [`depth`], [`sink`] | a pixel in a [`sink::Band`] |
//!
//! # Formats
//!
//! | what | format | range |
//! |---|---|---|
//! | positions | 16.16 | [`geometry::MAX_POSITION`] |
//! | texture coordinates of vertices | 16.16 | [`geometry::MAX_UV`], [`geometry::MAX_UV_SPAN`] in a triangle |
//! | matrices | 8.24 and 16.16 | |
//! | clip coordinates | 16.16 | |
//! | screen coordinates | 24.8 | [`viewport::GUARD_BAND`] |
//! | planes of 1/w, u/w, v/w | 31.31 modulo 2^64, with an exponent for each triangle | |
//! | texture coordinates of pixels | 8.24 | [`uv::Uv`] |
//! | lambda | 16.16 octaves | [`lod::log2`] |
//! | weights of four texels, of two levels | 0.11 and 0.12 | [`colour`] |
//! | depth buffer | 16 bits of near / w | |
//!
//! # The error of a texture coordinate
//!
//! Against exact arithmetic on the snapped vertices, one perspective division is off by no more
//! than the sum of the terms below, in repeats of the texture. R is the power of two of repeats that
//! exceeds the triangle's range of the coordinate (1 for 0 to 0.9, 2 for 0 to 1), rho the ratio of its
//! largest to its smallest w.
//!
//! | term | bound |
//! |---|---|
//! | 1/w of the corners: reciprocal 2^-29, shared exponent rho 2^-31; half of it, since a weighted mean moves | R (2^-30 + rho 2^-32) |
//! | u/w of the corners: half a unit, where 1/w has 2^30 / rho units or more | R rho 2^-31 |
//! | reciprocal of the area: a move by 2^-29 of the distance from a corner, near which u may change rho times as fast as on the average | R rho 2^-29 |
//! | gradients: 2^-11 units in u/w and in 1/w | R rho 2^-40 |
//! | the division: 2^-29 for the value's bits, the reciprocal, and the product's bits each, 2^-31 for the divisor's | R 2^-27 |
//! | rounding to 8.24 | 2^-25 |
//!
//! On 256 texels that is below 1/30,000 texel at rho = 4 and a range of 3 repeats, 1/180 texel at
//! rho = 256 and 16 repeats, and 0.35 texel at rho = 4096 and 64 repeats. The tests assert these
//! terms pixel by pixel. What a strategy adds by interpolating is said in its own documentation.
//!
//! # The error of a colour
//!
//! Against exact filtering of the same texels at the same coordinates, where a channel's texels span
//! c units, before the one rounding at the end:
//!
//! | term | bound |
//! |---|---|
//! | weights of four texels: the fractions of u and v cut to 2^-11, their product too | c 2^-9 |
//! | weight of the coarser of two levels: cut to 2^-12 | c 2^-12 |
//! | lambda, off by less than 2^-12 | c 2^-12 |
//! | mixed levels and sums of samples: cut to 2^-11 of a unit each | 2^-10 |
//!
//! For 8 bits (c = 255) that is 0.63 of a unit, for 6 bits 0.16: with the rounding no channel is
//! farther than its last bit from the rounded exact value.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "camera")]
pub mod angle;
mod arith;
pub mod camera;
pub mod clip;
pub mod colour;
pub mod cutout;
pub mod depth;
pub mod draw;
pub mod edge;
pub mod error;
pub mod filter;
pub mod geometry;
pub mod hash;
pub mod lod;
pub mod mipmap;
pub mod perspective;
pub mod project;
pub mod pyramid;
pub mod sample;
pub mod setup;
pub mod shade;
pub mod sink;
pub mod span;
pub mod texture;
pub mod transform;
pub mod uv;
pub mod viewport;

pub use embedded_graphics;
pub use fixed;

#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
