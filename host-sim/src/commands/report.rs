//! `host-sim report`: speed against error.

use std::process::ExitCode;

use host_sim::benchmark;
use host_sim::error::Error;
use host_sim::output;
use host_sim::report::answer::{Question, SURFACES, answer};
use host_sim::report::chip::Chip;
use host_sim::report::measure::{Extent, Measured, Progress, hard_cases, measure};
use host_sim::report::on_target::Record;
use host_sim::report::page::page;
use host_sim::report::plot::{Unit, marks, picture, svg};
use host_sim::report::table::{COST_SCENE, cores, csv, json, summary};
use host_sim::report::{peers, readme};
use host_sim::subject;
use indicatif::{ProgressBar, ProgressStyle};
use multum::viewport::Viewport;

use crate::arguments::Report;

pub(crate) fn run(arguments: &Report) -> Result<ExitCode, Error> {
    let record = Record::of_project()?;
    if !record.is_current() {
        eprintln!(
            "note: benches/on-target.json is of other sources of the core than these; do `firmware/run all bench`"
        );
    }
    if let Some(chip) = arguments.chip {
        return ask(arguments, chip, &record);
    }
    if arguments.readme {
        let measured = measured(Extent::Coordinates, &record)?;
        let path = readme::of_project();
        readme::write(&path, &measured.rows, &peers::all()?)?;
        println!("{}", summary(&measured.rows));
        println!("written: {}", path.display());
        return Ok(ExitCode::SUCCESS);
    }
    let folder = &arguments.out;
    output::prepare(folder)?;
    let measured = measured(Extent::Everything, &record)?;
    let peers = peers::all()?;
    output::write(&folder.join("report.csv"), &csv(&measured.rows)?)?;
    output::write(
        &folder.join("report.json"),
        &json(&measured, &record, &peers)?,
    )?;
    for core in cores() {
        let of_core = Chip::ALL.iter().find(|chip| chip.core == core);
        let title = of_core.map_or(core, |chip| chip.core_title);
        for unit in Unit::ALL {
            let marks = marks(&measured.rows, &peers, COST_SCENE, core, unit);
            let title = format!("{COST_SCENE} on {title}");
            let name = |kind: &str| folder.join(format!("plots/{core}-{}.{kind}", unit.name()));
            output::write(&name("svg"), svg(&title, unit, &marks)?.as_bytes())?;
            output::write_png(&picture(&title, unit, &marks)?, &name("png"))?;
        }
    }
    let page = page(&measured, &record, &peers)?;
    output::write(&folder.join("index.html"), page.as_bytes())?;
    println!("320x240, the nearest texel; instructions and milliseconds on {COST_SCENE}\n");
    println!("{}\n", summary(&measured.rows));
    println!("report: {}", folder.join("index.html").display());
    let failed = measured.hard_cases.iter().filter(|hard| !hard.pass).count();
    if failed > 0 {
        eprintln!("error: {failed} hard cases break their bounds; `host-sim stability` lists them");
        return Ok(ExitCode::FAILURE);
    }
    Ok(ExitCode::SUCCESS)
}

/// Answers which settings keep to the limits.
fn ask(arguments: &Report, chip: Chip, record: &Record) -> Result<ExitCode, Error> {
    let question = Question {
        chip,
        milliseconds: arguments.budget_ms,
        footprints: arguments.max_error,
        size: arguments.size,
    };
    let (width, height) = (arguments.size.width(), arguments.size.height());
    let measured = measured(Extent::Coordinates, record)?;
    println!(
        "{chip}, frames of {width}x{height}: cycles as counted at 320x240, errors as measured there\n"
    );
    let scenes: Vec<&str> = match &arguments.scene {
        Some(scene) => vec![scene],
        None => SURFACES.to_vec(),
    };
    let verdicts = answer(&measured.rows, &question, &scenes);
    for verdict in &verdicts {
        println!("{}", verdict.text(&question));
    }
    Ok(ExitCode::SUCCESS)
}

fn measured(extent: Extent, record: &Record) -> Result<Measured, Error> {
    let size = Viewport::new(320, 240).map_err(|e| Error::core("report", e))?;
    let scenes: Vec<_> = match extent {
        Extent::Coordinates => benchmark::SCENES.to_vec(),
        Extent::Everything => subject::names().collect(),
    };
    let bar = Bar::new();
    let mut measured = measure(&scenes, size, extent, record, &bar)?;
    if extent == Extent::Everything {
        measured.hard_cases = hard_cases(&bar)?;
    }
    bar.0.finish_and_clear();
    Ok(measured)
}

/// A bar with the time that is left, on the error stream.
struct Bar(ProgressBar);

impl Bar {
    fn new() -> Self {
        let style = ProgressStyle::with_template("{bar:30} {percent} % {eta} left")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        Self(ProgressBar::new(0).with_style(style))
    }
}

impl Progress for Bar {
    fn start(&self, steps: usize) {
        self.0.inc_length(steps as u64);
    }

    fn done(&self, steps: usize) {
        self.0.inc(steps as u64);
    }
}
