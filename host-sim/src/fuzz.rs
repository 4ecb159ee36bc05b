//! Random cases: triangles after projection, in clip space and seen by cameras. A case is told by
//! a seed and a number, so that any one of them can be drawn again.

use multum::clip::{ClipVertex, ClipVolume};
use multum::fixed::types::I16F16;
use multum::setup::Cull;
use multum::transform::Transform;
use multum::viewport::Viewport;
use rand::{Rng as _, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::error::Error;
use crate::frame::{Frame, ScreenTriangle, cut};
use crate::hard_case::{blank, frame, triangle};
use crate::reference::Beyond;
use crate::scene::{Prop, Scene, View};
use crate::shape;

/// The guard band, in pixels.
const GUARD: f64 = 1024.0;

/// The case `number` of a seed.
///
/// # Errors
///
/// [`Error::Core`] if the core refuses the case; none does.
pub fn case(seed: u64, number: u64) -> Result<Frame, Error> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(number);
    let random = &mut random;
    let sizes: [u32; 6] = [1, 7, 64, 97, 160, 320];
    let size = [0; 2].map(|_| pick(random, sizes));
    let texture = [0; 2].map(|_| 1 << random.random_range(0..=8));
    let wrap = pick(random, [Beyond::Repeat, Beyond::Clamp, Beyond::Mirror]);
    match random.random_range(0..4) {
        0 | 1 => {
            let triangles = (0..random.random_range(1..=3))
                .map(|_| on_screen(random, size))
                .collect::<Result<_, _>>()?;
            frame(size, texture, wrap, triangles)
        }
        2 => {
            let near = pick(random, [1, 256, 6554, 65_536]);
            let viewport = viewport(size)?;
            let volume = ClipVolume::new(viewport, I16F16::from_bits(near));
            let triangles = cut(&volume, &in_clip_space(random));
            frame(size, texture, wrap, triangles)
        }
        _ => seen(random, size, texture, wrap),
    }
}

fn viewport([width, height]: [u32; 2]) -> Result<Viewport, Error> {
    Viewport::new(width, height).map_err(|e| Error::core("random case", e))
}

fn pick<T: Copy, const N: usize>(random: &mut ChaCha8Rng, choices: [T; N]) -> T {
    choices[random.random_range(0..N)]
}

/// `2^low` to `2^high`, every power alike.
fn scale(random: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    random.random_range(low..=high).exp2()
}

/// Coordinates of three corners on one axis, in repeats: from one unit to 127.99 apart.
fn coordinates(random: &mut ChaCha8Rng) -> [f64; 3] {
    let extent = match random.random_range(0..8) {
        0 => 0.0,
        1 => 127.99,
        2 => 1.0 - 1.0 / 65536.0,
        _ => scale(random, -16.0, 6.99),
    };
    let least = random.random_range(-127.0..=127.0 - extent);
    let whole = random.random_bool(0.5);
    [0; 3].map(|_| {
        let t = if whole {
            f64::from(random.random_range(0..=1u8))
        } else {
            random.random_range(0.0..=1.0)
        };
        least + extent * t
    })
}

/// Depths of three corners, from equal to the whole range of 16.16.
fn depths(random: &mut ChaCha8Rng) -> [f64; 3] {
    let nearest = scale(random, -16.0, 12.0);
    let octaves = pick(random, [0.0, 0.01, 1.0, 4.0, 8.0, 12.0, 20.0, 30.0]);
    [0; 3].map(|_| (nearest * scale(random, 0.0, octaves)).clamp(1.0 / 65536.0, 32767.0))
}

fn on_screen(random: &mut ChaCha8Rng, size: [u32; 2]) -> Result<ScreenTriangle, Error> {
    let extent = pick(random, [0.02, 1.0, 8.0, 60.0, 400.0, 2048.0]);
    let middle = size.map(|s| random.random_range(-0.1..1.1) * f64::from(s));
    let grid = pick(random, [256.0, 256.0, 256.0, 2.0]);
    let mut place = || {
        middle.map(|m| {
            let c = m + extent * random.random_range(-0.5..=0.5);
            ((c * grid).round() / grid).clamp(-GUARD, GUARD)
        })
    };
    let mut positions = [place(), place(), place()];
    // A sliver: the third corner a subpixel or so beside the second.
    if random.random_bool(0.1) {
        let [x, y] = positions[1];
        let mut aside =
            |c: f64| (c + f64::from(random.random_range(-1..=1i8)) / 256.0).clamp(-GUARD, GUARD);
        positions[2] = [aside(x), aside(y)];
    }
    let (w, u, v) = (depths(random), coordinates(random), coordinates(random));
    triangle([0, 1, 2].map(|i| [positions[i][0], positions[i][1], w[i], u[i], v[i]]))
}

/// A triangle that may cross the eye plane, the near plane and the guard band.
fn in_clip_space(random: &mut ChaCha8Rng) -> [ClipVertex; 3] {
    let (u, v) = (coordinates(random), coordinates(random));
    let extent = scale(random, -8.0, 14.0);
    [0, 1, 2].map(|i| {
        let mut number =
            |least: f64| I16F16::saturating_from_num(extent * random.random_range(least..=1.0));
        ClipVertex {
            x: number(-1.0),
            y: number(-1.0),
            w: number(-0.3),
            u: I16F16::saturating_from_num(u[i]),
            v: I16F16::saturating_from_num(v[i]),
        }
    })
}

/// A quad in the world, seen by a camera.
fn seen(
    random: &mut ChaCha8Rng,
    size: [u32; 2],
    texture: [u32; 2],
    wrap: Beyond,
) -> Result<Frame, Error> {
    let extent = scale(random, -2.0, 10.0) as f32;
    let mut direction = || [0; 3].map(|_| random.random_range(-1.0f32..=1.0));
    let (across, down, middle, eye, up) = (
        direction(),
        direction(),
        direction(),
        direction(),
        direction(),
    );
    let corner =
        |s: f32, t: f32| [0, 1, 2].map(|i| extent * (middle[i] + s * across[i] + t * down[i]));
    let corners = [
        corner(-1.0, -1.0),
        corner(-1.0, 1.0),
        corner(1.0, 1.0),
        corner(1.0, -1.0),
    ];
    let repeats = [0; 2].map(|_| scale(random, -4.0, 6.9) as f32);
    let scene = Scene {
        name: "random".to_owned(),
        view: View {
            eye: eye.map(|c| c * extent),
            look: middle.map(|c| c * extent),
            // Never along the view but by a chance that is refused below.
            up,
            fov_y: random.random_range(5.0..=150.0),
            near: pick(random, [1.0 / 256.0, 0.1, 1.0]),
        },
        units: 1.0,
        props: vec![Prop {
            part: shape::quad(corners, repeats, &blank(texture[0], texture[1])?),
            stand: Transform::IDENTITY,
            wrap,
        }],
        cull: Cull::Off,
        depth: false,
    };
    let viewport = viewport(size)?;
    // What the core refuses (a vertex too far out, no direction) is an empty frame.
    Frame::of_scene(&scene, viewport).or_else(|_| frame(size, texture, wrap, Vec::new()))
}
