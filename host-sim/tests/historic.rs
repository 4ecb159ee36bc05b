//! The techniques of the past: what they must cost by derivation, and what the command says.

use std::process::{Command, Output};
use std::sync::Arc;

use host_sim::frame::{Batch, Frame, ScreenTriangle};
use host_sim::historic::{Cost, Technique, draw};
use host_sim::reference::{Beyond, Coverage, Planes};
use host_sim::subject::Subject;
use host_sim::{benchmark, pattern};
use multum::fixed::types::{I16F16, I24F8};
use multum::project::ScreenVertex;
use multum::setup::Cull;
use multum::viewport::Viewport;

fn scene(name: &str) -> Frame {
    let viewport = Viewport::new(320, 240).expect("a size");
    let subject = Subject::by_name(name).expect("a scene");
    subject.frame(viewport).expect("a frame")
}

fn cost(frame: &Frame, technique: Technique) -> Cost {
    draw(frame, technique).expect("a drawing").cost
}

/// 64 x 64 pixels with so many repeats of a texture of 256 x 256 along each side.
fn flat(repeats: f64) -> Frame {
    let vertex = |x: f64, y: f64| {
        let uv = [x, y].map(|c| I16F16::from_num(c * repeats));
        let [x, y] = [x, y].map(|c| I24F8::from_num(c * 64.0));
        ScreenVertex::new(x, y, I16F16::ONE, uv).expect("in range")
    };
    let corners = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)];
    let triangles = [[0, 1, 2], [0, 2, 3]].map(|t: [usize; 3]| ScreenTriangle {
        vertices: t.map(|i| vertex(corners[i].0, corners[i].1)),
        unsnapped: t.map(|i| [corners[i].0 * 64.0, corners[i].1 * 64.0]),
    });
    Frame {
        viewport: Viewport::new(64, 64).expect("a size"),
        near: I16F16::ONE,
        cull: Cull::Off,
        depth: false,
        batches: vec![Batch {
            picture: Arc::new(pattern::coordinates()),
            wrap: Beyond::Repeat,
            triangles: triangles.to_vec(),
        }],
    }
}

#[test]
fn on_a_flat_wall_both_are_as_good_as_rows() {
    let wall = scene("wall");
    for technique in Technique::ALL {
        let cost = cost(&wall, technique);
        assert_eq!((cost.covered, cost.writes), (76800, 76800), "{technique}");
        assert_eq!(
            (cost.holes, cost.repeated, cost.outside),
            (0, 0, 0),
            "{technique}"
        );
        // The lines are rows through pixel centres, the texels lie on them: what is left is the
        // rounding of some twenty operations on coordinates below 2 repeats of 256 texels.
        let rounding = 20.0 * f64::EPSILON * 2.0 * 256.0;
        assert!(cost.uv_error.texels.max <= rounding, "{technique}");
    }
}

#[test]
fn lines_that_share_a_pattern_tile_every_triangle() {
    for (name, _) in benchmark::SCENES {
        let frame = scene(name);
        let cost = cost(&frame, Technique::Lines);
        assert_eq!(
            (cost.holes, cost.repeated, cost.outside),
            (0, 0, 0),
            "{name}"
        );
        assert_eq!((cost.writes, cost.texels), (cost.covered, cost.covered));
        assert_eq!(cost.divisions, cost.lines);
    }
}

#[test]
fn lines_are_off_by_half_a_pixel_of_their_minor_axis() {
    for name in ["tilted", "oblique", "receding", "floor", "mesh"] {
        let frame = scene(name);
        // The pixel is at most half a pixel off its line, along x or y; over that distance the
        // coordinate changes by d |du/dx| w(line)/w(pixel).
        let mut bound: f64 = 0.0;
        for (_, triangle) in frame.triangles() {
            let (Some(planes), Some(coverage)) = (
                Planes::new(&triangle.corners()),
                Coverage::new(triangle.grid(), 256),
            ) else {
                continue;
            };
            coverage.for_each(320, 240, |x, y| {
                let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
                let w = planes.at(x, y).w;
                for (dx, dy) in [(0.5, 0.0), (-0.5, 0.0), (0.0, 0.5), (0.0, -0.5)] {
                    bound = bound.max(0.5 * planes.at(x + dx, y + dy).w / w);
                }
            });
        }
        let cost = cost(&frame, Technique::Lines);
        let max = cost.uv_error.footprints.max;
        assert!(max <= bound + 1e-9, "{name}: {max} > {bound}");
    }
    // It is no idle bound.
    let max = cost(&scene("tilted"), Technique::Lines)
        .uv_error
        .footprints
        .max;
    assert!(max > 0.25, "{max}");
}

#[test]
fn lines_started_afresh_leave_holes() {
    let cost = cost(&scene("mesh"), Technique::LinesFromEdges);
    assert!(cost.holes > 0 && cost.repeated > 0);
}

#[test]
fn magnified_forward_mapping_leaves_three_of_four_pixels_out() {
    // 32 x 32 texels on 64 x 64 pixels: each writes one of the four pixels that it covers.
    let cost = cost(&flat(0.125), Technique::Forward);
    assert_eq!((cost.covered, cost.writes), (64 * 64, 32 * 32));
    assert_eq!(cost.holes, 64 * 64 - 32 * 32);
    assert_eq!(cost.repeated, 0);
}

#[test]
fn minified_forward_mapping_writes_each_pixel_once_a_texel() {
    // 128 x 128 texels on 64 x 64 pixels: four in each.
    let cost = cost(&flat(0.5), Technique::Forward);
    assert_eq!(cost.writes, 4 * cost.covered);
    assert_eq!((cost.texels, cost.divisions), (128 * 128, 128 * 128));
    assert_eq!((cost.holes, cost.repeated), (0, cost.covered));
}

#[test]
fn a_triangle_of_one_texture_point_is_all_holes() {
    let cost = cost(&flat(0.0), Technique::Forward);
    assert_eq!((cost.writes, cost.holes), (0, 64 * 64));
}

#[test]
fn too_many_texels_are_refused_before_any_is_drawn() {
    // 60 x 60 repeats of 65,536 texels.
    let error = draw(&flat(60.0), Technique::Forward).expect_err("too much");
    let text = error.to_string();
    assert!(
        text.contains("about 2359") && text.contains("fewer repeats"),
        "{text}"
    );
    assert_eq!(text.lines().count(), 1);
}

fn host_sim(folder: &std::path::Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_host-sim"))
        .arg("historic")
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts")
}

#[test]
fn the_command_prints_a_row_for_each_and_writes_a_picture() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let run = |arguments: &[&str]| {
        let output = host_sim(folder.path(), arguments);
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).expect("text")
    };
    let text = run(&["tilted", "--size", "64x48", "-o", "sheet.png"]);
    assert_eq!(text.matches("| tilted ").count(), 4);
    let sheet = image::open(folder.path().join("sheet.png")).expect("a PNG");
    assert_eq!((sheet.width(), sheet.height()), (4 * 64, 48));
    let json = run(&["benchmark", "--size", "64x48", "--json"]);
    let rows: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(rows.as_array().map(Vec::len), Some(24));
    assert_eq!(rows[1]["technique"], "lines");
    assert_eq!(rows[1]["cost"]["holes"], 0);
}

#[test]
fn bad_arguments_are_refused_in_one_line() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let cases: [(&[&str], &str); 4] = [
        (&["nope"], "nope"),
        (&[], "SCENE"),
        (&["wall", "--size", "0x1"], "1 to 1024"),
        (&["wall", "-o", "a.jpg"], ".png"),
    ];
    for (arguments, word) in cases {
        let output = host_sim(folder.path(), arguments);
        let text = String::from_utf8(output.stderr).expect("text");
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(text.lines().count() == 1 && text.contains(word), "{text}");
    }
}
