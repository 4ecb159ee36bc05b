//! `host-sim hash`: one frame as a line that a device's image prints alike.

use std::process::ExitCode;

use host_sim::error::Error;
use host_sim::render::hash;
use host_sim::shaded::{Pixels, pixels};

use crate::arguments::Hash;

pub(crate) fn run(arguments: &Hash) -> Result<ExitCode, Error> {
    let drawing = &arguments.drawing;
    let frame = drawing.frame()?;
    let filtering = drawing.textures.filtering()?;
    let pixels = pixels(&frame, drawing.perspective, drawing.rows(), &filtering)?;
    let (width, height) = (frame.viewport.width(), frame.viewport.height());
    let hash = match &pixels {
        Pixels::Rgb565(pixels) => hash(pixels, frame.viewport),
        Pixels::Rgb888(pixels) => hash(pixels, frame.viewport),
    };
    println!("frame {} {width}x{height} {hash:016x}", drawing.name());
    Ok(ExitCode::SUCCESS)
}
