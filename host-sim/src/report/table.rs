//! Rows as CSV and JSON, and the lines that sum them up.

use comfy_table::presets::ASCII_MARKDOWN;
use comfy_table::{CellAlignment, Table};
use serde::Serialize;

use crate::error::Error;
use crate::report::chip::Chip;
use crate::report::measure::{Measured, Row};
use crate::report::on_target::{Cost, Record};
use crate::report::peers::Peer;

/// Strategies of the summary.
pub const SUMMARY: [&str; 11] = [
    "affine",
    "affine-within",
    "constant-z",
    "every:64",
    "every:16",
    "every:8",
    "adaptive",
    "quadratic:16",
    "extrapolated",
    "subdivided",
    "exact",
];

/// Scenes whose errors the summary has.
const SCENES: [&str; 4] = ["floor", "receding", "oblique", "tilted"];

/// The scene whose costs the summary has.
pub const COST_SCENE: &str = "oblique";

/// Chips of the summary.
const CHIPS: [&str; 4] = ["rp2040", "stm32f405", "stm32h743", "esp32-c3"];

/// A line each: errors in several scenes, instructions a pixel and milliseconds a frame of 320x240
/// in one, by the cheapest texture.
#[must_use]
pub fn summary(rows: &[Row]) -> Table {
    let chips: Vec<Chip> = CHIPS.iter().filter_map(|name| name.parse().ok()).collect();
    let mut header = vec!["strategy".to_owned()];
    header.extend(SCENES.map(|scene| format!("{scene}: footprints max")));
    for chip in &chips {
        header.push(format!("{}: instr / pixel", chip.title));
        header.push("ms".to_owned());
    }
    let mut table = Table::new();
    table.load_preset(ASCII_MARKDOWN);
    table.set_header(header);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    for strategy in SUMMARY {
        let mut cells = vec![strategy.to_owned()];
        cells.extend(SCENES.map(|scene| {
            let row = plain(rows, scene, strategy).next();
            row.map_or_else(String::new, |row| format!("{:.4}", row.uv.footprints.max))
        }));
        for chip in &chips {
            let cost = cheapest(rows, COST_SCENE, strategy, chip.core);
            let pixels = 320.0 * 240.0;
            let time = cost.and_then(|cost| chip.milliseconds(cost.cycles * pixels));
            cells.push(cost.map_or_else(String::new, |cost| format!("{:.1}", cost.instructions)));
            cells.push(time.map_or_else(String::new, |time| format!("{time:.1}")));
        }
        table.add_row(cells);
    }
    table
}

/// A strategy in a scene with the nearest texel and no depth test, in every texel format.
pub fn plain<'a>(
    rows: &'a [Row],
    scene: &'a str,
    strategy: &'a str,
) -> impl Iterator<Item = &'a Row> {
    rows.iter().filter(move |row| {
        row.scene == scene && row.setting.strategy == strategy && row.setting.is_plain()
    })
}

/// What that costs with the format that takes the fewest instructions.
#[must_use]
pub fn cheapest(rows: &[Row], scene: &str, strategy: &str, core: &str) -> Option<Cost> {
    plain(rows, scene, strategy)
        .filter_map(|row| row.costs.get(core).copied())
        .min_by(|a, b| a.instructions.total_cmp(&b.instructions))
}

/// The cores that rows have costs of, in the order of the chips.
#[must_use]
pub fn cores() -> Vec<&'static str> {
    let mut cores: Vec<&str> = Vec::new();
    for chip in Chip::ALL {
        if !cores.contains(&chip.core) {
            cores.push(chip.core);
        }
    }
    cores
}

/// All rows as CSV with a header; what is unknown is empty.
///
/// # Errors
///
/// [`Error::Content`] if a row cannot be written.
pub fn csv(rows: &[Row]) -> Result<Vec<u8>, Error> {
    let failed = |e: &dyn std::fmt::Display| Error::content("CSV", &e.to_string(), "report this");
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut header: Vec<String> = [
        "scene",
        "strategy",
        "filter",
        "depth",
        "format",
        "texels_max",
        "texels_p99",
        "texels_mean",
        "footprints_max",
        "footprints_p99",
        "footprints_mean",
        "snapping_footprints_max",
        "coverage_mismatches",
        "double_draws",
        "gaps",
        "depth_mismatches",
        "divisions",
        "psnr_db",
        "ssim",
        "colour_max",
        "host_ns_per_pixel",
    ]
    .map(str::to_owned)
    .to_vec();
    for core in cores() {
        header.push(format!("{core}_instructions_per_pixel"));
        header.push(format!("{core}_cycles_per_pixel"));
        header.push(format!("{core}_cycles_are"));
    }
    writer.write_record(&header).map_err(|e| failed(&e))?;
    for row in rows {
        writer.write_record(cells(row)).map_err(|e| failed(&e))?;
    }
    writer.into_inner().map_err(|e| failed(&e))
}

fn cells(row: &Row) -> Vec<String> {
    let setting = &row.setting;
    let mut cells = vec![
        row.scene.clone(),
        setting.strategy.clone(),
        setting.filter.clone(),
        setting.depth.clone(),
        setting.format.clone(),
    ];
    for error in [row.uv.texels, row.uv.footprints] {
        cells.extend([error.max, error.p99, error.mean].map(|n| format!("{n:.6}")));
    }
    cells.push(format!("{:.6}", row.snapping.footprints.max));
    let counts = [row.coverage_mismatches, row.double_draws, row.gaps];
    cells.extend(counts.map(|n| n.to_string()));
    cells.push(
        row.depth_mismatches
            .map_or_else(String::new, |n| n.to_string()),
    );
    cells.push(row.divisions.to_string());
    let number =
        |n: Option<f64>, digits: usize| n.map_or_else(String::new, |n| format!("{n:.digits$}"));
    // Equal pictures have no noise.
    let psnr = row.colours.map(|c| c.psnr.unwrap_or(f64::INFINITY));
    cells.push(number(psnr, 2));
    cells.push(number(row.colours.map(|c| c.ssim), 6));
    cells.push(number(row.colours.map(|c| c.off.max), 0));
    cells.push(number(row.host_nanoseconds, 3));
    for core in cores() {
        let cost = row.costs.get(core);
        cells.push(number(cost.map(|c| c.instructions), 2));
        cells.push(number(cost.map(|c| c.cycles), 2));
        cells.push(cost.map_or_else(String::new, |c| c.how.to_string()));
    }
    cells
}

#[derive(Serialize)]
struct Document<'a> {
    toolchain: &'a str,
    qemu: &'a str,
    counts_are_of_these_sources: bool,
    chips: [Chip; Chip::ALL.len()],
    scenes: &'a [crate::report::measure::Scene],
    rows: &'a [Row],
    aliasing: &'a [crate::report::measure::Aliasing],
    hard_cases: &'a [crate::report::measure::HardCase],
    flash: &'a [crate::report::on_target::Flash],
    stack: &'a [crate::report::on_target::Stack],
    peers: &'a [Peer],
    left_out: &'a [String],
}

/// Everything as JSON.
///
/// # Errors
///
/// [`Error::Content`] if it cannot be written.
pub fn json(measured: &Measured, record: &Record, peers: &[Peer]) -> Result<Vec<u8>, Error> {
    let [toolchain, qemu] = record.tools();
    let document = Document {
        toolchain,
        qemu,
        counts_are_of_these_sources: record.is_current(),
        chips: Chip::ALL,
        scenes: &measured.scenes,
        rows: &measured.rows,
        aliasing: &measured.aliasing,
        hard_cases: &measured.hard_cases,
        flash: record.flash(),
        stack: record.stack(),
        peers,
        left_out: &measured.left_out,
    };
    serde_json::to_vec(&document).map_err(|e| Error::content("JSON", &e.to_string(), "report this"))
}
