//! Measures how deep a call goes into the stack: the memory below the stack pointer is painted, and
//! after the call the deepest word that changed is looked for.
//!
//! What a function reserves and does not write to on the way that was taken stays unseen:
//! `firmware/run` also adds up what the functions reserve.

use core::ptr;

use crate::machine::{known_stack, paint};

/// Painted words.
const WORDS: usize = 1024;
/// No number that drawing stores, and no address.
const PAINT: u32 = 0xA5C3_965A;

/// How deep a call went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Depth {
    /// Bytes below the caller's stack pointer.
    pub bytes: u32,
    /// Where the code of the call begins.
    pub code: u32,
}

/// Calls `work`, in a function of its own, and measures it. `None` if it uses all that was painted.
#[inline(never)]
pub fn deepest<F: FnOnce()>(work: F) -> Option<Depth> {
    // SAFETY: nothing lies below the stack pointer; the images that measure have 1 MB of stack, and
    // no interrupts.
    let top = unsafe { paint(WORDS, PAINT) };
    call(work);
    let word = |depth: usize| ptr::with_exposed_provenance::<u32>(top - 4 * depth);
    // SAFETY: painted above.
    let changed = |&depth: &usize| unsafe { word(depth).read_volatile() } != PAINT;
    let words = (1..=WORDS).rev().find(changed).unwrap_or_default();
    (words < WORDS).then_some(Depth {
        bytes: 4 * words as u32,
        code: call::<F> as *const () as u32,
    })
}

#[inline(never)]
fn call<F: FnOnce()>(work: F) {
    work();
}

/// Whether what is known is measured: functions that use a known amount of stack, and a few words
/// of the function that calls them.
#[must_use]
pub fn calibrated() -> bool {
    const CALL: u32 = 16;
    let [little, much] = [
        deepest(|| known_stack::<64>()),
        deepest(|| known_stack::<448>()),
    ]
    .map(|depth| depth.map_or(0, |depth| depth.bytes));
    (64..=64 + CALL).contains(&little) && much == little + (448 - 64)
}
