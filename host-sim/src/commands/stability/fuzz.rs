//! `host-sim stability --fuzz`: random cases for some time, and the worst of them.

use std::process::ExitCode;
use std::time::{Duration, Instant};

use host_sim::choice::Perspective;
use host_sim::error::Error;
use host_sim::fuzz::case;
use host_sim::stability::{Worst, examine};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use super::{code, number, print_json, result, table};

/// Failing cases that are listed; more are only counted.
const LISTED: usize = 20;

/// What the random cases came to.
#[derive(Serialize)]
struct Report {
    seed: u64,
    cases: u64,
    pixels: usize,
    strategies: Vec<Strategy>,
    failures: usize,
    /// The first failures, as arguments of `--case`.
    failed: Vec<String>,
    pass: bool,
}

/// The worst case of a strategy.
#[derive(Serialize)]
struct Strategy {
    strategy: String,
    /// Argument of `--case`.
    case: String,
    worst: Worst,
    failures: usize,
}

/// Seed and number of a case's name, `fuzz:SEED:NUMBER`.
pub(super) fn parse(name: &str) -> Option<(u64, u64)> {
    let (seed, number) = name.strip_prefix("fuzz:")?.split_once(':')?;
    Some((seed.parse().ok()?, number.parse().ok()?))
}

pub(super) fn run(seconds: u64, seed: u64, json: bool) -> Result<ExitCode, Error> {
    let bar = ProgressBar::new(seconds).with_style(
        ProgressStyle::with_template("{bar:30} {pos}/{len} s, {msg}")
            .unwrap_or_else(|_| ProgressStyle::default_bar()),
    );
    let mut report = Report {
        seed,
        cases: 0,
        pixels: 0,
        strategies: Perspective::ALL
            .iter()
            .map(|perspective| Strategy {
                strategy: perspective.to_string(),
                case: String::new(),
                worst: Worst::default(),
                failures: 0,
            })
            .collect(),
        failures: 0,
        failed: Vec::new(),
        pass: true,
    };
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(seconds) {
        try_case(&mut report)?;
        if report.cases.is_multiple_of(64) {
            bar.set_position(start.elapsed().as_secs());
            bar.set_message(format!(
                "{} cases, {} failures",
                report.cases, report.failures
            ));
        }
    }
    bar.finish_and_clear();
    if json {
        print_json(&report)?;
    } else {
        print(&report);
    }
    Ok(code(report.pass))
}

/// Draws the next case with every strategy.
fn try_case(report: &mut Report) -> Result<(), Error> {
    let name = format!("fuzz:{}:{}", report.seed, report.cases);
    let frame = case(report.seed, report.cases)?;
    let mut passes = true;
    for (perspective, worst) in Perspective::ALL.into_iter().zip(&mut report.strategies) {
        let outcome = examine(&frame, perspective)?;
        report.pixels += outcome.pixels;
        if outcome.worst.ratio > worst.worst.ratio || outcome.worst.ratio.is_nan() {
            worst.worst = outcome.worst;
            worst.case.clone_from(&name);
        }
        if !outcome.passes() {
            worst.failures += 1;
            passes = false;
        }
    }
    report.cases += 1;
    if !passes {
        report.pass = false;
        report.failures += 1;
        if report.failed.len() < LISTED {
            report.failed.push(name);
        }
    }
    Ok(())
}

fn print(report: &Report) {
    println!(
        "{} random cases of seed {}, {} pixels; the worst of each strategy\n",
        report.cases, report.seed, report.pixels
    );
    let header = [
        "strategy",
        "to repeat",
        "error, texels",
        "bound, texels",
        "error/bound",
        "at",
        "failures",
        "result",
    ];
    let mut table = table(&header, 2);
    for s in &report.strategies {
        table.add_row(vec![
            s.strategy.clone(),
            format!("host-sim stability --case {}", s.case),
            number(s.worst.error),
            number(s.worst.bound),
            format!("{:.4}", s.worst.ratio),
            format!("{},{} #{}", s.worst.x, s.worst.y, s.worst.triangle),
            s.failures.to_string(),
            result(s.failures == 0),
        ]);
    }
    println!("{table}\n");
    for name in &report.failed {
        println!("FAIL: host-sim stability --case {name}");
    }
    println!("{} of {} cases failed", report.failures, report.cases);
}
