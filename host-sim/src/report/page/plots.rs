//! Plots with marks that say what they are.

use minijinja::Value;
use serde::Serialize;

use super::significant;
use crate::benchmark;
use crate::error::Error;
use crate::report::chip::Chip;
use crate::report::measure::Row;
use crate::report::peers::Peer;
use crate::report::plot::{Kind, Mark, Unit, marks, styled};
use crate::report::table::cores;

#[derive(Serialize)]
pub(super) struct Plot {
    core: &'static str,
    title: String,
    scene: &'static str,
    unit: &'static str,
    svg: Value,
    marks: Vec<Spot>,
    has_peers: bool,
}

#[derive(Serialize)]
struct Spot {
    left: f64,
    top: f64,
    title: String,
}

pub(super) fn plots(rows: &[Row], peers: &[Peer]) -> Result<Vec<Plot>, Error> {
    let mut plots = Vec::new();
    for core in cores() {
        let of_core = Chip::ALL.iter().filter(|chip| chip.core == core);
        let chips: Vec<Chip> = of_core.copied().collect();
        let title = chips.first().map_or(core, |chip| chip.core_title);
        for (scene, _) in benchmark::SCENES {
            for unit in Unit::ALL {
                let marks = marks(rows, peers, scene, core, unit);
                let title = format!("{scene} on {title}");
                let (svg, places) = styled(&title, unit, &marks)?;
                let spots = marks.iter().zip(places).map(|(mark, [left, top])| Spot {
                    left: 100.0 * left,
                    top: 100.0 * top,
                    title: tip(mark, unit, &chips),
                });
                plots.push(Plot {
                    core,
                    title,
                    scene,
                    unit: unit.name(),
                    marks: spots.collect(),
                    has_peers: marks.iter().any(|m| m.kind == Kind::Peer),
                    svg: Value::from_safe_string(svg),
                });
            }
        }
    }
    Ok(plots)
}

/// What a mark says when asked.
fn tip(mark: &Mark, unit: Unit, chips: &[Chip]) -> String {
    let kind = match mark.kind {
        Kind::Sized => ", sized texture",
        Kind::RunTime | Kind::Peer => "",
    };
    let cost = format!("{:.1} instructions a pixel", mark.cost);
    let error = format!("{} {} at most", significant(Some(mark.error)), unit.name());
    let clocks: Vec<_> = chips
        .iter()
        .filter(|chip| chip.clock.is_some())
        .map(|c| c.title)
        .collect();
    let where_to = if clocks.is_empty() {
        String::new()
    } else {
        format!(" ({})", clocks.join(", "))
    };
    let front = if mark.on_front {
        "; nothing of ours beats it in both"
    } else {
        ""
    };
    format!("{}{kind}{where_to}: {cost}, {error}{front}", mark.label)
}
