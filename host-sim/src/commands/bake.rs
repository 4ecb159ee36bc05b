//! `host-sim bake`: textures as Rust source for firmware.

use std::path::Path;
use std::process::ExitCode;

use host_sim::bake::{Name, Plan, texture_source};
use host_sim::error::Error;
use host_sim::output;
use host_sim::picture::Picture;

use crate::arguments::Bake;

pub(crate) fn run(arguments: &Bake) -> Result<ExitCode, Error> {
    let path = &arguments.output;
    let is_rust = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("rs"));
    if !is_rust {
        return Err(Error::write(
            path,
            &"textures are baked as Rust source: the name must end in .rs",
        ));
    }
    let name = match &arguments.name {
        Some(name) => Name::new(name),
        None => Name::of_stem(&stem(path)),
    }?;
    let mut pictures = Vec::new();
    for path in &arguments.pictures {
        let (picture, notice) = Picture::load(path)?;
        if let Some(notice) = notice {
            eprintln!("note: {notice}");
        }
        pictures.push((stem(path), picture));
    }
    let plan = Plan {
        format: arguments.format,
        average: arguments.average,
        levels: arguments.levels,
        padding: arguments.padding,
    };
    let baked = texture_source(&name, &pictures, &plan)?;
    output::write(path, baked.source.as_bytes())?;
    let (width, height) = baked.size;
    println!(
        "{}: {width}x{height}, {} level{}, {} bytes in flash",
        path.display(),
        baked.levels,
        if baked.levels == 1 { "" } else { "s" },
        baked.bytes
    );
    Ok(ExitCode::SUCCESS)
}

/// A file's name without folders and extension.
fn stem(path: &Path) -> String {
    path.file_stem()
        .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}
