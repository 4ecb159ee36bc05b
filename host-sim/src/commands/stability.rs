//! `host-sim stability`: hard and random cases, every strategy, every pixel against its bound.

use std::process::ExitCode;

use comfy_table::{CellAlignment, Table};
use host_sim::camera_precision::{self, Precision};
use host_sim::choice::Perspective;
use host_sim::error::Error;
use host_sim::frame::Frame;
use host_sim::fuzz::case as random_case;
use host_sim::hard_case;
use host_sim::stability::{Outcome, examine};
use host_sim::swimming::{self, Agreement, MOTIONS, Swimming};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use crate::arguments::Stability;

mod fuzz;

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
    swimming: Vec<Swimming>,
    agreement: Vec<Agreement>,
    camera: Vec<Precision>,
    pass: bool,
}

pub(crate) fn run(arguments: &Stability) -> Result<ExitCode, Error> {
    if let Some(seconds) = arguments.fuzz {
        return fuzz::run(seconds, arguments.seed, arguments.json);
    }
    let cases = match arguments.case.as_deref() {
        Some(name) => match fuzz::parse(name) {
            Some((seed, number)) => examined(&[(name.to_owned(), random_case(seed, number)?)])?,
            None => hard_cases(name)?,
        },
        None => hard_cases("")?,
    };
    let mut report = Report {
        pass: cases.iter().all(|row| row.pass),
        cases,
        swimming: Vec::new(),
        agreement: Vec::new(),
        camera: Vec::new(),
    };
    if arguments.case.is_none() {
        add_the_rest(&mut report)?;
    }
    if arguments.json {
        print_json(&report)?;
    } else {
        print(&report);
    }
    Ok(code(report.pass))
}

fn code(pass: bool) -> ExitCode {
    if pass {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// All hard cases whose name starts with a text.
fn hard_cases(wanted: &str) -> Result<Vec<Row>, Error> {
    let cases: Vec<_> = hard_case::all()?
        .into_iter()
        .filter(|case| case.name.starts_with(wanted))
        .map(|case| (case.name, case.frame))
        .collect();
    if cases.is_empty() {
        return Err(Error::content(
            "--case",
            &format!("no case's name starts with '{wanted}'"),
            "run host-sim stability to see all names",
        ));
    }
    examined(&cases)
}

/// Every case with every strategy.
fn examined(cases: &[(String, Frame)]) -> Result<Vec<Row>, Error> {
    let bar = ProgressBar::new(cases.len() as u64).with_style(
        ProgressStyle::with_template("{bar:30} {pos}/{len} {msg} {eta}")
            .unwrap_or_else(|_| ProgressStyle::default_bar()),
    );
    let mut rows = Vec::new();
    for (name, frame) in cases {
        bar.set_message(name.clone());
        for perspective in Perspective::ALL {
            let outcome = examine(frame, perspective)?;
            rows.push(Row {
                case: name.clone(),
                strategy: perspective.to_string(),
                pass: outcome.passes(),
                outcome,
            });
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(rows)
}

/// What moves, what is shared, and the camera.
fn add_the_rest(report: &mut Report) -> Result<(), Error> {
    for (motion, _) in MOTIONS {
        for perspective in Perspective::ALL {
            let swimming = swimming::measure(motion, perspective)?;
            report.pass &= swimming.beyond_bound == 0;
            report.swimming.push(swimming);
        }
    }
    for perspective in Perspective::ALL {
        if let Some(agreement) = swimming::agreement(perspective)? {
            report.pass &= agreement.beyond_bound == 0;
            report.agreement.push(agreement);
        }
    }
    report.camera = camera_precision::measure().map_err(|e| Error::core("camera", e))?;
    Ok(())
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
    print_swimming(report);
    print_agreement(report);
    print_camera(report);
    let failed = report.cases.iter().filter(|row| !row.pass).count();
    println!("{failed} of {} failed", report.cases.len());
}

fn print_swimming(report: &Report) {
    if report.swimming.is_empty() {
        return;
    }
    println!("Swimming: motion of surface points beyond float64's, per frame\n");
    for (name, what) in MOTIONS {
        println!("- {name}: {what}");
    }
    let mut table = table(
        &[
            "motion",
            "strategy",
            "steps",
            "texels max",
            "mean",
            "footprints max",
            "p99",
            "mean",
            "snapping footprints max",
            "result",
        ],
        2,
    );
    for s in &report.swimming {
        table.add_row(vec![
            s.motion.to_owned(),
            s.strategy.clone(),
            s.steps.to_string(),
            number(s.texels.max),
            number(s.texels.mean),
            number(s.footprints.max),
            number(s.footprints.p99),
            number(s.footprints.mean),
            number(s.snapping.max),
            result(s.beyond_bound == 0),
        ]);
    }
    println!("\n{table}\n");
}

fn print_agreement(report: &Report) {
    if report.agreement.is_empty() {
        return;
    }
    println!("Agreement: two triangles of one plane, between the anchors that their spans share\n");
    let mut table = table(
        &["strategy", "pixels", "texels max", "error/bound", "result"],
        1,
    );
    for a in &report.agreement {
        table.add_row(vec![
            a.strategy.clone(),
            a.pixels.to_string(),
            number(a.texels),
            format!("{:.3}", a.ratio),
            result(a.beyond_bound == 0),
        ]);
    }
    println!("{table}\n");
}

fn print_camera(report: &Report) {
    if report.camera.is_empty() {
        return;
    }
    println!("Cameras against float64 trigonometry, pixels at 320x240\n");
    let mut table = table(
        &[
            "trigonometry",
            "field of view",
            "orthogonality",
            "angle, rad",
            "turn, px",
            "lens, px",
        ],
        1,
    );
    for c in &report.camera {
        table.add_row(vec![
            format!("{:?}", c.trigonometry).to_lowercase(),
            c.field.to_string(),
            number(c.orthogonality),
            number(c.angle),
            number(c.turn_pixels),
            number(c.lens_pixels),
        ]);
    }
    println!("{table}\n");
}
