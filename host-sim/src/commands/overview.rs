//! `host-sim` without a command: all scenes as pictures, and their errors as a table.

use std::process::ExitCode;
use std::time::Instant;

use comfy_table::{CellAlignment, Table};
use host_sim::compare::{Comparison, Spread, compare};
use host_sim::error::Error;
use host_sim::heat_map::heat_map;
use host_sim::output;
use host_sim::scenes::DEFAULT;
use host_sim::shaded::pixels;
use host_sim::subject::Subject;
use indicatif::{ProgressBar, ProgressStyle};

use crate::arguments::Overview;

/// Times each frame is drawn for the clock; the fastest counts.
const REPEATS: u32 = 5;

const HEADER: [&str; 14] = [
    "scene",
    "triangles",
    "pixels",
    "coverage mismatches",
    "texels max",
    "p99",
    "mean",
    "footprints max",
    "p99",
    "mean",
    "snapping texels max",
    "footprints max",
    "PSNR dB",
    "ms",
];

pub(crate) fn run(arguments: &Overview) -> Result<ExitCode, Error> {
    let bar = ProgressBar::new(DEFAULT.len() as u64).with_style(
        ProgressStyle::with_template("{bar:30} {pos}/{len} {msg} {eta}")
            .unwrap_or_else(|_| ProgressStyle::default_bar()),
    );
    let mut table = Table::new();
    table.load_preset(comfy_table::presets::ASCII_MARKDOWN);
    table.set_header(HEADER);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    let mut wrong = 0;
    for name in DEFAULT {
        bar.set_message(name);
        let (comparison, milliseconds) = draw(name, arguments)?;
        wrong += comparison.coverage_mismatches;
        table.add_row(row(name, &comparison, milliseconds));
        bar.inc(1);
    }
    bar.finish_and_clear();
    println!(
        "{}x{} RGB565, perspective {}; errors of texture coordinates against float64, in level-0 texels and in footprints\n",
        arguments.size.width(),
        arguments.size.height(),
        arguments.perspective
    );
    println!("{table}\n");
    println!("pictures: {}", arguments.out.display());
    Ok(if wrong == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// Draws one scene, writes its three pictures, and gives its numbers.
fn draw(name: &str, arguments: &Overview) -> Result<(Comparison, f64), Error> {
    let frame = Subject::by_name(name)?.frame(arguments.size)?;
    let (width, height) = (arguments.size.width(), arguments.size.height());
    let filtering = arguments.textures.filtering()?;
    let report = compare(&frame, arguments.perspective, height, &filtering)?;
    let file = |suffix: &str| arguments.out.join(format!("{name}{suffix}.png"));
    output::write_png(&output::image(&report.core, width), &file(""))?;
    output::write_png(
        &output::image(&report.reference, width),
        &file("-reference"),
    )?;
    let title = format!("{name} {}: error in texels", arguments.perspective);
    output::write_png(&heat_map(&report.error, width, &title), &file("-error"))?;

    let mut fastest = f64::INFINITY;
    for _ in 0..REPEATS {
        let start = Instant::now();
        pixels(&frame, arguments.perspective, height, &filtering)?;
        fastest = fastest.min(start.elapsed().as_secs_f64() * 1e3);
    }
    Ok((report.comparison, fastest))
}

fn row(name: &str, c: &Comparison, milliseconds: f64) -> Vec<String> {
    let spread = |s: Spread| [s.max, s.p99, s.mean].map(|n| format!("{n:.4}"));
    let mut row = vec![
        name.to_owned(),
        c.triangles.to_string(),
        c.pixels.to_string(),
        c.coverage_mismatches.to_string(),
    ];
    row.extend(spread(c.uv_error.texels));
    row.extend(spread(c.uv_error.footprints));
    row.push(format!("{:.4}", c.snap_error.texels.max));
    row.push(format!("{:.4}", c.snap_error.footprints.max));
    row.push(
        c.psnr
            .map_or_else(|| "equal".to_owned(), |p| format!("{p:.1}")),
    );
    row.push(format!("{milliseconds:.2}"));
    row
}
