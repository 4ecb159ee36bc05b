//! Arm Cortex-M.

use core::arch::asm;

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

/// `SysTick`, a timer of 24 bits.
pub struct Ticks {
    /// Kept so that nobody else changes it.
    _timer: SYST,
}

impl Ticks {
    /// Ticks are counted modulo this and one more.
    pub const MOST: u32 = (1 << 24) - 1;

    /// Starts the timer; once.
    #[must_use]
    pub fn start() -> Option<Self> {
        let mut timer = Peripherals::take()?.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(Self::MOST);
        timer.clear_current();
        timer.enable_counter();
        Some(Self { _timer: timer })
    }

    /// The time, modulo.
    #[must_use]
    pub fn now(&self) -> u32 {
        // It counts down.
        Self::MOST - SYST::get_current()
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
