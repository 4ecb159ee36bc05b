//! Hands the linker the chip's memory map.

use std::path::PathBuf;
use std::process::ExitCode;
use std::{env, fs};

/// The feature of each chip, as cargo names it here, and its memory map.
const CHIPS: [(&str, &str); 4] = [
    ("CARGO_FEATURE_STM32F405", "../../memory.x"),
    ("CARGO_FEATURE_NRF51", "memory/nrf51.x"),
    ("CARGO_FEATURE_M4", "memory/mps2.x"),
    ("CARGO_FEATURE_M0", "memory/mps2.x"),
];

fn main() -> ExitCode {
    match link() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            println!("cargo::error={error}");
            ExitCode::FAILURE
        }
    }
}

fn link() -> Result<(), String> {
    println!("cargo::rerun-if-changed=build.rs");
    let mut chosen = CHIPS
        .iter()
        .filter(|(feature, _)| env::var_os(feature).is_some());
    let (Some((_, map)), None) = (chosen.next(), chosen.next()) else {
        return Err("choose exactly one chip: --features stm32f405, nrf51, m4 or m0".into());
    };
    println!("cargo::rerun-if-changed={map}");
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("cargo sets no OUT_DIR")?);
    fs::copy(map, out.join("memory.x")).map_err(|error| format!("{map}: {error}"))?;
    println!("cargo::rustc-link-search={}", out.display());
    // cortex-m-rt's linker script, which includes memory.x.
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    Ok(())
}
