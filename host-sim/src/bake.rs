//! Scenes and textures as Rust source, for chips that have no file system: tables that lie in
//! flash, checked by the compiler. What enters is loaded and averaged as a chip would; what leaves
//! is the text of a module, which names the core's types by their full paths.

mod scene;
mod source;
mod texture;

pub use self::scene::{Skin, rust_source};
pub use self::texture::{Baked, LEVELS, Levels, Name, Plan, texture_source};
