//! The command line: reads arguments, calls the library, prints.

mod arguments;
mod commands;

use std::process::ExitCode;

use clap::Parser as _;
use clap::error::ErrorKind;

use arguments::{Arguments, Command};

/// What a user did wrong.
const USAGE: u8 = 2;

fn main() -> ExitCode {
    sigpipe::reset();
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return refused(&error),
    };
    let result = match arguments.command {
        None => commands::overview::run(&arguments.overview),
        Some(Command::Bake(a)) => commands::bake::run(&a),
        Some(Command::Layout(a)) => commands::layout::run(&a),
        Some(Command::Render(a)) => commands::render::run(&a),
        Some(Command::Report(a)) => commands::report::run(&a),
        Some(Command::Compare(a)) => commands::compare::run(&a),
        Some(Command::Conformance(a)) => commands::conformance::run(&a),
        Some(Command::Filters(a)) => commands::filters::run(&a),
        Some(Command::Hash(a)) => commands::hash::run(&a),
        Some(Command::Historic(a)) => commands::historic::run(&a),
        Some(Command::Scenes) => commands::scenes::run(),
        Some(Command::Stability(a)) => commands::stability::run(&a),
    };
    match result {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(USAGE)
        }
    }
}

/// Prints help where it was asked for, and what is wrong with the arguments in one line.
fn refused(error: &clap::Error) -> ExitCode {
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            _ = error.print();
            ExitCode::SUCCESS
        }
        _ => {
            let text = error.to_string();
            let first: Vec<_> = text
                .lines()
                .take_while(|line| !line.trim().is_empty())
                .map(str::trim)
                .collect();
            eprintln!("{}; see host-sim --help", first.join(" "));
            ExitCode::from(USAGE)
        }
    }
}
