//! Two functions that do nothing, at addresses that are known: in a trace of executed addresses a
//! frame lies between them.

use core::arch::asm;

/// Before a frame.
#[inline(never)]
#[unsafe(no_mangle)]
pub(crate) extern "C" fn frame_begins() {
    // SAFETY: does nothing. Differs from the other, so that the two are not made one.
    unsafe { asm!("nop") };
}

/// After it.
#[inline(never)]
#[unsafe(no_mangle)]
pub(crate) extern "C" fn frame_ends() {
    // SAFETY: does nothing.
    unsafe { asm!("nop", "nop") };
}
