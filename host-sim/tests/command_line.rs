//! The program as a user calls it: what it writes and prints, and what it says of bad input.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

fn host_sim(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_host-sim"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts")
}

fn folder() -> TempDir {
    TempDir::new().expect("a temporary folder")
}

fn asset(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("assets")
        .join(name);
    path.to_str().expect("a path in UTF-8").to_owned()
}

fn decoded(path: &Path) -> image::RgbImage {
    image::open(path).expect("a PNG").into_rgb8()
}

/// Runs it, expects success and gives what it printed.
fn printed(folder: &Path, arguments: &[&str]) -> String {
    let output = host_sim(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {output:?}");
    String::from_utf8(output.stdout).expect("text")
}

/// Runs it, expects a refusal in one line with these words, exit code 2 and no file.
fn refused(arguments: &[&str], words: &[&str]) {
    let folder = folder();
    refused_in(folder.path(), arguments, words);
    let left: Vec<_> = std::fs::read_dir(folder.path())
        .expect("a folder")
        .collect();
    assert!(left.is_empty(), "{arguments:?} left {left:?}");
}

fn refused_in(folder: &Path, arguments: &[&str], words: &[&str]) {
    let output = host_sim(folder, arguments);
    let text = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {text}");
    assert_eq!(text.lines().count(), 1, "{arguments:?}: {text}");
    assert!(text.starts_with("error: "), "{arguments:?}: {text}");
    for word in words {
        assert!(text.contains(word), "{arguments:?}: no '{word}' in {text}");
    }
    assert!(output.stdout.is_empty(), "{arguments:?}");
}

/// As `head` does it.
#[cfg(unix)]
#[test]
fn a_reader_that_leaves_early_is_no_error() {
    let folder = folder();
    let mut child = Command::new(env!("CARGO_BIN_EXE_host-sim"))
        .args(["compare", "oblique", "--json"])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    // Before anything is printed: a frame is drawn first.
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("the program ends");
    let text = String::from_utf8(output.stderr).expect("text");
    assert_eq!(text, "", "{}", output.status);
}

/// The beginning of a PNG that claims a size: signature and header chunk, no pixels.
fn png_header(folder: &Path, width: u32, height: u32) -> PathBuf {
    let mut chunk = b"IHDR".to_vec();
    chunk.extend(width.to_be_bytes());
    chunk.extend(height.to_be_bytes());
    chunk.extend([8, 2, 0, 0, 0]);
    // CRC-32 as in the PNG specification, annex D.
    let crc = !chunk.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| {
            if c & 1 == 1 {
                0xEDB8_8320 ^ (c >> 1)
            } else {
                c >> 1
            }
        })
    });
    let mut bytes = b"\x89PNG\r\n\x1a\n\0\0\0\x0d".to_vec();
    bytes.extend(chunk);
    bytes.extend(crc.to_be_bytes());
    let path = folder.join(format!("{width}x{height}.png"));
    std::fs::write(&path, bytes).expect("a file");
    path
}

#[test]
fn without_arguments_every_scene_is_drawn_and_tabulated() {
    let folder = folder();
    let text = printed(folder.path(), &[]);
    for scene in [
        "crate", "corridor", "sidewalk", "checkers", "globe", "spot", "room",
    ] {
        let row = text.lines().find(|l| l.starts_with(&format!("| {scene} ")));
        let cells: Vec<_> = row.expect(scene).split('|').map(str::trim).collect();
        assert_eq!(cells.len(), 16, "{scene}");
        assert_eq!(cells[4], "0", "coverage mismatches of {scene}");
        for suffix in ["", "-reference"] {
            let path = folder.path().join(format!("out/{scene}{suffix}.png"));
            assert_eq!(decoded(&path).dimensions(), (320, 240));
        }
        // The heat map has its legend below.
        let map = decoded(&folder.path().join(format!("out/{scene}-error.png")));
        assert!(map.width() == 320 && map.height() > 240);
    }
}

#[test]
fn the_readme_shows_what_the_program_draws_and_prints() {
    let folder = folder();
    let text = printed(folder.path(), &[]);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let readme = std::fs::read_to_string(root.join("README.md")).expect("README.md");
    // All columns but the last, which is a time.
    let cells = |line: &str| -> Vec<String> {
        let mut cells: Vec<_> = line.split('|').map(|c| c.trim().to_owned()).collect();
        cells.truncate(cells.len() - 2);
        cells
    };
    let table = |text: &str| -> Vec<Vec<String>> {
        text.lines()
            .skip_while(|l| !l.starts_with("| scene"))
            .take_while(|l| l.starts_with('|'))
            .filter(|l| !l.starts_with("|-"))
            .map(cells)
            .collect()
    };
    assert_eq!(table(&text).len(), 8);
    assert_eq!(
        table(&readme),
        table(&text),
        "copy the table into README.md"
    );
    for scene in ["spot", "room"] {
        let shown = decoded(&root.join(format!("host-sim/pictures/{scene}.png")));
        let drawn = decoded(&folder.path().join(format!("out/{scene}.png")));
        assert!(shown == drawn, "copy out/{scene}.png to host-sim/pictures");
    }
}

/// The lines of the first table that starts with this header.
fn table_of(text: &str, header: &str) -> Vec<String> {
    text.lines()
        .skip_while(|l| !l.starts_with(header))
        .take_while(|l| l.starts_with('|'))
        .map(str::to_owned)
        .collect()
}

#[test]
fn the_readme_shows_the_filters_as_they_are_drawn() {
    let folder = folder();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let readme = std::fs::read_to_string(root.join("README.md")).expect("README.md");
    let arguments = [
        "filters",
        "checkers",
        "--perspective",
        "exact",
        "-o",
        "filters.png",
    ];
    for (arguments, header, rows) in [
        (&arguments as &[&str], "| filter ", 14),
        (&["layout"], "| degrees ", 9),
    ] {
        let table = table_of(&printed(folder.path(), arguments), header);
        assert_eq!(table.len(), rows, "{arguments:?}");
        assert_eq!(table_of(&readme, header), table, "copy it into README.md");
    }
    let shown = decoded(&root.join("host-sim/pictures/filters.png"));
    let drawn = decoded(&folder.path().join("filters.png"));
    assert!(shown == drawn, "copy filters.png to host-sim/pictures");
}

#[test]
fn a_mesh_file_is_framed_and_options_change_the_picture() {
    let folder = folder();
    let barrel = asset("kaykit/barrel_large.obj");
    let draw = |name: &str, more: &[&str]| {
        let mut arguments = vec!["render", &barrel, "-o", name];
        arguments.extend(more);
        printed(folder.path(), &arguments);
        decoded(&folder.path().join(name))
    };
    let plain = draw("plain.png", &[]);
    assert_eq!(plain.dimensions(), (320, 240));
    // It is in the middle, and nothing of it touches the rim.
    let background = *plain.get_pixel(0, 0);
    assert_ne!(*plain.get_pixel(160, 120), background);
    let rim = (0..320).flat_map(|x| [(x, 0), (x, 239)]);
    let rim = rim.chain((0..240).flat_map(|y| [(0, y), (319, y)]));
    for (x, y) in rim {
        assert_eq!(*plain.get_pixel(x, y), background);
    }
    // In a tall frame neither.
    let tall = draw("tall.png", &["--size", "100x300"]);
    for y in 0..300 {
        assert_eq!(*tall.get_pixel(0, y), background);
        assert_eq!(*tall.get_pixel(99, y), background);
    }
    assert_eq!(draw("bands.png", &["--band", "7"]), plain);
    assert_ne!(
        draw("affine.png", &["--perspective", "affine"]),
        draw("exact.png", &["--perspective", "exact"])
    );
    assert_ne!(draw("flat.png", &["--depth", "none"]), plain);
    assert_ne!(
        draw(
            "turned.png",
            &[
                "--eye", "-3,2,1", "--look", "0,1,0", "--up", "0,1,0", "--fov", "60"
            ]
        ),
        plain
    );
    let brick = asset("photo/brick.png");
    assert_ne!(draw("brick.png", &["--texture", &brick]), plain);
}

#[test]
fn texture_coordinates_can_be_made_from_positions() {
    let folder = folder();
    // A quad without any, upright and facing the camera, and one with some that are wrong.
    let quad = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";
    std::fs::write(folder.path().join("bare.obj"), format!("{quad}f 1 2 3 4\n")).expect("a file");
    let wrong = format!("{quad}vt 7 7\nf 1/1 2/1 3/1 4/1\n");
    std::fs::write(folder.path().join("wrong.obj"), wrong).expect("a file");
    let right = format!("{quad}vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
    std::fs::write(folder.path().join("right.obj"), right).expect("a file");
    let map = asset("globe/world.png");
    let draw = |file: &str, more: &[&str]| {
        let mut arguments = vec!["render", file, "--texture", &map, "-o", "a.png"];
        arguments.extend(more);
        printed(folder.path(), &arguments);
        decoded(&folder.path().join("a.png"))
    };
    let right = draw("right.obj", &[]);
    assert_ne!(draw("wrong.obj", &[]), right);
    for file in ["bare.obj", "wrong.obj"] {
        assert_eq!(draw(file, &["--texgen", "planar:z"]), right);
        assert_ne!(draw(file, &["--texgen", "spherical"]), right);
    }
}

#[test]
fn wrap_modes_change_what_lies_beyond_the_texture() {
    let folder = folder();
    let draw = |wrap: &str| {
        let name = format!("{wrap}.png");
        printed(
            folder.path(),
            &["render", "oblique", "--wrap", wrap, "-o", &name],
        );
        decoded(&folder.path().join(name))
    };
    let (repeat, clamp, mirror) = (draw("repeat"), draw("clamp"), draw("mirror"));
    // Only the first repeat, left of u = 1 and above v = 1, is the same in all.
    assert_eq!(repeat.get_pixel(40, 40), clamp.get_pixel(40, 40));
    assert_eq!(repeat.get_pixel(40, 40), mirror.get_pixel(40, 40));
    assert!(repeat != clamp && repeat != mirror && clamp != mirror);
}

#[test]
fn comparing_prints_numbers_for_people_and_for_machines() {
    let folder = folder();
    let text = printed(
        folder.path(),
        &["compare", "oblique", "--perspective", "exact"],
    );
    assert!(text.contains("coverage mismatches") && text.contains("all pixels equal"));
    let json = printed(
        folder.path(),
        &["compare", "oblique", "--perspective", "every:16", "--json"],
    );
    let value: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(value["pixels"], 320 * 240);
    for key in ["coverage_mismatches", "double_draws", "gaps"] {
        assert_eq!(value[key], 0, "{key}");
    }
    for unit in ["texels", "footprints"] {
        for key in ["max", "p99", "mean"] {
            assert!(value["uv_error"][unit][key].is_f64(), "{unit} {key}");
        }
    }
    // Wrong by texels, so the colours differ too.
    assert!(value["uv_error"]["texels"]["max"].as_f64() > Some(1.0));
    assert!(value["psnr"].as_f64().is_some());
}

#[test]
fn a_scene_has_one_hash_for_all_bands_and_another_for_another_size() {
    let folder = folder();
    let hash = |more: &[&str]| {
        let mut arguments = vec!["hash", "room"];
        arguments.extend(more);
        printed(folder.path(), &arguments)
    };
    assert_eq!(hash(&[]), hash(&["--band", "16"]));
    assert_ne!(hash(&[]), hash(&["--device"]));
    assert!(hash(&["--size", "64x48"]).starts_with("frame room 64x48 "));
}

#[test]
fn filters_and_formats_are_chosen_by_flags() {
    let folder = folder();
    let render = |name: &str, more: &[&str]| {
        let mut arguments = vec!["render", "corridor", "--size", "64x48", "-o", name];
        arguments.extend(more);
        printed(folder.path(), &arguments);
        decoded(&folder.path().join(name))
    };
    let plain = render("plain.png", &[]);
    let mut others = vec![];
    for more in [
        &["--filter", "trilinear"] as &[&str],
        &["--filter", "trilinear", "--lod-choice", "safest"],
        &["--filter", "trilinear", "--lod-bias", "-1"],
        &["--filter", "trilinear", "--lod-per", "triangle"],
        &["--filter", "trilinear", "--lod-rule", "euclidean"],
        &[
            "--filter",
            "trilinear",
            "--lod-bias",
            "-3",
            "--mag",
            "nearest",
        ],
        &["--filter", "trilinear", "--average", "light"],
        &["--filter", "aniso:4"],
        &["--format", "palette4"],
        &["--format", "rgb888"],
        &["--show", "uv"],
        &["--show", "texel-grid"],
    ] {
        let picture = render("other.png", more);
        assert_eq!(picture.dimensions(), plain.dimensions(), "{more:?}");
        assert_ne!(picture, plain, "{more:?}");
        assert!(!others.contains(&picture), "{more:?} changes nothing");
        others.push(picture);
    }
    // Morton order is another place for the same texels.
    assert_eq!(render("morton.png", &["--format", "morton"]), plain);
    // With a legend below.
    let level = render("level.png", &["--filter", "trilinear", "--show", "level"]);
    assert!(level.height() > plain.height());
}

#[test]
fn the_study_of_filters_prints_each_and_draws_all_side_by_side() {
    let folder = folder();
    let arguments = [
        "filters",
        "checkers",
        "--size",
        "64x48",
        "--samples",
        "16",
        "-o",
        "sheet.png",
    ];
    let text = printed(folder.path(), &arguments);
    for name in [
        "nearest",
        "bilinear",
        "bilinear:5",
        "trilinear",
        "trilinear:5",
        "aniso:8",
        "linear-mip-safest",
    ] {
        assert!(text.contains(&format!("| {name} ")), "{text}");
    }
    assert!(decoded(&folder.path().join("sheet.png")).width() > 3 * 64);
    let json = printed(
        folder.path(),
        &["filters", "checkers", "--size", "64x48", "--json"],
    );
    let document: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(document["filters"].as_array().map(Vec::len), Some(12));
}

#[test]
fn impossible_choices_of_filters_are_refused() {
    refused(
        &["render", "crate", "--lod-choice", "safest"],
        &["--lod-choice", "no levels", "trilinear"],
    );
    refused(&["render", "crate", "--filter", "cubic"], &["trilinear"]);
    refused(&["render", "crate", "--format", "rgb332"], &["rgb565"]);
    refused(&["render", "crate", "--lod-bias", "99"], &["-16 to 16"]);
    refused(&["render", "crate", "--show", "normals"], &["texel-grid"]);
    refused(
        &["filters", "crate", "--filter", "bilinear"],
        &["--filter", "every filter"],
    );
}

#[test]
fn memory_lines_are_counted() {
    let folder = folder();
    let text = printed(folder.path(), &["layout"]);
    assert!(text.contains("Morton, 32 bytes"), "{text}");
    assert_eq!(text.lines().filter(|l| l.starts_with("| ")).count(), 8);
}

#[test]
fn conformance_passes_in_all_families() {
    let folder = folder();
    let set = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/conformance");
    let set = set.to_str().expect("a path in UTF-8");
    let text = printed(folder.path(), &["conformance", set]);
    let families: Vec<_> = text.lines().filter(|line| line.ends_with(" 0")).collect();
    for (family, line) in ["coverage", "coverage", "coverage", "texel", "filter", "lod"]
        .iter()
        .zip(&families)
    {
        assert!(line.starts_with(family), "{text}");
    }
    assert_eq!(families.len(), 6, "{text}");
}

#[test]
fn a_conformance_set_that_was_tampered_with_fails() {
    let folder = folder();
    let set = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/conformance");
    for part in ["coverage", "texel", "filter"] {
        std::fs::create_dir(folder.path().join(part)).expect("a folder");
        for file in std::fs::read_dir(set.join(part)).expect("the set") {
            let file = file.expect("a file");
            let copy = folder.path().join(part).join(file.file_name());
            std::fs::copy(file.path(), copy).expect("a copy");
        }
    }
    let sheet = folder.path().join("coverage/tri64.png");
    let mut image = image::open(&sheet).expect("a PNG").into_luma8();
    let pixel = image.get_pixel_mut(32, 32);
    pixel.0[0] = 255 - pixel.0[0];
    image.save(&sheet).expect("saved");
    let output = host_sim(folder.path(), &["conformance", "."]);
    assert_eq!(output.status.code(), Some(1));
    let text = String::from_utf8(output.stdout).expect("text");
    let row = text.lines().find(|l| l.starts_with("coverage tri64"));
    assert!(row.expect("a row").ends_with(" 1"), "{text}");
}

#[test]
fn unknown_names_and_wrong_options_are_refused_in_one_line() {
    refused(&["render", "nope"], &["nope", "choose", "crate"]);
    refused(&["frobnicate"], &["frobnicate"]);
    refused(&["render"], &["SCENE"]);
    refused(
        &["render", "crate", "--perspective", "every:5"],
        &["every:5", "every:16"],
    );
    refused(
        &["render", "crate", "--wrap", "round"],
        &["round", "mirror"],
    );
    refused(&["render", "crate", "--depth", "z24"], &["z24", "z16"]);
    refused(
        &["render", "crate", "--eye", "1,2"],
        &["1,2", "three numbers"],
    );
    refused(
        &["render", "crate", "--eye", "1,2,nan"],
        &["nan", "three numbers"],
    );
    refused(&["render", "crate", "--fov", "190"], &["190", "1 to 170"]);
    refused(
        &["render", "crate", "--eye", "0,0,0", "--look", "0,0,0"],
        &["crate", "direction"],
    );
    refused(&["render", "wall", "--fov", "50"], &["wall", "no camera"]);
    refused(&["render", "crate", "--texture", "a.png"], &["--texture"]);
    refused(
        &["render", "crate", "--texgen", "spherical"],
        &["--texgen", "mesh file"],
    );
    refused(
        &["render", "a.obj", "--texgen", "conical"],
        &["conical", "cylindrical"],
    );
    refused(&["render", "crate", "-o", "a.jpg"], &["a.jpg", ".png"]);
    refused(&["conformance", "missing"], &["missing", "cannot be read"]);
    refused(
        &["conformance", ".", "--texel-tol", "2"],
        &["texel-tol", "0.5"],
    );
}

#[test]
fn sizes_of_zero_or_beyond_the_guard_band_are_refused() {
    for size in [
        "0x240",
        "320x0",
        "1025x240",
        "320x20000",
        "320",
        "-1x5",
        "axb",
        "99999999999x1",
    ] {
        refused(
            &["render", "crate", &format!("--size={size}")],
            &["--size", "1 to 1024"],
        );
    }
    for band in ["0", "1025", "x"] {
        refused(&["render", "crate", "--band", band], &["--band"]);
    }
}

#[test]
fn files_that_cannot_be_used_are_refused() {
    let folder = folder();
    let write = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).expect("a file");
    };
    write("broken.glb", "glTF but not really");
    write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write(
        "textured.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n",
    );
    write("picture.png", "not a picture");
    let none = png_header(folder.path(), 0, 0);
    let huge = png_header(folder.path(), 20_000, 20_000);
    let before = std::fs::read_dir(folder.path()).expect("a folder").count();
    let refused = |arguments: &[&str], words: &[&str]| refused_in(folder.path(), arguments, words);

    refused(
        &["render", "missing.obj"],
        &["missing.obj", "cannot be read"],
    );
    refused(&["render", "broken.glb"], &["broken.glb"]);
    refused(
        &["render", "flat.obj"],
        &["flat.obj", "texture coordinates"],
    );
    refused(&["render", "textured.obj"], &["textured.obj", "--texture"]);
    refused(
        &["render", "textured.obj", "--texture", "picture.png"],
        &["picture.png"],
    );
    refused(
        &["render", "textured.obj", "--texture", "gone.png"],
        &["gone.png"],
    );
    for picture in [none, huge] {
        let picture = picture.to_str().expect("a path in UTF-8");
        refused(
            &["render", "textured.obj", "--texture", picture],
            &[picture],
        );
    }
    let after = std::fs::read_dir(folder.path()).expect("a folder").count();
    assert_eq!(before, after, "something was written");
}

#[test]
fn a_picture_that_cannot_be_written_leaves_the_old_one() {
    let folder = folder();
    std::fs::write(folder.path().join("old.png"), "precious").expect("a file");
    // A file where a folder would have to be.
    refused_in(
        folder.path(),
        &["render", "crate", "-o", "old.png/new.png"],
        &["cannot be written"],
    );
    let kept = std::fs::read(folder.path().join("old.png")).expect("still there");
    assert_eq!(kept, b"precious");
}

/// The pictures and texts of the tests crate, which compiles the texts and compares their texels.
fn baked(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../tests/baked")
        .join(name)
}

/// Each file there and how it is made.
const BAKED: [(&str, &str); 15] = [
    ("rgb565.rs", "picture.png --format rgb565"),
    ("rgb888.rs", "picture.png --format rgb888"),
    ("gray8.rs", "picture.png --format gray8"),
    ("palette8.rs", "picture.png --format palette8"),
    ("palette4.rs", "picture.png --format palette4"),
    ("rgba5551.rs", "picture.png --format rgba5551"),
    ("rgba8888.rs", "picture.png --format rgba8888"),
    ("bc1.rs", "picture.png --format bc1"),
    ("morton.rs", "picture.png --format morton"),
    ("light.rs", "picture.png --average light"),
    ("rgb565_one.rs", "picture.png --levels one"),
    (
        "palette4_one.rs",
        "picture.png --format palette4 --levels one",
    ),
    ("bc1_one.rs", "picture.png --format bc1 --levels one"),
    ("atlas_of_two.rs", "picture.png square.png --name ATLAS"),
    (
        "padded.rs",
        "picture.png square.png --padding 1 --levels one --format rgb888",
    ),
];

#[test]
fn baking_writes_the_text_that_the_tests_crate_compiles() {
    let folder = folder();
    for (file, how) in BAKED {
        let words = how.split(' ').map(|word| {
            if word.ends_with(".png") {
                baked(word).to_str().expect("a path in UTF-8").to_owned()
            } else {
                word.to_owned()
            }
        });
        let mut arguments = vec!["bake".to_owned(), "-o".to_owned(), file.to_owned()];
        arguments.extend(words);
        let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
        let line = printed(folder.path(), &arguments);
        assert_eq!(line.lines().count(), 1, "{line}");
        assert!(line.starts_with(&format!("{file}: ")), "{line}");
        let text = std::fs::read_to_string(folder.path().join(file)).expect("written");
        let kept = std::fs::read_to_string(baked(file)).expect("committed");
        assert_eq!(
            text, kept,
            "in tests/baked run: host-sim bake -o {file} {how}"
        );
    }
    let line = printed(
        folder.path(),
        &[
            "bake",
            &asset("photo/brick.png"),
            "-o",
            "b.rs",
            "--format",
            "bc1",
        ],
    );
    // Blocks of 16 texels: 128^2 + 64^2 + ... + 1, and one each for 2x2 and 1x1.
    assert_eq!(line, "b.rs: 512x512, 10 levels, 174776 bytes in flash\n");
}

#[test]
fn textures_that_cannot_be_baked_are_refused() {
    let folder = folder();
    std::fs::write(folder.path().join("broken.png"), "not a picture").expect("a file");
    std::fs::write(folder.path().join("old.rs"), "precious").expect("a file");
    let empty = png_header(folder.path(), 0, 0);
    let empty = empty.to_str().expect("a path in UTF-8");
    let huge = png_header(folder.path(), 20_000, 20_000);
    let huge = huge.to_str().expect("a path in UTF-8");
    let before = std::fs::read_dir(folder.path()).expect("a folder").count();
    let picture = baked("picture.png");
    let picture = picture.to_str().expect("a path in UTF-8");
    let refused = |arguments: &[&str], words: &[&str]| {
        let mut all = vec!["bake"];
        all.extend(arguments);
        refused_in(folder.path(), &all, words);
    };

    refused(&["-o", "t.rs"], &["PICTURE"]);
    refused(&[picture], &["--output"]);
    refused(&["gone.png", "-o", "t.rs"], &["gone.png", "cannot be read"]);
    refused(&["broken.png", "-o", "t.rs"], &["broken.png"]);
    for bad in [empty, huge] {
        refused(&[bad, "-o", "t.rs"], &[bad]);
        refused(&[picture, bad, "-o", "old.rs"], &[bad]);
    }
    refused(&[picture, "-o", "t.txt"], &["t.txt", ".rs"]);
    refused(&[picture, "-o", "t"], &["t: ", ".rs"]);
    refused(&[picture, "-o", "3d.rs"], &["'3D'", "--name"]);
    for name in ["brick", "a b", "", "A\nB", "fn"] {
        refused(
            &[picture, "-o", "t.rs", "--name", name],
            &["--name", "BRICK_WALL"],
        );
    }
    refused(
        &[picture, "-o", "crate.rs", "--format", "palette4"],
        &["'crate'", "keyword", "--name"],
    );
    refused(
        &[picture, picture, "-o", "t.rs", "--name", "RECTANGLES"],
        &["RECTANGLES"],
    );
    refused(
        &[picture, "-o", "t.rs", "--padding", "2"],
        &["--padding", "several"],
    );
    refused(
        &[picture, picture, "-o", "t.rs", "--padding", "4000"],
        &["4000", "pad less"],
    );
    refused(
        &[picture, picture, "-o", "t.rs", "--padding", "-1"],
        &["-1"],
    );
    refused(&[picture, "-o", "t.rs", "--format", "rgb332"], &["rgb565"]);
    refused(&[picture, "-o", "t.rs", "--levels", "two"], &["all, one"]);
    refused(&[picture, "-o", "t.rs", "--average", "dark"], &["stored"]);
    refused(&[picture, "-o", "old.rs/t.rs"], &["cannot be written"]);
    let after = std::fs::read_dir(folder.path()).expect("a folder").count();
    assert_eq!(before, after, "something was written");
    let kept = std::fs::read(folder.path().join("old.rs")).expect("still there");
    assert_eq!(kept, b"precious");
}

#[test]
fn a_report_answers_and_refuses() {
    let folder = folder();
    let question = ["report", "--chip", "stm32f405", "--scene", "oblique"];
    let limits = ["--budget-ms", "20", "--max-error", "0.5"];
    let text = printed(folder.path(), &[&question[..], &limits].concat());
    assert!(text.contains("STM32F405 (Cortex-M4, 168 MHz)"), "{text}");
    let fits = text.lines().find(|line| line.contains("every:16"));
    assert!(fits.is_some_and(|line| line.contains("ms left")), "{text}");
    // A tenth of a millisecond is not enough for anything.
    let text = printed(
        folder.path(),
        &[&question[..], &["--budget-ms", "0.1"]].concat(),
    );
    assert!(text.contains("nothing stays within 0.1 ms"), "{text}");

    refused(&["report", "--chip", "z80"], &["rp2040", "esp32-c3"]);
    refused(
        &["report", "--chip", "rp2040", "--budget-ms", "-1"],
        &["from 0 on"],
    );
    refused(
        &["report", "--chip", "rp2040", "--max-error", "NaN"],
        &["from 0 on"],
    );
    refused(
        &["report", "--chip", "rp2040", "--scene", "spot"],
        &["oblique", "mesh"],
    );
    refused(&["report", "--chip", "rp2040", "--readme"], &["--readme"]);
    refused(&["report", "--budget-ms", "20"], &["--chip"]);
    // At once, not after minutes of work.
    std::fs::write(folder.path().join("taken"), "").expect("a file");
    refused_in(
        folder.path(),
        &["report", "-o", "taken"],
        &["taken", "cannot be written", "-o"],
    );
}
