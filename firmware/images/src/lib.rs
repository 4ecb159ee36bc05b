//! What every image needs: its chip's plan, a way to print, and what happens in a fault.
#![no_std]

mod fault;
pub mod host;

#[cfg(feature = "nrf51")]
pub use scenes_in_flash::plan::NRF51 as PLAN;
#[cfg(feature = "stm32f405")]
pub use scenes_in_flash::plan::STM32F405 as PLAN;
