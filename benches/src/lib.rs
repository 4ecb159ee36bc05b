//! What drawing costs on a PC, ours beside that of other renderers.
//!
//! The [`scene`]s of host-sim's `benchmark`, triangles given after projection, and one [`texture`]
//! enter. A [`case`] is a scene and what draws it: the core in one of its ways ([`ours`]) or one of
//! the [`peers`]. Every case becomes a [`drawing::Drawing`], which draws a whole frame of 320x240,
//! setup included and clearing not. Two benches draw them all:
//!
//! - `benches/time.rs`, with Criterion: nanoseconds per pixel, or per triangle for `mesh`;
//! - `benches/instructions.rs`, with Valgrind's callgrind: instructions per pixel or triangle.
//!
//! [`time`] and [`instructions`] run them and read what they measured, [`table`] puts it side by side,
//! [`budget`] compares it with `budgets.toml`.
//!
//! The core and the peers are generic, so that all of it is compiled here, with the workspace's profile
//! `bench`: that of releases with one codegen unit; optimization 3, thin link-time optimization, the
//! target's baseline (SSE2 on x86-64).

pub mod budget;
pub mod case;
pub mod drawing;
pub mod error;
pub mod instructions;
pub mod ours;
pub mod peers;
mod program;
pub mod scene;
pub mod table;
pub mod texture;
pub mod time;
