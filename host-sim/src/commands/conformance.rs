//! `host-sim conformance`: the core against an independent renderer.

use std::process::ExitCode;

use host_sim::conformance;
use host_sim::error::Error;

use crate::arguments::Conformance;

pub(crate) fn run(arguments: &Conformance) -> Result<ExitCode, Error> {
    let families = conformance::run(&arguments.dir, arguments.texel_tol)?;
    let tolerance = arguments.texel_tol;
    println!("texel cases: perspective exact, ties within {tolerance} texel of a boundary\n");
    println!(
        "{:16} {:>6} {:>9} {:>7} {:>7} {:>7} {:>11}",
        "family", "cases", "pixels", "ties", "quads", "exempt", "mismatches"
    );
    let mut wrong = 0;
    for f in &families {
        println!(
            "{:16} {:6} {:9} {:7} {:7} {:7} {:11}",
            f.name, f.cases, f.pixels, f.ties, f.quads, f.exempt, f.mismatches
        );
        wrong += f.mismatches;
    }
    for f in &families {
        if let Some(strict) = f.strict_mismatches {
            println!(
                "\n{}: {strict} pixels differ at the data set's own 0.005 texel",
                f.name
            );
        }
    }
    Ok(if wrong == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}
