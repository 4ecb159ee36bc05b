//! PC side of multum: pictures and meshes from files, in the formats that the core draws.

pub mod error;
mod file;
pub mod model;
pub mod picture;
