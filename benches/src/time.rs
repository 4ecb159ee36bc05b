//! Wall time, as the bench `time` measures it with Criterion.

use std::collections::HashMap;
use std::io::stderr;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::case::Case;
use crate::error::Error;
use crate::program::run;

/// Nanoseconds of drawing one frame of each case, in Criterion's fastest sample: what others do on the
/// machine can only add to it.
///
/// # Errors
///
/// [`Error::Start`] without Cargo, [`Error::Failed`] if the bench fails, [`Error::Read`] and
/// [`Error::Content`] if it does not leave what it should.
pub fn measure(cases: &[Case]) -> Result<Vec<f64>, Error> {
    let folder = tempfile::tempdir().map_err(|e| Error::read(&std::env::temp_dir(), &e))?;
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command
        .args(["bench", "--locked", "-p", "benches", "--bench", "time"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env("CRITERION_HOME", folder.path())
        .stdout(stderr());
    run(&mut command, "run this with `cargo run`")?;
    let fastest = fastest(folder.path())?;
    cases
        .iter()
        .map(|case| {
            let name = format!("{}/{}", case.scene, case.drawer);
            let time = fastest.get(&name).copied();
            time.ok_or_else(|| Error::content("Criterion", &format!("has no time for {name}")))
        })
        .collect()
}

/// What Criterion 0.8 writes about a benchmark.
#[derive(Deserialize)]
struct Benchmark {
    full_id: String,
}

/// Its samples: so many frames took so many nanoseconds.
#[derive(Deserialize)]
struct Samples {
    iters: Vec<f64>,
    times: Vec<f64>,
}

/// The fastest sample of each benchmark, in nanoseconds a frame.
fn fastest(folder: &Path) -> Result<HashMap<String, f64>, Error> {
    let mut found = HashMap::new();
    for group in folders(folder)? {
        for benchmark in folders(&group)? {
            let new = benchmark.join("new");
            // Beside the benchmarks there may be a summary.
            if !new.is_dir() {
                continue;
            }
            let Benchmark { full_id } = json(&new.join("benchmark.json"))?;
            let Samples { iters, times } = json(&new.join("sample.json"))?;
            let each = times.iter().zip(&iters).map(|(time, frames)| time / frames);
            found.insert(full_id, each.fold(f64::INFINITY, f64::min));
        }
    }
    Ok(found)
}

fn folders(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let failed = |e| Error::read(folder, &e);
    let entries: Vec<_> = std::fs::read_dir(folder)
        .and_then(Iterator::collect)
        .map_err(failed)?;
    let paths = entries.iter().map(std::fs::DirEntry::path);
    Ok(paths.filter(|path| path.is_dir()).collect())
}

fn json<T: DeserializeOwned>(file: &Path) -> Result<T, Error> {
    let text = std::fs::read(file).map_err(|e| Error::read(file, &e))?;
    serde_json::from_slice(&text).map_err(|e| Error::content(&file.display(), &e))
}

#[cfg(test)]
mod tests {
    use super::fastest;

    #[test]
    fn the_fastest_sample_counts() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let new = folder.path().join("wall/euc/new");
        std::fs::create_dir_all(&new)?;
        std::fs::create_dir_all(folder.path().join("wall/report"))?;
        std::fs::write(new.join("benchmark.json"), r#"{"full_id": "wall/euc"}"#)?;
        let samples = r#"{"iters": [2.0, 4.0, 2.0], "times": [20.0, 36.0, 19.0]}"#;
        std::fs::write(new.join("sample.json"), samples)?;
        assert_eq!(fastest(folder.path())?.get("wall/euc"), Some(&9.0));
        Ok(())
    }
}
