//! One module for each command.

pub(crate) mod bake;
pub(crate) mod compare;
pub(crate) mod conformance;
pub(crate) mod filters;
pub(crate) mod hash;
pub(crate) mod historic;
pub(crate) mod layout;
pub(crate) mod overview;
pub(crate) mod render;
pub(crate) mod report;
pub(crate) mod scenes;
pub(crate) mod stability;
