//! `host-sim render`: one picture.

use std::path::Path;
use std::process::ExitCode;

use host_sim::error::Error;
use host_sim::output;
use host_sim::render::colours;

use crate::arguments::Render;

pub(crate) fn run(arguments: &Render) -> Result<ExitCode, Error> {
    let path = match &arguments.output {
        Some(path) => path.clone(),
        None => Path::new("out")
            .join(arguments.drawing.name())
            .with_extension("png"),
    };
    let is_png = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("png"));
    if !is_png {
        return Err(Error::write(
            &path,
            &"pictures are written as PNG: the name must end in .png",
        ));
    }
    let frame = arguments.drawing.frame()?;
    let pixels = colours(
        &frame,
        arguments.drawing.perspective,
        arguments.drawing.rows(),
    )?;
    output::write_png(&output::image(&pixels, frame.viewport.width()), &path)?;
    println!("{}", path.display());
    Ok(ExitCode::SUCCESS)
}
