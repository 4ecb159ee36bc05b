//! Other renderers' figures for the benchmark scenes, measured once.

use serde::{Deserialize, Serialize};

use crate::error::Error;

/// Where the figures come from.
pub const SOURCE: &str = "Other renderers' figures are of their own code on the same scenes, 320x240 pixels of RGB565 \
    with a texture of 256x256, measured once for this project and not again by this command: Arm code under QEMU, \
    counted by icount; the PC's by callgrind; gcc 12 -O3, or a release build of rustc. Where a count depends on \
    the scene, the lowest is given. `cargo run --profile bench -p benches -- table` measures those that are crates, \
    beside this one.";

/// A renderer's figures for one scene on one core.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Peer {
    /// Its name.
    pub peer: String,
    /// How it draws.
    pub mode: String,
    /// The core, by its name in the record of counts.
    pub core: String,
    /// The scene.
    pub scene: String,
    /// Instructions a pixel.
    pub instructions: f64,
    /// Mean error in level-0 texels, if it was measured.
    pub texels_mean: Option<f64>,
    /// The 99th percentile of it.
    pub texels_p99: Option<f64>,
    /// The largest.
    pub texels_max: Option<f64>,
}

/// All figures.
///
/// # Errors
///
/// [`Error::Content`] if the table in the program is broken.
pub fn all() -> Result<Vec<Peer>, Error> {
    csv::Reader::from_reader(include_bytes!("peers.csv").as_slice())
        .deserialize()
        .collect::<Result<_, _>>()
        .map_err(|e| Error::content("peers.csv", &e.to_string(), "correct that line"))
}

#[cfg(test)]
mod tests {
    use super::all;

    #[test]
    fn the_table_is_read_whole() {
        let peers = all().expect("a table");
        assert_eq!(peers.len(), include_str!("peers.csv").lines().count() - 1);
        assert!(peers.iter().all(|p| p.instructions > 1.0));
    }
}
