//! Hands the linker the chip's memory map, and the code the chip's name.

use std::path::PathBuf;
use std::process::ExitCode;
use std::{env, fs};

/// The chips, each a feature, and their memory maps.
const CHIPS: [(&str, &str); 8] = [
    ("stm32f405", "../../memory.x"),
    ("nrf51", "memory/nrf51.x"),
    ("m0", "memory/mps2.x"),
    ("m3", "memory/mps2.x"),
    ("m4", "memory/mps2.x"),
    ("m7", "memory/mps2.x"),
    ("m33", "memory/mps2-secure.x"),
    ("riscv", "memory/virt.x"),
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
    let mut chosen = CHIPS.iter().filter(|(chip, _)| {
        env::var_os(format!("CARGO_FEATURE_{}", chip.to_uppercase())).is_some()
    });
    let (Some((chip, map)), None) = (chosen.next(), chosen.next()) else {
        let names = CHIPS.map(|(chip, _)| chip).join(", ");
        return Err(format!("choose exactly one chip with --features: {names}"));
    };
    println!("cargo::rustc-env=CHIP={chip}");
    println!("cargo::rerun-if-changed={map}");
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("cargo sets no OUT_DIR")?);
    fs::copy(map, out.join("memory.x")).map_err(|error| format!("{map}: {error}"))?;
    println!("cargo::rustc-link-search={}", out.display());
    // The linker script of cortex-m-rt or riscv-rt, which includes memory.x.
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    Ok(())
}
