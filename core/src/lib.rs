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
//! | project | [`corner`], [`project`] | [`project::ScreenVertex`], snapped |
//! | setup | [`setup`] | [`setup::TriangleSetup`], [`setup::Plane`] |
//! | edge, span | [`edge`], [`span`] | [`edge::Edge`], [`span::Span`] |
//! | perspective | [`perspective`] | [`perspective::Run`]: texture coordinates and their steps |
//! | level of detail | [`lod`], [`pyramid`] | [`lod::Chosen`]: a level, or two and a weight |
//! | texture | [`shade`], [`sample`], [`mipmap`], [`filter`], [`texture`], [`colour`] | a colour |
//! | depth, sink | [`depth`], [`visibility`], [`sink`] | a pixel in a [`sink::Band`] |
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
//! | planes of 1/w, u/w, v/w | 62 bits, with a factor for each triangle | |
//! | texture coordinates of pixels | 8.24 | [`uv::Uv`] |
//! | lambda | 16.16 octaves | [`lod::log2`] |
//! | weights of four texels, of two levels | 0.11 and 0.12 | [`colour`] |
//! | depth buffer | 16 bits of near / w | |
//!
//! # Unsafe code
//!
//! None, which the compiler is told to see to; but on x86-64 filters of four and of eight texels, divisions at every pixel,
//! depth tests and long runs take eight pixels at a time by SSE2, instructions that Rust counts as unsafe. They give the
//! same bits as the code of all other processors, from whole numbers as there.
//!
//! # The error of a texture coordinate
//!
//! Against exact arithmetic on the snapped vertices, one perspective division is off by no more
//! than the sum of the terms below, in repeats of the texture. C is what the triangle's coordinates
//! span, P the power of two, 2^-11 or more, that no coordinate on either axis is farther from the first corner's,
//! rho the ratio of the point's w to the triangle's smallest.
//!
//! | term | bound |
//! |---|---|
//! | 1/w of the corners: cut to a unit, where there are 2^30 / rho or more | C rho 2^-30 |
//! | u/w of the corners: cut to a unit of 2 P repeats, likewise | P rho 2^-29 |
//! | planes: exact, but for bits shifted out of large triangles | C rho 2^-40 |
//! | the division: result rounded up, ratio and u/w cut to a unit; reciprocal 2^-29, its divisor cut to 31 bits | 2^-24 + 3 P 2^-30 + C 2^-28 |
//! | single words in place of 64 bits, where depths are within 1:128 and P is at most 32: those of u/w with the bits of the result, rounded; and what is added so that nothing comes out before the edge of a texel that it was on | 1.6 rho (2^-24 + C 2^-30) + 4 2^-24 |
//! | small triangles, see below: 16 bits of w, 20 of 1/w and u/w of the corners, changes cut to a unit for 16 columns and 16 rows, a reciprocal of 16 bits; and what is added so that nothing comes out before the edge of a texel that it was on | C (2^-15.6 + 2^-15.8 + 2^-15.3 + 33 2^-24.8) + 2^-18.8 + 33 2^-25.8 + P 2^-15 + 48 2^-24 |
//! | with a division at every pixel: words stepped up to 127 pixels, 1/w by steps of 30 bits, u/w by steps that are rounded up | 2^-18 + 81 C 2^-29 |
//!
//! On 256 texels that is below 1/5,000 texel at rho = 4 and 3 repeats (1/700 with a division at every pixel),
//! 1/190 texel at rho = 256 and 16 repeats, and 0.33 texel at rho = 4096 and 64 repeats. Small are triangles of up
//! to 16 pixels each way, all corners' depths and coordinates less than an eighth and an eighth of a repeat from
//! the first's: with them it is below 1/150 texel, at most 1.7 units of the 16.16 in which coordinates are given.
//! The tests assert these terms pixel by pixel. What a strategy adds by interpolating is said in its own
//! documentation.
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
//! farther than its last bit from the rounded exact value. In small triangles lambda may be off by 2^-8.7, which makes
//! it 1.2 units, and 0.3; of 99.8 % of their pixels it is off by less than 2^-12.
#![no_std]
// Only `simd` needs it, and only for SSE2.
#![cfg_attr(
    not(all(target_arch = "x86_64", target_feature = "sse2")),
    forbid(unsafe_code)
)]
#![deny(unsafe_code)]

#[cfg(feature = "camera")]
pub mod angle;
mod arith;
pub mod camera;
pub mod clip;
pub mod colour;
pub mod corner;
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
mod near_depths;
pub mod perspective;
pub mod project;
pub mod pyramid;
pub mod sample;
pub mod setup;
pub mod shade;
mod simd;
pub mod sink;
pub mod span;
pub mod texture;
pub mod transform;
pub mod uv;
pub mod viewport;
pub mod visibility;

pub use embedded_graphics;
pub use fixed;

#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
