//! The PC side of multum: scenes, meshes and pictures from files, drawn by the core, checked
//! against a float64 reference.
//!
//! A [`subject`] is a [`scene`] of the world or given after projection. [`frame`] runs the core's
//! geometry over it; from there two ways part and meet again in [`compare`]: [`render`] draws
//! with the core, [`mod@reference`] computes the same pixels in float64 and shares no arithmetic
//! with it. [`stability`] does so for the cases in which rasterizers fail, against the [`bound`]s
//! of the strategies.

pub mod aliasing;
pub mod any;
pub mod any_shader;
pub mod atlas;
pub mod bake;
pub mod benchmark;
pub mod bound;
pub mod camera_precision;
pub mod choice;
pub mod compare;
pub mod conformance;
pub mod encode;
pub mod error;
mod file;
pub mod filtering;
pub mod frame;
#[cfg(feature = "cli")]
pub mod fuzz;
pub mod hard_case;
pub mod heat_map;
pub mod historic;
pub mod layout;
pub mod lettering;
pub mod model;
pub mod output;
pub mod pattern;
pub mod picture;
pub mod probe;
pub mod reference;
pub mod render;
#[cfg(feature = "cli")]
pub mod report;
pub mod scene;
pub mod scenes;
pub mod shaded;
pub mod shape;
pub mod similarity;
pub mod stability;
pub mod stored;
pub mod subject;
pub mod swimming;
pub mod texgen;
pub mod view;
