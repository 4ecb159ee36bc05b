//! PC side.
