//! The README's section: the summary and one plot.

use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::file;
use crate::output;
use crate::report::measure::Row;
use crate::report::peers::Peer;
use crate::report::plot::{Unit, marks, svg};
use crate::report::table::{COST_SCENE, summary};

/// The line before the section.
pub const BEGIN: &str = "<!-- `host-sim report --readme` writes what is between these lines -->";
/// The line after it.
pub const END: &str = "<!-- end of the report -->";

/// The plot's file, from the README.
const PLOT: &str = "host-sim/pictures/speed-against-error.svg";

/// The core of the plot.
const CORE: (&str, &str) = ("m4", "Cortex-M4");

/// The section with its marks, and the plot that it shows.
///
/// # Errors
///
/// [`Error::Content`] if the plot cannot be drawn.
pub fn section(rows: &[Row], peers: &[Peer]) -> Result<(String, String), Error> {
    let (core, title) = CORE;
    let marks = marks(rows, peers, COST_SCENE, core, Unit::Texels);
    let plot = svg(&format!("{COST_SCENE} on a {title}"), Unit::Texels, &marks)?;
    let text = format!(
        "{BEGIN}\n![Instructions a pixel against the largest error]({PLOT})\n\n{}\n{END}",
        summary(rows)
    );
    Ok((text, plot))
}

/// Rewrites a README between its marks, and the plot beside it.
///
/// # Errors
///
/// [`Error::Read`], [`Error::Write`], or [`Error::Content`] for a README without marks.
pub fn write(readme: &Path, rows: &[Row], peers: &[Peer]) -> Result<(), Error> {
    let (section, plot) = section(rows, peers)?;
    let text = String::from_utf8_lossy(&file::read(readme)?).into_owned();
    let parts = text.split_once(BEGIN).and_then(|(before, rest)| {
        let (_, after) = rest.split_once(END)?;
        Some((before, after))
    });
    let Some((before, after)) = parts else {
        return Err(Error::content(
            &readme.display().to_string(),
            &format!("it has no lines {BEGIN} and {END}"),
            "put them where the section shall be",
        ));
    };
    let folder = readme.parent().unwrap_or(Path::new("."));
    output::write(&folder.join(PLOT), plot.as_bytes())?;
    output::write(readme, format!("{before}{section}{after}").as_bytes())
}

/// The project's README.
#[must_use]
pub fn of_project() -> PathBuf {
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).parent();
    project.unwrap_or(Path::new(".")).join("README.md")
}
