//! Bakes the scenes: host-sim's meshes and textures become tables in flash.

use std::path::PathBuf;
use std::process::ExitCode;
use std::{env, fs};

use std::fmt::Write as _;

use host_sim::bake::{self, Skin};
use host_sim::{benchmark, scenes};
use multum::project::ScreenVertex;
use multum::pyramid::average::Average;
use multum::viewport::Viewport;

/// The scenes that images draw, and what they have of their textures; `src/baked.rs` includes each.
const SCENES: [(&str, Skin); 5] = [
    ("crate", Skin::Plain),
    ("spot", Skin::Plain),
    ("room", Skin::Plain),
    ("corridor", Skin::Levels(Average::Stored)),
    ("checkers", Skin::Levels(Average::Stored)),
];

fn main() -> ExitCode {
    match bake_all() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            println!("cargo::error={error}");
            ExitCode::FAILURE
        }
    }
}

fn bake_all() -> Result<(), String> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=../../host-sim/assets");
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("cargo sets no OUT_DIR")?);
    for (name, skin) in SCENES {
        let source = scenes::on_device(name)
            .map_err(|error| error.to_string())?
            .ok_or_else(|| format!("there is no scene {name}"))
            .and_then(|scene| bake::rust_source(&scene, skin).map_err(|error| error.to_string()))?;
        let path = out.join(format!("{name}.rs"));
        fs::write(&path, source).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    let path = out.join("benchmark.rs");
    fs::write(&path, benchmarks()?).map_err(|error| format!("{}: {error}", path.display()))
}

/// The benchmark scenes as one table: name and triangles, each corner as raw bits.
fn benchmarks() -> Result<String, String> {
    let viewport = Viewport::new(320, 240).map_err(|error| error.to_string())?;
    let corner = |v: &ScreenVertex| {
        let [u, v_] = v.uv().map(|c| c.to_bits());
        [v.x().to_bits(), v.y().to_bits(), v.w().to_bits(), u, v_]
    };
    let mut source = String::from("/// The scenes.\npub const SCENES: &[Scene] = &[\n");
    for (name, _) in benchmark::SCENES {
        let frame = benchmark::by_name(name)
            .ok_or_else(|| format!("no benchmark scene {name}"))?
            .frame(viewport)
            .map_err(|error| error.to_string())?;
        _ = writeln!(source, "Scene {{ name: {name:?}, triangles: &[");
        for triangle in frame.batches.iter().flat_map(|batch| &batch.triangles) {
            _ = writeln!(source, "{:?},", triangle.vertices.each_ref().map(corner));
        }
        source += "] },\n";
    }
    Ok(source + "];\n")
}
