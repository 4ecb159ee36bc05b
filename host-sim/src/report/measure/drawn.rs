//! A scene's frame, what strategies make of it, and filters.

use std::collections::BTreeMap;

use image::RgbImage;
use multum::viewport::Viewport;

use super::{Colours, Row, Scene};
use crate::choice::Perspective;
use crate::compare::coordinates::Coordinates;
use crate::compare::coverage::{self, CoverageCheck};
use crate::compare::{UvError, Visible, colour_error, shown};
use crate::error::Error;
use crate::filtering::Filtering;
use crate::frame::Frame;
use crate::heat_map::heat_map;
use crate::render::{divisions, fragments};
use crate::report::setting::{RUN_TIME, Setting};
use crate::shaded::{pixels, store, with_textures};
use crate::similarity::{psnr, ssim};
use crate::subject::Subject;

/// A scene's frame with or without a depth buffer, and what does not depend on the strategy.
pub(super) struct Prepared {
    pub(super) name: String,
    pub(super) what: String,
    pub(super) depth: &'static str,
    /// Whether the scene itself asks for a depth buffer.
    pub(super) needs_depth: bool,
    pub(super) frame: Frame,
    pub(super) shown: Vec<bool>,
    pub(super) coverage: CoverageCheck,
    /// The nearest texels in float64.
    pub(super) visible: Visible,
}

impl Prepared {
    pub(super) fn new(
        (name, what): (&str, &str),
        (depth, has_depth): (&'static str, bool),
        viewport: Viewport,
    ) -> Result<Self, Error> {
        let mut frame = Subject::by_name(name)?.frame(viewport)?;
        let needs_depth = frame.depth;
        frame.depth = has_depth;
        let shown = shown(&frame);
        Ok(Self {
            name: name.to_owned(),
            what: what.to_owned(),
            depth,
            needs_depth,
            coverage: coverage::check(&frame, &shown),
            visible: Visible::find(&frame, &shown, &Filtering::default())?,
            shown,
            frame,
        })
    }

    pub(super) fn scene(&self) -> Scene {
        Scene {
            name: self.name.clone(),
            what: self.what.clone(),
            triangles: self.shown.iter().filter(|shown| **shown).count(),
            needs_depth: self.needs_depth,
        }
    }

    /// Whether it has a depth buffer where the scene asks for one, and none otherwise.
    pub(super) fn is_its_own(&self) -> bool {
        self.frame.depth == self.needs_depth
    }

    pub(super) fn width(&self) -> u32 {
        self.frame.viewport.width()
    }

    pub(super) fn setting(&self, strategy: String, filter: &str) -> Setting {
        Setting {
            strategy,
            filter: filter.to_owned(),
            depth: self.depth.to_owned(),
            format: RUN_TIME.to_owned(),
        }
    }

    pub(super) fn row(
        &self,
        way: Perspective,
        filter: &str,
        geometry: &Geometry,
        colours: Option<Colours>,
    ) -> Row {
        Row {
            scene: self.name.clone(),
            setting: self.setting(way.to_string(), filter),
            uv: geometry.uv,
            snapping: geometry.snapping,
            coverage_mismatches: self.coverage.mismatches as u64,
            double_draws: self.coverage.double_draws as u64,
            gaps: self.coverage.gaps as u64,
            depth_mismatches: Some(geometry.depth_mismatches as u64),
            divisions: geometry.divisions,
            colours,
            host_nanoseconds: None,
            costs: BTreeMap::new(),
        }
    }
}

/// What does not depend on the filter.
pub(super) struct Geometry {
    pub(super) uv: UvError,
    pub(super) snapping: UvError,
    pub(super) depth_mismatches: usize,
    pub(super) divisions: u64,
    pub(super) map: Option<RgbImage>,
}

impl Geometry {
    pub(super) fn new(scene: &Prepared, way: Perspective, keeps: bool) -> Result<Self, Error> {
        let frame = &scene.frame;
        let coordinates = Coordinates::of(frame, &fragments(frame, way)?);
        let map = (keeps && scene.is_its_own()).then(|| {
            let title = format!("{way}: error in texels");
            heat_map(&coordinates.error, scene.width(), &title)
        });
        Ok(Self {
            uv: coordinates.uv_error,
            snapping: coordinates.snap_error,
            depth_mismatches: coordinates.depth_mismatches(&scene.visible),
            divisions: divisions(frame, way),
            map,
        })
    }
}

/// What one filter makes of a frame, by strategy.
pub(super) struct Painted {
    pub(super) reference: Vec<[u8; 3]>,
    pub(super) colours: Vec<Colours>,
    /// Pixels, where pictures are made of them.
    pub(super) core: Vec<Vec<[u8; 3]>>,
}

impl Painted {
    pub(super) fn new(
        scene: &Prepared,
        filtering: &Filtering,
        ways: &[Perspective],
        done: impl Fn(usize),
    ) -> Result<Self, Error> {
        let frame = &scene.frame;
        let exact = if filtering.is_plain() {
            None
        } else {
            Some(Visible::find(frame, &scene.shown, filtering)?)
        };
        let exact = exact.as_ref().unwrap_or(&scene.visible);
        let textures = store(frame, filtering)?;
        let (mut colours, mut core) = (Vec::new(), Vec::new());
        for way in ways {
            let height = frame.viewport.height();
            let drawn = if filtering.is_plain() {
                pixels(frame, *way, height, filtering)?
            } else {
                with_textures(frame, *way, height, filtering, &textures)?
            };
            let drawn = drawn.rgb();
            colours.push(compared(&drawn, exact, scene.width()));
            if filtering.is_plain() && scene.is_its_own() {
                core.push(drawn);
            }
            done(1);
        }
        Ok(Self {
            reference: if core.is_empty() {
                Vec::new()
            } else {
                exact.colour.clone()
            },
            colours,
            core,
        })
    }
}

pub(super) fn compared(drawn: &[[u8; 3]], exact: &Visible, width: u32) -> Colours {
    Colours {
        psnr: psnr(drawn, &exact.colour),
        // Frames that are smaller than a window are equal or not.
        ssim: ssim(drawn, &exact.colour, width as usize).unwrap_or(f64::NAN),
        off: colour_error(drawn, exact),
    }
}
