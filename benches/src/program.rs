//! Starting programs and saying why one did not do its work.

use std::process::Command;

use crate::error::Error;

/// Runs a program to its end.
pub(crate) fn run(command: &mut Command, remedy: &str) -> Result<(), Error> {
    let status = command.status().map_err(|error| Error::Start {
        program: command.get_program().display().to_string(),
        reason: error.kind().to_string(),
        remedy: remedy.to_owned(),
    })?;
    if status.success() {
        return Ok(());
    }
    let words = [command.get_program()]
        .into_iter()
        .chain(command.get_args());
    let words: Vec<_> = words.map(|word| word.display().to_string()).collect();
    Err(Error::Failed {
        command: words.join(" "),
        status: status.to_string(),
    })
}
