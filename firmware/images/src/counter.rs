//! Counts executed instructions with the processor's timer, where QEMU runs with
//! `-icount shift=0`: then the timer advances by one tick in a fixed number of instructions.

use core::arch::asm;

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;

/// The 24-bit timer.
pub struct Counter {
    /// Kept so that nobody else changes it.
    _timer: SYST,
    instructions_per_tick: u32,
}

const RANGE: u32 = 1 << 24;

impl Counter {
    /// Starts the timer and finds the instructions of one tick from two loops of known length.
    /// `None` if the timer does not count instructions.
    #[must_use]
    pub fn new(mut timer: SYST) -> Option<Self> {
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(RANGE - 1);
        timer.clear_current();
        timer.enable_counter();
        let mut counter = Self {
            _timer: timer,
            instructions_per_tick: 1,
        };
        // The difference of two loops is exact: what surrounds them is the same.
        const ROUNDS: [u32; 2] = [100_000, 500_000];
        let [short, long] = ROUNDS.map(|rounds| counter.ticks(|| known_loop(rounds)));
        let instructions = 2 * (ROUNDS[1] - ROUNDS[0]);
        let ticks = long.saturating_sub(short);
        let per_tick = (instructions + ticks / 2).checked_div(ticks)?;
        // Off by more than the two ticks that reading the timer may be off.
        if per_tick == 0 || (ticks * per_tick).abs_diff(instructions) > 2 * per_tick {
            return None;
        }
        counter.instructions_per_tick = per_tick;
        Some(counter)
    }

    /// The instructions that `work` executes, to within one tick; at most 2^24 ticks.
    pub fn instructions(&mut self, work: impl FnOnce()) -> u64 {
        u64::from(self.ticks(work)) * u64::from(self.instructions_per_tick)
    }

    fn ticks(&mut self, work: impl FnOnce()) -> u32 {
        // It counts down.
        let start = SYST::get_current();
        work();
        start.wrapping_sub(SYST::get_current()) % RANGE
    }

    /// Instructions of one tick.
    #[must_use]
    pub const fn instructions_per_tick(&self) -> u32 {
        self.instructions_per_tick
    }
}

/// Executes `2 rounds` instructions and a few more; at least one round. Written here because the
/// length of a library's delay loop is its own business, and differs between versions.
#[inline(never)]
fn known_loop(rounds: u32) {
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
