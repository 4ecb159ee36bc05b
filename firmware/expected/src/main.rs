//! What a chip's image `frames` must print, drawn on the PC: `expected CHIP`.
//!
//! Each frame is drawn whole, where the chip draws bands, so that equal hashes show both that the
//! target gives the same integers and that bands change nothing.

use std::process::ExitCode;

use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::error::Error;
use scenes::draw::{BACKGROUND, Buffers, NO_VERTEX, frame};
use scenes::plan::{PLANS, Plan};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [chip] = arguments.as_slice() else {
        return refuse("usage: expected CHIP");
    };
    let Some(plan) = PLANS.iter().find(|plan| plan.chip == chip) else {
        let known = PLANS.map(|plan| plan.chip).join(", ");
        return refuse(&format!("error: no chip `{chip}`; there is {known}"));
    };
    match print(plan) {
        Ok(()) => ExitCode::SUCCESS,
        Err((scene, error)) => {
            eprintln!("error: scene `{scene}` on {chip}: {error}");
            ExitCode::FAILURE
        }
    }
}

fn refuse(line: &str) -> ExitCode {
    eprintln!("{line}");
    ExitCode::from(2)
}

fn print(plan: &Plan) -> Result<(), (&'static str, Error)> {
    let &Plan { width, height, .. } = plan;
    let mut vertices = vec![NO_VERTEX; plan.vertices()];
    let mut pixels: Vec<Rgb565> = vec![BACKGROUND; plan.pixels(height)];
    let mut depths = vec![0; plan.depths(height)];
    for scene in plan.scenes {
        let buffers = Buffers {
            vertices: &mut vertices,
            pixels: &mut pixels,
            depths: &mut depths,
        };
        let hash =
            frame(scene, [width, height], height, buffers).map_err(|error| (scene.name, error))?;
        println!(
            "frame {} {width}x{height} {:016x}",
            scene.name,
            hash.value()
        );
    }
    Ok(())
}
