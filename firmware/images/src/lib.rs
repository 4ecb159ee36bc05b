//! What every image needs: its chip's plan, a way to print, and what happens in a fault.
#![no_std]

pub mod counter;
mod fault;
pub mod filters;
pub mod host;
pub mod machine;
mod marker;
pub mod measure;
pub mod size;
pub mod stack;

#[cfg(any(feature = "nrf51", feature = "m0"))]
pub use scenes_in_flash::plan::NRF51 as PLAN;
#[cfg(not(any(feature = "nrf51", feature = "m0")))]
pub use scenes_in_flash::plan::STM32F405 as PLAN;
