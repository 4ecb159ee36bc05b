//! Tests.
pub mod tolerance;
