//! `host-sim layout`: when Morton order pays.

use std::process::ExitCode;

use comfy_table::{CellAlignment, Table};
use host_sim::error::Error;
use host_sim::layout::{Cost, LINES, SIDE, cost};

use crate::arguments::Layout;

/// Degrees between two rows of the table.
const STEP: usize = 15;

pub(crate) fn run(arguments: &Layout) -> Result<ExitCode, Error> {
    let costs = (0..=90)
        .step_by(STEP)
        .map(cost)
        .collect::<Result<Vec<_>, _>>()
        .map_err(|e| Error::core("layout", e))?;
    if arguments.json {
        let json = serde_json::to_string_pretty(&costs)
            .map_err(|e| Error::content("JSON", &e.to_string(), "report this"))?;
        println!("{json}");
    } else {
        println!(
            "lines of memory that a pixel needs: distinct ones in its span, {SIDE}x{SIDE} RGB565, a texel a pixel\n"
        );
        println!("{}", table(&costs));
    }
    Ok(ExitCode::SUCCESS)
}

fn table(costs: &[Cost]) -> Table {
    let mut table = Table::new();
    table.load_preset(comfy_table::presets::ASCII_MARKDOWN);
    let mut header = vec!["degrees".to_owned()];
    for layout in ["rows", "Morton"] {
        header.extend(LINES.map(|bytes| format!("{layout}, {bytes} bytes")));
    }
    table.set_header(header);
    for column in table.column_iter_mut() {
        column.set_cell_alignment(CellAlignment::Right);
    }
    for cost in costs {
        let mut row = vec![cost.degrees.to_string()];
        row.extend(
            [cost.rows, cost.morton]
                .concat()
                .iter()
                .map(|n| format!("{n:.3}")),
        );
        table.add_row(row);
    }
    table
}
