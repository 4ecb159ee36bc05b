//! The tables that the build script writes. What an image does not name is not in it.

macro_rules! baked {
    ($module:ident, $file:literal) => {
        #[doc = concat!("Baked `", $file, "`.")]
        // The loops over texels run in the compiler, and end.
        #[allow(long_running_const_eval)]
        pub mod $module {
            use crate::scene::{Part, Scene, Skin};
            include!(concat!(env!("OUT_DIR"), "/", $file));
        }
    };
}

baked!(wooden_crate, "crate.rs");
baked!(spot, "spot.rs");
baked!(room, "room.rs");
baked!(corridor, "corridor.rs");
baked!(checkers, "checkers.rs");
