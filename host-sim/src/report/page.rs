//! The report as one HTML file: nothing to load, readable without scripts.

mod answers;
mod data;
mod gallery;
mod plots;
mod small_png;
mod tables;

use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, Value, context};

use answers::{breaks, example, mip_maps};
use data::{chips, data};
use gallery::gallery;
use plots::plots;
use tables::{flash, hard_cases, strategies};

use crate::benchmark;
use crate::error::Error;
use crate::report::measure::Measured;
use crate::report::on_target::Record;
use crate::report::peers::{Peer, SOURCE};

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
        .add_template("page", include_str!("page/page.html"))
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
        style => Value::from_safe_string(include_str!("page/page.css").to_owned()),
        script => Value::from_safe_string(include_str!("page/page.js").to_owned()),
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
