//! Speed against error: every technique on every scene, what it gets wrong, and what it costs on
//! each chip.
//!
//! [`measure`] draws and compares, [`on_target`] adds what was counted on the chips' cores. From the
//! rows of both come the [`answer`] to a user's question, [`table`]s, [`plot`]s, a [`page`] and the
//! [`readme`]'s section.

pub mod answer;
pub mod chip;
pub mod front;
pub mod measure;
pub mod on_target;
pub mod page;
pub mod peers;
pub mod plot;
pub mod readme;
pub mod setting;
pub mod table;
