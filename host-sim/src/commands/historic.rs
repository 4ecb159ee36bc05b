//! `host-sim historic`: what two techniques of the past cost beside the core.

use std::process::ExitCode;

use comfy_table::{CellAlignment, Table};
use host_sim::benchmark;
use host_sim::choice::Perspective;
use host_sim::compare::rgb;
use host_sim::error::Error;
use host_sim::historic::{Cost, Technique, core_cost, draw};
use host_sim::output;
use host_sim::subject::Subject;
use image::{GenericImage as _, RgbImage};

use crate::arguments::Historic;

const HEADER: [&str; 15] = [
    "scene",
    "technique",
    "covered",
    "holes",
    "repeated",
    "outside",
    "writes",
    "jumps",
    "lines",
    "divisions",
    "texels",
    "error max, texels",
    "mean",
    "max, footprints",
    "mean",
];

const BESIDE: Perspective = Perspective::Every(16);

pub(crate) fn run(arguments: &Historic) -> Result<ExitCode, Error> {
    if let Some(path) = &arguments.output
        && !path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("png"))
    {
        return Err(Error::write(
            path,
            &"pictures are written as PNG: the name must end in .png",
        ));
    }
    let scenes: Vec<&str> = if arguments.scene == "benchmark" {
        benchmark::SCENES.iter().map(|(name, _)| *name).collect()
    } else {
        vec![&arguments.scene]
    };
    let (width, height) = (arguments.size.width(), arguments.size.height());
    let columns = 1 + Technique::ALL.len() as u32;
    let mut sheet = RgbImage::new(columns * width, scenes.len() as u32 * height);
    let mut rows = Vec::new();
    for (top, name) in (0..).step_by(height as usize).zip(scenes) {
        let frame = Subject::by_name(name)?.frame(arguments.size)?;
        let (pixels, cost) = core_cost(&frame, BESIDE)?;
        let mut drawn = vec![(BESIDE.to_string(), pixels, cost)];
        for technique in Technique::ALL {
            let drawing = draw(&frame, technique)?;
            drawn.push((technique.to_string(), drawing.pixels, drawing.cost));
        }
        for (left, (technique, pixels, cost)) in (0..).step_by(width as usize).zip(drawn) {
            let pixels: Vec<_> = pixels.into_iter().map(rgb).collect();
            sheet
                .copy_from(&output::image(&pixels, width), left, top)
                .map_err(|e| Error::content(name, &e.to_string(), "give a smaller --size"))?;
            rows.push((name.to_owned(), technique, cost));
        }
    }
    if let Some(path) = &arguments.output {
        output::write_png(&sheet, path)?;
    }
    if arguments.json {
        println!("{}", json(&rows)?);
    } else {
        println!("{}", table(&rows));
    }
    Ok(ExitCode::SUCCESS)
}

fn json(rows: &[(String, String, Cost)]) -> Result<String, Error> {
    let rows: Vec<_> = rows
        .iter()
        .map(|(scene, technique, cost)| {
            serde_json::json!({ "scene": scene, "technique": technique, "cost": cost })
        })
        .collect();
    serde_json::to_string_pretty(&rows)
        .map_err(|e| Error::content("JSON", &e.to_string(), "report this"))
}

fn table(rows: &[(String, String, Cost)]) -> Table {
    let mut table = Table::new();
    table.load_preset(comfy_table::presets::ASCII_MARKDOWN);
    table.set_header(HEADER);
    for column in table.column_iter_mut().skip(2) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    for (scene, technique, c) in rows {
        let mut cells = vec![scene.clone(), technique.clone()];
        let counts = [
            c.covered,
            c.holes,
            c.repeated,
            c.outside,
            c.writes,
            c.jumps,
            c.lines,
            c.divisions,
            c.texels,
        ];
        cells.extend(counts.map(|n| n.to_string()));
        let errors = [c.uv_error.texels, c.uv_error.footprints];
        cells.extend(
            errors
                .iter()
                .flat_map(|s| [s.max, s.mean])
                .map(|n| format!("{n:.4}")),
        );
        table.add_row(cells);
    }
    table
}
