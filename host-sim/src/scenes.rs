//! The scenes of the world: real meshes and textures, each there to show one thing.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use multum::fixed::types::I16F16;
use multum::setup::Cull;
use multum::transform::Transform;

use crate::error::Error;
use crate::model::{self, Part};
use crate::picture::Picture;
use crate::reference::Beyond;
use crate::scene::{Prop, Scene, View};
use crate::{pattern, shape};

/// Names, and what each scene shows.
pub const SCENES: [(&str, &str); 8] = [
    (
        "crate",
        "a wooden crate, turned: diagonal planks bend under affine mapping",
    ),
    (
        "corridor",
        "stripes on long walls, camera yawed and rolled: span error",
    ),
    (
        "sidewalk",
        "one quad from z = -1 to -10, not clipped: perspective itself",
    ),
    (
        "checkers",
        "nine checkerboards in a row, receding: aliasing",
    ),
    (
        "globe",
        "a map on a sphere: many small triangles, a seam in the texture",
    ),
    ("spot", "a cow of 5,856 triangles with a 1024x1024 texture"),
    (
        "room",
        "brick and gravel, a crate, walls cut by the near plane",
    ),
    ("spot-control", "the cow's control mesh of 372 triangles"),
];

/// The scenes that are drawn when nothing else is asked for.
pub const DEFAULT: [&str; 7] = [
    "crate", "corridor", "sidewalk", "checkers", "globe", "spot", "room",
];

/// Largest side of a texture in the firmware's images.
const DEVICE_TEXTURE: u32 = 256;

/// A scene as the firmware's images have it: textures of at most 256x256, and the cow by its
/// control mesh. `None` if there is none of this name.
///
/// # Errors
///
/// As [`by_name`].
pub fn on_device(name: &str) -> Result<Option<Scene>, Error> {
    let scene = match name {
        "spot" => Some(spot(name, "spot_control_mesh.obj")?),
        _ => by_name(name)?,
    };
    scene
        .map(|scene| scene.with_textures_up_to(DEVICE_TEXTURE))
        .transpose()
}

/// A scene by name; `None` if there is none of this name.
///
/// # Errors
///
/// The scene's files missing or broken.
pub fn by_name(name: &str) -> Result<Option<Scene>, Error> {
    let scene = match name {
        "crate" => turned_crate()?,
        "corridor" => corridor(),
        "sidewalk" => sidewalk(),
        "checkers" => checkers(),
        "globe" => globe()?,
        "spot" => spot(name, "spot_triangulated.obj")?,
        "spot-control" => spot(name, "spot_control_mesh.obj")?,
        "room" => room()?,
        _ => return Ok(None),
    };
    Ok(Some(scene))
}

fn asset(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("assets")
        .join(name)
}

fn picture(name: &str) -> Result<Arc<Picture>, Error> {
    Ok(Arc::new(Picture::load(&asset(name))?.0))
}

fn prop(part: Part) -> Prop {
    Prop {
        part,
        stand: Transform::IDENTITY,
        wrap: Beyond::Repeat,
    }
}

/// A place in the world and a turn about an axis there.
fn turned(at: [f32; 3], axis: [f32; 3], angle: f32) -> Result<Transform, Error> {
    let place = Transform::translation(at.map(I16F16::saturating_from_num));
    Transform::rotation(axis, angle)
        .and_then(|turn| place.after(&turn))
        .map_err(|error| Error::core("built-in scene", error))
}

fn turned_crate() -> Result<Scene, Error> {
    Ok(Scene {
        name: "crate".to_owned(),
        view: View {
            eye: [0.0, 0.55, 2.0],
            look: [0.0, -0.05, 0.0],
            up: [0.0, 1.0, 0.0],
            fov_y: 50.0,
            near: 0.125,
        },
        units: 1.0,
        props: vec![Prop {
            stand: turned([0.0; 3], [0.15, 1.0, 0.0], 0.62)?,
            ..prop(shape::cube(&Arc::new(pattern::planks())))
        }],
        cull: Cull::Back,
        depth: false,
    })
}

/// The inside of a box: left and right wall, floor and ceiling, fronts inwards.
fn inside([x0, y0, z0]: [f32; 3], [x1, y1, z1]: [f32; 3]) -> [[[f32; 3]; 4]; 4] {
    [
        [[x0, y1, z1], [x0, y0, z1], [x0, y0, z0], [x0, y1, z0]],
        [[x1, y1, z0], [x1, y0, z0], [x1, y0, z1], [x1, y1, z1]],
        [[x0, y0, z0], [x0, y0, z1], [x1, y0, z1], [x1, y0, z0]],
        [[x0, y1, z1], [x0, y1, z0], [x1, y1, z0], [x1, y1, z1]],
    ]
}

fn corridor() -> Scene {
    let stripes = Arc::new(pattern::stripes());
    let paving = Arc::new(pattern::paving());
    let [left, right, floor, ceiling] = inside([-1.5, 0.0, -24.0], [1.5, 2.6, 1.0]);
    Scene {
        name: "corridor".to_owned(),
        view: View {
            eye: [0.35, 1.35, 0.0],
            look: [-1.0, 1.15, -4.0],
            up: [0.27, 1.0, 0.0],
            fov_y: 60.0,
            near: 0.125,
        },
        units: 1.0,
        props: vec![
            prop(shape::quad(floor, [3.0, 25.0], &paving)),
            prop(shape::quad(ceiling, [3.0, 25.0], &paving)),
            prop(shape::quads(&[left, right], [25.0, 2.0], &stripes)),
        ],
        cull: Cull::Back,
        depth: false,
    }
}

fn sidewalk() -> Scene {
    let (x, y) = (1.5, -0.5);
    let quad = [[-x, y, -10.0], [-x, y, -1.0], [x, y, -1.0], [x, y, -10.0]];
    Scene {
        name: "sidewalk".to_owned(),
        view: View {
            eye: [0.0; 3],
            look: [0.0, -0.1, -1.0],
            up: [0.0, 1.0, 0.0],
            fov_y: 60.0,
            near: 0.125,
        },
        units: 1.0,
        props: vec![prop(shape::quad(
            quad,
            [3.0, 9.0],
            &Arc::new(pattern::paving()),
        ))],
        cull: Cull::Back,
        depth: false,
    }
}

fn checkers() -> Scene {
    let boards: Vec<_> = (0..9)
        .map(|i| {
            let (near, far) = (-1.0 - i as f32, -2.0 - i as f32);
            [
                [-0.5, 0.0, far],
                [-0.5, 0.0, near],
                [0.5, 0.0, near],
                [0.5, 0.0, far],
            ]
        })
        .collect();
    Scene {
        name: "checkers".to_owned(),
        view: View {
            eye: [0.9, 0.55, -0.35],
            look: [-0.1, -0.1, -2.9],
            up: [0.2, 1.0, 0.0],
            fov_y: 55.0,
            near: 0.125,
        },
        units: 1.0,
        props: vec![prop(shape::quads(
            &boards,
            [1.0, 1.0],
            &Arc::new(pattern::checkers()),
        ))],
        cull: Cull::Back,
        depth: false,
    }
}

fn globe() -> Result<Scene, Error> {
    Ok(Scene {
        name: "globe".to_owned(),
        view: View {
            eye: [0.0, 0.5, 2.7],
            look: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            fov_y: 48.0,
            near: 0.5,
        },
        units: 1.0,
        props: vec![Prop {
            stand: turned([0.0; 3], [0.25, 1.0, 0.1], -0.35)?,
            ..prop(shape::sphere(48, 24, &picture("globe/world.png")?))
        }],
        cull: Cull::Back,
        depth: false,
    })
}

fn spot(name: &str, file: &str) -> Result<Scene, Error> {
    let texture = asset("spot/spot_texture.png");
    let model = model::load(&asset("spot").join(file), Some(&texture))?;
    Ok(Scene {
        name: name.to_owned(),
        view: View {
            eye: [-1.5, 0.75, -1.9],
            look: [0.0, 0.0, 0.1],
            up: [0.0, 1.0, 0.0],
            fov_y: 45.0,
            near: 0.5,
        },
        units: 1.0,
        props: model.parts.into_iter().map(prop).collect(),
        cull: Cull::Back,
        depth: true,
    })
}

fn room() -> Result<Scene, Error> {
    let brick = picture("photo/brick.png")?;
    let gravel = picture("photo/gravel.png")?;
    let (low, high) = ([-2.5, 0.0, -8.0], [2.5, 2.8, 3.0]);
    let [left, right, floor, ceiling] = inside(low, high);
    let ([x0, y0, z0], [x1, y1, _]) = (low, high);
    let back = [[x0, y1, z0], [x0, y0, z0], [x1, y0, z0], [x1, y1, z0]];
    let wood = Arc::new(pattern::planks());
    Ok(Scene {
        name: "room".to_owned(),
        view: View {
            eye: [-1.1, 1.5, 1.2],
            look: [0.5, 1.0, -4.0],
            up: [0.04, 1.0, 0.0],
            fov_y: 65.0,
            near: 0.0625,
        },
        units: 1.0,
        props: vec![
            prop(shape::quad(floor, [3.0, 6.0], &gravel)),
            prop(shape::quad(ceiling, [2.0, 4.0], &wood)),
            prop(shape::quads(&[left, right], [5.5, 1.4], &brick)),
            prop(shape::quad(back, [2.5, 1.4], &brick)),
            Prop {
                stand: turned([0.9, 0.5, -2.2], [0.0, 1.0, 0.0], 0.5)?,
                ..prop(shape::cube(&wood))
            },
        ],
        cull: Cull::Back,
        depth: true,
    })
}
