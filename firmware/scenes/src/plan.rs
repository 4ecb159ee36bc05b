//! What each chip draws, and in which memory.

use crate::baked::{checkers, corridor, room, spot, wooden_crate};
use crate::scene::Scene;

/// The frames of one chip's image `frames`.
#[derive(Debug)]
pub struct Plan {
    /// Columns of the frame.
    pub width: u32,
    /// Rows of the frame.
    pub height: u32,
    /// Rows that are drawn at a time.
    pub band_rows: u32,
    /// What is drawn, one after the other.
    pub scenes: &'static [&'static Scene],
}

/// 128 KB of RAM: a frame would take 150 KB.
pub const STM32F405: Plan = Plan {
    width: 320,
    height: 240,
    band_rows: 16,
    scenes: &[
        &wooden_crate::SCENE,
        &spot::SCENE,
        &room::SCENE,
        &corridor::SCENE,
    ],
};

/// 16 KB of RAM, no FPU and no division. 16 rows take 5 KB and leave a shorter last band.
pub const NRF51: Plan = Plan {
    width: 160,
    height: 120,
    band_rows: 16,
    scenes: &[&wooden_crate::SCENE, &checkers::SCENE],
};

impl Plan {
    /// Vertices of the largest scene.
    #[must_use]
    pub const fn vertices(&self) -> usize {
        let mut most = 0;
        let mut scene = 0;
        while scene < self.scenes.len() {
            if self.scenes[scene].vertices() > most {
                most = self.scenes[scene].vertices();
            }
            scene += 1;
        }
        most
    }

    /// Pixels of `rows` rows.
    #[must_use]
    pub const fn pixels(&self, rows: u32) -> usize {
        self.width as usize * rows as usize
    }

    /// Elements of a depth buffer of `rows` rows; none if no scene needs it.
    #[must_use]
    pub const fn depths(&self, rows: u32) -> usize {
        let mut scene = 0;
        while scene < self.scenes.len() {
            if self.scenes[scene].depth {
                return self.pixels(rows);
            }
            scene += 1;
        }
        0
    }
}
