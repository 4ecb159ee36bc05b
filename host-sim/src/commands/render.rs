//! `host-sim render`: one picture.

use std::path::Path;
use std::process::ExitCode;

use host_sim::error::Error;
use host_sim::output;
use host_sim::shaded::pixels;
use host_sim::view::view;

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
    let drawing = &arguments.drawing;
    let filtering = drawing.textures.filtering()?;
    let frame = drawing.frame()?;
    let (perspective, rows) = (drawing.perspective, drawing.rows());
    let image = match arguments.show {
        Some(what) => view(&frame, perspective, rows, &filtering, what)?,
        None => {
            let pixels = pixels(&frame, perspective, rows, &filtering)?;
            output::image(&pixels.rgb(), frame.viewport.width())
        }
    };
    output::write_png(&image, &path)?;
    println!("{}", path.display());
    Ok(ExitCode::SUCCESS)
}
