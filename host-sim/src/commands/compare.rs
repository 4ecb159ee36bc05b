//! `host-sim compare`: the numbers of one scene.

use std::process::ExitCode;

use host_sim::compare::{Comparison, Spread, compare};
use host_sim::error::Error;

use crate::arguments::Compare;

pub(crate) fn run(arguments: &Compare) -> Result<ExitCode, Error> {
    let drawing = &arguments.drawing;
    let frame = drawing.frame()?;
    let filtering = drawing.textures.filtering()?;
    let report = compare(&frame, drawing.perspective, drawing.rows(), &filtering)?;
    if arguments.json {
        let json = serde_json::to_string_pretty(&report.comparison)
            .map_err(|e| Error::content("JSON", &e.to_string(), "report this"))?;
        println!("{json}");
    } else {
        print(
            &drawing.name(),
            &drawing.perspective.to_string(),
            &filtering.to_string(),
            &report.comparison,
        );
    }
    Ok(ExitCode::SUCCESS)
}

fn print(name: &str, perspective: &str, filtering: &str, c: &Comparison) {
    let line = |what: &str, value: &dyn std::fmt::Display| println!("{what:32}{value}");
    let spread = |what: &str, s: Spread| {
        line(
            what,
            &format_args!("max {:.5}  p99 {:.5}  mean {:.5}", s.max, s.p99, s.mean),
        );
    };
    line("scene", &name);
    line("perspective", &perspective);
    line("filter, texels", &filtering);
    line("triangles shown", &c.triangles);
    line("pixels", &c.pixels);
    line("divisions", &c.divisions);
    line("coverage mismatches", &c.coverage_mismatches);
    line("double draws", &c.double_draws);
    line("gaps", &c.gaps);
    line("depth mismatches", &c.depth_mismatches);
    spread("UV error, level-0 texels", c.uv_error.texels);
    spread("UV error, footprints", c.uv_error.footprints);
    spread("snapping adds, level-0 texels", c.snap_error.texels);
    spread("snapping adds, footprints", c.snap_error.footprints);
    spread("colour error, 8-bit units", c.colour_error);
    match c.psnr {
        Some(psnr) => line("colour PSNR", &format_args!("{psnr:.2} dB")),
        None => line("colour PSNR", &"all pixels equal"),
    }
}
