//! Pictures of a scene, each in the page itself and equal ones once.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::RgbImage;
use minijinja::Value;
use serde::Serialize;

use super::answers::ALIASING;
use super::small_png::smallest;
use crate::error::Error;
use crate::report::measure::Pictures;

#[derive(Serialize)]
pub(super) struct Gallery {
    name: String,
    what: String,
    reference: Option<Value>,
    techniques: Vec<Technique>,
    filters: Vec<Picture>,
}

#[derive(Serialize)]
struct Technique {
    /// All that drew this very picture.
    names: Vec<String>,
    core: Value,
    map: Option<Value>,
}

#[derive(Serialize)]
struct Picture {
    name: String,
    source: Value,
}

/// Of filters, what is shown of every scene, and what of those in which they differ most.
const LEVELS: &str = "levels";
const FILTERS: [&str; 5] = ["ideal", "nearest", "bilinear", "trilinear", "aniso:8"];
const FILTERED: [&str; 4] = [ALIASING, "corridor", "room", "floor"];

pub(super) fn gallery(name: &str, what: &str, pictures: &Pictures) -> Result<Gallery, Error> {
    // Equal pictures once.
    let mut groups: Vec<(Vec<String>, &RgbImage, Option<&RgbImage>)> = Vec::new();
    for (technique, core, map) in &pictures.techniques {
        let same = groups.iter_mut().find(|(_, other, _)| *other == core);
        match same {
            Some((names, _, _)) => names.push(technique.clone()),
            None => groups.push((vec![technique.clone()], core, map.as_ref())),
        }
    }
    let techniques = groups.into_iter().map(|(names, core, map)| {
        Ok(Technique {
            names,
            core: source(core)?,
            map: map.map(source).transpose()?,
        })
    });
    let is_shown =
        |filter: &str| filter == LEVELS || (FILTERED.contains(&name) && FILTERS.contains(&filter));
    let filters = pictures.filters.iter();
    let filters = filters
        .filter(|(filter, _)| is_shown(filter))
        .map(|(filter, picture)| {
            Ok(Picture {
                name: filter.clone(),
                source: source(picture)?,
            })
        });
    Ok(Gallery {
        name: name.to_owned(),
        what: what.to_owned(),
        reference: pictures.reference.as_ref().map(source).transpose()?,
        techniques: techniques.collect::<Result<_, Error>>()?,
        filters: filters.collect::<Result<_, Error>>()?,
    })
}

/// A picture as an address that holds it.
fn source(picture: &RgbImage) -> Result<Value, Error> {
    let text = STANDARD.encode(smallest(picture)?);
    Ok(Value::from_safe_string(format!(
        "data:image/png;base64,{text}"
    )))
}
