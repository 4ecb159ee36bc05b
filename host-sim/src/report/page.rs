//! The report as one HTML file: nothing to load, readable without scripts.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::RgbImage;
use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, Value, context};
use multum::viewport::Viewport;
use serde::Serialize;

use crate::benchmark;
use crate::error::Error;
use crate::report::answer::{Question, SURFACES, Verdict, answer, verdict};
use crate::report::chip::Chip;
use crate::report::measure::{HardCase, Measured, Pictures, Row};
use crate::report::on_target::{Flash, Record};
use crate::report::peers::{Peer, SOURCE};
use crate::report::plot::{Mark, Unit, marks, styled};
use crate::report::setting::{NEAREST, NO_DEPTH, RUN_TIME};
use crate::report::small_png::smallest;
use crate::report::table::{COST_SCENE, cheapest, cores, plain};

/// The question that the page answers without being asked: 50 frames a second on an RP2040, and
/// an error that nearest sampling does not show.
const EXAMPLE: (&str, f64, f64) = ("rp2040", 20.0, 0.25);

/// Settings of an answer that the page lists.
const LISTED: usize = 6;

/// The page.
///
/// # Errors
///
/// [`Error::Content`] if a plot or picture cannot be made.
pub fn page(measured: &Measured, record: &Record, peers: &[Peer]) -> Result<String, Error> {
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.add_filter("fixed", fixed);
    environment.add_filter("significant", significant);
    environment
        .add_template("page", include_str!("page.html"))
        .map_err(|e| failed(&e))?;
    let rows = &measured.rows;
    let [toolchain, qemu] = record.tools();
    let scenes: Vec<_> = measured
        .scenes
        .iter()
        .zip(&measured.pictures)
        .map(|(scene, pictures)| gallery(&scene.name, &scene.what, pictures))
        .collect::<Result<_, Error>>()?;
    let context = context! {
        version => env!("CARGO_PKG_VERSION"),
        style => Value::from_safe_string(include_str!("page.css").to_owned()),
        script => Value::from_safe_string(include_str!("page.js").to_owned()),
        data => Value::from_safe_string(data(rows)?),
        toolchain => toolchain,
        qemu => qemu,
        is_current => record.is_current(),
        example => Value::from(Serde(example(rows)?)),
        mip_maps => Value::from(Serde(mip_maps(measured, record))),
        breaks => Value::from(Serde(breaks(measured))),
        chips => Value::from(Serde(chips())),
        plots => Value::from(Serde(plots(rows, peers)?)),
        benchmark_scenes => Value::from(Serde(benchmark::SCENES.map(|(name, _)| name))),
        scenes => Value::from(Serde(scenes)),
        strategies => Value::from(Serde(strategies(rows))),
        hard_cases => Value::from(Serde(hard_cases(&measured.hard_cases))),
        flash => Value::from(Serde(flash(record.flash()))),
        stack => Value::from(Serde(record.stack())),
        peers => Value::from(Serde(peers)),
        source => SOURCE,
        left_out => Value::from(Serde(&measured.left_out)),
    };
    let template = environment.get_template("page").map_err(|e| failed(&e))?;
    template.render(context).map_err(|e| failed(&e))
}

fn failed(error: &dyn std::fmt::Display) -> Error {
    Error::content("page", &error.to_string(), "report this")
}

/// A number with so many digits after the point; nothing for none.
fn fixed(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(String::new, |n| format!("{n:.digits$}"))
}

/// An error, with what matters of it.
fn significant(value: Option<f64>) -> String {
    let Some(n) = value else { return String::new() };
    if n == 0.0 || n >= 100.0 {
        return format!("{n:.0}");
    }
    let digits = (2.0 - n.log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{n:.digits$}")
}

#[derive(Serialize)]
struct Example {
    chip: String,
    rate: f64,
    question: Question,
    everywhere: Answered,
    scenes: Vec<Answered>,
    /// The fastest that keeps the error in all scenes, whatever its time.
    precise: Option<Listed>,
}

#[derive(Serialize)]
struct Answered {
    scenes: String,
    count: usize,
    fits: Vec<Listed>,
    nearest: Option<Listed>,
}

#[derive(Serialize)]
struct Listed {
    setting: String,
    milliseconds: f64,
    how: String,
    footprints: f64,
    worst: String,
    reason: String,
}

fn answered(verdict: &Verdict, question: &Question) -> Answered {
    let listed = |candidate: &crate::report::answer::Candidate| Listed {
        setting: candidate.setting.to_string(),
        milliseconds: candidate.milliseconds,
        how: candidate.how.to_string(),
        footprints: candidate.footprints,
        worst: candidate.worst.clone(),
        reason: verdict.reason(candidate, question),
    };
    Answered {
        scenes: verdict.scenes.join(", "),
        count: verdict.fits.len(),
        fits: verdict.fits.iter().take(LISTED).map(listed).collect(),
        nearest: verdict.misses.first().map(listed),
    }
}

fn example(rows: &[Row]) -> Result<Example, Error> {
    let (chip, milliseconds, footprints) = EXAMPLE;
    let question = Question {
        chip: chip.parse().map_err(|e: String| failed(&e))?,
        milliseconds,
        footprints,
        size: Viewport::new(320, 240).map_err(|e| Error::core("report", e))?,
    };
    let verdicts = answer(rows, &question, &SURFACES);
    let mut answers = verdicts.iter().map(|v| answered(v, &question));
    let everywhere = answers.next().ok_or_else(|| failed(&"no scenes"))?;
    let patient = Question {
        milliseconds: f64::INFINITY,
        ..question
    };
    let precise = verdict(rows, &patient, &SURFACES);
    let precise = precise.fits.first().map(|fit| Listed {
        setting: fit.setting.to_string(),
        milliseconds: fit.milliseconds,
        how: fit.how.to_string(),
        footprints: fit.footprints,
        worst: fit.worst.clone(),
        reason: precise.reason(fit, &question),
    });
    Ok(Example {
        chip: question.chip.to_string(),
        rate: 1e3 / milliseconds,
        question,
        everywhere,
        scenes: answers.collect(),
        precise,
    })
}

#[derive(Serialize)]
struct MipMaps {
    scene: &'static str,
    rows: Vec<MipMap>,
    /// Bytes that levels add to the code on the Cortex-M4, and what a pyramid adds to a texture.
    flash: Option<i64>,
    /// Of the nearest texel's aliasing, what is left with trilinear filtering, in percent.
    aliasing_left: Option<f64>,
    /// Instructions of the cheapest mip-mapped filter, as a multiple of the nearest texel's.
    cheapest_times: Option<f64>,
    cheapest: String,
}

#[derive(Serialize)]
struct MipMap {
    filter: String,
    error: f64,
    aliasing: f64,
    blur: f64,
    /// Instructions a pixel by core.
    costs: Vec<Option<f64>>,
}

/// The scene that shows aliasing.
const ALIASING: &str = "checkers";

fn mip_maps(measured: &Measured, record: &Record) -> MipMaps {
    let study = measured.aliasing.iter().find(|a| a.scene == ALIASING);
    let cost = |filter: &str, core: &str| {
        let named = |row: &&Row| {
            let name = &row.setting.filter;
            let is_it = name == filter || name.strip_suffix(":piece") == Some(filter);
            let setting = &row.setting;
            let is_plain = setting.depth == NO_DEPTH && setting.format == RUN_TIME;
            row.scene == COST_SCENE && is_it && is_plain && setting.strategy == "every:16"
        };
        let row = measured.rows.iter().find(named)?;
        row.costs.get(core).map(|cost| cost.instructions)
    };
    let mut rows = Vec::new();
    for numbers in study.into_iter().flat_map(|study| &study.filters) {
        let name = numbers.filter.replace("aniso:", "anisotropic:");
        rows.push(MipMap {
            costs: ["m0", "m4", "m33", "riscv"]
                .map(|core| cost(&name, core))
                .to_vec(),
            filter: numbers.filter.clone(),
            error: numbers.error,
            aliasing: numbers.aliasing,
            blur: numbers.blur,
        });
    }
    let aliasing = |filter: &str| rows.iter().find(|r| r.filter == filter).map(|r| r.aliasing);
    let aliasing_left = aliasing("trilinear")
        .zip(aliasing(NEAREST))
        .map(|(with, without)| 100.0 * with / without);
    let span = "nearest-mip-nearest:span";
    let cheapest_times = cost(span, "m4")
        .zip(cost(NEAREST, "m4"))
        .map(|(a, b)| a / b);
    let flash = record.flash().iter();
    let flash = flash.filter(|f| f.core == "m4" && f.image == "level-each-span");
    MipMaps {
        scene: ALIASING,
        rows,
        flash: flash.map(|f| f.more_than_previous).next(),
        aliasing_left,
        cheapest_times,
        cheapest: span.to_owned(),
    }
}

#[derive(Serialize)]
struct Break {
    place: String,
    what: String,
    /// Largest errors in footprints.
    every: f64,
    adaptive: f64,
    /// Instructions a pixel on the Cortex-M4, where they were counted.
    every_cost: Option<f64>,
    adaptive_cost: Option<f64>,
}

/// Where every:16 is off by more than adaptive's bound.
fn breaks(measured: &Measured) -> Vec<Break> {
    let bound = EXAMPLE.2;
    let footprints = |scene: &str, strategy: &str| {
        let row = plain(&measured.rows, scene, strategy).next();
        row.map_or(0.0, |row| row.uv.footprints.max)
    };
    let mut breaks: Vec<Break> = measured
        .scenes
        .iter()
        .map(|scene| Break {
            place: scene.name.clone(),
            what: scene.what.clone(),
            every: footprints(&scene.name, "every:16"),
            adaptive: footprints(&scene.name, "adaptive"),
            every_cost: cheapest(&measured.rows, &scene.name, "every:16", "m4")
                .map(|c| c.instructions),
            adaptive_cost: cheapest(&measured.rows, &scene.name, "adaptive", "m4")
                .map(|c| c.instructions),
        })
        .collect();
    let of = |case: &str, strategy: &str| {
        let found = measured.hard_cases.iter();
        let mut found = found.filter(|h| h.case == case && h.strategy == strategy);
        found.next().map_or(0.0, |h| h.footprints)
    };
    for case in measured
        .hard_cases
        .iter()
        .filter(|h| h.strategy == "every:16")
    {
        breaks.push(Break {
            place: case.case.clone(),
            what: case.reason.to_owned(),
            every: case.footprints,
            adaptive: of(&case.case, "adaptive"),
            every_cost: None,
            adaptive_cost: None,
        });
    }
    breaks.retain(|b| b.every > bound);
    breaks.sort_by(|a, b| b.every.total_cmp(&a.every));
    breaks
}

#[derive(Serialize)]
struct ChipView {
    name: &'static str,
    title: String,
    core: &'static str,
    clock: Option<f64>,
}

fn chips() -> Vec<ChipView> {
    let view = |chip: Chip| ChipView {
        name: chip.name,
        title: chip.to_string(),
        core: chip.core,
        clock: chip.clock,
    };
    Chip::ALL.into_iter().map(view).collect()
}

#[derive(Serialize)]
struct Plot {
    core: &'static str,
    title: String,
    scene: &'static str,
    unit: &'static str,
    svg: Value,
    marks: Vec<Spot>,
    has_peers: bool,
}

#[derive(Serialize)]
struct Spot {
    left: f64,
    top: f64,
    title: String,
}

fn plots(rows: &[Row], peers: &[Peer]) -> Result<Vec<Plot>, Error> {
    let mut plots = Vec::new();
    for core in cores() {
        let of_core = Chip::ALL.iter().filter(|chip| chip.core == core);
        let chips: Vec<Chip> = of_core.copied().collect();
        let title = chips.first().map_or(core, |chip| chip.core_title);
        for (scene, _) in benchmark::SCENES {
            for unit in Unit::ALL {
                let marks = marks(rows, peers, scene, core, unit);
                let title = format!("{scene} on {title}");
                let (svg, places) = styled(&title, unit, &marks)?;
                let spots = marks.iter().zip(places).map(|(mark, [left, top])| Spot {
                    left: 100.0 * left,
                    top: 100.0 * top,
                    title: tip(mark, unit, &chips),
                });
                plots.push(Plot {
                    core,
                    title,
                    scene,
                    unit: unit.name(),
                    marks: spots.collect(),
                    has_peers: marks
                        .iter()
                        .any(|m| m.kind == crate::report::plot::Kind::Peer),
                    svg: Value::from_safe_string(svg),
                });
            }
        }
    }
    Ok(plots)
}

/// What a mark says when asked.
fn tip(mark: &Mark, unit: Unit, chips: &[Chip]) -> String {
    use crate::report::plot::Kind;
    let kind = match mark.kind {
        Kind::Sized => ", sized texture",
        Kind::RunTime | Kind::Peer => "",
    };
    let cost = format!("{:.1} instructions a pixel", mark.cost);
    let error = format!("{} {} at most", significant(Some(mark.error)), unit.name());
    let clocks: Vec<_> = chips
        .iter()
        .filter(|chip| chip.clock.is_some())
        .map(|c| c.title)
        .collect();
    let where_to = if clocks.is_empty() {
        String::new()
    } else {
        format!(" ({})", clocks.join(", "))
    };
    let front = if mark.on_front {
        "; nothing of ours beats it in both"
    } else {
        ""
    };
    format!("{}{kind}{where_to}: {cost}, {error}{front}", mark.label)
}

#[derive(Serialize)]
struct Gallery {
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

fn gallery(name: &str, what: &str, pictures: &Pictures) -> Result<Gallery, Error> {
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

#[derive(Serialize)]
struct Strategy {
    scene: String,
    setting: String,
    footprints: [f64; 3],
    texels: f64,
    psnr: Option<f64>,
    ssim: Option<f64>,
    mismatches: u64,
    host: Option<f64>,
    costs: Vec<Option<f64>>,
}

/// Strategies by themselves, for readers without scripts.
fn strategies(rows: &[Row]) -> Vec<Strategy> {
    let plain = rows.iter().filter(|row| row.setting.is_plain());
    plain
        .map(|row| Strategy {
            scene: row.scene.clone(),
            setting: row.setting.to_string(),
            footprints: [
                row.uv.footprints.max,
                row.uv.footprints.p99,
                row.uv.footprints.mean,
            ],
            texels: row.uv.texels.max,
            psnr: row.colours.and_then(|c| c.psnr),
            ssim: row.colours.map(|c| c.ssim),
            mismatches: row.coverage_mismatches,
            host: row.host_nanoseconds,
            costs: cores()
                .iter()
                .map(|core| row.costs.get(*core).map(|c| c.instructions))
                .collect(),
        })
        .collect()
}

#[derive(Serialize)]
struct Hard {
    strategies: Vec<String>,
    cases: Vec<HardRow>,
    failed: usize,
    count: usize,
}

#[derive(Serialize)]
struct HardRow {
    name: String,
    reason: &'static str,
    cells: Vec<HardCell>,
}

#[derive(Serialize)]
struct HardCell {
    footprints: f64,
    of_bound: f64,
    pass: bool,
}

fn hard_cases(all: &[HardCase]) -> Hard {
    let mut strategies: Vec<String> = Vec::new();
    let mut cases: Vec<HardRow> = Vec::new();
    for hard in all {
        if !strategies.contains(&hard.strategy) {
            strategies.push(hard.strategy.clone());
        }
        if cases.last().is_none_or(|row| row.name != hard.case) {
            cases.push(HardRow {
                name: hard.case.clone(),
                reason: hard.reason,
                cells: Vec::new(),
            });
        }
        if let Some(row) = cases.last_mut() {
            row.cells.push(HardCell {
                footprints: hard.footprints,
                of_bound: hard.of_bound,
                pass: hard.pass,
            });
        }
    }
    Hard {
        strategies,
        cases,
        failed: all.iter().filter(|hard| !hard.pass).count(),
        count: all.len(),
    }
}

#[derive(Serialize)]
struct FlashRow {
    feature: String,
    image: String,
    /// Bytes on the Cortex-M0+ and on the M4: all, and more than the image before.
    sizes: Vec<Option<(i64, i64)>>,
}

fn flash(all: &[Flash]) -> Vec<FlashRow> {
    let first = all.first().map(|f| f.core.as_str()).unwrap_or_default();
    let of = |image: &str, core: &str| {
        let found = all.iter().find(|f| f.core == core && f.image == image);
        found.map(|f| (f.flash_of_feature, f.more_than_previous))
    };
    all.iter()
        .filter(|f| f.core == first)
        .map(|f| FlashRow {
            feature: f.feature.clone(),
            image: f.image.clone(),
            sizes: ["m0", "m4"].map(|core| of(&f.image, core)).to_vec(),
        })
        .collect()
}

/// Rows for the page's script: without names of fields, for there are thousands.
fn data(rows: &[Row]) -> Result<String, Error> {
    let round = |n: f64| format!("{n:.4e}").parse::<f64>().unwrap_or(n);
    let cores = cores();
    let compact: Vec<serde_json::Value> = rows
        .iter()
        .map(|row| {
            let costs: Vec<_> = cores
                .iter()
                .map(|core| row.costs.get(*core))
                .map(|cost| cost.map(|c| (c.instructions, round(c.cycles), c.how)))
                .collect();
            let s = &row.setting;
            serde_json::json!([
                row.scene,
                s.strategy,
                s.filter,
                s.depth,
                s.format,
                round(row.uv.footprints.max),
                round(row.uv.footprints.p99),
                round(row.uv.footprints.mean),
                round(row.uv.texels.max),
                row.colours.map(|c| c.psnr.map(round)),
                row.colours.map(|c| round(c.ssim)),
                row.coverage_mismatches,
                row.host_nanoseconds.map(round),
                costs,
            ])
        })
        .collect();
    let value = serde_json::json!({ "cores": cores, "chips": chips(), "surfaces": SURFACES, "rows": compact });
    // Within a script element no tag may begin.
    let text = serde_json::to_string(&value).map_err(|e| failed(&e))?;
    Ok(text.replace('<', "\\u003c"))
}
