//! `host-sim scenes`: what can be drawn by name.

use std::process::ExitCode;

use host_sim::error::Error;
use host_sim::subject;

pub(crate) fn run() -> Result<ExitCode, Error> {
    for (name, shows) in subject::names() {
        println!("{name:13} {shows}");
    }
    Ok(ExitCode::SUCCESS)
}
