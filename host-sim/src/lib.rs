//! PC side.
pub mod bake;
