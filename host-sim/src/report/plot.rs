//! Speed against error as a picture: logarithmic axes, a mark for each setting, the Pareto front.

use std::sync::Once;

use image::RgbImage;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, register_font};

use crate::error::Error;
use crate::report::front::front;
use crate::report::measure::Row;
use crate::report::peers::Peer;
use crate::report::setting::SIZED;

/// Width and height of a plot in pixels.
pub const SIZE: (u32, u32) = (760, 470);

/// Errors below this are drawn here: a unit of the last place is a 65,536th of a texel of 256.
const LEAST: f64 = 1e-5;

/// In which unit the error is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// The texels that a pixel spans.
    Footprints,
    /// Texels of the finest level.
    Texels,
}

impl Unit {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Footprints, Self::Texels];

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Footprints => "footprints",
            Self::Texels => "texels",
        }
    }
}

/// What a mark stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A texture whose sides are part of its type.
    Sized,
    /// A texture whose sides are known at run time.
    RunTime,
    /// Another renderer.
    Peer,
}

/// A setting with its cost and error.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Its name in the plot.
    pub label: String,
    /// Instructions a pixel.
    pub cost: f64,
    /// The largest error.
    pub error: f64,
    /// What it is.
    pub kind: Kind,
    /// Whether no other of ours beats it in both.
    pub on_front: bool,
}

/// The marks of a scene on a core: strategies by themselves, and other renderers where their error
/// was measured in this unit.
#[must_use]
pub fn marks(rows: &[Row], peers: &[Peer], scene: &str, core: &str, unit: Unit) -> Vec<Mark> {
    let mut marks: Vec<Mark> = rows
        .iter()
        .filter(|row| row.scene == scene && row.setting.is_plain())
        .filter_map(|row| {
            let error = match unit {
                Unit::Footprints => row.uv.footprints.max,
                Unit::Texels => row.uv.texels.max,
            };
            let is_sized = row.setting.format == SIZED;
            Some(Mark {
                label: row.setting.strategy.clone(),
                cost: row.costs.get(core)?.instructions,
                error,
                kind: if is_sized { Kind::Sized } else { Kind::RunTime },
                on_front: false,
            })
        })
        .collect();
    let points: Vec<_> = marks.iter().map(|m| (m.cost, m.error.max(LEAST))).collect();
    for (mark, on_front) in marks.iter_mut().zip(front(&points)) {
        mark.on_front = on_front;
    }
    let known = peers
        .iter()
        .filter(|p| p.scene == scene && p.core == core && unit == Unit::Texels);
    marks.extend(known.filter_map(|peer| {
        Some(Mark {
            label: format!("{}, {}", peer.peer, short(&peer.mode)),
            cost: peer.instructions,
            error: peer.texels_max?,
            kind: Kind::Peer,
            on_front: false,
        })
    }));
    marks
}

/// What matters most of a renderer's mode.
fn short(mode: &str) -> &str {
    mode.split(',').next().unwrap_or(mode)
}

/// Colours of a plot.
#[derive(Clone, Copy, Debug)]
pub struct Theme {
    paper: RGBColor,
    ink: RGBColor,
    grid: RGBColor,
    ours: RGBColor,
    peer: RGBColor,
}

impl Theme {
    /// Dark on white.
    pub const LIGHT: Self = Self {
        paper: RGBColor(255, 255, 255),
        ink: RGBColor(38, 38, 46),
        grid: RGBColor(222, 222, 228),
        ours: RGBColor(0, 98, 173),
        peer: RGBColor(190, 84, 0),
    };

    /// Colours that [`styled`] turns into those of the page that the plot is in.
    const MARKED: Self = Self {
        paper: RGBColor(1, 1, 1),
        ink: RGBColor(1, 1, 2),
        grid: RGBColor(1, 1, 3),
        ours: RGBColor(1, 1, 4),
        peer: RGBColor(1, 1, 5),
    };
}

/// Where each mark is in a plot, from its left and upper edge, as parts of its sides.
pub type Places = Vec<[f64; 2]>;

/// A plot as SVG with white paper.
///
/// # Errors
///
/// [`Error::Content`] if it cannot be drawn.
pub fn svg(title: &str, unit: Unit, marks: &[Mark]) -> Result<String, Error> {
    Ok(drawn(title, unit, marks, Theme::LIGHT)?.0)
}

/// A plot as SVG whose colours are the page's properties `--paper`, `--ink`, `--grid`, `--ours` and
/// `--peer`, and the places of its marks.
///
/// # Errors
///
/// [`Error::Content`] if it cannot be drawn.
pub fn styled(title: &str, unit: Unit, marks: &[Mark]) -> Result<(String, Places), Error> {
    let (mut svg, places) = drawn(title, unit, marks, Theme::MARKED)?;
    for (number, name) in (1..).zip(["paper", "ink", "grid", "ours", "peer"]) {
        svg = svg.replace(&format!("#01010{number}"), &format!("var(--{name})"));
    }
    Ok((svg, places))
}

fn drawn(title: &str, unit: Unit, marks: &[Mark], theme: Theme) -> Result<(String, Places), Error> {
    let mut svg = String::new();
    let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
    let places = draw(&root, 1, (title, unit), marks, theme)?;
    drop(root);
    Ok((svg, places))
}

/// Pixels of a picture for one of a plot: lettering of one pixel's strokes is hard to read.
const PICTURE_SCALE: u32 = 2;

/// A plot as a picture, twice as large.
///
/// # Errors
///
/// [`Error::Content`] if it cannot be drawn.
pub fn picture(title: &str, unit: Unit, marks: &[Mark]) -> Result<RgbImage, Error> {
    let (width, height) = (SIZE.0 * PICTURE_SCALE, SIZE.1 * PICTURE_SCALE);
    let mut pixels = vec![255; 3 * width as usize * height as usize];
    let root = BitMapBackend::with_buffer(&mut pixels, (width, height)).into_drawing_area();
    draw(&root, PICTURE_SCALE, (title, unit), marks, Theme::LIGHT)?;
    drop(root);
    RgbImage::from_raw(width, height, pixels)
        .ok_or_else(|| Error::content("plot", "it has no pixels", "report this"))
}

/// Distance of labels from their marks, in pixels.
const GAP: i32 = 7;
const LABEL: i32 = 13;

/// `scale` times as large as [`SIZE`].
fn draw<DB>(
    root: &DrawingArea<DB, Shift>,
    scale: u32,
    (title, unit): (&str, Unit),
    marks: &[Mark],
    theme: Theme,
) -> Result<Places, Error>
where
    DB: DrawingBackend,
{
    prepare_font();
    let scaled = |pixels: i32| pixels * scale.cast_signed();
    let failed = |e: &dyn std::fmt::Display| Error::content("plot", &e.to_string(), "report this");
    root.fill(&theme.paper).map_err(|e| failed(&e))?;
    let text = |size: i32| ("sans-serif", scaled(size)).into_font().color(&theme.ink);
    let (costs, errors) = (
        range(marks, |m| m.cost),
        range(marks, |m| m.error.max(LEAST)),
    );
    let mut chart = ChartBuilder::on(root)
        .margin(scaled(12))
        .margin_right(scaled(24))
        .caption(title, text(17))
        .x_label_area_size(scaled(38))
        .y_label_area_size(scaled(62))
        .build_cartesian_2d(
            (costs.0..costs.1).log_scale(),
            (errors.0..errors.1).log_scale(),
        )
        .map_err(|e| failed(&e))?;
    chart
        .configure_mesh()
        .x_desc("instructions a pixel")
        .y_desc(format!("largest error, {}", unit.name()))
        .label_style(text(LABEL))
        .axis_desc_style(text(14))
        .axis_style(theme.ink)
        .bold_line_style(theme.grid)
        .light_line_style(theme.paper)
        .x_label_formatter(&|n| number(*n))
        .y_label_formatter(&|n| {
            if *n <= LEAST {
                format!("≤ {}", number(*n))
            } else {
                number(*n)
            }
        })
        .draw()
        .map_err(|e| failed(&e))?;
    let stairs = stairs(marks, errors.1, costs.1);
    chart
        .draw_series(LineSeries::new(
            stairs,
            theme.ours.mix(0.6).stroke_width(2 * scale),
        ))
        .map_err(|e| failed(&e))?;
    let area = chart.plotting_area();
    let places: Vec<(i32, i32)> = marks
        .iter()
        .map(|m| area.map_coordinate(&(m.cost, m.error.max(LEAST))))
        .collect();
    for (mark, place) in marks.iter().zip(&places) {
        let place = *place;
        let result = match mark.kind {
            Kind::Sized => root.draw(&Circle::new(place, scaled(5), theme.ours.filled())),
            Kind::RunTime => root.draw(&Circle::new(
                place,
                scaled(5),
                theme.ours.stroke_width(2 * scale),
            )),
            Kind::Peer => root.draw(&TriangleMarker::new(place, scaled(6), theme.peer.filled())),
        };
        result.map_err(|e| failed(&e))?;
    }
    let unscaled = |(x, y): &(i32, i32)| (x / scaled(1), y / scaled(1));
    let unscaled: Vec<_> = places.iter().map(unscaled).collect();
    for (number, ((x, y), side)) in labels(marks, &unscaled) {
        let mark = &marks[number];
        let colour = if mark.kind == Kind::Peer {
            theme.peer
        } else {
            theme.ink
        };
        let style = text(LABEL).color(&colour);
        let style = style.pos(Pos::new(side, VPos::Center));
        root.draw(&Text::new(
            mark.label.clone(),
            (scaled(x), scaled(y)),
            style,
        ))
        .map_err(|e| failed(&e))?;
    }
    root.present().map_err(|e| failed(&e))?;
    let part = |(x, y): (i32, i32)| {
        [(x, SIZE.0), (y, SIZE.1)].map(|(at, side)| f64::from(at) / f64::from(side * scale))
    };
    Ok(places.into_iter().map(part).collect())
}

/// Pictures get a typeface of the program's, so that they are the same on every machine.
fn prepare_font() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let font = epaint_default_fonts::UBUNTU_LIGHT;
        // It is a font: a dependency's constant.
        _ = register_font("sans-serif", FontStyle::Normal, font);
    });
}

/// The ends of an axis, with room for marks.
fn range(marks: &[Mark], of: impl Fn(&Mark) -> f64) -> (f64, f64) {
    let values = marks.iter().map(of).filter(|v| v.is_finite());
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), v| {
        (low.min(v), high.max(v))
    });
    if low > high {
        return (1.0, 10.0);
    }
    (low / 1.6, high * 1.9)
}

/// The front as a line: to the right of it and above, something on it is better in both.
fn stairs(marks: &[Mark], top: f64, right: f64) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = marks
        .iter()
        .filter(|m| m.on_front)
        .map(|m| (m.cost, m.error.max(LEAST)))
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut line = Vec::new();
    let mut above = top;
    for (cost, error) in points {
        line.extend([(cost, above), (cost, error)]);
        above = error;
    }
    if !line.is_empty() {
        line.push((right, above));
    }
    line
}

/// An axis's number, without needless digits.
fn number(n: f64) -> String {
    if n >= 1.0 || n <= 0.0 {
        return format!("{n:.0}");
    }
    let digits = (-n.log10()).ceil().clamp(0.0, 9.0) as usize;
    format!("{n:.digits$}")
}

type Place = ((i32, i32), HPos);

/// Labels that have room: numbers of marks, those on the front first, and where the text begins or
/// ends.
fn labels(marks: &[Mark], places: &[(i32, i32)]) -> Vec<(usize, Place)> {
    let mut order: Vec<usize> = (0..marks.len()).collect();
    order.sort_by_key(|&i| {
        let is_peer = marks[i].kind == Kind::Peer;
        (!marks[i].on_front, !is_peer, marks[i].kind == Kind::RunTime)
    });
    // Boxes that are taken: left, top, right, bottom.
    let mut taken: Vec<[i32; 4]> = places
        .iter()
        .map(|(x, y)| [x - 5, y - 5, x + 5, y + 5])
        .collect();
    let mut found: Vec<(usize, Place)> = Vec::new();
    let (width, height) = (SIZE.0.cast_signed(), SIZE.1.cast_signed());
    for i in order {
        let (x, y) = places[i];
        // The same strategy with the other texture, close by: one name for both.
        let is_named = found.iter().any(|&(other, _)| {
            let (a, b) = places[other];
            marks[other].label == marks[i].label && (a - x).abs() < 60 && (b - y).abs() < 30
        });
        if is_named {
            continue;
        }
        let length = marks[i].label.chars().count() as i32 * 13 / 2;
        let candidates = [
            (GAP, 0, HPos::Left),
            (-GAP, 0, HPos::Right),
            (GAP, -LABEL, HPos::Left),
            (GAP, LABEL, HPos::Left),
            (-GAP, -LABEL, HPos::Right),
            (-GAP, LABEL, HPos::Right),
        ];
        let free = candidates.into_iter().find_map(|(dx, dy, side)| {
            let left = if matches!(side, HPos::Left) {
                x + dx
            } else {
                x + dx - length
            };
            let space = [left, y + dy - LABEL / 2, left + length, y + dy + LABEL / 2];
            let is_inside =
                left > 66 && left + length < width - 8 && space[1] > 34 && space[3] < height - 52;
            let is_free = taken.iter().enumerate().all(|(n, other)| {
                n == i
                    || space[2] < other[0]
                    || other[2] < space[0]
                    || space[3] < other[1]
                    || other[3] < space[1]
            });
            (is_inside && is_free).then_some((((x + dx, y + dy), side), space))
        });
        if let Some((place, space)) = free {
            taken.push(space);
            found.push((i, place));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(label: &str, cost: f64, error: f64, on_front: bool) -> Mark {
        Mark {
            label: label.to_owned(),
            cost,
            error,
            kind: Kind::Sized,
            on_front,
        }
    }

    #[test]
    fn a_plot_names_its_marks_and_tells_where_they_are() {
        let marks = [
            mark("affine", 7.0, 3.0, true),
            mark("exact", 40.0, 0.0, true),
        ];
        let (svg, places) = styled("a <title>", Unit::Footprints, &marks).expect("a plot");
        assert!(svg.contains("affine") && svg.contains("exact"));
        assert!(svg.contains("a &lt;title&gt;"), "the title is escaped");
        assert!(svg.contains("var(--ink)") && !svg.contains("#01010"));
        let [[ax, ay], [bx, by]] = places[..] else {
            panic!("two places")
        };
        // Faster is to the left, a smaller error below.
        assert!(ax < bx && ay < by);
        assert!([ax, ay, bx, by].iter().all(|c| (0.0..1.0).contains(c)));
    }

    #[test]
    fn a_plot_of_nothing_is_a_plot() {
        assert!(svg("empty", Unit::Texels, &[]).is_ok());
        assert!(picture("empty", Unit::Texels, &[]).is_ok());
    }

    #[test]
    fn the_front_descends_in_stairs() {
        let marks = [
            mark("a", 1.0, 4.0, true),
            mark("b", 2.0, 5.0, false),
            mark("c", 3.0, 1.0, true),
        ];
        let expected = [(1.0, 9.0), (1.0, 4.0), (3.0, 4.0), (3.0, 1.0), (8.0, 1.0)];
        assert_eq!(stairs(&marks, 9.0, 8.0), expected);
    }
}
