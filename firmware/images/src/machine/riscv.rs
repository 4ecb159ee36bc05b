//! RISC-V, with the semihosting calls of its specification ("RISC-V Semihosting", version 0.3):
//! those of Arm, told from other breakpoints by the two instructions around.

use core::arch::{asm, naked_asm};

pub use riscv::singleton;
pub use riscv_rt::entry;

const OPEN: usize = 0x01;
const WRITE: usize = 0x05;
const EXIT: usize = 0x18;
const APPLICATION_EXIT: usize = 0x2_0026;
const RUN_TIME_ERROR: usize = 0x2_0023;

/// Calls the debugger.
///
/// # Safety
///
/// `argument` is what the operation asks for: a value, or the address of a block that it may read.
unsafe fn call(operation: usize, argument: usize) -> isize {
    let result;
    // SAFETY: the caller's; the debugger changes a0 only. The three instructions are uncompressed
    // and, aligned so, in one page.
    unsafe {
        asm!(
            ".option push",
            ".option norvc",
            ".balign 16",
            "slli x0, x0, 0x1f",
            "ebreak",
            "srai x0, x0, 7",
            ".option pop",
            inout("a0") operation => result,
            in("a1") argument,
            options(nostack),
        );
    }
    result
}

/// Standard output on the PC.
#[derive(Clone, Copy)]
pub struct Stream(isize);

impl Stream {
    /// `None` if the debugger opens nothing.
    #[must_use]
    pub fn open() -> Option<Self> {
        // Terminal, to write.
        const NAME: &[u8] = b":tt\0";
        const MODE: usize = 4;
        let block = [NAME.as_ptr() as usize, MODE, NAME.len() - 1];
        // SAFETY: a name, how to open it, and the name's length.
        let handle = unsafe { call(OPEN, block.as_ptr() as usize) };
        (handle >= 0).then_some(Self(handle))
    }

    /// Prints bytes as they are.
    pub fn write(&mut self, bytes: &[u8]) {
        let block = [self.0.cast_unsigned(), bytes.as_ptr() as usize, bytes.len()];
        // SAFETY: a handle, bytes, and how many.
        _ = unsafe { call(WRITE, block.as_ptr() as usize) };
    }
}

/// Ends QEMU, with success or not. On a real chip it stops here.
pub fn exit(success: bool) -> ! {
    let reason = if success {
        APPLICATION_EXIT
    } else {
        RUN_TIME_ERROR
    };
    // SAFETY: on 32-bit machines the argument is the reason itself.
    unsafe { call(EXIT, reason) };
    loop {
        riscv::asm::wfi();
    }
}

/// The counter of retired instructions.
pub struct Ticks {
    start: u64,
}

impl Ticks {
    /// It always runs.
    #[must_use]
    pub fn start() -> Option<Self> {
        Some(Self { start: now() })
    }

    /// From here on.
    pub fn restart(&mut self) {
        self.start = now();
    }

    /// Since the restart.
    #[must_use]
    pub fn elapsed(&self) -> u64 {
        now().wrapping_sub(self.start)
    }
}

fn now() -> u64 {
    loop {
        let (before, low, after): (u32, u32, u32);
        // SAFETY: reads registers, in the mode that may. Without `nomem`, so that work on memory
        // stays on its side of it.
        unsafe {
            asm!(
                "csrr {before}, minstreth",
                "csrr {low}, minstret",
                "csrr {after}, minstreth",
                before = out(reg) before,
                low = out(reg) low,
                after = out(reg) after,
                options(nostack),
            );
        }
        if before == after {
            return u64::from(after) << 32 | u64::from(low);
        }
    }
}

/// Executes `2 rounds` instructions and a few more; at least one round.
#[inline(never)]
pub fn known_loop(rounds: u32) {
    // SAFETY: touches one register, which the compiler hands out.
    unsafe {
        asm!(
            "2:",
            "addi {rounds}, {rounds}, -1",
            "bnez {rounds}, 2b",
            rounds = inout(reg) rounds.max(1) => _,
            options(nomem, nostack),
        );
    }
}

/// Fills words below the stack pointer, and gives where that points to. In the caller's frame.
///
/// # Safety
///
/// Below the stack pointer there are so many words of which nobody needs what they hold.
#[inline(always)]
pub unsafe fn paint(words: usize, paint: u32) -> usize {
    let top;
    // SAFETY: the caller's; `words` is not zero.
    unsafe {
        asm!(
            "mv {top}, sp",
            "mv {word}, sp",
            "2:",
            "addi {word}, {word}, -4",
            "sw {paint}, 0({word})",
            "addi {words}, {words}, -1",
            "bnez {words}, 2b",
            top = out(reg) top,
            word = out(reg) _,
            words = inout(reg) words.max(1) => _,
            paint = in(reg) paint as usize,
        );
    }
    top
}

/// Uses so many bytes of the stack, and no more: a multiple of 16, below 2048.
#[unsafe(naked)]
pub extern "C" fn known_stack<const BYTES: usize>() {
    naked_asm!(
        "addi sp, sp, -{bytes}",
        "sw zero, 0(sp)",
        "addi sp, sp, {bytes}",
        "ret",
        bytes = const BYTES,
    );
}

/// Say so and end, where the default is to wait for ever.
#[unsafe(export_name = "ExceptionHandler")]
fn exception(_: &mut riscv_rt::TrapFrame) -> ! {
    crate::host::Output::new().text("exception\n");
    exit(false)
}
