//! Counts executed instructions where QEMU runs with `-icount shift=0`: then the processor's timer
//! advances by one tick in a fixed number of instructions.

use crate::machine::{Ticks, known_loop};

/// A calibrated timer.
pub struct Counter {
    timer: Ticks,
    instructions_per_tick: u32,
}

impl Counter {
    /// Starts the timer and finds the instructions of one tick from two loops of known length.
    /// `None` if the timer does not count instructions.
    #[must_use]
    pub fn new() -> Option<Self> {
        let mut counter = Self {
            timer: Ticks::start()?,
            instructions_per_tick: 1,
        };
        // The difference of two loops is exact: what surrounds them is the same.
        const ROUNDS: [u32; 2] = [100_000, 500_000];
        let [short, long] = ROUNDS.map(|rounds| counter.ticks(|| known_loop(rounds)) as u32);
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

    /// The instructions that `work` executes, to within two ticks.
    pub fn instructions(&mut self, work: impl FnOnce()) -> u64 {
        self.ticks(work) * u64::from(self.instructions_per_tick)
    }

    fn ticks(&mut self, work: impl FnOnce()) -> u64 {
        self.timer.restart();
        work();
        self.timer.elapsed()
    }

    /// Instructions of one tick.
    #[must_use]
    pub const fn instructions_per_tick(&self) -> u32 {
        self.instructions_per_tick
    }
}
