//! Arm Cortex-M.

use core::arch::{asm, naked_asm};
use core::sync::atomic::{AtomicU32, Ordering};

pub use cortex_m::singleton;
pub use cortex_m_rt::entry;

use cortex_m::Peripherals;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::{ExceptionFrame, exception};
use cortex_m_semihosting::debug::{self, EXIT_FAILURE, EXIT_SUCCESS};
use cortex_m_semihosting::hio::{self, HostStream};

/// Standard output on the PC.
#[derive(Clone, Copy)]
pub struct Stream(HostStream);

impl Stream {
    /// `None` without a debugger.
    #[must_use]
    pub fn open() -> Option<Self> {
        hio::hstdout().ok().map(Self)
    }

    /// Prints bytes as they are.
    pub fn write(&mut self, bytes: &[u8]) {
        // There is nobody else to tell.
        _ = self.0.write_all(bytes);
    }
}

/// Ends QEMU, with success or not. On a real chip it stops here.
pub fn exit(success: bool) -> ! {
    debug::exit(if success { EXIT_SUCCESS } else { EXIT_FAILURE });
    loop {
        cortex_m::asm::wfi();
    }
}

/// `SysTick`, a timer of 24 bits, and how often it went round since it was restarted.
pub struct Ticks {
    timer: SYST,
}

const MOST: u32 = (1 << 24) - 1;

static ROUNDS: AtomicU32 = AtomicU32::new(0);

/// The timer went round. Not in an image that ships: none of those counts.
#[cfg(not(any(feature = "stm32f405", feature = "nrf51")))]
#[exception]
fn SysTick() {
    // Nobody else writes meanwhile; an Armv6-M has nothing better than load and store.
    ROUNDS.store(
        ROUNDS.load(Ordering::Relaxed).wrapping_add(1),
        Ordering::Relaxed,
    );
}

impl Ticks {
    /// Starts the timer; once.
    #[must_use]
    pub fn start() -> Option<Self> {
        let mut timer = Peripherals::take()?.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(MOST);
        timer.clear_current();
        timer.enable_interrupt();
        timer.enable_counter();
        Some(Self { timer })
    }

    /// From here on.
    pub fn restart(&mut self) {
        self.timer.clear_current();
        ROUNDS.store(0, Ordering::Relaxed);
    }

    /// Since the restart.
    #[must_use]
    pub fn elapsed(&self) -> u64 {
        loop {
            let rounds = ROUNDS.load(Ordering::Relaxed);
            // It counts down.
            let ticks = MOST - SYST::get_current();
            if rounds == ROUNDS.load(Ordering::Relaxed) {
                return u64::from(rounds) * (u64::from(MOST) + 1) + u64::from(ticks);
            }
        }
    }
}

/// Executes `2 rounds` instructions and a few more; at least one round. Written here because the
/// length of a library's delay loop is its own business, and differs between versions.
#[inline(never)]
pub fn known_loop(rounds: u32) {
    // SAFETY: touches one register, which the compiler hands out, and the flags.
    unsafe {
        asm!(
            "2:",
            "subs {rounds}, #1",
            "bne 2b",
            rounds = inout(reg) rounds.max(1) as usize => _,
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
            "mov {top}, sp",
            "mov {word}, sp",
            "2:",
            "subs {word}, #4",
            "str {paint}, [{word}]",
            "subs {words}, #1",
            "bne 2b",
            top = out(reg) top,
            word = out(reg) _,
            words = inout(reg) words.max(1) => _,
            paint = in(reg) paint as usize,
        );
    }
    top
}

/// Uses so many bytes of the stack, and no more: a multiple of 4, below 512.
#[unsafe(naked)]
pub extern "C" fn known_stack<const BYTES: usize>() {
    naked_asm!(
        "sub sp, #{bytes}",
        "movs r0, #0",
        "str r0, [sp]",
        "add sp, #{bytes}",
        "bx lr",
        bytes = const BYTES,
    );
}

/// Say so and end, where the default is to wait for ever.
///
/// # Safety
///
/// Called by the processor only.
#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    crate::host::Output::new().text("hard fault\n");
    exit(false)
}
