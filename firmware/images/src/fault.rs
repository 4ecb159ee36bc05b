//! Panics.
//!
//! No panic can happen in a release image, and the linker shows it: the handler calls a function
//! that does not exist. If no code can panic, the handler is left out and nothing is missing; if
//! one panic remains, linking fails with "undefined symbol: multum_panic_is_reachable". To find
//! it, link with `-Clink-arg=--unresolved-symbols=ignore-all` and look in the disassembly for
//! calls into `core::panicking`. A debug image, with its overflow checks, may panic: it prints
//! where, and fails.

use core::panic::PanicInfo;

#[cfg(debug_assertions)]
use crate::host::{Output, exit};

#[cfg(not(debug_assertions))]
#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        fn multum_panic_is_reachable() -> !;
    }
    // SAFETY: no image in which this could be called can be linked.
    unsafe { multum_panic_is_reachable() }
}

#[cfg(debug_assertions)]
#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    let mut output = Output::new();
    output.text("panic");
    if let Some(place) = info.location() {
        output.text(" at ").text(place.file());
        output.text(" line ").decimal(place.line());
    }
    output.text("\n");
    exit(false)
}
