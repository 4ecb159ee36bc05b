//! What can be asked for on the command line.

mod textures;

use std::path::{Path, PathBuf};

use clap::{Args, Parser, Subcommand};
use host_sim::bake::{LEVELS, Levels};
use host_sim::benchmark;
use host_sim::choice::Perspective;
use host_sim::error::Error;
use host_sim::filtering::{AVERAGES, FORMATS, Format, by_name};
use host_sim::frame::Frame;
use host_sim::model;
use host_sim::reference::Beyond;
use host_sim::reference::ideal::SAMPLES;
use host_sim::report::chip::Chip;
use host_sim::scene::Scene;
use host_sim::subject::Subject;
use host_sim::texgen::Projection;
use host_sim::view::View;
use multum::pyramid::average::Average;
use multum::viewport::Viewport;

use textures::Textures;

/// Draws scenes and mesh files with the multum core and checks them against a float64 reference.
///
/// Without a command: renders seven scenes and prints a table of their errors.
#[derive(Debug, Parser)]
#[command(name = "host-sim", version, args_conflicts_with_subcommands = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
    #[command(flatten)]
    pub(crate) overview: Overview,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Writes a texture, or an atlas of several, with its mip levels as Rust source for firmware.
    Bake(Bake),
    /// Draws one scene or mesh file as a PNG.
    Render(Render),
    /// Compares one scene or mesh file with the reference.
    Compare(Compare),
    /// Draws a conformance data set and compares it with the independent renderer's images.
    Conformance(Conformance),
    /// Draws a scene with every filter and compares each with the ideal picture.
    Filters(Filters),
    /// Prints a frame's hash, to compare it with a device's.
    Hash(Hash),
    /// Draws a scene with techniques of the past and counts what they cost.
    Historic(Historic),
    /// Counts the memory lines that spans read from textures in rows and in Morton order.
    Layout(Layout),
    /// Draws every scene with every technique: what each costs on a chip, and what it gets wrong.
    Report(Report),
    /// Lists the built-in scenes.
    Scenes,
    /// Draws hard cases with every strategy and checks each pixel against its derived bound.
    Stability(Stability),
}

#[derive(Args, Debug)]
pub(crate) struct Overview {
    /// Folder for the pictures
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    pub(crate) out: PathBuf,
    /// Perspective correction: affine, affine-within, every:4, 8, 16, 32 or 64, adaptive, constant-z, constant-z-columns, quadratic:16 or 32, extrapolated, subdivided, or exact
    #[arg(long, value_name = "HOW", default_value = "every:16")]
    pub(crate) perspective: Perspective,
    #[command(flatten)]
    pub(crate) textures: Textures,
    /// Size of the pictures in pixels
    #[arg(long, value_name = "WxH", default_value = "320x240", value_parser = size)]
    pub(crate) size: Viewport,
}

#[derive(Args, Debug)]
pub(crate) struct Bake {
    /// PNG or JPEG files; several become one atlas
    #[arg(value_name = "PICTURE", required = true)]
    pub(crate) pictures: Vec<PathBuf>,
    /// The source to write
    #[arg(short, long, value_name = "FILE.rs")]
    pub(crate) output: PathBuf,
    /// The static's name [default: that of FILE in capitals]
    #[arg(long, value_name = "NAME")]
    pub(crate) name: Option<String>,
    /// Texels: rgb565, rgb888, gray8, palette8, palette4, rgba5551, rgba8888, bc1 or morton
    #[arg(long, value_name = "NAME", default_value = "rgb565", value_parser = |s: &str| by_name(&FORMATS, s))]
    pub(crate) format: Format,
    /// How levels are averaged: stored (the numbers) or light (what they stand for in sRGB)
    #[arg(long, value_name = "WHAT", default_value = "stored", value_parser = |s: &str| by_name(&AVERAGES, s))]
    pub(crate) average: Average,
    /// Mip levels: all or one (the finest)
    #[arg(long, value_name = "WHICH", default_value = "all", value_parser = |s: &str| by_name(&LEVELS, s))]
    pub(crate) levels: Levels,
    /// Repeat the edges of each picture of an atlas for at least so many texels around it, for
    /// texture coordinates that lie in the atlas
    #[arg(long, value_name = "N")]
    pub(crate) padding: Option<u32>,
}

#[derive(Args, Debug)]
pub(crate) struct Render {
    #[command(flatten)]
    pub(crate) drawing: Drawing,
    /// Show what is going on instead: uv, level, error or texel-grid
    #[arg(long, value_name = "WHAT")]
    pub(crate) show: Option<View>,
    /// The picture to write [default: out/NAME.png]
    #[arg(short, long, value_name = "FILE.png")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Args, Debug)]
pub(crate) struct Compare {
    #[command(flatten)]
    pub(crate) drawing: Drawing,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
pub(crate) struct Conformance {
    /// The data set: a folder with coverage, texel and filter in it
    pub(crate) dir: PathBuf,
    /// Texel cases: pixels nearer than this to a texel boundary are ties, in texels
    #[arg(long, value_name = "TEXELS", default_value_t = 1.0 / 64.0, value_parser = tolerance)]
    pub(crate) texel_tol: f64,
}

#[derive(Args, Debug)]
pub(crate) struct Filters {
    #[command(flatten)]
    pub(crate) drawing: Drawing,
    /// Samples a pixel of the ideal picture
    #[arg(long, value_name = "N", default_value_t = SAMPLES, value_parser = clap::value_parser!(u32).range(1..=65_536))]
    pub(crate) samples: u32,
    /// A picture to write: the ideal and every filter side by side
    #[arg(short, long, value_name = "FILE.png")]
    pub(crate) output: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
pub(crate) struct Hash {
    #[command(flatten)]
    pub(crate) drawing: Drawing,
}

#[derive(Args, Debug)]
pub(crate) struct Historic {
    /// A built-in scene, or benchmark for all the benchmark scenes
    #[arg(value_name = "SCENE|benchmark")]
    pub(crate) scene: String,
    /// Size of the frame in pixels
    #[arg(long, value_name = "WxH", default_value = "320x240", value_parser = size)]
    pub(crate) size: Viewport,
    /// A picture to write: every:16 and each technique side by side, holes in magenta
    #[arg(short, long, value_name = "FILE.png")]
    pub(crate) output: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
pub(crate) struct Layout {
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
pub(crate) struct Report {
    /// Folder for index.html, report.csv, report.json and plots
    #[arg(short, long, value_name = "DIR", default_value = "report")]
    pub(crate) out: PathBuf,
    /// Write no report: answer which settings keep to --budget-ms and --max-error on this chip
    #[arg(long, value_name = "NAME", conflicts_with_all = ["out", "readme"])]
    pub(crate) chip: Option<Chip>,
    /// Most time for a frame, in milliseconds
    #[arg(long, value_name = "MS", default_value_t = 20.0, value_parser = limit, allow_negative_numbers = true, requires = "chip")]
    pub(crate) budget_ms: f64,
    /// Largest error anywhere, in footprints
    #[arg(long, value_name = "FOOTPRINTS", default_value_t = 0.25, value_parser = limit, allow_negative_numbers = true, requires = "chip")]
    pub(crate) max_error: f64,
    /// Size of the chip's frame in pixels
    #[arg(long, value_name = "WxH", default_value = "320x240", value_parser = size, requires = "chip")]
    pub(crate) size: Viewport,
    /// One benchmark scene instead of all surfaces
    #[arg(long, value_name = "NAME", value_parser = benchmark_scene, requires = "chip")]
    pub(crate) scene: Option<String>,
    /// Write no report: rewrite the README's section and plot
    #[arg(long, conflicts_with = "out")]
    pub(crate) readme: bool,
}

#[derive(Args, Debug)]
pub(crate) struct Stability {
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Only cases whose name starts with this; fuzz:SEED:NUMBER repeats a random one
    #[arg(long, value_name = "NAME", conflicts_with = "fuzz")]
    pub(crate) case: Option<String>,
    /// Random cases instead, for so many seconds
    #[arg(long, value_name = "SECONDS", value_parser = clap::value_parser!(u64).range(1..=604_800))]
    pub(crate) fuzz: Option<u64>,
    /// Seed of the random cases
    #[arg(long, value_name = "S", default_value_t = 1, requires = "fuzz")]
    pub(crate) seed: u64,
}

/// What to draw, and how.
#[derive(Args, Debug)]
pub(crate) struct Drawing {
    /// A built-in scene, or an .obj, .gltf or .glb file
    #[arg(value_name = "SCENE|FILE")]
    subject: String,
    /// Draw the scene as the firmware has it: small textures, and the cow by its control mesh
    #[arg(long)]
    device: bool,
    /// A PNG or JPEG to use instead of the file's textures
    #[arg(long, value_name = "FILE")]
    texture: Option<PathBuf>,
    /// Make texture coordinates from positions, for a file with none or others: planar:x,
    /// planar:y, planar:z, cylindrical or spherical
    #[arg(long, value_name = "HOW")]
    texgen: Option<Projection>,
    /// Size of the frame in pixels
    #[arg(long, value_name = "WxH", default_value = "320x240", value_parser = size)]
    size: Viewport,
    /// Perspective correction: affine, affine-within, every:4, 8, 16, 32 or 64, adaptive, constant-z, constant-z-columns, quadratic:16 or 32, extrapolated, subdivided, or exact
    #[arg(long, value_name = "HOW", default_value = "every:16")]
    pub(crate) perspective: Perspective,
    #[command(flatten)]
    pub(crate) textures: Textures,
    /// Beyond the texture's edges: repeat, clamp or mirror [default: the scene's]
    #[arg(long, value_name = "MODE", value_parser = wrap)]
    wrap: Option<Beyond>,
    /// Depth buffer: none or z16 [default: the scene's]
    #[arg(long, value_name = "KIND", value_parser = depth)]
    depth: Option<bool>,
    /// Draw in bands of so many rows [default: the whole frame]
    #[arg(long, value_name = "ROWS", value_parser = clap::value_parser!(u32).range(1..=1024))]
    band: Option<u32>,
    /// Position of the camera
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    eye: Option<[f32; 3]>,
    /// The point that the camera looks at
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    look: Option<[f32; 3]>,
    /// The direction that is up in the picture
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    up: Option<[f32; 3]>,
    /// Vertical field of view in degrees
    #[arg(long, value_name = "DEG", value_parser = field_of_view)]
    fov: Option<f32>,
}

impl Drawing {
    /// A short name of the subject, for files and titles.
    pub(crate) fn name(&self) -> String {
        Path::new(&self.subject).file_stem().map_or_else(
            || self.subject.clone(),
            |s| s.to_string_lossy().into_owned(),
        )
    }

    /// Rows of a band.
    pub(crate) fn rows(&self) -> u32 {
        self.band.unwrap_or(self.size.height())
    }

    /// The triangles to draw. Notices about the file go to the error stream.
    pub(crate) fn frame(&self) -> Result<Frame, Error> {
        let mut subject = self.subject()?;
        self.place_camera(&mut subject)?;
        let mut frame = subject.frame(self.size)?;
        if let Some(wrap) = self.wrap {
            for batch in &mut frame.batches {
                batch.wrap = wrap;
            }
        }
        if let Some(depth) = self.depth {
            frame.depth = depth;
        }
        Ok(frame)
    }

    fn subject(&self) -> Result<Subject, Error> {
        let path = Path::new(&self.subject);
        if path.extension().is_none() && !path.exists() {
            if self.texture.is_some() {
                return Err(Error::content(
                    "--texture",
                    "built-in scenes have their own textures",
                    "leave it out, or give a mesh file",
                ));
            }
            if self.texgen.is_some() {
                return Err(Error::content(
                    "--texgen",
                    "built-in scenes have their own texture coordinates",
                    "leave it out, or give a mesh file",
                ));
            }
            return if self.device {
                Subject::on_device(&self.subject)
            } else {
                Subject::by_name(&self.subject)
            };
        }
        let texture = self.texture.as_deref();
        let mut model = match self.texgen {
            Some(projection) => model::load_projected(path, texture, projection, [1.0; 2])?,
            None => model::load(path, texture)?,
        };
        for notice in std::mem::take(&mut model.notices) {
            eprintln!("note: {notice}");
        }
        Ok(Subject::World(Scene::of_model(
            &self.name(),
            model,
            self.size,
        )))
    }

    fn place_camera(&self, subject: &mut Subject) -> Result<(), Error> {
        let given =
            self.eye.is_some() || self.look.is_some() || self.up.is_some() || self.fov.is_some();
        match subject {
            Subject::World(scene) => {
                let units = scene.units;
                let view = &mut scene.view;
                if let Some(eye) = self.eye {
                    view.eye = eye.map(|c| c * units);
                    // The automatic near plane may lie behind the mesh as seen from here.
                    view.near = view.near.min(1.0 / 16.0);
                }
                if let Some(look) = self.look {
                    view.look = look.map(|c| c * units);
                }
                view.up = self.up.unwrap_or(view.up);
                view.fov_y = self.fov.unwrap_or(view.fov_y);
                Ok(())
            }
            Subject::Projected(_) if given => Err(Error::content(
                &self.subject,
                "this scene is given after projection and has no camera",
                "leave --eye, --look, --up and --fov out",
            )),
            Subject::Projected(_) => Ok(()),
        }
    }
}

fn size(text: &str) -> Result<Viewport, String> {
    let number = |t: &str| t.trim().parse::<u32>().ok();
    text.split_once(['x', 'X'])
        .and_then(|(w, h)| Some((number(w)?, number(h)?)))
        .and_then(|(w, h)| Viewport::new(w, h).ok())
        .ok_or_else(|| "give WIDTHxHEIGHT, each 1 to 1024, such as 320x240".to_owned())
}

fn wrap(text: &str) -> Result<Beyond, String> {
    match text {
        "repeat" => Ok(Beyond::Repeat),
        "clamp" => Ok(Beyond::Clamp),
        "mirror" => Ok(Beyond::Mirror),
        _ => Err("choose repeat, clamp or mirror".to_owned()),
    }
}

fn depth(text: &str) -> Result<bool, String> {
    match text {
        "none" => Ok(false),
        "z16" => Ok(true),
        _ => Err("choose none or z16".to_owned()),
    }
}

fn vector(text: &str) -> Result<[f32; 3], String> {
    let numbers: Option<Vec<f32>> = text
        .split(',')
        .map(|t| t.trim().parse().ok().filter(|n: &f32| n.is_finite()))
        .collect();
    numbers
        .and_then(|n| n.try_into().ok())
        .ok_or_else(|| "give three numbers, such as 1,0.5,-2".to_owned())
}

fn field_of_view(text: &str) -> Result<f32, String> {
    text.parse()
        .ok()
        .filter(|n| (1.0..=170.0).contains(n))
        .ok_or_else(|| "give degrees from 1 to 170".to_owned())
}

fn limit(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|n: &f64| *n >= 0.0 && n.is_finite())
        .ok_or_else(|| "give a number from 0 on".to_owned())
}

fn benchmark_scene(text: &str) -> Result<String, String> {
    let names = benchmark::SCENES.map(|(name, _)| name);
    if names.contains(&text) {
        Ok(text.to_owned())
    } else {
        Err(format!("choose one of {}", names.join(", ")))
    }
}

fn tolerance(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|n| (0.0..0.5).contains(n))
        .ok_or_else(|| "give texels from 0 to below 0.5".to_owned())
}
