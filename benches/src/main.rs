//! The command line of the benches: runs them, compares, prints.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use benches::budget;
use benches::case::{Case, Drawer, all};
use benches::error::Error;
use benches::instructions::{DRAW, count, draw};
use benches::scene::WIDTH;
use benches::table::{Cost, side_by_side};
use benches::time::measure;
use clap::{Parser, Subcommand};
use host_sim::output;
use multum::embedded_graphics::pixelcolor::RgbColor;

/// What drawing the benchmark scenes costs on this PC. Run with `cargo run --profile bench -p benches
/// --`, so that what is measured is what `cargo bench` measures.
#[derive(Parser)]
#[command(about, long_about = None)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Measure instructions and time, ours and the peers', and print them side by side. Needs
    /// Valgrind; time means something on an idle machine only.
    Table,
    /// Count our instructions and fail if one is more than 1 % above benches/budgets.toml. Needs
    /// Valgrind.
    Budgets {
        /// Write what was counted to the file as the budgets.
        #[arg(long)]
        accept: bool,
    },
    /// Write every case's frame as a PNG file.
    Pictures {
        /// Where to.
        folder: PathBuf,
    },
}

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1).peekable();
    let result = if arguments.next_if(|first| first == DRAW).is_some() {
        draw(arguments).map(|()| ExitCode::SUCCESS)
    } else {
        match Arguments::parse().command {
            Command::Table => table(),
            Command::Budgets { accept } => budgets(accept),
            Command::Pictures { folder } => pictures(&folder),
        }
    };
    result.unwrap_or_else(|error| {
        eprintln!("error: {error}");
        ExitCode::FAILURE
    })
}

fn table() -> Result<ExitCode, Error> {
    let cases = all();
    let (instructions, times) = (count(&cases)?, measure(&cases)?);
    let costs: Vec<_> = cases
        .into_iter()
        .zip(instructions)
        .zip(times)
        .map(|((case, instructions), time)| Cost {
            case,
            instructions,
            time,
        })
        .collect();
    print(&side_by_side(&costs));
    Ok(ExitCode::SUCCESS)
}

fn budgets(accept: bool) -> Result<ExitCode, Error> {
    if !cfg!(target_arch = "x86_64") {
        return Err(Error::content(
            "budgets.toml",
            "has budgets for x86-64 only",
        ));
    }
    let mut cases = all();
    cases.retain(|case| matches!(case.drawer, Drawer::Ours(_)));
    let counted = budget::per_pixel(&cases, &count(&cases)?);
    let mut text = budget::read()?;
    if accept {
        text = budget::accept(&text, &counted)?;
        output::write(budget::FILE.as_ref(), text.as_bytes())?;
    }
    let report = budget::compare(&text, &counted)?;
    print(&report.text);
    if report.faults == 0 {
        return Ok(ExitCode::SUCCESS);
    }
    let (faults, all) = (report.faults, counted.len());
    eprintln!("error: {faults} faults in {all} counts; what is meant to cost more: --accept");
    Ok(ExitCode::FAILURE)
}

fn pictures(folder: &Path) -> Result<ExitCode, Error> {
    for case in all() {
        let mut drawing = case.drawing()?;
        drawing.clear();
        drawing.draw();
        let pixels: Vec<_> = drawing
            .pixels()
            .iter()
            .map(|p| [p.r() << 3, p.g() << 2, p.b() << 3])
            .collect();
        output::write_png(
            &output::image(&pixels, WIDTH),
            &folder.join(file_name(case)),
        )?;
    }
    Ok(ExitCode::SUCCESS)
}

/// To the standard output; whoever does not want to read it to its end may close it.
fn print(text: &str) {
    _ = std::io::stdout().write_all(text.as_bytes());
}

/// The case's name without what file names should not have.
fn file_name(case: Case) -> String {
    format!("{case}.png").replace([' ', ':'], "-")
}
