//! The report: the README's section, answers, and independence of the number of threads.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use host_sim::benchmark::SCENES;
use host_sim::report::measure::{Extent, Measured, Progress, measure};
use host_sim::report::on_target::Record;
use host_sim::report::page::page;
use host_sim::report::table::{csv, json};
use host_sim::report::{peers, readme};
use multum::viewport::Viewport;

/// Counts the steps.
#[derive(Default)]
struct Steps {
    to_come: AtomicUsize,
    done: AtomicUsize,
}

impl Progress for Steps {
    fn start(&self, steps: usize) {
        self.to_come.store(steps, Ordering::Relaxed);
    }

    fn done(&self, steps: usize) {
        self.done.fetch_add(steps, Ordering::Relaxed);
    }
}

fn record() -> Record {
    Record::of_project().expect("a record")
}

fn measured(names: &[(&str, &str)], size: [u32; 2], extent: Extent) -> Measured {
    let viewport = Viewport::new(size[0], size[1]).expect("a size");
    let steps = Steps::default();
    let measured = measure(names, viewport, extent, &record(), &steps).expect("scenes");
    let [to_come, done] = [&steps.to_come, &steps.done].map(|n| n.load(Ordering::Relaxed));
    assert_eq!(done, to_come, "the bar comes to its end");
    measured
}

#[test]
fn the_readme_has_the_section_that_the_command_writes() {
    let measured = measured(&SCENES, [320, 240], Extent::Coordinates);
    let peers = peers::all().expect("a table");
    let (section, plot) = readme::section(&measured.rows, &peers).expect("a section");
    let remedy = "do `cargo run --release -p host-sim -- report --readme`";
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let text = std::fs::read_to_string(root.join("README.md")).expect("a README");
    assert!(text.contains(&section), "README.md: {remedy}");
    let kept = std::fs::read_to_string(root.join("host-sim/pictures/speed-against-error.svg"));
    assert!(kept.is_ok_and(|kept| kept == plot), "its plot: {remedy}");
}

#[test]
fn everything_is_the_same_with_one_thread_and_with_three() {
    let with_threads = |count: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
        let scenes = [("crate", "a crate"), ("oblique", "a wall")];
        let mut measured = pool
            .expect("threads")
            .install(|| measured(&scenes, [64, 48], Extent::Everything));
        // Times are this machine's.
        for row in &mut measured.rows {
            assert!(row.host_nanoseconds.is_none_or(|n| n > 0.0));
            row.host_nanoseconds = None;
        }
        let peers = peers::all().expect("a table");
        let page = page(&measured, &record(), &peers).expect("a page");
        let csv = csv(&measured.rows).expect("a table");
        let json = json(&measured, &record(), &peers).expect("a document");
        // 2 scenes, 18 strategies, 12 filters, 2 depth modes, and 3 techniques of the past.
        let settings = 2 * (18 * 12 * 2 + 3);
        assert!(measured.rows.len() >= settings, "{}", measured.rows.len());
        (page, csv, json)
    };
    let (one, three) = (with_threads(1), with_threads(3));
    assert!(one == three);
    let (page, csv, json) = one;
    let lines = String::from_utf8(csv).expect("text");
    let columns = lines.lines().next().expect("a header").split(',').count();
    let values: serde_json::Value = serde_json::from_slice(&json).expect("JSON");
    assert_eq!(
        values["rows"].as_array().map(Vec::len),
        Some(lines.lines().count() - 1)
    );
    assert!(columns > 40 && page.contains("</html>"));
}

#[test]
fn a_record_of_other_sources_is_known_for_that() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let [record, budgets] =
        ["benches/on-target.json", "benches/budgets.toml"].map(|f| root.join(f));
    let other = Record::read(&record, &budgets, &root.join("host-sim/src")).expect("a record");
    assert!(!other.is_current());
}

#[test]
fn a_broken_record_says_what_to_do() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("record.json");
    std::fs::write(&path, "{\"rows\": 1}").expect("a file");
    let budgets = root.join("benches/budgets.toml");
    let error = Record::read(&path, &budgets, &root.join("core/src")).expect_err("no record");
    let text = error.to_string();
    assert!(
        text.contains("record.json") && text.contains("firmware/run all bench"),
        "{text}"
    );
    assert_eq!(text.lines().count(), 1);
}
