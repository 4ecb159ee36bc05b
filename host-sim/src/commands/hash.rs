//! `host-sim hash`: one frame as a line that a device's image prints alike.

use std::process::ExitCode;

use host_sim::error::Error;
use host_sim::render::{colours, hash};

use crate::arguments::Hash;

pub(crate) fn run(arguments: &Hash) -> Result<ExitCode, Error> {
    let drawing = &arguments.drawing;
    let frame = drawing.frame()?;
    let pixels = colours(&frame, drawing.perspective, drawing.rows())?;
    let (width, height) = (frame.viewport.width(), frame.viewport.height());
    let hash = hash(&pixels, frame.viewport);
    println!("frame {} {width}x{height} {hash:016x}", drawing.name());
    Ok(ExitCode::SUCCESS)
}
