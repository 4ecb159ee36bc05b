//! `host-sim stability`: hard and random cases, every strategy, every pixel against its bound.

use std::process::ExitCode;

use comfy_table::{CellAlignment, Table};
use host_sim::choice::Perspective;
use host_sim::error::Error;
use host_sim::hard_case;
use host_sim::stability::{Outcome, examine};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use crate::arguments::Stability;

const HEADER: [&str; 12] = [
    "case",
    "strategy",
    "pixels",
    "max texels",
    "max footprints",
    "error there",
    "bound there",
    "error/bound",
    "at",
    "coverage",
    "texel",
    "result",
];

/// One case with one strategy.
#[derive(Serialize)]
struct Row {
    case: String,
    strategy: String,
    #[serde(flatten)]
    outcome: Outcome,
    pass: bool,
}

/// What is printed as JSON.
#[derive(Serialize)]
struct Report {
    cases: Vec<Row>,
    pass: bool,
}

pub(crate) fn run(arguments: &Stability) -> Result<ExitCode, Error> {
    let report = cases(arguments.case.as_deref())?;
    if arguments.json {
        print_json(&report)?;
    } else {
        print(&report);
    }
    Ok(if report.pass {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// All hard cases whose name starts with a text.
fn cases(wanted: Option<&str>) -> Result<Report, Error> {
    let wanted = wanted.unwrap_or("");
    let mut cases = hard_case::all()?;
    cases.retain(|case| case.name.starts_with(wanted));
    if cases.is_empty() {
        return Err(Error::content(
            "--case",
            &format!("no case's name starts with '{wanted}'"),
            "run host-sim stability to see all names",
        ));
    }
    let bar = ProgressBar::new(cases.len() as u64).with_style(
        ProgressStyle::with_template("{bar:30} {pos}/{len} {msg} {eta}")
            .unwrap_or_else(|_| ProgressStyle::default_bar()),
    );
    let mut rows = Vec::new();
    for case in &cases {
        bar.set_message(case.name.clone());
        for perspective in Perspective::ALL {
            let outcome = examine(&case.frame, perspective)?;
            rows.push(Row {
                case: case.name.clone(),
                strategy: perspective.to_string(),
                pass: outcome.passes(),
                outcome,
            });
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(Report {
        pass: rows.iter().all(|row| row.pass),
        cases: rows,
    })
}

fn print_json(report: &impl Serialize) -> Result<(), Error> {
    let json = serde_json::to_string_pretty(report)
        .map_err(|e| Error::content("JSON", &e.to_string(), "report this"))?;
    println!("{json}");
    Ok(())
}

/// A table with the first `names` columns to the left and the others to the right.
fn table(header: &[&str], names: usize) -> Table {
    let mut table = Table::new();
    table.load_preset(comfy_table::presets::ASCII_MARKDOWN);
    table.set_header(header);
    for column in table.column_iter_mut().skip(names) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

/// `pass`, or something to look for.
fn result(pass: bool) -> String {
    if pass { "pass" } else { "FAIL" }.to_owned()
}

/// Few digits whatever the size.
fn number(n: f64) -> String {
    if n == 0.0 || (1e-3..1e5).contains(&n) {
        format!("{n:.5}")
    } else {
        format!("{n:.2e}")
    }
}

fn print(report: &Report) {
    println!(
        "Every pixel against float64 and the strategy's derived bound. Errors of u or v in level-0\n\
         texels and in footprints; error, bound and place are those of the pixel nearest to its bound.\n"
    );
    let mut table = table(&HEADER, 2);
    for Row {
        case,
        strategy,
        outcome: o,
        pass,
    } in &report.cases
    {
        table.add_row(vec![
            case.clone(),
            strategy.clone(),
            o.pixels.to_string(),
            number(o.texels),
            number(o.footprints),
            number(o.worst.error),
            number(o.worst.bound),
            format!("{:.3}", o.worst.ratio),
            format!("{},{} #{}", o.worst.x, o.worst.y, o.worst.triangle),
            o.coverage_mismatches.to_string(),
            o.texel_mismatches.to_string(),
            result(*pass),
        ]);
    }
    println!("{table}\n");
    let failed = report.cases.iter().filter(|row| !row.pass).count();
    println!("{} of {} failed", failed, report.cases.len());
}
