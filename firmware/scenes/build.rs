//! Bakes the scenes: host-sim's meshes and textures become tables in flash.

mod stand_in;

use std::path::PathBuf;
use std::process::ExitCode;
use std::{env, fs};

/// The scenes that images draw; `src/baked.rs` includes each.
const SCENES: [&str; 3] = ["crate", "spot", "room"];

fn main() -> ExitCode {
    match bake() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            println!("cargo::error={error}");
            ExitCode::FAILURE
        }
    }
}

fn bake() -> Result<(), String> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=stand_in.rs");
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("cargo sets no OUT_DIR")?);
    for name in SCENES {
        let source = stand_in::with_scene(name, host_sim::bake::rust_source)
            .ok_or_else(|| format!("there is no scene `{name}`"))?;
        let path = out.join(format!("{name}.rs"));
        fs::write(&path, source).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    Ok(())
}
