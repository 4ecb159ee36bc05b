//! `host-sim filters`: every filter against the ideal picture.

use std::process::ExitCode;

use comfy_table::{CellAlignment, Table};
use host_sim::aliasing::{Numbers, Study, pictures, study};
use host_sim::error::Error;
use host_sim::lettering::side_by_side;
use host_sim::output;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use crate::arguments::Filters;

const HEADER: [&str; 7] = [
    "filter",
    "error energy",
    "aliasing",
    "blur",
    "shift",
    "from float64 max",
    "p99",
];

/// Pictures in a row of the sheet.
const COLUMNS: u32 = 3;

pub(crate) fn run(arguments: &Filters) -> Result<ExitCode, Error> {
    let drawing = &arguments.drawing;
    let filtering = drawing.textures.filtering()?;
    if filtering.min != host_sim::filtering::Filtering::default().min {
        return Err(Error::content(
            "--filter",
            "this command draws every filter",
            "leave it out, or use render or compare",
        ));
    }
    let frame = drawing.frame()?;
    let bar = ProgressBar::new(pictures() as u64).with_style(
        ProgressStyle::with_template("{bar:30} {pos}/{len} {eta}")
            .unwrap_or_else(|_| ProgressStyle::default_bar()),
    );
    let study = study(
        &frame,
        drawing.perspective,
        &filtering,
        arguments.samples,
        || bar.inc(1),
    )?;
    bar.finish_and_clear();
    if let Some(path) = &arguments.output {
        let width = frame.viewport.width();
        let ideal = format!("ideal: {} samples a pixel", arguments.samples);
        let mut sheet = vec![(ideal, output::image(&study.ideal, width))];
        sheet.extend(study.outcomes.iter().map(|outcome| {
            let picture = output::image(&outcome.pixels, width);
            (outcome.numbers.filter.clone(), picture)
        }));
        output::write_png(&side_by_side(&sheet, COLUMNS), path)?;
    }
    if arguments.json {
        println!("{}", json(&study)?);
    } else {
        println!(
            "{}, {}, {}; energies in squared 8-bit units against {} samples a pixel, whose own detail has {:.1}\n",
            drawing.name(),
            drawing.perspective,
            host_sim::filtering::name_of(&host_sim::filtering::FORMATS, filtering.format),
            arguments.samples,
            study.signal
        );
        println!("{}", table(&study));
    }
    Ok(ExitCode::SUCCESS)
}

fn table(study: &Study) -> Table {
    let mut table = Table::new();
    table.load_preset(comfy_table::presets::ASCII_MARKDOWN);
    table.set_header(HEADER);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    for outcome in &study.outcomes {
        let n = &outcome.numbers;
        let mut row = vec![n.filter.clone()];
        row.extend([n.error, n.aliasing, n.blur, n.shift].map(|e| format!("{e:.1}")));
        row.extend([n.from_float64, n.from_float64_p99].map(|e| format!("{e:.0}")));
        table.add_row(row);
    }
    table
}

#[derive(Serialize)]
struct Document<'a> {
    signal: f64,
    filters: Vec<&'a Numbers>,
}

fn json(study: &Study) -> Result<String, Error> {
    let document = Document {
        signal: study.signal,
        filters: study.outcomes.iter().map(|o| &o.numbers).collect(),
    };
    serde_json::to_string_pretty(&document)
        .map_err(|e| Error::content("JSON", &e.to_string(), "report this"))
}
