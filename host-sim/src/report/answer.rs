//! Which settings keep to a time and an error on a chip.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use multum::viewport::Viewport;
use serde::Serialize;

use crate::report::chip::Chip;
use crate::report::measure::Row;
use crate::report::on_target::How;
use crate::report::setting::Setting;

/// Scenes in which a setting has to do when none is named: each shows another kind of surface, and
/// all are two triangles. `mesh`, of thousands, is a load of its own.
pub const SURFACES: [&str; 5] = ["wall", "floor", "receding", "oblique", "tilted"];

/// Settings that are listed; more are only counted.
const LISTED: usize = 8;

/// Settings that miss and are listed.
const MISSES: usize = 3;

/// What a user asks.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Question {
    /// The chip.
    pub chip: Chip,
    /// Most time for a frame.
    pub milliseconds: f64,
    /// Largest error anywhere, in footprints.
    pub footprints: f64,
    /// Pixels of a frame.
    #[serde(skip)]
    pub size: Viewport,
}

/// A setting in one or more scenes.
#[derive(Clone, Debug, Serialize)]
pub struct Candidate {
    /// The setting.
    pub setting: Setting,
    /// Time of a frame, of the slowest scene.
    pub milliseconds: f64,
    /// How its cycles were found.
    pub how: How,
    /// Largest error, of the worst scene.
    pub footprints: f64,
    /// The scene with that error.
    pub worst: String,
}

impl Candidate {
    /// By what factor it misses the farther of the two limits; at most 1 if it keeps both.
    #[must_use]
    pub fn excess(&self, question: &Question) -> f64 {
        let ratio = |value: f64, limit: f64| if value <= limit { 0.0 } else { value / limit };
        let time = ratio(self.milliseconds, question.milliseconds);
        time.max(ratio(self.footprints, question.footprints))
    }
}

/// What is known of some scenes.
#[derive(Clone, Debug, Serialize)]
pub struct Verdict {
    /// The scenes.
    pub scenes: Vec<String>,
    /// Settings within both limits, the fastest first.
    pub fits: Vec<Candidate>,
    /// Settings that are not, the nearest first.
    pub misses: Vec<Candidate>,
}

/// The answer: for all scenes together, then for each.
#[must_use]
pub fn answer(rows: &[Row], question: &Question, scenes: &[&str]) -> Vec<Verdict> {
    let mut verdicts = Vec::new();
    if scenes.len() > 1 {
        verdicts.push(verdict(rows, question, scenes));
    }
    verdicts.extend(scenes.iter().map(|scene| verdict(rows, question, &[scene])));
    verdicts
}

/// Settings of which the costs are known in all of the scenes.
#[must_use]
pub fn verdict(rows: &[Row], question: &Question, scenes: &[&str]) -> Verdict {
    let pixels = f64::from(question.size.width() * question.size.height());
    let mut candidates: BTreeMap<String, (usize, Candidate)> = BTreeMap::new();
    for row in rows
        .iter()
        .filter(|row| scenes.contains(&row.scene.as_str()))
    {
        let Some(cost) = row.costs.get(question.chip.core) else {
            continue;
        };
        let Some(milliseconds) = question.chip.milliseconds(cost.cycles * pixels) else {
            continue;
        };
        let footprints = row.uv.footprints.max;
        let candidate = Candidate {
            setting: row.setting.clone(),
            milliseconds,
            how: cost.how,
            footprints,
            worst: row.scene.clone(),
        };
        candidates
            .entry(row.setting.to_string())
            .and_modify(|(count, known)| {
                *count += 1;
                if milliseconds > known.milliseconds {
                    known.milliseconds = milliseconds;
                    known.how = cost.how;
                }
                if footprints > known.footprints {
                    known.footprints = footprints;
                    known.worst.clone_from(&row.scene);
                }
            })
            .or_insert((1, candidate));
    }
    let complete = candidates
        .into_values()
        .filter(|(count, _)| *count == scenes.len())
        .map(|(_, candidate)| candidate);
    let (mut fits, mut misses): (Vec<_>, Vec<_>) =
        complete.partition(|candidate| candidate.excess(question) <= 1.0);
    fits.sort_by(|a, b| a.milliseconds.total_cmp(&b.milliseconds));
    misses.sort_by(|a, b| a.excess(question).total_cmp(&b.excess(question)));
    Verdict {
        scenes: scenes.iter().map(|&scene| scene.to_owned()).collect(),
        fits,
        misses,
    }
}

impl Verdict {
    /// Why it misses.
    #[must_use]
    pub fn reason(&self, miss: &Candidate, question: &Question) -> String {
        let mut reasons = Vec::new();
        if miss.footprints > question.footprints {
            reasons.push(format!(
                "{:.3} footprints in {}",
                miss.footprints, miss.worst
            ));
        }
        if miss.milliseconds > question.milliseconds {
            let pixels = f64::from(question.size.width() * question.size.height());
            let room = pixels * question.milliseconds / miss.milliseconds;
            reasons.push(format!(
                "{:.1} ms, so that frames of {} pixels would fit",
                miss.milliseconds,
                (room / 100.0).floor() * 100.0
            ));
        }
        reasons.join("; ")
    }

    /// The largest filter that fits, if any filters: what the time that is left can buy.
    #[must_use]
    pub fn smoothest(&self) -> Option<&Candidate> {
        let filtered = self
            .fits
            .iter()
            .filter(|fit| !fit.setting.filter.starts_with("nearest"));
        filtered.max_by(|a, b| a.milliseconds.total_cmp(&b.milliseconds))
    }

    /// In words, for a terminal.
    #[must_use]
    pub fn text(&self, question: &Question) -> String {
        let mut text = format!("{}: ", self.scenes.join(", "));
        let limit = format!(
            "{} ms and {} footprints",
            question.milliseconds, question.footprints
        );
        match self.fits.len() {
            0 => _ = writeln!(text, "nothing stays within {limit}"),
            n => _ = writeln!(text, "{n} settings stay within {limit}, the fastest first"),
        }
        for fit in self.fits.iter().take(LISTED) {
            let left = question.milliseconds - fit.milliseconds;
            _ = writeln!(
                text,
                "  {:<44} {:>6.1} ms {:<9} {left:>6.1} ms left; {:.4} footprints at worst, in {}",
                fit.setting.to_string(),
                fit.milliseconds,
                fit.how.to_string(),
                fit.footprints,
                fit.worst
            );
        }
        if let Some(smoothest) = self.smoothest() {
            let (setting, time) = (&smoothest.setting, smoothest.milliseconds);
            _ = writeln!(
                text,
                "  of those that filter, the most for the time: {setting}, {time:.1} ms"
            );
        }
        if self.fits.is_empty() {
            for miss in self.misses.iter().take(MISSES) {
                let reason = self.reason(miss, question);
                _ = writeln!(text, "  nearest: {}: {reason}", miss.setting);
            }
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::{Spread, UvError};
    use crate::report::on_target::Cost;
    use crate::report::setting::{NEAREST, NO_DEPTH, RUN_TIME};

    fn row(scene: &str, strategy: &str, cycles: f64, footprints: f64) -> Row {
        let error = Spread {
            max: footprints,
            ..Spread::default()
        };
        Row {
            scene: scene.to_owned(),
            setting: Setting {
                strategy: strategy.to_owned(),
                filter: NEAREST.to_owned(),
                depth: NO_DEPTH.to_owned(),
                format: RUN_TIME.to_owned(),
            },
            uv: UvError {
                footprints: error,
                texels: error,
            },
            snapping: UvError::default(),
            coverage_mismatches: 0,
            double_draws: 0,
            gaps: 0,
            depth_mismatches: None,
            divisions: 0,
            colours: None,
            host_nanoseconds: None,
            costs: BTreeMap::from([(
                "m0".to_owned(),
                Cost {
                    instructions: cycles,
                    cycles,
                    how: How::Exact,
                },
            )]),
        }
    }

    fn question() -> Question {
        Question {
            chip: "rp2040".parse().expect("a chip"),
            milliseconds: 20.0,
            footprints: 0.25,
            size: Viewport::new(250, 100).expect("a size"),
        }
    }

    #[test]
    fn both_limits_hold_and_the_fastest_is_first() {
        // 25,000 pixels at 125 MHz: 100 cycles a pixel are 20 ms.
        let rows = [
            row("wall", "exact", 100.0, 0.0),
            row("wall", "every:16", 40.0, 0.25),
            row("wall", "affine", 20.0, 0.26),
            row("wall", "subdivided", 100.1, 0.0),
        ];
        let verdict = verdict(&rows, &question(), &["wall"]);
        let fits: Vec<_> = verdict
            .fits
            .iter()
            .map(|c| c.setting.strategy.as_str())
            .collect();
        let misses: Vec<_> = verdict
            .misses
            .iter()
            .map(|c| c.setting.strategy.as_str())
            .collect();
        assert_eq!(fits, ["every:16", "exact"]);
        assert_eq!(misses, ["subdivided", "affine"]);
    }

    #[test]
    fn in_several_scenes_the_worst_decides() {
        let rows = [
            row("wall", "every:16", 40.0, 0.0),
            row("floor", "every:16", 50.0, 0.3),
            row("wall", "exact", 60.0, 0.0),
            row("floor", "exact", 70.0, 0.1),
            row("wall", "affine", 20.0, 0.0),
        ];
        let verdict = verdict(&rows, &question(), &["wall", "floor"]);
        assert_eq!(verdict.fits.len(), 1);
        assert_eq!(verdict.fits[0].setting.strategy, "exact");
        assert!((verdict.fits[0].milliseconds - 14.0).abs() < 1e-9);
        // What was not counted in all of them is no answer.
        assert_eq!(verdict.misses.len(), 1);
        assert_eq!(verdict.misses[0].worst, "floor");
    }

    #[test]
    fn where_nothing_fits_the_nearest_says_why() {
        let rows = [row("wall", "exact", 200.0, 0.1)];
        let question = question();
        let text = verdict(&rows, &question, &["wall"]).text(&question);
        assert!(text.contains("nothing stays within 20 ms"), "{text}");
        assert!(
            text.contains("40.0 ms, so that frames of 12500 pixels"),
            "{text}"
        );
    }
}
