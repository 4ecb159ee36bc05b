//! What was counted on the chips' cores: `benches/on-target.json`, and the PC's instructions in
//! `benches/budgets.toml`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

use crate::error::Error;
use crate::file;
use crate::report::setting::Setting;

/// The name under which the PC stands among the cores.
pub const PC: &str = "x86-64";

/// How the cycles of a frame were found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum How {
    /// Each executed instruction by the core's documented timing.
    Exact,
    /// By a model of the core's pipeline, without a memory's wait states.
    Estimate,
    /// From instructions, by the cycles an instruction took in the most similar frame whose cycles
    /// are known on this core.
    Scaled,
    /// One cycle an instruction: no model of this core.
    AtLeast,
}

impl std::fmt::Display for How {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Exact => "exact",
            Self::Estimate => "estimate",
            Self::Scaled => "scaled",
            Self::AtLeast => "at least",
        })
    }
}

/// What drawing a frame costs on a core, divided by its pixels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// Instructions a pixel.
    pub instructions: f64,
    /// Cycles a pixel.
    pub cycles: f64,
    /// How the cycles were found.
    pub how: How,
}

/// Instructions of one frame on each core.
#[derive(Clone, Debug, Deserialize)]
struct Row {
    scene: String,
    #[serde(flatten)]
    setting: Setting,
    instructions_per_pixel: BTreeMap<String, f64>,
}

/// Cycles of one frame on one core.
#[derive(Clone, Debug, Deserialize)]
struct Cycles {
    core: String,
    scene: String,
    #[serde(flatten)]
    setting: Setting,
    instructions_per_pixel: f64,
    cycles_per_pixel: Option<f64>,
    how: How,
}

/// The flash of an image that uses one feature more than another.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Flash {
    /// The core.
    pub core: String,
    /// The image.
    pub image: String,
    /// What it does that the previous one does not.
    pub feature: String,
    /// Bytes beyond those of an image that draws nothing.
    pub flash_of_feature: i64,
    /// Bytes beyond the previous image's.
    pub more_than_previous: i64,
}

/// The deepest stack of a call that draws.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Stack {
    /// The core.
    pub core: String,
    /// The setting.
    #[serde(flatten)]
    pub setting: StackSetting,
    /// Bytes that a painted stack shows were used.
    pub bytes: u64,
    /// A bound from the code; none where there is a call that cannot be followed.
    pub at_most: Option<u64>,
}

/// What is drawn where the stack is measured.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct StackSetting {
    /// Strategy.
    pub strategy: String,
    /// Filter.
    pub filter: String,
    /// Depth test.
    pub depth: String,
    /// The function called.
    pub entry: String,
}

/// The file's contents.
#[derive(Clone, Debug, Deserialize)]
struct Contents {
    toolchain: String,
    qemu: String,
    core_sources_sha256: String,
    rows: Vec<Row>,
    #[serde(default)]
    flash: Vec<Flash>,
    #[serde(default)]
    stack: Vec<Stack>,
    #[serde(default)]
    cycles: Vec<Cycles>,
}

/// The tables of `budgets.toml` that are read here.
#[derive(Debug, Deserialize)]
struct Budgets {
    host_instructions_per_pixel: BTreeMap<String, BTreeMap<String, f64>>,
}

/// Everything that was counted.
#[derive(Clone, Debug)]
pub struct Record {
    contents: Contents,
    /// The digest of the core's sources as they are.
    now: String,
}

impl Record {
    /// Reads what the project keeps: the record, the PC's budgets, and the core's sources, of
    /// which the record holds the digest.
    ///
    /// # Errors
    ///
    /// [`Error::Read`] or [`Error::Content`].
    pub fn of_project() -> Result<Self, Error> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        Self::read(
            &root.join("benches/on-target.json"),
            &root.join("benches/budgets.toml"),
            &root.join("core/src"),
        )
    }

    /// Reads a record, budgets and sources.
    ///
    /// # Errors
    ///
    /// [`Error::Read`] or [`Error::Content`].
    pub fn read(record: &Path, budgets: &Path, sources: &Path) -> Result<Self, Error> {
        let broken = |path: &Path, e: &dyn std::fmt::Display, remedy: &str| {
            Error::content(&path.display().to_string(), &e.to_string(), remedy)
        };
        let mut contents: Contents = serde_json::from_slice(&file::read(record)?)
            .map_err(|e| broken(record, &e, "do `firmware/run all bench`"))?;
        let text = String::from_utf8_lossy(&file::read(budgets)?).into_owned();
        let remedy = "do `cargo run --profile bench -p benches -- budgets --accept`";
        let budgets: Budgets =
            toml::from_str(&text).map_err(|e| broken(budgets, &e.message(), remedy))?;
        for (name, instructions) in budgets.host_instructions_per_pixel.into_values().flatten() {
            contents.add(&name, instructions);
        }
        Ok(Self {
            contents,
            now: digest(sources)?,
        })
    }

    /// Whether the core's sources are those that were counted.
    #[must_use]
    pub fn is_current(&self) -> bool {
        self.contents.core_sources_sha256 == self.now
    }

    /// The compiler and the emulator that it was counted with.
    #[must_use]
    pub fn tools(&self) -> [&str; 2] {
        [&self.contents.toolchain, &self.contents.qemu]
    }

    /// Flash of features, in the order of the images.
    #[must_use]
    pub fn flash(&self) -> &[Flash] {
        &self.contents.flash
    }

    /// Stacks.
    #[must_use]
    pub fn stack(&self) -> &[Stack] {
        &self.contents.stack
    }

    /// The texel formats that a scene was counted with, all else as in `setting`.
    pub fn formats<'a>(
        &'a self,
        scene: &'a str,
        setting: &'a Setting,
    ) -> impl Iterator<Item = &'a str> {
        let same = move |row: &&Row| row.scene == scene && row.setting.is_like(setting);
        self.contents
            .rows
            .iter()
            .filter(same)
            .map(|row| row.setting.format.as_str())
    }

    /// What a frame costs on each core that it was counted on.
    #[must_use]
    pub fn costs(&self, scene: &str, setting: &Setting) -> BTreeMap<String, Cost> {
        let rows = self.contents.rows.iter();
        rows.filter(|row| row.scene == scene && row.setting == *setting)
            .flat_map(|row| &row.instructions_per_pixel)
            .map(|(core, instructions)| {
                let cost = self.contents.cost(core, scene, setting, *instructions);
                (core.clone(), cost)
            })
            .collect()
    }
}

impl Contents {
    /// A count on the PC by its name: scene, strategy, filter, depth test, texel format.
    fn add(&mut self, name: &str, instructions: f64) {
        let words: Vec<&str> = name.split(' ').collect();
        let [scene, strategy, filter, depth, format] = words[..] else {
            return;
        };
        // The default bound has no name elsewhere.
        let strategy = strategy.strip_suffix(":0.25").unwrap_or(strategy);
        self.rows.push(Row {
            scene: scene.to_owned(),
            setting: Setting {
                strategy: strategy.to_owned(),
                filter: filter.to_owned(),
                depth: depth.to_owned(),
                format: format.to_owned(),
            },
            instructions_per_pixel: BTreeMap::from([(PC.to_owned(), instructions)]),
        });
    }

    fn cost(&self, core: &str, scene: &str, setting: &Setting, instructions: f64) -> Cost {
        // The more alike the better: scene, strategy, filter, depth test, format.
        let likeness = |cycles: &&Cycles| {
            let (a, b) = (&cycles.setting, setting);
            let [strategy, filter] = [a.strategy == b.strategy, a.filter == b.filter];
            let [depth, format] = [a.depth == b.depth, a.format == b.format];
            let scene = cycles.scene == scene;
            [filter, strategy, depth, scene, format].map(usize::from)
        };
        let known = self
            .cycles
            .iter()
            .filter(|cycles| cycles.core == core && cycles.cycles_per_pixel.is_some())
            .max_by_key(likeness);
        let Some(known) = known else {
            return Cost {
                instructions,
                cycles: instructions,
                how: How::AtLeast,
            };
        };
        let each = known.cycles_per_pixel.unwrap_or_default() / known.instructions_per_pixel;
        let same = known.scene == scene && known.setting == *setting;
        Cost {
            instructions,
            cycles: instructions * each,
            how: if same { known.how } else { How::Scaled },
        }
    }
}

/// SHA-256 of sources: of each, by path, its path, its length and itself. `firmware/run` computes
/// the same.
fn digest(folder: &Path) -> Result<String, Error> {
    let mut names = Vec::new();
    list(folder, &mut names)?;
    let mut named: Vec<(String, PathBuf)> = names
        .into_iter()
        .map(|path| {
            let relative = path.strip_prefix(folder).unwrap_or(&path);
            let parts = relative
                .components()
                .map(|c| c.as_os_str().to_string_lossy());
            (parts.collect::<Vec<_>>().join("/"), path)
        })
        .collect();
    named.sort();
    let mut hash = Sha256::new();
    for (name, path) in named {
        let content = file::read(&path)?;
        hash.update(format!("{name}\0{}\0", content.len()));
        hash.update(content);
    }
    Ok(hash
        .finalize()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect())
}

/// The files of a folder and of those in it.
fn list(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), Error> {
    let failed = |e: std::io::Error| Error::read(folder, &e);
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.is_dir() {
            list(&path, files)?;
        } else {
            files.push(path);
        }
    }
    Ok(())
}
