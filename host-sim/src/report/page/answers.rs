//! The questions that the page answers without being asked.

use multum::viewport::Viewport;
use serde::Serialize;

use super::failed;
use crate::error::Error;
use crate::report::answer::{Candidate, Question, SURFACES, Verdict, answer, verdict};
use crate::report::measure::{Measured, Row};
use crate::report::on_target::Record;
use crate::report::setting::{NEAREST, NO_DEPTH, RUN_TIME};
use crate::report::table::{COST_SCENE, cheapest, plain};

/// A chip, milliseconds a frame and footprints: 50 frames a second on an RP2040, and an error that
/// nearest sampling does not show.
const EXAMPLE: (&str, f64, f64) = ("rp2040", 20.0, 0.25);

/// Settings of an answer that the page lists.
const LISTED: usize = 6;

#[derive(Serialize)]
pub(super) struct Example {
    chip: String,
    rate: f64,
    question: Question,
    everywhere: Answered,
    scenes: Vec<Answered>,
    /// The fastest that keeps the error in all scenes, whatever its time.
    precise: Option<Listed>,
}

#[derive(Serialize)]
struct Answered {
    scenes: String,
    count: usize,
    fits: Vec<Listed>,
    nearest: Option<Listed>,
}

#[derive(Serialize)]
struct Listed {
    setting: String,
    milliseconds: f64,
    how: String,
    footprints: f64,
    worst: String,
    reason: String,
}

fn answered(verdict: &Verdict, question: &Question) -> Answered {
    let listed = |candidate: &Candidate| Listed {
        setting: candidate.setting.to_string(),
        milliseconds: candidate.milliseconds,
        how: candidate.how.to_string(),
        footprints: candidate.footprints,
        worst: candidate.worst.clone(),
        reason: verdict.reason(candidate, question),
    };
    Answered {
        scenes: verdict.scenes.join(", "),
        count: verdict.fits.len(),
        fits: verdict.fits.iter().take(LISTED).map(listed).collect(),
        nearest: verdict.misses.first().map(listed),
    }
}

pub(super) fn example(rows: &[Row]) -> Result<Example, Error> {
    let (chip, milliseconds, footprints) = EXAMPLE;
    let question = Question {
        chip: chip.parse().map_err(|e: String| failed(&e))?,
        milliseconds,
        footprints,
        size: Viewport::new(320, 240).map_err(|e| Error::core("report", e))?,
    };
    let verdicts = answer(rows, &question, &SURFACES);
    let mut answers = verdicts.iter().map(|v| answered(v, &question));
    let everywhere = answers.next().ok_or_else(|| failed(&"no scenes"))?;
    let patient = Question {
        milliseconds: f64::INFINITY,
        ..question
    };
    let precise = verdict(rows, &patient, &SURFACES);
    let precise = precise.fits.first().map(|fit| Listed {
        setting: fit.setting.to_string(),
        milliseconds: fit.milliseconds,
        how: fit.how.to_string(),
        footprints: fit.footprints,
        worst: fit.worst.clone(),
        reason: precise.reason(fit, &question),
    });
    Ok(Example {
        chip: question.chip.to_string(),
        rate: 1e3 / milliseconds,
        question,
        everywhere,
        scenes: answers.collect(),
        precise,
    })
}

#[derive(Serialize)]
pub(super) struct MipMaps {
    scene: &'static str,
    rows: Vec<MipMap>,
    /// Bytes that levels add to the code on the Cortex-M4, and what a pyramid adds to a texture.
    flash: Option<i64>,
    /// Of the nearest texel's aliasing, what is left with trilinear filtering, in percent.
    aliasing_left: Option<f64>,
    /// Instructions of the cheapest mip-mapped filter, as a multiple of the nearest texel's.
    cheapest_times: Option<f64>,
    cheapest: String,
}

#[derive(Serialize)]
struct MipMap {
    filter: String,
    error: f64,
    aliasing: f64,
    blur: f64,
    /// Instructions a pixel by core.
    costs: Vec<Option<f64>>,
}

/// The scene that shows aliasing.
pub(super) const ALIASING: &str = "checkers";

pub(super) fn mip_maps(measured: &Measured, record: &Record) -> MipMaps {
    let study = measured.aliasing.iter().find(|a| a.scene == ALIASING);
    let cost = |filter: &str, core: &str| {
        let named = |row: &&Row| {
            let name = &row.setting.filter;
            let is_it = name == filter || name.strip_suffix(":piece") == Some(filter);
            let setting = &row.setting;
            let is_plain = setting.depth == NO_DEPTH && setting.format == RUN_TIME;
            row.scene == COST_SCENE && is_it && is_plain && setting.strategy == "every:16"
        };
        let row = measured.rows.iter().find(named)?;
        row.costs.get(core).map(|cost| cost.instructions)
    };
    let mut rows = Vec::new();
    for numbers in study.into_iter().flat_map(|study| &study.filters) {
        let name = numbers.filter.replace("aniso:", "anisotropic:");
        rows.push(MipMap {
            costs: ["m0", "m4", "m33", "riscv"]
                .map(|core| cost(&name, core))
                .to_vec(),
            filter: numbers.filter.clone(),
            error: numbers.error,
            aliasing: numbers.aliasing,
            blur: numbers.blur,
        });
    }
    let aliasing = |filter: &str| rows.iter().find(|r| r.filter == filter).map(|r| r.aliasing);
    let aliasing_left = aliasing("trilinear")
        .zip(aliasing(NEAREST))
        .map(|(with, without)| 100.0 * with / without);
    let span = "nearest-mip-nearest:span";
    let cheapest_times = cost(span, "m4")
        .zip(cost(NEAREST, "m4"))
        .map(|(a, b)| a / b);
    let flash = record.flash().iter();
    let flash = flash.filter(|f| f.core == "m4" && f.image == "level-each-span");
    MipMaps {
        scene: ALIASING,
        rows,
        flash: flash.map(|f| f.more_than_previous).next(),
        aliasing_left,
        cheapest_times,
        cheapest: span.to_owned(),
    }
}

#[derive(Serialize)]
pub(super) struct Break {
    place: String,
    what: String,
    /// Largest errors in footprints.
    every: f64,
    adaptive: f64,
    /// Instructions a pixel on the Cortex-M4, where they were counted.
    every_cost: Option<f64>,
    adaptive_cost: Option<f64>,
}

/// Where every:16 is off by more than adaptive's bound.
pub(super) fn breaks(measured: &Measured) -> Vec<Break> {
    let bound = EXAMPLE.2;
    let footprints = |scene: &str, strategy: &str| {
        let row = plain(&measured.rows, scene, strategy).next();
        row.map_or(0.0, |row| row.uv.footprints.max)
    };
    let mut breaks: Vec<Break> = measured
        .scenes
        .iter()
        .map(|scene| Break {
            place: scene.name.clone(),
            what: scene.what.clone(),
            every: footprints(&scene.name, "every:16"),
            adaptive: footprints(&scene.name, "adaptive"),
            every_cost: cheapest(&measured.rows, &scene.name, "every:16", "m4")
                .map(|c| c.instructions),
            adaptive_cost: cheapest(&measured.rows, &scene.name, "adaptive", "m4")
                .map(|c| c.instructions),
        })
        .collect();
    let of = |case: &str, strategy: &str| {
        let found = measured.hard_cases.iter();
        let mut found = found.filter(|h| h.case == case && h.strategy == strategy);
        found.next().map_or(0.0, |h| h.footprints)
    };
    for case in measured
        .hard_cases
        .iter()
        .filter(|h| h.strategy == "every:16")
    {
        breaks.push(Break {
            place: case.case.clone(),
            what: case.reason.to_owned(),
            every: case.footprints,
            adaptive: of(&case.case, "adaptive"),
            every_cost: None,
            adaptive_cost: None,
        });
    }
    breaks.retain(|b| b.every > bound);
    // Those with costs first.
    let order = |b: &Break| (b.every_cost.is_none(), -b.every);
    breaks.sort_by(|a, b| {
        let (a, b) = (order(a), order(b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    breaks
}
