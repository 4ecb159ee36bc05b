//! Counting instructions with callgrind, a tool of Valgrind 3.
//!
//! The program starts itself again under callgrind, which counts while `frame` runs, that is, while
//! a frame is drawn, and writes a part of its file whenever it returns. Parts are matched to cases by
//! their order.
//!
//! Gungraun (once iai-callgrind) counts the same but is not used: its runner is a program of 170
//! crates to be installed in exactly the library's version, which takes longer than all the rest of
//! the check; it starts Valgrind anew for each case, and knows cases by number only.

use std::path::Path;
use std::process::Command;

use crate::case::Case;
use crate::drawing::Drawing;
use crate::error::Error;
use crate::program::run;

/// The argument that a program which calls [`count`] must answer with [`draw`].
pub const DRAW: &str = "--draw-under-callgrind";

/// How callgrind knows `frame`.
const COUNTED: &str = "benches::instructions::frame";

/// Instructions of drawing one frame of each case.
///
/// The running program must call [`draw`] with the arguments after [`DRAW`] if that is its first.
///
/// # Errors
///
/// [`Error::Start`] without Valgrind; [`Error::Failed`] if it or a case fails; [`Error::Content`] if
/// its file is not as it should be.
pub fn count(cases: &[Case]) -> Result<Vec<u64>, Error> {
    let this = std::env::current_exe().map_err(|e| Error::read(Path::new("this program"), &e))?;
    let folder = tempfile::tempdir().map_err(|e| Error::read(&std::env::temp_dir(), &e))?;
    let file = folder.path().join("counts");
    let mut command = Command::new("valgrind");
    command
        .args([
            "--tool=callgrind",
            "--quiet",
            "--cache-sim=no",
            "--branch-sim=no",
        ])
        .args(["--collect-atstart=no", "--combine-dumps=yes"])
        .arg(format!("--toggle-collect={COUNTED}"))
        .arg(format!("--dump-after={COUNTED}"))
        .arg(format!("--callgrind-out-file={}", file.display()))
        .arg(this)
        .arg(DRAW)
        .args(cases.iter().map(Case::to_string));
    run(
        &mut command,
        "install Valgrind (Debian: apt-get install valgrind)",
    )?;
    let text = std::fs::read_to_string(&file).map_err(|e| Error::read(&file, &e))?;
    let counts = totals(&text)?;
    if counts.len() != cases.len() {
        let problem = format!("it counted {} frames and not {}", counts.len(), cases.len());
        return Err(Error::content("callgrind", &problem));
    }
    Ok(counts)
}

/// Draws the cases of these names, one frame each, so that callgrind can count.
///
/// # Errors
///
/// [`Error`] for an unknown name, or a scene that is refused.
pub fn draw(names: impl IntoIterator<Item = String>) -> Result<(), Error> {
    for name in names {
        let mut drawing = Case::by_name(&name)?.drawing()?;
        drawing.clear();
        frame(&mut *drawing);
    }
    Ok(())
}

/// What is counted. Not inlined, for callgrind must see it called.
#[inline(never)]
fn frame(drawing: &mut dyn Drawing) {
    drawing.draw();
}

/// The counts of the parts in which anything was counted: the last part is what is left at the
/// program's end.
fn totals(text: &str) -> Result<Vec<u64>, Error> {
    let mut counts = Vec::new();
    for line in text.lines() {
        if let Some(count) = line.strip_prefix("totals: ") {
            let count = count
                .trim()
                .parse()
                .map_err(|_| Error::content("callgrind", &format!("'{line}' is no count")))?;
            if count > 0 {
                counts.push(count);
            }
        }
    }
    Ok(counts)
}

#[cfg(test)]
mod tests {
    use super::totals;

    #[test]
    fn the_empty_part_at_the_end_is_no_frame() {
        let text = "part: 1\ntotals: 1150495\n\npart: 2\ntotals: 7\n\npart: 3\ntotals: 0\n";
        assert_eq!(totals(text).ok(), Some(vec![1_150_495, 7]));
    }

    #[test]
    fn counts_that_are_not_numbers_are_refused() {
        assert!(totals("totals: many\n").is_err());
    }
}
