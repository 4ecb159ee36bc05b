//! Bakes the scenes: host-sim's meshes and textures become tables in flash.

use std::path::PathBuf;
use std::process::ExitCode;
use std::{env, fs};

use host_sim::{bake, scenes};

/// The scenes that images draw; `src/baked.rs` includes each.
const SCENES: [&str; 3] = scenes::DEVICE;

fn main() -> ExitCode {
    match bake_all() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            println!("cargo::error={error}");
            ExitCode::FAILURE
        }
    }
}

fn bake_all() -> Result<(), String> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=../../host-sim/assets");
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("cargo sets no OUT_DIR")?);
    for name in SCENES {
        let source = scenes::on_device(name)
            .map_err(|error| error.to_string())?
            .ok_or_else(|| format!("there is no scene {name}"))
            .and_then(|scene| bake::rust_source(&scene).map_err(|error| error.to_string()))?;
        let path = out.join(format!("{name}.rs"));
        fs::write(&path, source).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    Ok(())
}
