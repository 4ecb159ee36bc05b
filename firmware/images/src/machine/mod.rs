//! What differs between architectures: where a program begins, how it prints and ends, and what
//! counts its instructions. Each has the same items; an image holds one of them.

#[cfg(not(target_arch = "riscv32"))]
mod arm;
#[cfg(target_arch = "riscv32")]
mod riscv;

#[cfg(not(target_arch = "riscv32"))]
pub use arm::*;
#[cfg(target_arch = "riscv32")]
pub use riscv::*;
