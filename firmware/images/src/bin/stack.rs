//! Measures how much stack a call takes that draws, triangle by triangle.
#![no_std]
#![no_main]

use images::filters::{Levels, levels, nearest_level, trilinear};
use images::host::{Output, exit};
use images::machine::{entry, singleton};
use images::stack::{Depth, calibrated, deepest};
use multum::clip::{ClipVertex, ClipVolume};
use multum::depth::{NoDepth, Z16};
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::filter::{LinearTexels, LinearTexels5};
use multum::fixed::types::I16F16;
use multum::lod::{EachPiece, EachSpan};
use multum::mipmap::Anisotropic;
use multum::perspective::{Adaptive, Affine, Every, PerPixel, Quadratic, Strategy, Subdivided};
use multum::project::ScreenVertex;
use multum::sample::{Bilinear, Nearest};
use multum::setup::Cull;
use multum::shade::Shader;
use multum::sink::Band;
use multum::texture::Repeat;
use multum::viewport::Viewport;
use scenes_in_flash::benchmark::{HEIGHT, SCENES, WIDTH, corners};

const PIXELS: usize = WIDTH as usize * HEIGHT as usize;
const NEAR: I16F16 = I16F16::ONE;

#[entry]
fn main() -> ! {
    if run().is_none() {
        Output::new().text("error: not drawn, or deeper than can be measured\n");
        exit(false);
    }
    exit(true)
}

fn run() -> Option<()> {
    if !calibrated() {
        Output::new().text("error: of a known stack another depth is measured\n");
        exit(false);
    }
    let pixels = singleton!(: [Rgb565; PIXELS] = [Rgb565::new(0, 0, 0); PIXELS])?;
    let depths = singleton!(: [u16; PIXELS] = [0; PIXELS])?;
    let levels = levels()?;
    let texture = *levels.level(0);
    let nearest = || Nearest::<_, Repeat>::new(texture);
    let size = texture.log2_size();
    let adaptive = Adaptive::new(Adaptive::DEFAULT_BOUND, size);
    let subdivided = Subdivided::new(Subdivided::DEFAULT_BOUND, size);
    let bilinear = Bilinear::<_, Repeat>::new(texture);
    let of_levels = &levels;
    let trilinear_5 = trilinear(of_levels, LinearTexels5, EachPiece);
    let trilinear = || trilinear(of_levels, LinearTexels, EachPiece);

    let mut frame = Frame { pixels, depths };
    frame.plain(["affine", "nearest"], Affine, nearest())?;
    frame.plain(["every:16", "nearest"], Every::<16>, nearest())?;
    frame.plain(["adaptive", "nearest"], adaptive, nearest())?;
    frame.plain(["exact", "nearest"], PerPixel, nearest())?;
    frame.plain(["quadratic:16", "nearest"], Quadratic::<16>, nearest())?;
    frame.plain(["subdivided", "nearest"], subdivided, nearest())?;
    frame.tested(["every:16", "nearest"], Every::<16>, nearest())?;
    frame.tested(["quadratic:16", "nearest"], Quadratic::<16>, nearest())?;
    frame.plain(["every:16", "bilinear"], Every::<16>, bilinear)?;
    frame.plain(["every:16", "trilinear:piece"], Every::<16>, trilinear())?;
    frame.tested(["every:16", "trilinear:piece"], Every::<16>, trilinear())?;
    frame.plain(["every:16", "trilinear:5:piece"], Every::<16>, trilinear_5)?;
    let anisotropic = Anisotropic::<4, _>::new(trilinear());
    frame.plain(
        ["every:16", "anisotropic:4:piece"],
        Every::<16>,
        anisotropic,
    )?;
    frame.clipped(&levels)
}

/// What triangles are drawn to.
struct Frame {
    pixels: &'static mut [Rgb565],
    depths: &'static mut [u16],
}

impl Frame {
    /// Triangles on the screen, without a depth test.
    fn plain<P, S>(&mut self, names: [&str; 2], strategy: P, sampler: S) -> Option<()>
    where
        P: Strategy,
        S: Shader<Texel = Rgb565>,
    {
        let mut pipeline = pipeline(strategy, sampler, NoDepth);
        let mut band = band(self.pixels)?;
        let [strategy, filter] = names;
        scenes([strategy, filter, "none", "triangle"], None, |triangle| {
            deepest(|| pipeline.draw_triangle(&mut band, triangle))
        })
    }

    /// With it.
    fn tested<P, S>(&mut self, names: [&str; 2], strategy: P, sampler: S) -> Option<()>
    where
        P: Strategy,
        S: Shader<Texel = Rgb565>,
    {
        let mut pipeline = pipeline(strategy, sampler, empty(self.depths)?);
        let mut band = band(self.pixels)?;
        let [strategy, filter] = names;
        scenes([strategy, filter, "z16", "triangle"], None, |triangle| {
            deepest(|| pipeline.draw_triangle(&mut band, triangle))
        })
    }

    /// Triangles in clip space: those of the scenes, and such as are cut by each plane.
    fn clipped(&mut self, levels: &Levels) -> Option<()> {
        let sampler = nearest_level(levels, EachSpan);
        let mut pipeline = pipeline(Every::<16>, sampler, empty(self.depths)?);
        let mut band = band(self.pixels)?;
        let volume = ClipVolume::new(Viewport::new(WIDTH, HEIGHT).ok()?, NEAR);
        let mut most = None;
        let mut draw = |vertices: &[ClipVertex; 3]| {
            let mut result = Ok(());
            let depth = deepest(|| {
                result = pipeline.draw(&mut band, &volume, vertices, &[[0, 1, 2]]);
            });
            result.ok().and(depth)
        };
        for a in 0..CUT.len() {
            for b in 0..a {
                for c in 0..b {
                    let [a, b, c] = [a, b, c].map(|i| CUT.get(i).map(clip_vertex));
                    deeper(&mut most, "cut", draw(&[a?, b?, c?])?);
                }
            }
        }
        let names = ["every:16", "nearest-mip-nearest:span", "z16", "clipped"];
        scenes(names, most, |triangle| {
            draw(&triangle.map(|v| unprojected(&v)))
        })
    }
}

/// The depth and the scene that it was first reached in.
type Deepest = Option<(Depth, &'static str)>;

fn deeper(most: &mut Deepest, scene: &'static str, depth: Depth) {
    if most.is_none_or(|(most, _)| depth.bytes > most.bytes) {
        *most = Some((depth, scene));
    }
}

/// Draws each triangle of the scenes and prints a line for the deepest, `most` or deeper. `None` if
/// something fails.
fn scenes(
    names: [&str; 4],
    mut most: Deepest,
    mut draw: impl FnMut(&[ScreenVertex; 3]) -> Option<Depth>,
) -> Option<()> {
    for scene in SCENES {
        for triangle in scene.triangles {
            deeper(&mut most, scene.name, draw(&corners(triangle)?)?);
        }
    }
    let (Depth { bytes, code }, scene) = most?;
    let mut output = Output::new();
    output.text(env!("CHIP"));
    for name in names {
        output.text(" ").text(name);
    }
    output.text(" ").text(scene).text(" ").decimal(bytes);
    output.text(" ").hex(code.into()).text("\n");
    Some(())
}

/// x, y, w, u and v of corners in front of the near plane, on it and behind it, within the guard
/// band and beyond it on all sides.
const CUT: [[i16; 5]; 12] = [
    [0, 0, 4, 0, 0],
    [1, 1, 1, 1, 0],
    [-60, -50, 2, 0, 3],
    [-50, 60, 3, 2, 2],
    [60, -60, 4, 3, 1],
    [50, 50, 5, 1, 3],
    [-90, 0, 6, 3, 3],
    [0, 90, 7, 0, 2],
    [-20, -30, -1, 2, 0],
    [-30, 20, -2, 3, 2],
    [30, -20, -3, 1, 1],
    [20, 30, 0, 2, 3],
];

fn clip_vertex(v: &[i16; 5]) -> ClipVertex {
    let [x, y, w, u, v] = v.map(I16F16::from_num);
    ClipVertex { x, y, w, u, v }
}

/// The vertex in clip space, but for rounding.
fn unprojected(v: &ScreenVertex) -> ClipVertex {
    let along = |position: i32, size: u32| {
        let size = i64::from(size) << 8;
        let twice = (2 * i64::from(position) - size) * i64::from(v.w().to_bits());
        I16F16::from_bits((twice / size) as i32)
    };
    let [u, down] = v.uv();
    ClipVertex {
        x: along(v.x().to_bits(), WIDTH),
        y: -along(v.y().to_bits(), HEIGHT),
        w: v.w(),
        u,
        v: down,
    }
}

fn band<P: Copy>(buffer: &mut [P]) -> Option<Band<'_, P>> {
    Band::new(buffer, WIDTH, HEIGHT, WIDTH as usize, 0).ok()
}

/// An empty depth buffer.
fn empty(buffer: &mut [u16]) -> Option<Z16<'_>> {
    let mut depth = Z16::new(band(buffer)?, NEAR);
    depth.clear();
    Some(depth)
}

fn pipeline<P, S, D>(strategy: P, sampler: S, depth: D) -> Pipeline<P, S, D> {
    Pipeline {
        strategy,
        sampler,
        depth,
        cull: Cull::Off,
    }
}
