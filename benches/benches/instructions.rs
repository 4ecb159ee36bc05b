//! Instructions of every case with callgrind: `cargo bench -p benches --bench instructions [-- FILTER]`.
//! `FILTER` is a part of a case's name, such as `every:16` or `euc`.
//!
//! Needs Valgrind. A frame is drawn as a whole; preparing and clearing it is not counted.

use std::fmt::Write as _;
use std::io::Write as _;
use std::process::ExitCode;

use benches::case::{Case, all};
use benches::error::Error;
use benches::instructions::{DRAW, count, draw};
use benches::scene::Unit;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1).peekable();
    let result = if arguments.next_if(|first| first == DRAW).is_some() {
        draw(arguments)
    } else {
        // Cargo adds --bench.
        print(arguments.find(|argument| !argument.starts_with("--")))
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn print(filter: Option<String>) -> Result<(), Error> {
    let filter = filter.unwrap_or_default();
    let cases: Vec<Case> = all()
        .into_iter()
        .filter(|case| case.to_string().contains(&filter))
        .collect();
    let mut text = String::new();
    for (case, instructions) in cases.iter().zip(count(&cases)?) {
        let Unit { name, count } = Unit::of(case.scene);
        let (case, each) = (case.to_string(), instructions as f64 / count as f64);
        _ = writeln!(text, "{case:<48} {each:>10.2} instructions/{name}");
    }
    // Whoever does not want to read it to its end may close it.
    _ = std::io::stdout().write_all(text.as_bytes());
    Ok(())
}
