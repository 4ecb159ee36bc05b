//! Chips that are sold with the cores that were counted, and their usual clocks.

use std::fmt;
use std::str::FromStr;

use serde::Serialize;

use crate::report::on_target::PC;

/// A chip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Chip {
    /// Its name on the command line.
    pub name: &'static str,
    /// Its name in print.
    pub title: &'static str,
    /// The core in the record of counts.
    pub core: &'static str,
    /// The core's name in print.
    pub core_title: &'static str,
    /// MHz; none for a PC, whose frames are timed.
    pub clock: Option<f64>,
}

const fn chip(
    name: &'static str,
    title: &'static str,
    core: &'static str,
    core_title: &'static str,
    clock: f64,
) -> Chip {
    Chip {
        name,
        title,
        core,
        core_title,
        clock: Some(clock),
    }
}

impl Chip {
    /// All of them, one for each core that was counted at least.
    pub const ALL: [Self; 8] = [
        chip("rp2040", "RP2040", "m0", "Cortex-M0+", 125.0),
        chip("stm32f103", "STM32F103", "m3", "Cortex-M3", 72.0),
        chip("nrf52840", "nRF52840", "m4", "Cortex-M4", 64.0),
        chip("stm32f405", "STM32F405", "m4", "Cortex-M4", 168.0),
        chip("stm32h743", "STM32H743", "m7", "Cortex-M7", 480.0),
        chip("rp2350", "RP2350", "m33", "Cortex-M33", 150.0),
        chip("esp32-c3", "ESP32-C3", "riscv", "RV32IMC", 160.0),
        Self {
            name: "pc",
            title: "PC",
            core: PC,
            core_title: "x86-64",
            clock: None,
        },
    ];

    /// Milliseconds that so many cycles take; none on a PC.
    #[must_use]
    pub fn milliseconds(&self, cycles: f64) -> Option<f64> {
        self.clock.map(|mhz| cycles / (mhz * 1e3))
    }
}

impl fmt::Display for Chip {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({}", self.title, self.core_title)?;
        match self.clock {
            Some(mhz) => write!(f, ", {mhz} MHz)"),
            None => f.write_str(")"),
        }
    }
}

impl FromStr for Chip {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        let found = Self::ALL
            .into_iter()
            .find(|chip| chip.name == s && chip.clock.is_some());
        found.ok_or_else(|| {
            let known = Self::ALL.iter().filter(|chip| chip.clock.is_some());
            let names: Vec<_> = known.map(|chip| chip.name).collect();
            format!("choose one of {}", names.join(", "))
        })
    }
}
