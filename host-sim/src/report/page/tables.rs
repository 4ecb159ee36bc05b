//! Tables of strategies, hard cases and sizes.

use serde::Serialize;

use crate::report::measure::{HardCase, Row};
use crate::report::on_target::Flash;
use crate::report::table::cores;

#[derive(Serialize)]
pub(super) struct Strategy {
    scene: String,
    setting: String,
    footprints: [f64; 3],
    texels: f64,
    psnr: Option<f64>,
    ssim: Option<f64>,
    mismatches: u64,
    host: Option<f64>,
    costs: Vec<Option<f64>>,
}

/// Strategies by themselves, for readers without scripts.
pub(super) fn strategies(rows: &[Row]) -> Vec<Strategy> {
    let plain = rows.iter().filter(|row| row.setting.is_plain());
    plain
        .map(|row| Strategy {
            scene: row.scene.clone(),
            setting: row.setting.to_string(),
            footprints: [
                row.uv.footprints.max,
                row.uv.footprints.p99,
                row.uv.footprints.mean,
            ],
            texels: row.uv.texels.max,
            psnr: row.colours.and_then(|c| c.psnr),
            ssim: row.colours.map(|c| c.ssim),
            mismatches: row.coverage_mismatches,
            host: row.host_nanoseconds,
            costs: cores()
                .iter()
                .map(|core| row.costs.get(*core).map(|c| c.instructions))
                .collect(),
        })
        .collect()
}

#[derive(Serialize)]
pub(super) struct Hard {
    strategies: Vec<String>,
    cases: Vec<HardRow>,
    failed: usize,
    count: usize,
}

#[derive(Serialize)]
struct HardRow {
    name: String,
    reason: &'static str,
    cells: Vec<HardCell>,
}

#[derive(Serialize)]
struct HardCell {
    footprints: f64,
    of_bound: f64,
    pass: bool,
}

pub(super) fn hard_cases(all: &[HardCase]) -> Hard {
    let mut strategies: Vec<String> = Vec::new();
    let mut cases: Vec<HardRow> = Vec::new();
    for hard in all {
        if !strategies.contains(&hard.strategy) {
            strategies.push(hard.strategy.clone());
        }
        if cases.last().is_none_or(|row| row.name != hard.case) {
            cases.push(HardRow {
                name: hard.case.clone(),
                reason: hard.reason,
                cells: Vec::new(),
            });
        }
        if let Some(row) = cases.last_mut() {
            row.cells.push(HardCell {
                footprints: hard.footprints,
                of_bound: hard.of_bound,
                pass: hard.pass,
            });
        }
    }
    Hard {
        strategies,
        cases,
        failed: all.iter().filter(|hard| !hard.pass).count(),
        count: all.len(),
    }
}

#[derive(Serialize)]
pub(super) struct FlashRow {
    feature: String,
    image: String,
    /// Bytes on the Cortex-M0+ and on the M4: all, and more than the image before.
    sizes: Vec<Option<(i64, i64)>>,
}

pub(super) fn flash(all: &[Flash]) -> Vec<FlashRow> {
    let first = all.first().map(|f| f.core.as_str()).unwrap_or_default();
    let of = |image: &str, core: &str| {
        let found = all.iter().find(|f| f.core == core && f.image == image);
        found.map(|f| (f.flash_of_feature, f.more_than_previous))
    };
    all.iter()
        .filter(|f| f.core == first)
        .map(|f| FlashRow {
            feature: f.feature.clone(),
            image: f.image.clone(),
            sizes: ["m0", "m4"].map(|core| of(&f.image, core)).to_vec(),
        })
        .collect()
}
