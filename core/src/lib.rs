//! Textured triangles in perspective, for microcontrollers.
#![no_std]
#![forbid(unsafe_code)]

mod arith;
pub mod camera;
pub mod clip;
pub mod depth;
pub mod draw;
pub mod edge;
pub mod error;
pub mod geometry;
pub mod hash;
mod packed;
pub mod perspective;
pub mod project;
pub mod sample;
pub mod setup;
pub mod sink;
pub mod span;
pub mod texture;
pub mod transform;
pub mod uv;
pub mod viewport;

pub use embedded_graphics;
pub use fixed;
