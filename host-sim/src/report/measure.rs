//! Draws every scene with every setting and compares each frame with the float64 reference.

mod drawn;

use std::collections::BTreeMap;
use std::time::Instant;

use image::RgbImage;
use multum::viewport::Viewport;
use rayon::prelude::*;
use serde::Serialize;

use drawn::{Geometry, Painted, Prepared, compared};

use crate::aliasing::{Numbers, study};
use crate::choice::Perspective;
use crate::compare::{Spread, UvError, rgb};
use crate::error::Error;
use crate::filtering::{Filtering, Minify};
use crate::hard_case;
use crate::historic::{self, Technique};
use crate::output::image;
use crate::render::{colours_with, texels};
use crate::report::on_target::{Cost, Record};
use crate::report::setting::{DEPTHS, NEAREST, NO_DEPTH, RUN_TIME, Setting, filters, strategies};
use crate::stability::examine;
use crate::view::{View, view};

/// Times a frame is drawn for the clock; the fastest counts.
const REPEATS: u32 = 3;

/// Samples a pixel of ideal pictures.
const SAMPLES: u32 = 128;

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Errors of coordinates alone.
    Coordinates,
    /// Colours, pictures and times too.
    Everything,
}

/// A scene.
#[derive(Clone, Debug, Serialize)]
pub struct Scene {
    /// Its name.
    pub name: String,
    /// What it shows.
    pub what: String,
    /// Triangles on the screen.
    pub triangles: usize,
    /// Whether it needs a depth buffer.
    pub needs_depth: bool,
}

/// The colours of a frame against the reference's, which filters with the same filter and chooses
/// levels at every pixel.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Colours {
    /// Peak signal to noise ratio in dB; `None` where all pixels are equal.
    pub psnr: Option<f64>,
    /// Structural similarity of luma.
    pub ssim: f64,
    /// Largest difference of a pixel's channels, in 8-bit units.
    pub off: Spread,
}

/// What one setting makes of a scene, and costs.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The scene.
    pub scene: String,
    /// The setting.
    #[serde(flatten)]
    pub setting: Setting,
    /// Distance of texture coordinates from the reference's.
    pub uv: UvError,
    /// What snapping the vertices to 1/256 pixel adds to that.
    pub snapping: UvError,
    /// Pixels, summed over triangles, where coverage is not the exact one.
    pub coverage_mismatches: u64,
    /// Pixels drawn by two triangles that share an edge, or by one of them twice.
    pub double_draws: u64,
    /// Pixels that a triangle covers and none draws.
    pub gaps: u64,
    /// Pixels where another triangle is in front than in the reference.
    pub depth_mismatches: Option<u64>,
    /// Perspective divisions along spans.
    pub divisions: u64,
    /// Colours; none if they were not asked for.
    pub colours: Option<Colours>,
    /// Nanoseconds a pixel of the frame on this machine, drawn by this program; none if it was not
    /// timed.
    pub host_nanoseconds: Option<f64>,
    /// Costs by core, of frames of 320x240.
    pub costs: BTreeMap<String, Cost>,
}

/// Pictures of a scene: by name, in an order to be shown in.
#[derive(Clone, Debug, Default)]
pub struct Pictures {
    /// The reference.
    pub reference: Option<RgbImage>,
    /// By technique: what is drawn and the map of its errors, if there is one.
    pub techniques: Vec<(String, RgbImage, Option<RgbImage>)>,
    /// Mip levels, and the same scene under filters.
    pub filters: Vec<(String, RgbImage)>,
}

/// Filters of a scene against its ideal picture.
#[derive(Clone, Debug, Serialize)]
pub struct Aliasing {
    /// The scene.
    pub scene: String,
    /// Energy of the ideal's own detail.
    pub signal: f64,
    /// By filter.
    pub filters: Vec<Numbers>,
}

/// A hard case with one strategy.
#[derive(Clone, Debug, Serialize)]
pub struct HardCase {
    /// Its name.
    pub case: String,
    /// What it is there for.
    pub reason: &'static str,
    /// The strategy.
    pub strategy: String,
    /// Largest error in level-0 texels.
    pub texels: f64,
    /// Largest error in footprints.
    pub footprints: f64,
    /// Largest error divided by its derived bound.
    pub of_bound: f64,
    /// Whether bound, coverage and texels hold.
    pub pass: bool,
}

/// Everything that was measured.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    /// The scenes.
    pub scenes: Vec<Scene>,
    /// By scene and setting.
    pub rows: Vec<Row>,
    /// By scene.
    pub pictures: Vec<Pictures>,
    /// By scene.
    pub aliasing: Vec<Aliasing>,
    /// By case and strategy.
    pub hard_cases: Vec<HardCase>,
    /// What was left out, and why.
    pub left_out: Vec<String>,
}

/// Draws and compares.
///
/// Frames are drawn on all cores of the machine; the results do not depend on how many there are.
/// Times are taken afterwards, by one thread. `start` is given the number of steps, then `done` is
/// called for each.
///
/// # Errors
///
/// Those of scenes and of the core.
pub fn measure(
    names: &[(&str, &str)],
    viewport: Viewport,
    extent: Extent,
    record: &Record,
    progress: &(dyn Progress + Sync),
) -> Result<Measured, Error> {
    let ways = strategies();
    let filters = match extent {
        Extent::Coordinates => vec![(NEAREST.to_owned(), Filtering::default())],
        Extent::Everything => filters(),
    };
    let frames = names.len() * DEPTHS.len();
    progress.start(match extent {
        Extent::Coordinates => frames * (1 + ways.len()),
        Extent::Everything => {
            let drawn = frames * (1 + ways.len() * (1 + filters.len()));
            drawn + names.len() * (Technique::ALL.len() + 3)
        }
    });

    let prepared: Vec<Prepared> = names
        .par_iter()
        .flat_map(|name| DEPTHS.par_iter().map(move |depth| (name, depth)))
        .map(|(name, depth)| {
            let prepared = Prepared::new(*name, *depth, viewport);
            progress.done(1);
            prepared
        })
        .collect::<Result<_, Error>>()?;

    let keeps = extent == Extent::Everything;
    let geometry: Vec<Geometry> = prepared
        .par_iter()
        .flat_map(|scene| ways.par_iter().map(move |way| (scene, *way)))
        .map(|(scene, way)| {
            let geometry = Geometry::new(scene, way, keeps);
            progress.done(1);
            geometry
        })
        .collect::<Result<_, Error>>()?;

    let painted: Vec<Painted> = if keeps {
        prepared
            .par_iter()
            .flat_map(|scene| filters.par_iter().map(move |(_, filter)| (scene, filter)))
            .map(|(scene, filter)| Painted::new(scene, filter, &ways, |n| progress.done(n)))
            .collect::<Result<_, Error>>()?
    } else {
        Vec::new()
    };

    let mut measured = Measured::default();
    for (number, pair) in prepared.chunks(DEPTHS.len()).enumerate() {
        measured.scenes.push(pair[0].scene());
        let mut pictures = Pictures::default();
        for (within, scene) in pair.iter().enumerate() {
            let place = number * DEPTHS.len() + within;
            for (w, way) in ways.iter().enumerate() {
                let geometry = &geometry[place * ways.len() + w];
                for (f, (filter, _)) in filters.iter().enumerate() {
                    let painted = painted.get(place * filters.len() + f);
                    let colours = painted.map(|p| p.colours[w]);
                    let row = scene.row(*way, filter, geometry, colours);
                    measured.rows.extend(with_costs(&row, record));
                }
            }
            if scene.is_its_own() {
                let of_nearest = painted.get(place * filters.len());
                pictures.reference = of_nearest.map(|p| image(&p.reference, scene.width()));
                for (w, way) in ways.iter().enumerate() {
                    let core = of_nearest.and_then(|p| p.core.get(w));
                    let map = geometry[place * ways.len() + w].map.clone();
                    if let Some(core) = core {
                        let core = image(core, scene.width());
                        pictures.techniques.push((way.to_string(), core, map));
                    }
                }
            }
        }
        measured.pictures.push(pictures);
    }
    if keeps {
        let own: Vec<&Prepared> = prepared.iter().filter(|scene| scene.is_its_own()).collect();
        add_techniques_of_the_past(&mut measured, &own, progress)?;
        add_filters(&mut measured, &own, progress)?;
        add_times(&mut measured, &prepared, &ways, progress)?;
    }
    Ok(measured)
}

/// Examines every hard case with every strategy, on all cores of the machine.
///
/// # Errors
///
/// Those of the core.
pub fn hard_cases(progress: &(dyn Progress + Sync)) -> Result<Vec<HardCase>, Error> {
    let (cases, ways) = (hard_case::all()?, strategies());
    progress.start(cases.len() * ways.len());
    cases
        .par_iter()
        .flat_map(|case| ways.par_iter().map(move |way| (case, *way)))
        .map(|(case, way)| {
            let outcome = examine(&case.frame, way)?;
            progress.done(1);
            Ok(HardCase {
                case: case.name.clone(),
                reason: case.reason,
                strategy: way.to_string(),
                texels: outcome.texels,
                footprints: outcome.footprints,
                of_bound: outcome.worst.ratio,
                pass: outcome.passes(),
            })
        })
        .collect()
}

/// Where it is told how far the work is.
pub trait Progress {
    /// So many more steps are to come.
    fn start(&self, steps: usize);
    /// So many more are done.
    fn done(&self, steps: usize);
}

/// A row for each texel format that was counted, or one without costs.
fn with_costs(row: &Row, record: &Record) -> Vec<Row> {
    let mut formats: Vec<&str> = record.formats(&row.scene, &row.setting).collect();
    formats.retain(|format| format.starts_with(RUN_TIME));
    formats.push(RUN_TIME);
    formats.sort_unstable();
    formats.dedup();
    let of = |format: &str| {
        let mut row = row.clone();
        row.setting.format = format.to_owned();
        row.costs = record.costs(&row.scene, &row.setting);
        row
    };
    formats.into_iter().map(of).collect()
}

/// Lines of constant depth and forward mapping, in float64.
fn add_techniques_of_the_past(
    measured: &mut Measured,
    scenes: &[&Prepared],
    progress: &(dyn Progress + Sync),
) -> Result<(), Error> {
    let drawn: Vec<_> = scenes
        .par_iter()
        .flat_map(|scene| {
            Technique::ALL
                .par_iter()
                .map(move |technique| (*scene, *technique))
        })
        .map(|(scene, technique)| {
            let drawing = historic::draw(&scene.frame, technique);
            progress.done(1);
            (scene, technique, drawing)
        })
        .collect();
    for (number, (scene, technique, drawing)) in drawn.into_iter().enumerate() {
        let drawing = match drawing {
            Ok(drawing) => drawing,
            Err(error @ Error::Content { .. }) => {
                measured
                    .left_out
                    .push(format!("{technique} on {}: {error}", scene.name));
                continue;
            }
            Err(error) => return Err(error),
        };
        let pixels: Vec<[u8; 3]> = drawing.pixels.into_iter().map(rgb).collect();
        let cost = drawing.cost;
        measured.rows.push(Row {
            scene: scene.name.clone(),
            setting: scene.setting(technique.to_string(), NEAREST),
            uv: cost.uv_error,
            snapping: UvError::default(),
            coverage_mismatches: cost.holes + cost.outside,
            double_draws: cost.repeated,
            gaps: cost.holes,
            depth_mismatches: None,
            divisions: cost.divisions,
            colours: Some(compared(&pixels, &scene.visible, scene.width())),
            host_nanoseconds: None,
            costs: BTreeMap::new(),
        });
        let pictures = &mut measured.pictures[number / Technique::ALL.len()];
        let picture = image(&pixels, scene.width());
        pictures
            .techniques
            .push((technique.to_string(), picture, None));
    }
    Ok(())
}

/// Filters against the ideal, and the levels that are chosen.
fn add_filters(
    measured: &mut Measured,
    scenes: &[&Prepared],
    progress: &(dyn Progress + Sync),
) -> Result<(), Error> {
    let exact = Perspective::Exact;
    let trilinear = Minify::ALL
        .into_iter()
        .find(|(name, _)| *name == "trilinear");
    let trilinear = trilinear.map_or_else(Filtering::default, |(_, min)| Filtering::named(min));
    let studies: Vec<_> = scenes
        .par_iter()
        .map(|scene| {
            let height = scene.frame.viewport.height();
            let study = study(&scene.frame, exact, &Filtering::default(), SAMPLES, || ())?;
            progress.done(1);
            let levels = view(&scene.frame, exact, height, &trilinear, View::Level)?;
            progress.done(1);
            Ok((study, levels))
        })
        .collect::<Result<_, Error>>()?;
    for ((scene, pictures), (study, levels)) in
        scenes.iter().zip(&mut measured.pictures).zip(studies)
    {
        pictures.filters.push(("levels".to_owned(), levels));
        let ideal = image(&study.ideal, scene.width());
        pictures.filters.push(("ideal".to_owned(), ideal));
        for outcome in &study.outcomes {
            let picture = image(&outcome.pixels, scene.width());
            pictures
                .filters
                .push((outcome.numbers.filter.clone(), picture));
        }
        measured.aliasing.push(Aliasing {
            scene: scene.name.clone(),
            signal: study.signal,
            filters: study.outcomes.into_iter().map(|o| o.numbers).collect(),
        });
    }
    Ok(())
}

/// Strategies by themselves, each with the types that firmware has too. Filters are chosen at run
/// time in this program, so that their times would say nothing.
fn add_times(
    measured: &mut Measured,
    scenes: &[Prepared],
    ways: &[Perspective],
    progress: &(dyn Progress + Sync),
) -> Result<(), Error> {
    for scene in scenes {
        let textures = texels(&scene.frame);
        let viewport = scene.frame.viewport;
        let pixels = f64::from(viewport.width() * viewport.height());
        for way in ways {
            let mut fastest = f64::INFINITY;
            for _ in 0..REPEATS {
                let start = Instant::now();
                colours_with(&scene.frame, *way, viewport.height(), &textures)?;
                fastest = fastest.min(start.elapsed().as_secs_f64());
            }
            let setting = scene.setting(way.to_string(), NEAREST);
            let same = |row: &&mut Row| row.scene == scene.name && row.setting == setting;
            if let Some(row) = measured.rows.iter_mut().find(same) {
                row.host_nanoseconds = Some(fastest * 1e9 / pixels);
            }
        }
        if scene.depth == NO_DEPTH {
            progress.done(1);
        }
    }
    Ok(())
}
