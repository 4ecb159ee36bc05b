//! What the page's script works with.

use serde::Serialize;

use super::failed;
use crate::error::Error;
use crate::report::answer::SURFACES;
use crate::report::chip::Chip;
use crate::report::measure::Row;
use crate::report::table::cores;

#[derive(Serialize)]
pub(super) struct ChipView {
    name: &'static str,
    title: String,
    core: &'static str,
    clock: Option<f64>,
}

pub(super) fn chips() -> Vec<ChipView> {
    let view = |chip: Chip| ChipView {
        name: chip.name,
        title: chip.to_string(),
        core: chip.core,
        clock: chip.clock,
    };
    Chip::ALL.into_iter().map(view).collect()
}

/// Rows for the page's script: without names of fields, for there are thousands.
pub(super) fn data(rows: &[Row]) -> Result<String, Error> {
    let round = |n: f64| format!("{n:.4e}").parse::<f64>().unwrap_or(n);
    let cores = cores();
    let compact: Vec<serde_json::Value> = rows
        .iter()
        .map(|row| {
            let costs: Vec<_> = cores
                .iter()
                .map(|core| row.costs.get(*core))
                .map(|cost| cost.map(|c| (c.instructions, round(c.cycles), c.how)))
                .collect();
            let s = &row.setting;
            serde_json::json!([
                row.scene,
                s.strategy,
                s.filter,
                s.depth,
                s.format,
                round(row.uv.footprints.max),
                round(row.uv.footprints.p99),
                round(row.uv.footprints.mean),
                round(row.uv.texels.max),
                row.colours.map(|c| c.psnr.map(round)),
                row.colours.map(|c| round(c.ssim)),
                row.coverage_mismatches,
                row.host_nanoseconds.map(round),
                costs,
            ])
        })
        .collect();
    let value = serde_json::json!({ "cores": cores, "chips": chips(), "surfaces": SURFACES, "rows": compact });
    // Within a script element no tag may begin.
    let text = serde_json::to_string(&value).map_err(|e| failed(&e))?;
    Ok(text.replace('<', "\\u003c"))
}
