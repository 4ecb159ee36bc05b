//! Hard cases that come through the camera, the clip stage and the projection.

use std::sync::Arc;

use multum::clip::{ClipVertex, ClipVolume};
use multum::fixed::types::I16F16;
use multum::setup::Cull;
use multum::transform::Transform;
use multum::viewport::Viewport;

use super::{HardCase, blank};
use crate::error::Error;
use crate::frame::{Batch, Frame, cut};
use crate::reference::Beyond;
use crate::scene::{Prop, Scene, View};
use crate::shape;

fn viewport() -> Result<Viewport, Error> {
    Viewport::new(160, 120).map_err(|e| Error::core("hard case", e))
}

/// A quad with a texture of 256 x 256 repeated across and down.
fn quad(corners: [[f32; 3]; 4], repeats: [f32; 2]) -> Result<Prop, Error> {
    Ok(Prop {
        part: shape::quad(corners, repeats, &blank(256, 256)?),
        stand: Transform::IDENTITY,
        wrap: Beyond::Repeat,
    })
}

/// A camera at the origin that looks along -z, and rolled by some degrees.
fn rolled(degrees: f32, near: f32) -> View {
    let (sin, cos) = degrees.to_radians().sin_cos();
    View {
        eye: [0.0; 3],
        look: [0.0, 0.0, -1.0],
        up: [-sin, cos, 0.0],
        fov_y: 60.0,
        near,
    }
}

/// Quads seen by several cameras, in one frame: each triangle is looked at alone.
fn seen(
    name: &str,
    reason: &'static str,
    views: &[View],
    quads: &[([[f32; 3]; 4], [f32; 2])],
) -> Result<HardCase, Error> {
    let viewport = viewport()?;
    let mut batches = Vec::new();
    for view in views {
        let scene = Scene {
            name: name.to_owned(),
            view: *view,
            units: 1.0,
            props: quads
                .iter()
                .map(|&(corners, repeats)| quad(corners, repeats))
                .collect::<Result<_, _>>()?,
            cull: Cull::Off,
            depth: false,
        };
        batches.extend(Frame::of_scene(&scene, viewport)?.batches);
    }
    Ok(HardCase {
        name: name.to_owned(),
        reason,
        frame: Frame {
            viewport,
            near: I16F16::ONE,
            cull: Cull::Off,
            depth: false,
            batches,
        },
    })
}

/// Triangles in clip space, given by x, y, w, u, v in units of 2^-16.
fn clipped(
    name: &str,
    reason: &'static str,
    near: i32,
    triangles: &[[[i32; 5]; 3]],
) -> Result<HardCase, Error> {
    let viewport = viewport()?;
    let near = I16F16::from_bits(near);
    let volume = ClipVolume::new(viewport, near);
    let vertex = |c: [i32; 5]| {
        let [x, y, w, u, v] = c.map(I16F16::from_bits);
        ClipVertex { x, y, w, u, v }
    };
    Ok(HardCase {
        name: name.to_owned(),
        reason,
        frame: Frame {
            viewport,
            near,
            cull: Cull::Off,
            depth: false,
            batches: vec![Batch {
                picture: Arc::clone(&blank(256, 256)?),
                wrap: Beyond::Repeat,
                triangles: triangles
                    .iter()
                    .flat_map(|t| cut(&volume, &t.map(vertex)))
                    .collect(),
            }],
        },
    })
}

pub(super) fn cases() -> Result<Vec<HardCase>, Error> {
    let mut cases = near_plane()?;
    cases.extend(walls()?);
    Ok(cases)
}

fn near_plane() -> Result<Vec<HardCase>, Error> {
    const ONE: i32 = 1 << 16;
    let floor = (
        [
            [-8.0, -1.0, 8.0],
            [-8.0, -1.0, -40.0],
            [8.0, -1.0, -40.0],
            [8.0, -1.0, 8.0],
        ],
        [16.0, 48.0],
    );
    let wall = (
        [
            [1.0, -4.0, 8.0],
            [1.0, -4.0, -40.0],
            [1.0, 4.0, -40.0],
            [1.0, 4.0, 8.0],
        ],
        [48.0, 8.0],
    );
    let rolls = [0.0, 10.0, 33.0, 90.0];
    let big = 8000.0;
    let ground = [
        [-big, -1.0, big],
        [-big, -1.0, -big],
        [big, -1.0, -big],
        [big, -1.0, big],
    ];
    let at_eye = |w: i32| {
        [
            [w.clamp(-1, 1), 3, w, 0, 0],
            [2 * ONE, ONE, 3 * ONE, 4 * ONE, 0],
            [-ONE, -2 * ONE, 4 * ONE, 0, 4 * ONE],
        ]
    };
    Ok(vec![
        seen(
            "near-cut",
            "floor and wall reach behind the eye: the near plane cuts them",
            &rolls.map(|roll| rolled(roll, 0.1)),
            &[floor, wall],
        )?,
        seen(
            "near-cut-least",
            "the same with the nearest near plane there is: w keeps 8 bits there",
            &rolls.map(|roll| rolled(roll, 1.0 / 256.0)),
            &[floor, wall],
        )?,
        clipped(
            "eye-plane",
            "a vertex within one unit of the eye plane, in front of it, on it and behind it",
            256,
            &[
                at_eye(-1),
                at_eye(0),
                at_eye(1),
                at_eye(255),
                at_eye(256),
                at_eye(257),
            ],
        )?,
        clipped(
            "eye-plane-no-near",
            "the same without a near plane to speak of: w of one unit comes through",
            1,
            &[at_eye(-1), at_eye(0), at_eye(1), at_eye(2)],
        )?,
        seen(
            "beyond-guard-band",
            "walls so large that the guard band cuts them on all sides",
            &rolls.map(|roll| rolled(roll, 0.1)),
            &[(
                [
                    [-900.0, 500.0, -3.0],
                    [-700.0, -800.0, -40.0],
                    [900.0, -600.0, -5.0],
                    [800.0, 900.0, -2.0],
                ],
                [120.0, 120.0],
            )],
        )?,
        seen(
            "horizon",
            "ground as far as positions reach: depths up to the horizon in one triangle",
            &rolls.map(|roll| rolled(roll, 0.1)),
            &[(ground, [100.0, 100.0])],
        )?,
    ])
}

/// Walls that the line of sight meets at 1 to 89 degrees, the camera rolled by 0 to 90.
fn walls() -> Result<Vec<HardCase>, Error> {
    let rolls: Vec<_> = (0..=9).map(|i| rolled(10.0 * i as f32, 0.1)).collect();
    [1.0f32, 5.0, 15.0, 30.0, 45.0, 60.0, 75.0, 85.0, 89.0]
        .into_iter()
        .map(|degrees| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            // Through a point 2 units ahead, 3 units to both sides along the wall.
            let side = |t: f32, y: f32| [t * sin, y, -2.0 - t * cos];
            let wall = [
                side(-3.0, 2.0),
                side(-3.0, -2.0),
                side(3.0, -2.0),
                side(3.0, 2.0),
            ];
            seen(
                &format!("wall-{degrees:02}"),
                "a wall at an angle, the camera rolled by 0 to 90 degrees: depth along the span",
                &rolls,
                &[(wall, [6.0, 4.0])],
            )
        })
        .collect()
}
