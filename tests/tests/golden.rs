//! Every scene's frame, bit for bit, as hashes in a table that is part of the repository.
//!
//! A change that moves a pixel on purpose is accepted by
//!
//! ```text
//! MULTUM_ACCEPT=1 cargo test -p tests --test golden
//! ```
//!
//! which writes the table anew; look at the pictures and commit it with the reason.

use std::fmt::Write as _;
use std::path::Path;

use host_sim::choice::Perspective;
use host_sim::filtering::{FORMATS, Filtering, Minify, Per, RATES, name_of};
use host_sim::render::{colours, hash};
use host_sim::shaded::{Pixels, pixels};
use host_sim::subject::{self, Subject};
use multum::viewport::Viewport;

fn table() -> String {
    let viewport = Viewport::new(320, 240).expect("a size in range");
    let mut table = String::new();
    for (name, _) in subject::names() {
        let frame = Subject::by_name(name)
            .and_then(|s| s.frame(viewport))
            .expect("a built-in scene");
        for perspective in Perspective::ALL {
            // Bands of an odd height: whole frames have a test of their own.
            let pixels = colours(&frame, perspective, 17).expect("a frame in range");
            let hash = hash(&pixels, viewport);
            _ = writeln!(
                table,
                "{name:13} 320x240 rgb565 {perspective:9} {hash:016x}",
                perspective = perspective.to_string()
            );
        }
    }
    // Filters and formats as drawn for displays of 16 and of 24 bits.
    for name in ["corridor", "checkers", "globe", "room"] {
        let frame = Subject::by_name(name)
            .and_then(|s| s.frame(viewport))
            .expect("a built-in scene");
        let plain = Filtering::default();
        let filters = Minify::ALL.map(|(_, min)| Filtering::named(min));
        let trilinear = Filtering::named("trilinear".parse().expect("a filter"));
        let formats = FORMATS.map(|(_, format)| Filtering {
            format,
            per: Per::Piece,
            ..trilinear
        });
        for filtering in filters.into_iter().chain(formats).filter(|f| *f != plain) {
            let drawn = pixels(&frame, Perspective::Every(16), 17, &filtering);
            let hash = match drawn.expect("a frame in range") {
                Pixels::Rgb565(pixels) => hash(&pixels, viewport),
                Pixels::Rgb888(pixels) => hash(&pixels, viewport),
            };
            let per = name_of(&RATES, filtering.per);
            _ = writeln!(table, "{name:13} 320x240 {filtering} per {per} {hash:016x}");
        }
    }
    table
}

#[test]
fn frames_are_the_same_to_the_bit() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden/frames.txt");
    let now = table();
    if std::env::var_os("MULTUM_ACCEPT").is_some() {
        assert!(std::env::var_os("CI").is_none(), "CI accepts nothing");
        std::fs::write(&path, &now).expect("the table can be written");
        return;
    }
    let kept = std::fs::read_to_string(&path).expect("tests/golden/frames.txt");
    let moved: Vec<_> = kept
        .lines()
        .zip(now.lines())
        .filter(|(kept, now)| kept != now)
        .map(|(kept, now)| format!("was {kept}\nnow {now}"))
        .collect();
    assert!(
        moved.is_empty(),
        "{}\nto accept, see the head of this file",
        moved.join("\n")
    );
    assert_eq!(kept.lines().count(), now.lines().count());
}
