//! Temporal stability: how a texture swims when a camera or a plane moves by parts of a pixel.
//!
//! A point of a surface is followed from frame to frame. At the pixel that shows it, the core's
//! coordinate differs from float64's by some error; what that error changes by from one frame to
//! the next is motion that the eye sees and the scene does not have. The float64 side starts from
//! the camera's own numbers, so snapping and the matrix's rounding count as well.

use std::sync::Arc;

use multum::fixed::types::I16F16;
use multum::setup::Cull;
use multum::texture::Texture;
use multum::transform::Transform;
use multum::viewport::Viewport;
use serde::Serialize;

use crate::bound::{self, Bounds, anchors, every_pixel, stepping};
use crate::choice::Perspective;
use crate::compare::Spread;
use crate::error::Error;
use crate::frame::Frame;
use crate::hard_case::{blank, triangle};
use crate::picture::Picture;
use crate::probe::{probe, texel_numbers};
use crate::reference::{Beyond, Corners, Planes};
use crate::scene::{Prop, Scene, View};
use crate::shape;

/// Texels on a side of the texture.
const SIDE: u32 = 256;

/// Frames of a motion.
const FRAMES: u16 = 48;

/// Followed points on each axis of the plane.
const POINTS: u8 = 16;

/// What moves, and why it is looked at.
pub const MOTIONS: [(&str, &str); 4] = [
    ("sideways", "the camera moves by about 1/16 px a frame"),
    (
        "forward",
        "the camera moves 1/256 unit a frame towards the plane",
    ),
    ("roll", "the camera rolls by 1/1000 rad a frame"),
    (
        "plane",
        "the plane itself moves by 1/16 px and more a frame",
    ),
];

/// What came of one motion with one strategy.
#[derive(Clone, Debug, Serialize)]
pub struct Swimming {
    /// The motion's name.
    pub motion: &'static str,
    /// The strategy.
    pub strategy: String,
    /// Steps of points from one frame to the next that were measured.
    pub steps: usize,
    /// Excess motion of a point in a frame, in level-0 texels.
    pub texels: Spread,
    /// The same in footprints.
    pub footprints: Spread,
    /// Of that, what snapping and the matrix's rounding alone cause, in footprints.
    pub snapping: Spread,
    /// Steps that exceed the bounds of both frames and the motion from snapping together.
    pub beyond_bound: usize,
}

/// A point at one frame.
#[derive(Clone, Copy)]
struct Seen {
    /// The core's coordinate less float64's, in texels.
    error: [f64; 2],
    /// The same of float64 with snapped corners.
    snapping: [f64; 2],
    /// The strategy's bound, in texels.
    bound: [f64; 2],
    footprint: f64,
}

/// A plane that is met at 55 degrees and leans, in front of all cameras.
const PLANE: [[f32; 3]; 4] = [
    [-1.5, 1.2, -1.7],
    [-1.3, -1.4, -1.5],
    [2.2, -1.5, -6.0],
    [2.0, 1.1, -6.2],
];

/// The camera and the plane's offset in a frame.
fn pose(motion: &str, frame: u16) -> (View, [f32; 3]) {
    let t = f32::from(frame);
    let mut view = View {
        eye: [0.0; 3],
        look: [0.2, 0.05, -3.0],
        up: [0.15, 1.0, 0.0],
        fov_y: 60.0,
        near: 0.1,
    };
    let mut offset = [0.0; 3];
    match motion {
        "sideways" => {
            view.eye[0] += t / 1024.0;
            view.look[0] += t / 1024.0;
        }
        "forward" => view.eye[2] -= t / 256.0,
        "roll" => view.up[0] += t / 1000.0,
        _ => offset = [t / 1024.0, -t / 1500.0, t / 700.0],
    }
    (view, offset)
}

/// Follows the points of the plane through a motion.
///
/// # Errors
///
/// [`Error::Core`]; none of the motions leaves the core's range.
pub fn measure(motion: &'static str, perspective: Perspective) -> Result<Swimming, Error> {
    let viewport = Viewport::new(320, 240).map_err(|e| Error::core("motion", e))?;
    let picture = blank(SIDE, SIDE)?;
    let texels = texel_numbers(SIDE, SIDE);
    let texture = Texture::new(&texels, SIDE, SIDE).map_err(|e| Error::core("texture", e))?;
    let mut before: Option<Vec<Option<Seen>>> = None;
    let (mut all, mut footprints, mut snapping) = (Vec::new(), Vec::new(), Vec::new());
    let mut beyond_bound = 0;
    for number in 0..FRAMES {
        let now = follow(
            pose(motion, number),
            viewport,
            &picture,
            texture,
            perspective,
        )?;
        for (a, b) in before.iter().flatten().zip(&now) {
            let (Some(a), Some(b)) = (a, b) else { continue };
            let change = |of: fn(&Seen) -> [f64; 2]| {
                let (a, b) = (of(a), of(b));
                [(b[0] - a[0]).abs(), (b[1] - a[1]).abs()]
            };
            let (excess, snap) = (change(|s| s.error), change(|s| s.snapping));
            let kept = [0, 1]
                .into_iter()
                // Float64's own rounding: far below a millionth of a texel.
                .all(|i| excess[i] <= a.bound[i] + b.bound[i] + snap[i] + 1e-9);
            beyond_bound += usize::from(!kept);
            let most = excess[0].max(excess[1]);
            all.push(most);
            footprints.push(most / b.footprint);
            snapping.push(snap[0].max(snap[1]) / b.footprint);
        }
        before = Some(now);
    }
    Ok(Swimming {
        motion,
        strategy: perspective.to_string(),
        steps: all.len(),
        texels: Spread::of(all),
        footprints: Spread::of(footprints),
        snapping: Spread::of(snapping),
        beyond_bound,
    })
}

/// All points in one frame; `None` for those that are not drawn.
fn follow(
    (view, offset): (View, [f32; 3]),
    viewport: Viewport,
    picture: &Arc<Picture>,
    texture: Texture<'_, u32>,
    perspective: Perspective,
) -> Result<Vec<Option<Seen>>, Error> {
    let offset = offset.map(I16F16::from_num);
    let scene = Scene {
        name: "motion".to_owned(),
        view,
        units: 1.0,
        props: vec![Prop {
            part: shape::quad(PLANE, [4.0, 4.0], picture),
            stand: Transform::translation(offset),
            wrap: Beyond::Repeat,
        }],
        cull: Cull::Off,
        depth: false,
    };
    let frame = Frame::of_scene(&scene, viewport)?;
    let lens = view
        .camera(viewport)
        .map_err(|e| Error::core("motion", e))?
        .lens;
    let eye = Eye::new(&view, lens.scales().map(f64::from), viewport);
    // The mesh's own numbers: rounded to 16.16, then moved.
    let corner = |i: usize| -> [f64; 3] {
        [0, 1, 2]
            .map(|k| f64::from(I16F16::saturating_from_num(PLANE[i][k])) + f64::from(offset[k]))
    };
    let (a, b, d) = (corner(0), corner(1), corner(3));
    let uv = [[0.0, 0.0], [0.0, 4.0], [4.0, 0.0]];
    let projected = [a, b, d].map(|p| eye.project(p));
    let exact = Planes::new(&Corners {
        position: projected.map(|(p, _)| p),
        w: projected.map(|(_, w)| w),
        uv,
    });
    let Some(exact) = exact else {
        return Ok(Vec::new());
    };
    let mut drawn = Vec::new();
    for (_, t) in frame.triangles() {
        let record = probe(&t.vertices, viewport, perspective, texture, Beyond::Repeat);
        drawn.push((t.corners(), record));
    }
    let steps = (0..POINTS).map(|i| (f64::from(i) + 0.5) / f64::from(POINTS));
    let points = steps
        .clone()
        .flat_map(|s| steps.clone().map(move |t| (s, t)));
    Ok(points
        .map(|(s, t)| {
            let p = [0, 1, 2].map(|i| a[i] + s * (d[i] - a[i]) + t * (b[i] - a[i]));
            let (position, _) = eye.project(p);
            let [x, y] = position.map(|c| c.floor() as i32);
            let truth = exact.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let footprint = truth.footprint([f64::from(SIDE); 2]).max(1.0);
            drawn.iter().find_map(|(corners, record)| {
                let (span, pixels) = record
                    .spans()
                    .find(|(span, _)| span.y == y && (span.left..span.right).contains(&x))?;
                let found = pixels.get(x.abs_diff(span.left) as usize)?.coordinates();
                let planes = Planes::new(corners)?;
                let snapped = planes.at(f64::from(x) + 0.5, f64::from(y) + 0.5).uv;
                let mut bounds = Bounds::new(perspective, &planes, corners, [f64::from(SIDE); 2]);
                bounds.enter(span);
                let bound = bounds.at(x);
                let texels = |repeats: f64| repeats * f64::from(SIDE);
                Some(Seen {
                    error: [0, 1].map(|i| texels(found[i] - truth.uv[i])),
                    snapping: [0, 1].map(|i| texels(snapped[i] - truth.uv[i])),
                    bound: bound.map(texels),
                    footprint,
                })
            })
        })
        .collect())
}

/// A camera in float64.
struct Eye {
    rows: [[f64; 3]; 3],
    eye: [f64; 3],
    scales: [f64; 2],
    size: [f64; 2],
}

impl Eye {
    fn new(view: &View, scales: [f64; 2], viewport: Viewport) -> Self {
        let wide = |a: [f32; 3]| a.map(f64::from);
        let (eye, look, up) = (wide(view.eye), wide(view.look), wide(view.up));
        let unit = |a: [f64; 3]| {
            let length = a.iter().map(|c| c * c).sum::<f64>().sqrt();
            a.map(|c| c / length)
        };
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [
                a[1] * b[2] - a[2] * b[1],
                a[2] * b[0] - a[0] * b[2],
                a[0] * b[1] - a[1] * b[0],
            ]
        };
        let back = unit([0, 1, 2].map(|i| eye[i] - look[i]));
        let right = unit(cross(up, back));
        Self {
            rows: [right, cross(back, right), back],
            eye,
            scales,
            size: [viewport.width(), viewport.height()].map(f64::from),
        }
    }

    /// The place on the screen in pixels, and w.
    fn project(&self, p: [f64; 3]) -> ([f64; 2], f64) {
        let d = [0, 1, 2].map(|i| p[i] - self.eye[i]);
        let [x, y, z] = self
            .rows
            .map(|row| row.iter().zip(d).map(|(r, d)| r * d).sum::<f64>());
        let w = -z;
        let x = (x * self.scales[0] / w + 1.0) * 0.5 * self.size[0];
        let y = (1.0 - y * self.scales[1] / w) * 0.5 * self.size[1];
        ([x, y], w)
    }
}

/// How well triangles of one plane agree where their spans share anchors.
#[derive(Clone, Debug, Serialize)]
pub struct Agreement {
    /// The strategy.
    pub strategy: String,
    /// Pixels, summed over pairs of triangles, in pieces that are whole in both.
    pub pixels: usize,
    /// Largest difference of u or v between the two, in level-0 texels of a 256x256 texture.
    pub texels: f64,
    /// Largest part of the bound: the arithmetic's own errors of both, without any chord.
    pub ratio: f64,
    /// Pixels beyond it.
    pub beyond_bound: usize,
}

/// Draws overlapping triangles of exactly one plane and compares them between shared anchors.
/// `None` for a strategy without anchors.
///
/// # Errors
///
/// [`Error::Core`]; the triangles are in range.
pub fn agreement(perspective: Perspective) -> Result<Option<Agreement>, Error> {
    let Some(n) = anchors(perspective) else {
        return Ok(None);
    };
    let viewport = Viewport::new(320, 240).map_err(|e| Error::core("agreement", e))?;
    let texture = Texture::new(&[0], 1, 1).map_err(|e| Error::core("texture", e))?;
    // 1/w = 1 - x / 512, u/w = x / 256, v/w = y / 128: all of it exact in 16.16 at these x.
    let corner = |x: i32, y: i32| {
        let (x, y) = (f64::from(x), f64::from(y));
        let w = 512.0 / (512.0 - x);
        [x, y, w, x / 256.0 * w, y / 128.0 * w]
    };
    let triangles = [
        [corner(0, 0), corner(384, 16), corner(256, 240)],
        [corner(0, 240), corner(384, 240), corner(384, 0)],
        [corner(0, 128), corner(256, 0), corner(384, 200)],
        [corner(-512, 100), corner(384, -64), corner(256, 230)],
    ]
    .into_iter()
    .map(|t| {
        let t = triangle(t)?;
        let record = probe(&t.vertices, viewport, perspective, texture, Beyond::Repeat);
        Ok((t.corners(), record))
    })
    .collect::<Result<Vec<_>, Error>>()?;
    let mut result = Agreement {
        strategy: perspective.to_string(),
        pixels: 0,
        texels: 0.0,
        ratio: 0.0,
        beyond_bound: 0,
    };
    for (i, (corners, record)) in triangles.iter().enumerate() {
        for (other_corners, other) in &triangles[..i] {
            let bound_of = |corners: &Corners, axis: usize| {
                if n > 1 {
                    // No span is longer than the frame is wide.
                    bound::every(corners, axis, 320, n) + stepping(n)
                } else {
                    every_pixel(corners, axis)
                }
            };
            let bound = [0, 1].map(|axis| bound_of(corners, axis) + bound_of(other_corners, axis));
            for (a, left) in record.spans() {
                let Some((b, right)) = other.spans().find(|(span, _)| span.y == a.y) else {
                    continue;
                };
                // From the first shared anchor to the last; both spans have their ends beyond.
                let first = (a.left.max(b.left) + n - 1).div_euclid(n) * n;
                let last = (a.right.min(b.right) - 1).div_euclid(n) * n;
                for x in first..last {
                    let at = |left_end: i32| x.abs_diff(left_end) as usize;
                    let (p, q) = (left[at(a.left)], right[at(b.left)]);
                    let (p, q) = (p.coordinates(), q.coordinates());
                    let off = [0, 1].map(|axis| (p[axis] - q[axis]).abs());
                    let ratio = (off[0] / bound[0]).max(off[1] / bound[1]);
                    result.pixels += 1;
                    result.texels = result.texels.max(off[0].max(off[1]) * f64::from(SIDE));
                    result.ratio = result.ratio.max(ratio);
                    result.beyond_bound += usize::from(ratio > 1.0);
                }
            }
        }
    }
    Ok(Some(result))
}
