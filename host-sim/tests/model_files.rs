//! Pictures and meshes from files: what is loaded, and what is said about files that are refused.

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use host_sim::model::{self, Model};
use host_sim::picture::Picture;
use host_sim::texgen::{Axis, Projection};
use image::{DynamicImage, ImageFormat, Rgb, RgbImage, RgbaImage};
use multum::geometry::Mesh;
use tempfile::TempDir;

fn asset(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("assets")
        .join(name)
}

/// A directory with these files in it.
fn directory(files: &[(&str, &[u8])]) -> TempDir {
    let directory = TempDir::new().unwrap();
    for (name, bytes) in files {
        fs::write(directory.path().join(name), bytes).unwrap();
    }
    directory
}

/// Loads and checks what holds for every model.
fn loaded(path: &Path, texture: Option<&Path>) -> Model {
    let model = model::load(path, texture).unwrap_or_else(|e| panic!("{e}"));
    assert!(!model.parts.is_empty());
    for part in &model.parts {
        Mesh::new(&part.vertices, &part.triangles).unwrap();
        assert!(!part.triangles.is_empty());
        for vertex in &part.vertices {
            let squared: f32 = (0..3)
                .map(|axis| (vertex.position[axis].to_num::<f32>() - model.centre[axis]).powi(2))
                .sum();
            assert!(squared.sqrt() <= model.radius + 1e-3);
        }
    }
    for notice in &model.notices {
        assert!(!notice.contains('\n'), "{notice:?}");
    }
    model
}

/// The message for a file that cannot be loaded: one line that names the file.
fn refused(path: &Path, texture: Option<&Path>) -> String {
    let error = model::load(path, texture).expect_err("loaded").to_string();
    assert!(!error.contains('\n'), "{error:?}");
    let directory = path.parent().unwrap().display().to_string();
    assert!(error.starts_with(&directory), "{error}");
    error[directory.len()..].trim_start_matches('/').to_owned()
}

/// The message for an OBJ file of this text beside a 2x2 picture `t.png` and its MTL `m.mtl`.
fn obj_refused(text: &str) -> String {
    let files = obj_files(text);
    refused(&files.path().join("a.obj"), None)
}

fn obj_loaded(text: &str) -> Model {
    let files = obj_files(text);
    loaded(&files.path().join("a.obj"), None)
}

fn obj_files(text: &str) -> TempDir {
    directory(&[
        ("a.obj", text.as_bytes()),
        (
            "m.mtl",
            b"newmtl skin\nKd 1\nmap_Kd t.png\nnewmtl red\nKd 1 0 0\n",
        ),
        ("t.png", &png(2, 2)),
    ])
}

const HEAD: &str = "mtllib m.mtl\nusemtl skin\n";
const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

fn gradient(width: u32, height: u32) -> RgbImage {
    RgbImage::from_fn(width, height, |x, y| {
        Rgb([(x * 255 / width) as u8, (y * 255 / height) as u8, 128])
    })
}

fn encoded(width: u32, height: u32, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    gradient(width, height)
        .write_to(&mut bytes, format)
        .unwrap();
    bytes.into_inner()
}

fn png(width: u32, height: u32) -> Vec<u8> {
    encoded(width, height, ImageFormat::Png)
}

/// A PNG header that claims a size, with no pixels behind it.
fn png_of_size(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    chunk(&mut bytes, *b"IHDR", &{
        let mut header = [width.to_be_bytes(), height.to_be_bytes()].concat();
        header.extend([8, 2, 0, 0, 0]);
        header
    });
    chunk(&mut bytes, *b"IDAT", &[]);
    chunk(&mut bytes, *b"IEND", &[]);
    bytes
}

fn chunk(png: &mut Vec<u8>, kind: [u8; 4], data: &[u8]) {
    png.extend((data.len() as u32).to_be_bytes());
    let body = [&kind[..], data].concat();
    png.extend(&body);
    // CRC-32 as PNG has it, bit by bit.
    let crc = body.iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| {
            (crc >> 1) ^ (0xEDB8_8320 * (crc & 1))
        })
    });
    png.extend((!crc).to_be_bytes());
}

mod pictures {
    use super::*;

    fn refused(bytes: &[u8]) -> String {
        let error = Picture::from_encoded(bytes, "p.png").expect_err("decoded");
        let error = error.to_string();
        assert!(
            !error.contains('\n') && error.starts_with("p.png: "),
            "{error:?}"
        );
        error
    }

    #[test]
    fn chelsea_is_resampled_with_a_notice() {
        let (picture, notice) = Picture::load(&asset("photo/chelsea.png")).unwrap();
        assert_eq!((picture.width(), picture.height()), (512, 256));
        assert_eq!(picture.pixels().len(), 512 * 256);
        assert_eq!(notice.unwrap(), "chelsea.png: 451x300 resampled to 512x256");
        // The middle of both pictures shows the same colour, more or less.
        let original = image::open(asset("photo/chelsea.png")).unwrap().into_rgb8();
        let before = original.get_pixel(225, 150).0;
        let after = picture.pixels()[128 * 512 + 256];
        for (a, b) in before.into_iter().zip(after) {
            assert!(a.abs_diff(b) < 24, "{before:?} {after:?}");
        }
    }

    #[test]
    fn sizes_that_fit_stay_exact_and_silent() {
        for (width, height) in [(1, 1), (4, 8), (1024, 1)] {
            let (picture, notice) = Picture::from_encoded(&png(width, height), "p.png").unwrap();
            assert_eq!((picture.width(), picture.height()), (width, height));
            assert_eq!(notice, None);
            let expected: Vec<_> = gradient(width, height).pixels().map(|p| p.0).collect();
            assert_eq!(picture.pixels(), expected);
        }
    }

    #[test]
    fn large_sides_go_down_to_1024() {
        let (picture, notice) = Picture::from_encoded(&png(4096, 2), "p.png").unwrap();
        assert_eq!((picture.width(), picture.height()), (1024, 2));
        assert_eq!(notice.unwrap(), "p.png: 4096x2 resampled to 1024x2");
    }

    #[test]
    fn jpeg_and_alpha_are_understood() {
        let jpeg = encoded(16, 16, ImageFormat::Jpeg);
        assert_eq!(Picture::from_encoded(&jpeg, "p.jpg").unwrap().0.width(), 16);
        let mut bytes = Cursor::new(Vec::new());
        let clear = RgbaImage::from_pixel(2, 2, image::Rgba([10, 20, 30, 0]));
        clear.write_to(&mut bytes, ImageFormat::Png).unwrap();
        let (picture, notice) = Picture::from_encoded(bytes.get_ref(), "p.png").unwrap();
        assert_eq!((picture.pixels()[3], notice), ([10, 20, 30], None));
        assert_eq!(picture.alpha(), Some(&[0; 4][..]));
    }

    #[test]
    fn alpha_is_kept_unless_all_is_opaque() {
        let alpha = |image: DynamicImage| {
            let mut bytes = Cursor::new(Vec::new());
            image.write_to(&mut bytes, ImageFormat::Png).unwrap();
            let picture = Picture::from_encoded(bytes.get_ref(), "p.png").unwrap().0;
            let resized = picture.resized(4, 4).unwrap();
            assert_eq!(resized.alpha().is_some(), picture.alpha().is_some());
            picture.alpha().map(<[u8]>::to_vec)
        };
        // Left column 40, right column 200 (of 255), in each kind of PNG with alpha.
        let a = |x: u32| 40 + 160 * x as u8;
        let rgba = RgbaImage::from_fn(2, 2, |x, _| image::Rgba([1, 2, 3, a(x)]));
        let expected = Some(vec![40, 200, 40, 200]);
        let image = DynamicImage::ImageRgba8(rgba);
        assert_eq!(
            alpha(DynamicImage::ImageRgba16(image.to_rgba16())),
            expected
        );
        assert_eq!(
            alpha(DynamicImage::ImageLumaA8(image.to_luma_alpha8())),
            expected
        );
        assert_eq!(alpha(image), expected);
        let opaque = RgbaImage::from_pixel(2, 2, image::Rgba([1, 2, 3, 255]));
        assert_eq!(alpha(DynamicImage::ImageRgba8(opaque)), None);
        assert_eq!(alpha(DynamicImage::ImageRgb8(gradient(2, 2))), None);
    }

    #[test]
    fn alpha_is_resampled_with_the_picture() {
        // A step in the middle stays one.
        let mut bytes = Cursor::new(Vec::new());
        let image = RgbaImage::from_fn(48, 3, |x, _| {
            image::Rgba([9, 9, 9, if x < 24 { 0 } else { 255 }])
        });
        image.write_to(&mut bytes, ImageFormat::Png).unwrap();
        let (picture, notice) = Picture::from_encoded(bytes.get_ref(), "p.png").unwrap();
        assert!(notice.is_some());
        assert_eq!((picture.width(), picture.height()), (64, 4));
        for picture in [picture.resized(16, 8).unwrap(), picture] {
            let alpha = picture.alpha().unwrap();
            assert_eq!(alpha.len(), picture.pixels().len());
            let width = picture.width() as usize;
            for row in alpha.chunks(width) {
                // Lanczos rings within 3 source texels of the step.
                let (left, right) = (&row[..width / 2 - 4], &row[width / 2 + 4..]);
                assert!(left.iter().all(|&a| a == 0) && right.iter().all(|&a| a == 255));
            }
        }
    }

    #[test]
    fn alpha_of_another_length_is_refused() {
        let picture = || Picture::new(2, 2, vec![[0; 3]; 4]).unwrap();
        let said = picture().with_alpha(vec![0; 5]).unwrap_err().to_string();
        assert!(
            said.starts_with("picture: ") && said.contains('5'),
            "{said}"
        );
        assert_eq!(picture().with_alpha(vec![255; 4]).unwrap(), picture());
    }

    #[test]
    fn sizes_are_refused_before_decoding() {
        let said = refused(&png_of_size(20_000, 20_000));
        assert_eq!(
            said,
            "p.png: a picture of 20000x20000 pixels; give one of 1x1 to 16384x16384"
        );
        assert!(refused(&png_of_size(16_385, 1)).contains("16385x1"));
        for (width, height) in [(0, 0), (0, 4), (4, 0)] {
            let said = refused(&png_of_size(width, height));
            assert!(said.contains("1x1 to 16384x16384"), "{said}");
        }
        // Within the sides, beyond the memory that 16-bit pixels would take: still one line.
        refused(&png_of_size(16_384, 16_384));
    }

    #[test]
    fn broken_pictures_are_refused() {
        let whole = png(8, 8);
        for end in 0..whole.len() - 12 {
            refused(&whole[..end]);
        }
        let jpeg = encoded(16, 16, ImageFormat::Jpeg);
        refused(&jpeg[..20]);
        assert!(refused(b"GIF89a").contains("give an undamaged PNG or JPEG file"));
        assert!(refused(b"").contains("not a usable picture"));
        let said = Picture::load(Path::new("none/such.png"))
            .unwrap_err()
            .to_string();
        assert!(
            said.starts_with("none/such.png: cannot be read ("),
            "{said}"
        );
        assert!(
            said.ends_with("; check the name and the permissions"),
            "{said}"
        );
    }

    #[test]
    fn new_and_resized_check_their_sides() {
        let picture = Picture::new(2, 1, vec![[0; 3], [255; 3]]).unwrap();
        assert_eq!(picture.resized(4, 4).unwrap().pixels().len(), 16);
        assert_eq!(picture.resized(2, 1).unwrap(), picture);
        for (width, height) in [(0, 1), (3, 1), (8192, 1)] {
            let said = picture.resized(width, height).unwrap_err().to_string();
            assert!(said.contains("powers of two"), "{said}");
        }
        let said = Picture::new(2, 2, vec![[0; 3]]).unwrap_err().to_string();
        assert_eq!(said, "picture: a buffer of 1 elements where 4 are needed");
    }

    #[test]
    fn rgb565_rounds_to_nearest() {
        use multum::embedded_graphics::prelude::RgbColor;
        let greys = (0..=255).map(|x| [x; 3]).collect();
        let picture = Picture::new(16, 16, greys).unwrap();
        for (x, colour) in picture.rgb565().into_iter().enumerate() {
            let nearest = |max: f64| (x as f64 * max / 255.0).round() as u8;
            assert_eq!(
                [colour.r(), colour.g(), colour.b()],
                [nearest(31.0), nearest(63.0), nearest(31.0)],
                "{x}"
            );
        }
    }
}

mod obj {
    use super::*;

    #[test]
    fn spot_loads_with_a_given_texture() {
        let texture = asset("spot/spot_texture.png");
        for (file, triangles) in [("spot_control_mesh", 372), ("spot_triangulated", 5856)] {
            let path = asset(&format!("spot/{file}.obj"));
            let model = loaded(&path, Some(&texture));
            assert_eq!(model.triangle_count(), triangles);
            assert_eq!((model.parts.len(), model.scale), (1, 1.0));
            assert_eq!(model.parts[0].picture.width(), 1024);
            assert_eq!(model.notices, [""; 0]);
            assert!((0.9..1.3).contains(&model.radius), "{}", model.radius);
            let said = refused(&path, None);
            assert_eq!(
                said,
                format!("{file}.obj: no texture in the file; give a picture with --texture FILE")
            );
        }
    }

    #[test]
    fn kaykit_loads_with_its_own_texture() {
        for (file, triangles) in [("barrel_large", 561), ("chest_gold", 1106)] {
            let model = loaded(&asset(&format!("kaykit/{file}.obj")), None);
            assert_eq!(model.triangle_count(), triangles);
            assert_eq!(model.parts.len(), 1);
            assert_eq!(model.parts[0].picture.height(), 1024);
            assert_eq!(model.notices, [""; 0]);
        }
    }

    /// The file's vt (0, 0) is the lower left of the picture, the core's (0, 0) the upper left.
    #[test]
    fn v_is_flipped() {
        let text = format!("{HEAD}{CORNERS}vt 0.25 0.125\nf 1/5 2/2 3/3\n");
        let model = obj_loaded(&text);
        let uvs: Vec<_> = model.parts[0]
            .vertices
            .iter()
            .map(|vertex| vertex.uv.map(|x| x.to_num::<f32>()))
            .collect();
        assert_eq!(uvs, [[0.25, 0.875], [1.0, 1.0], [1.0, 0.0]]);
    }

    #[test]
    fn polygons_lines_normals_and_relative_indices() {
        let text = format!(
            "{HEAD}{CORNERS}vn 0 0 1\nf -4/-4/-1 -3/-3/-1 -2/-2/-1 -1/-1/-1\nl 1 2 3\nf 1/1 2/2\n\
             f 1/1 2/2 3/3 4/4 1/1\np 1\ng other\nf 1/1//9 2/2/7 3/3\n"
        );
        let model = obj_loaded(&text);
        assert_eq!(model.triangle_count(), 2 + 3 + 1);
        // Normals, groups and repeated corners make no new vertices.
        assert_eq!(model.parts[0].vertices.len(), 4);
        assert_eq!(model.parts[0].triangles[..2], [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn a_material_without_texture_becomes_its_colour() {
        let text = format!("{HEAD}{CORNERS}f 1/1 2/2 3/3\nusemtl red\nf 1/1 3/3 4/4\n");
        let model = obj_loaded(&text);
        assert_eq!(model.parts.len(), 2);
        let red = &model.parts[1].picture;
        assert_eq!((red.width(), red.pixels()), (1, &[[255, 0, 0]][..]));
        assert_eq!(
            model.notices,
            ["a.obj: material 'red' has no texture: its plain colour is used"]
        );
        let only_red = format!("mtllib m.mtl\nusemtl red\n{CORNERS}f 1/1 2/2 3/3\n");
        let said = obj_refused(&only_red);
        assert!(
            said.ends_with("give a picture with --texture FILE"),
            "{said}"
        );
    }

    #[test]
    fn texture_paths_are_seen_from_the_mtl() {
        let text = format!("mtllib sub/m.mtl\nusemtl a\n{CORNERS}f 1/1 2/2 3/3\n");
        let files = directory(&[("a.obj", text.as_bytes())]);
        let sub = files.path().join("sub");
        fs::create_dir(&sub).unwrap();
        fs::write(sub.join("t 1.png"), png(3, 4)).unwrap();
        for name in ["t 1.png", "C:\\art\\t 1.png", "-s 2 2 1 t 1.png"] {
            fs::write(sub.join("m.mtl"), format!("newmtl a\nmap_Kd {name}\n")).unwrap();
            let model = loaded(&files.path().join("a.obj"), None);
            assert_eq!(model.parts[0].picture.width(), 4, "{name}");
            let resampled = "t 1.png: 3x4 resampled to 4x4".to_owned();
            assert!(model.notices.contains(&resampled), "{:?}", model.notices);
            assert_eq!(model.notices.len() > 1, name.starts_with('-'));
        }
        fs::write(sub.join("m.mtl"), "newmtl a\nmap_Kd gone.png\n").unwrap();
        assert_eq!(
            refused(&files.path().join("a.obj"), None),
            "a.obj: the texture 'gone.png' of material 'a' is missing; \
             put it beside the MTL file or give a picture with --texture FILE"
        );
        fs::remove_file(sub.join("m.mtl")).unwrap();
        let said = refused(&files.path().join("a.obj"), None);
        assert!(
            said.starts_with("a.obj: the material file 'sub/m.mtl' cannot be read ("),
            "{said}"
        );
        // With a picture given, neither file is needed.
        loaded(&files.path().join("a.obj"), Some(&sub.join("t 1.png")));
    }

    #[test]
    fn large_and_small_models_are_scaled_by_a_power_of_two() {
        for (size, scale) in [
            (1e6f32, 2f32.powi(-19)),
            (1e-4, 2f32.powi(14)),
            (1024.0, 1.0),
        ] {
            let text = format!("{HEAD}{CORNERS}v {size} 0 0\nv 0 -{size} 0\nf 1/1 5/2 6/3\n");
            let model = obj_loaded(&text);
            assert_eq!(model.scale, scale);
            let middle = size * scale / 2.0;
            assert_eq!(model.centre, [middle, -middle, 0.0]);
            let x: f32 = model.parts[0].vertices[1].position[0].to_num();
            assert!((x - size * scale).abs() <= 1.0 / 131_072.0, "{x}");
        }
    }

    #[test]
    fn even_repeats_are_taken_off() {
        let text = format!(
            "{HEAD}{CORNERS}vt 1000.25 0.5\nvt 1001.25 0.5\nvt 1000.25 1.5\n\
             f 1/5 2/6 3/7\nf 1/1 2/2 3/3\n"
        );
        let model = obj_loaded(&text);
        let u = model.parts[0].vertices.iter().map(|v| v.uv[0].to_num());
        let u: Vec<f32> = u.collect();
        assert_eq!(u, [0.25, 1.25, 0.25, 0.0, 1.0, 1.0]);
        let said = obj_refused(&format!(
            "{HEAD}{CORNERS}vt 128.5 0\no Wall\nf 1/1 2/5 3/3\n"
        ));
        assert_eq!(
            said,
            "a.obj: triangle 0 of mesh 'Wall' spans 128.5 repeats of its texture, \
             and 127 are the most; split the face or scale its UVs down"
        );
    }

    #[test]
    fn more_than_65535_vertices_make_several_parts() {
        let mut text = format!("{HEAD}vt 0 0\nvt 1 0\nvt 0 1\n");
        let faces = 30_000;
        for i in 0..faces {
            let x = f64::from(i) / 100.0;
            text += &format!("v {x} 0 0\nv {x} 1 0\nv {x} 0 1\nf -3/1 -2/2 -1/3\n");
        }
        let model = obj_loaded(&text);
        assert_eq!(model.triangle_count(), faces as usize);
        let vertices: Vec<_> = model.parts.iter().map(|p| p.vertices.len()).collect();
        assert_eq!(vertices, [65_535, 24_465]);
    }

    #[test]
    fn bad_files_are_one_line() {
        let cases = [
            (
                "",
                "a.obj: no triangles; export the model again with its faces as a mesh",
            ),
            (
                CORNERS,
                "a.obj: no triangles; export the model again with its faces as a mesh",
            ),
            (
                "v 0 0 0\nv 1 0 0\nv 0 1 0\no Box\nf 1 2 3\n",
                "a.obj: mesh 'Box' (line 5) has no texture coordinates; unwrap it (UVs) in the \
                 modelling program and export the file again, or give --texgen",
            ),
            (
                "v 0 0 0\nvt 0 0\nf 1/1 1/1 1/9\n",
                "a.obj: line 3: the face names texture coordinate '9', but the file has 1; \
                 export the model again",
            ),
            (
                "v 0 0 0\nvt 0 0\nf 1/1 1/1 2/1\n",
                "a.obj: line 3: the face names vertex '2', but the file has 1; \
                 export the model again",
            ),
            (
                "v 0 0 0\nvt 0 0\nf 1/1 1/1 -9223372036854775808/1\n",
                "a.obj: line 3: the face names vertex '-9223372036854775808', \
                 but the file has 1; export the model again",
            ),
            (
                "v 0 0 0\nv 0 nan 0\n",
                "a.obj: line 2: vertex 2 is not finite: '0 nan 0'; \
                 repair the model and export it again",
            ),
            (
                "v 1e39 0 0\n",
                "a.obj: line 1: vertex 1 is not finite: '1e39 0 0'; \
                 repair the model and export it again",
            ),
            (
                "v 0 zero 0\n",
                "a.obj: line 1: vertex 1 is not three numbers: '0 zero 0'; export the model again",
            ),
            (
                "vt nan 0\n",
                "a.obj: line 1: texture coordinate 1 is not finite: 'nan 0'; \
                 repair the UVs in the modelling program and export the file again",
            ),
        ];
        for (text, expected) in cases {
            assert_eq!(obj_refused(text), expected);
        }
        // Forward references across objects are legal only within the whole file.
        let forward = format!("{HEAD}f 1/1 2/2 3/3\no late\n{CORNERS}f 1/1 2/2 3/3\n");
        let said = obj_refused(&forward);
        assert!(said.contains("not a usable OBJ file"), "{said}");
    }

    #[test]
    fn names_and_missing_files() {
        let files = directory(&[("a.stl", b"solid"), ("plain", b"")]);
        for name in ["a.stl", "plain"] {
            assert_eq!(
                refused(&files.path().join(name), None),
                format!(
                    "{name}: not a mesh by its name; \
                     give a file whose name ends in .obj, .glb or .gltf"
                )
            );
        }
        for name in ["gone.obj", "gone.glb"] {
            let said = refused(&files.path().join(name), None);
            assert!(
                said.starts_with(&format!("{name}: cannot be read (")),
                "{said}"
            );
        }
        // A directory.
        fs::create_dir(files.path().join("d.obj")).unwrap();
        refused(&files.path().join("d.obj"), None);
        // A broken picture is named, not the model.
        let said = refused(
            &asset("spot/spot_control_mesh.obj"),
            Some(&asset("spot/README.txt")),
        );
        assert!(
            said.starts_with("README.txt: not a usable picture"),
            "{said}"
        );
    }

    #[test]
    fn damaged_files_never_panic() {
        let text = format!("{HEAD}o a\n{CORNERS}vn 0 0 1\nf 1/1/1 -2/2/1 3/3/1 4/4\n");
        let files = obj_files(&text);
        let path = files.path().join("a.obj");
        for position in 0..text.len() {
            for byte in [b'\n', b'-', b'/', b'9', 0xff] {
                let mut damaged = text.clone().into_bytes();
                damaged[position] = byte;
                fs::write(&path, damaged).unwrap();
                match model::load(&path, None) {
                    Ok(_) => drop(loaded(&path, None)),
                    Err(e) => assert!(!e.to_string().contains('\n'), "{e:?}"),
                }
            }
        }
    }
}

mod gltf {
    use super::*;
    use base64::Engine;

    const TRIANGLE: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    const UVS: [[f32; 2]; 3] = [[0.0, 0.25], [1.0, 0.25], [0.0, 1.0]];

    /// The binary chunk: 3 positions, 3 texture coordinates, 3 indices, and a picture.
    struct Bin {
        bytes: Vec<u8>,
        picture: usize,
    }

    fn bin(positions: [[f32; 3]; 3], uvs: [[f32; 2]; 3], indices: [u16; 3]) -> Bin {
        let mut bytes = Vec::new();
        let floats = positions.as_flattened().iter().chain(uvs.as_flattened());
        bytes.extend(floats.flat_map(|x| x.to_le_bytes()));
        bytes.extend(indices.iter().flat_map(|i| i.to_le_bytes()));
        bytes.extend([0; 2]);
        let picture = png(4, 2);
        bytes.extend(&picture);
        Bin {
            bytes,
            picture: picture.len(),
        }
    }

    /// A document over [`Bin`]; tests replace pieces of it.
    fn json(bin: &Bin) -> String {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
"nodes":[{{"mesh":0}}],
"meshes":[{{"name":"Tri","primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}},"indices":2,"material":0}}]}}],
"materials":[{{"name":"Skin","pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],
"textures":[{{"source":0}}],
"images":[{{"bufferView":3,"mimeType":"image/png"}}],
"accessors":[
{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
{{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}},
{{"bufferView":2,"componentType":5123,"count":3,"type":"SCALAR"}}],
"bufferViews":[
{{"buffer":0,"byteOffset":0,"byteLength":36}},
{{"buffer":0,"byteOffset":36,"byteLength":24}},
{{"buffer":0,"byteOffset":60,"byteLength":6}},
{{"buffer":0,"byteOffset":68,"byteLength":{}}}],
"buffers":[{{"byteLength":{}}}]}}"#,
            bin.picture,
            bin.bytes.len()
        )
    }

    /// The document with pieces replaced, each of which must be there.
    fn edited(mut json: String, edits: &[(&str, &str)]) -> String {
        for (from, to) in edits {
            assert!(json.contains(from), "{from}");
            json = json.replacen(from, to, 1);
        }
        json
    }

    fn glb(json: &str, bin: &[u8]) -> Vec<u8> {
        let pad = |length: usize| length.next_multiple_of(4) - length;
        let mut chunks = Vec::new();
        chunks.extend(((json.len() + pad(json.len())) as u32).to_le_bytes());
        chunks.extend(b"JSON");
        chunks.extend(json.bytes());
        chunks.extend(vec![b' '; pad(json.len())]);
        chunks.extend(((bin.len() + pad(bin.len())) as u32).to_le_bytes());
        chunks.extend(b"BIN\0");
        chunks.extend(bin);
        chunks.extend(vec![0; pad(bin.len())]);
        let mut bytes = b"glTF\x02\0\0\0".to_vec();
        bytes.extend((12 + chunks.len() as u32).to_le_bytes());
        bytes.extend(chunks);
        bytes
    }

    fn standard() -> Bin {
        bin(TRIANGLE, UVS, [0, 1, 2])
    }

    /// The standard file, edited, as a .glb in a directory of its own.
    fn file(bin: &Bin, edits: &[(&str, &str)]) -> TempDir {
        let document = edited(json(bin), edits);
        directory(&[("a.glb", &glb(&document, &bin.bytes))])
    }

    fn glb_loaded(bin: &Bin, edits: &[(&str, &str)]) -> Model {
        loaded(&file(bin, edits).path().join("a.glb"), None)
    }

    fn glb_refused(bin: &Bin, edits: &[(&str, &str)]) -> String {
        refused(&file(bin, edits).path().join("a.glb"), None)
    }

    /// Corners of the first triangle: x, y, z, u, v.
    fn corners(model: &Model) -> [[f32; 5]; 3] {
        let part = &model.parts[0];
        part.triangles[0].map(|i| {
            let vertex = part.vertices[usize::from(i)];
            let [x, y, z] = vertex.position.map(|x| x.to_num());
            let [u, v] = vertex.uv.map(|x| x.to_num());
            [x, y, z, u, v]
        })
    }

    const PLAIN: [[f32; 5]; 3] = [
        [0.0, 0.0, 0.0, 0.0, 0.25],
        [1.0, 0.0, 0.0, 1.0, 0.25],
        [0.0, 1.0, 0.0, 0.0, 1.0],
    ];

    #[test]
    fn embedded_picture() {
        let model = glb_loaded(&standard(), &[]);
        assert_eq!(corners(&model), PLAIN);
        let expected: Vec<_> = gradient(4, 2).pixels().map(|p| p.0).collect();
        assert_eq!(model.parts[0].picture.pixels(), expected);
        assert_eq!((model.triangle_count(), model.scale), (1, 1.0));
        assert_eq!((model.centre, model.notices.len()), ([0.5, 0.5, 0.0], 0));
    }

    #[test]
    fn external_buffer_and_pictures() {
        let bin = standard();
        let embedded = r#""bufferView":3,"mimeType":"image/png""#;
        let buffer = r#""buffers":[{"#;
        let uri = |text: &str| format!(r#""uri":"{text}""#);
        let data = |kind: &str, bytes: &[u8]| {
            let text = base64::engine::general_purpose::STANDARD.encode(bytes);
            format!("data:{kind};base64,{text}")
        };
        let jpeg = encoded(8, 8, ImageFormat::Jpeg);
        let images = [
            uri("my%20skin.png"),
            uri("skin.jpg"),
            uri(&data("image/jpeg", &jpeg)),
            // Without padding.
            uri(data("image/png", &png(8, 2)).trim_end_matches('=')),
        ];
        let buffers = [
            uri("a.bin"),
            uri(&data("application/octet-stream", &bin.bytes)),
        ];
        for image in &images {
            for buffer_uri in &buffers {
                let buffer_to = format!("{buffer}{buffer_uri},");
                let document = edited(json(&bin), &[(embedded, image), (buffer, &buffer_to)]);
                let files = directory(&[
                    ("a.gltf", document.as_bytes()),
                    ("a.bin", &bin.bytes),
                    ("my skin.png", &png(8, 4)),
                    ("skin.jpg", &jpeg),
                ]);
                let model = loaded(&files.path().join("a.gltf"), None);
                assert_eq!(model.parts[0].picture.width(), 8, "{image}");
                assert_eq!(corners(&model), PLAIN);
            }
        }
    }

    #[test]
    fn embedded_pictures_are_resampled_with_a_notice() {
        let mut bin = standard();
        bin.bytes.truncate(68);
        let picture = png(5, 6);
        bin.picture = picture.len();
        bin.bytes.extend(&picture);
        let model = glb_loaded(&bin, &[]);
        assert_eq!(model.notices, ["a.glb: image 0: 5x6 resampled to 4x8"]);
    }

    #[test]
    fn a_given_texture_overrides() {
        let bin = standard();
        let files = file(&bin, &[(r#""bufferView":3"#, r#""bufferView":1"#)]);
        let path = files.path().join("a.glb");
        let model = loaded(&path, Some(&asset("globe/world.png")));
        assert_eq!(model.parts[0].picture.width(), 512);
        assert!(refused(&path, None).starts_with("a.glb: image 0: not a usable picture"));
    }

    #[test]
    fn nodes_place_meshes() {
        let nodes = r#""nodes":[{"mesh":0}]"#;
        // The parent moves by 10, the child doubles and turns a quarter about z.
        let turned = r#""nodes":[{"translation":[10,0,0],"children":[1]},
            {"mesh":0,"scale":[2,2,2],"rotation":[0,0,0.70710678,0.70710678]}]"#;
        let placed = corners(&glb_loaded(&standard(), &[(nodes, turned)]));
        let expected = [[10.0, 0.0, 0.0], [10.0, 2.0, 0.0], [8.0, 0.0, 0.0]];
        for (corner, expected) in placed.iter().zip(expected) {
            for axis in 0..3 {
                assert!((corner[axis] - expected[axis]).abs() < 1e-4, "{placed:?}");
            }
        }
        // A mirror turns the winding round.
        let mirrored = r#""nodes":[{"mesh":0,"scale":[-1,1,1]}]"#;
        let placed = corners(&glb_loaded(&standard(), &[(nodes, mirrored)]));
        assert_eq!(
            placed.map(|c| [c[0], c[1]]),
            [[0.0, 0.0], [0.0, 1.0], [-1.0, 0.0]]
        );
        // One mesh in two places.
        let twice = r#""nodes":[{"children":[1,2]},{"mesh":0},{"mesh":0,"translation":[0,0,3]}]"#;
        let model = glb_loaded(&standard(), &[(nodes, twice)]);
        assert_eq!((model.triangle_count(), model.parts.len()), (2, 1));
        // A loop must end.
        let loops = r#""nodes":[{"children":[1]},{"mesh":0,"children":[0]}]"#;
        let said = glb_refused(&standard(), &[(nodes, loops)]);
        assert!(
            said.contains("node 0 has two parents or is its own ancestor"),
            "{said}"
        );
    }

    #[test]
    fn texture_coordinate_sets_and_transforms() {
        let index = r#""baseColorTexture":{"index":0}"#;
        let second = r#""baseColorTexture":{"index":0,"texCoord":1}"#;
        let attribute = (r#""TEXCOORD_0":1"#, r#""TEXCOORD_1":1"#);
        let model = glb_loaded(&standard(), &[(index, second), attribute]);
        assert_eq!(corners(&model), PLAIN);
        let moved = r#""baseColorTexture":{"index":0,"extensions":{
            "KHR_texture_transform":{"offset":[0.5,0.25],"scale":[0.5,2]}}}"#;
        let model = glb_loaded(&standard(), &[(index, moved)]);
        let uvs = corners(&model).map(|c| [c[3], c[4]]);
        assert_eq!(uvs, [[0.5, 0.75], [1.0, 0.75], [0.5, 2.25]]);
        let said = glb_refused(&standard(), &[attribute]);
        assert_eq!(
            said,
            "a.glb: mesh 'Tri' has no texture coordinates; unwrap it (UVs) in the modelling \
             program and export the file again, or give --texgen"
        );
    }

    #[test]
    fn projections_need_no_coordinates_and_use_none() {
        let index = r#""baseColorTexture":{"index":0}"#;
        let moved = r#""baseColorTexture":{"index":0,"extensions":{
            "KHR_texture_transform":{"offset":[0.5,0.25],"scale":[0.5,2]}}}"#;
        for edits in [
            &[][..],
            &[(index, moved)],
            &[(r#""TEXCOORD_0":1"#, r#""TEXCOORD_1":1"#)],
        ] {
            let files = file(&standard(), edits);
            let front = Projection::Planar(Axis::Z);
            let path = files.path().join("a.glb");
            let model = model::load_projected(&path, None, front, [1.0, 3.0]).unwrap();
            let uvs = corners(&model).map(|c| [c[3], c[4]]);
            assert_eq!(uvs, [[0.0, 3.0], [1.0, 3.0], [0.0, 0.0]]);
            assert!(model::load_projected(&path, None, front, [1.0, 128.0]).is_err());
        }
    }

    #[test]
    fn what_is_not_drawn_is_noted() {
        let texture = (
            r#""textures":[{"#,
            r#""samplers":[{"wrapS":33071}],"textures":[{"sampler":0,"#,
        );
        let factor = (
            r#""pbrMetallicRoughness":{"#,
            r#""pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1],"#,
        );
        let model = glb_loaded(&standard(), &[texture, factor]);
        assert_eq!(
            model.notices,
            [
                "a.glb: the colour of material 'Skin' is ignored: it has a texture",
                "a.glb: the wrap mode of material 'Skin' is ignored: its texture repeats"
            ]
        );
        let points = r#""material":0},{"attributes":{"POSITION":0},"mode":0}"#;
        let model = glb_loaded(&standard(), &[(r#""material":0}"#, points)]);
        assert_eq!(model.notices, ["a.glb: points and lines are not drawn"]);
    }

    #[test]
    fn plain_colours() {
        let second = r#""material":0},{"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":1}"#;
        let materials = r#""materials":[{"name":"Red","pbrMetallicRoughness":{"baseColorFactor":[1,0,0.216,1]}},"#;
        let edits = [
            (r#""material":0}"#, second),
            (r#""materials":["#, materials),
        ];
        let model = glb_loaded(&standard(), &edits);
        assert_eq!(model.parts.len(), 2);
        assert_eq!(model.parts[0].picture.pixels(), [[255, 0, 128]]);
        assert_eq!(
            model.notices,
            ["a.glb: material 'Red' has no texture: its plain colour is used"]
        );
        let untextured = (r#""baseColorTexture":{"index":0}"#, "");
        assert_eq!(
            glb_refused(&standard(), &[untextured]),
            "a.glb: no texture in the file; give a picture with --texture FILE"
        );
    }

    #[test]
    fn bad_numbers_are_one_line() {
        let mut positions = TRIANGLE;
        positions[1][2] = f32::NAN;
        assert_eq!(
            glb_refused(&bin(positions, UVS, [0, 1, 2]), &[]),
            "a.glb: vertex 1 of mesh 'Tri' is not finite; repair the model and export it again"
        );
        positions[1][2] = f32::NEG_INFINITY;
        assert!(
            glb_refused(&bin(positions, UVS, [0, 1, 2]), &[]).contains("vertex 1 of mesh 'Tri'")
        );
        let mut uvs = UVS;
        uvs[2][1] = f32::NAN;
        assert_eq!(
            glb_refused(&bin(TRIANGLE, uvs, [0, 1, 2]), &[]),
            "a.glb: vertex 2 of mesh 'Tri' has the texture coordinate [0.0, NaN], which is not \
             finite; repair the UVs in the modelling program and export the file again"
        );
        assert_eq!(
            glb_refused(&bin(TRIANGLE, UVS, [0, 1, 3]), &[]),
            "a.glb: mesh 'Tri': an index names vertex 3, but there are 3; \
             export the model again as glTF 2.0"
        );
        // Finite in the file, not after its node.
        let huge = (r#"{"mesh":0}"#, r#"{"mesh":0,"scale":[1e30,1e30,1e30]}"#);
        let far = bin(TRIANGLE.map(|p| p.map(|x| x * 1e30)), UVS, [0, 1, 2]);
        assert!(glb_refused(&far, &[huge]).contains("not finite"));
    }

    #[test]
    fn bad_documents_are_one_line() {
        let count = |to: &'static str| (r#""count":3,"type":"VEC3""#, to);
        let view = r#""byteOffset":0,"byteLength":36"#;
        let cases: &[(&[(&str, &str)], &str)] = &[
            (
                &[(r#""POSITION":0"#, r#""POSITION":7"#)],
                "names accessor 7, but the file has 3",
            ),
            (
                &[(r#""indices":2"#, r#""indices":9"#)],
                "not a usable glTF file (meshes[0]",
            ),
            (
                &[(r#""indices":2"#, r#""indices":0"#)],
                "indices of type Vec3 F32 are not supported",
            ),
            (
                &[(r#""TEXCOORD_0":1"#, r#""TEXCOORD_0":0"#)],
                "texture coordinates of type Vec3 F32",
            ),
            (
                &[count(r#""count":0,"type":"VEC3""#)],
                "mesh 'Tri': 0 positions, where 1 to",
            ),
            (
                &[count(r#""count":4,"type":"VEC3""#)],
                "mesh 'Tri': positions reach beyond their buffer",
            ),
            (
                &[count(r#""count":2,"type":"VEC3""#)],
                "an index names vertex 2, but there are 2",
            ),
            (
                &[count(r#""count":99999999999,"type":"VEC3""#)],
                "positions, where 1 to",
            ),
            (
                &[(view, r#""byteOffset":18446744073709551615,"byteLength":36"#)],
                "beyond their buffer",
            ),
            (
                &[(view, r#""byteOffset":0,"byteLength":36,"byteStride":4"#)],
                "beyond their buffer",
            ),
            (
                &[(
                    r#""count":3,"type":"SCALAR""#,
                    r#""count":2,"type":"SCALAR""#,
                )],
                "2 indices do not make",
            ),
            (&[(r#""bufferView":3,"#, "")], "image 0 has no data"),
            (
                &[(
                    r#""bufferView":3,"mimeType":"image/png""#,
                    r#""uri":"https://x.invalid/a.png""#,
                )],
                "image 0 lies elsewhere: 'https://x.invalid/a.png'; export the model again with its data embedded",
            ),
            (
                &[(
                    r#""bufferView":3,"mimeType":"image/png""#,
                    r#""uri":"gone.png""#,
                )],
                "gone.png: cannot be read (",
            ),
            (
                &[(
                    r#""bufferView":3,"mimeType":"image/png""#,
                    r#""uri":"data:image/png;base64,=x""#,
                )],
                "image 0: data URI with broken base64",
            ),
            (
                &[(
                    r#""bufferView":3,"mimeType":"image/png""#,
                    r#""uri":"data:""#,
                )],
                "image 0: data URI without data",
            ),
            (
                &[(
                    r#""buffers":[{"byteLength":"#,
                    r#""buffers":[{"byteLength":9"#,
                )],
                "buffer 0 is cut off",
            ),
            (
                &[(r#""scene":0,"scenes":[{"nodes":[0]}],"#, "")],
                "no scene; export the model again",
            ),
            (
                &[(r#"{"nodes":[0]}"#, r#"{"nodes":[]}"#)],
                "no triangles; export the model again",
            ),
            (
                &[(
                    r#""asset""#,
                    r#""extensionsRequired":["KHR_draco_mesh_compression"],"asset""#,
                )],
                "KHR_draco_mesh_compression",
            ),
            (
                &[(r#""primitives":[{"#, r#""primitives":[{"mode":99,"#)],
                "not a usable glTF file",
            ),
            (
                &[(r#""asset""#, "asset")],
                "not a usable glTF file (key must be a string",
            ),
        ];
        for (edits, expected) in cases {
            let said = glb_refused(&standard(), edits);
            assert!(said.contains(expected), "{edits:?}: {said}");
        }
    }

    #[test]
    fn truncated_files_are_refused_at_every_length() {
        let bin = standard();
        let whole = glb(&json(&bin), &bin.bytes);
        let files = directory(&[]);
        let path = files.path().join("a.glb");
        for end in 0..whole.len() {
            fs::write(&path, &whole[..end]).unwrap();
            let said = refused(&path, None);
            assert!(
                said.starts_with("a.glb: not a usable glTF file ("),
                "{end}: {said}"
            );
        }
        // A length shorter than the header itself.
        let mut short = whole;
        short[8..12].copy_from_slice(&3u32.to_le_bytes());
        fs::write(&path, &short).unwrap();
        assert_eq!(
            refused(&path, None),
            "a.glb: not a usable glTF file (the header is cut off); \
             export the model again as glTF 2.0"
        );
        fs::write(files.path().join("a.gltf"), b"").unwrap();
        refused(&files.path().join("a.gltf"), None);
    }

    #[test]
    fn sparse_accessors_are_checked() {
        let sparse = |view: usize, count: usize| {
            format!(
                r#""count":3,"type":"VEC3","sparse":{{"count":{count},
                "indices":{{"bufferView":2,"componentType":5123}},"values":{{"bufferView":{view}}}}}"#
            )
        };
        let plain = r#""count":3,"type":"VEC3""#;
        // All three replaced by themselves.
        let model = glb_loaded(&standard(), &[(plain, &sparse(0, 3))]);
        assert_eq!(corners(&model), PLAIN);
        for (view, count) in [(0, 0), (0, 4), (1, 3), (2, 1)] {
            let said = glb_refused(&standard(), &[(plain, &sparse(view, count))]);
            assert!(
                said.contains("positions reach beyond their buffer"),
                "{said}"
            );
        }
    }

    #[test]
    fn damaged_files_never_panic() {
        let bin = standard();
        let whole = glb(&json(&bin), &bin.bytes);
        let files = directory(&[]);
        let path = files.path().join("a.glb");
        for position in 0..whole.len() {
            for byte in [0, b'9', 0xff] {
                let mut damaged = whole.clone();
                damaged[position] = byte;
                fs::write(&path, damaged).unwrap();
                match model::load(&path, None) {
                    Ok(_) => drop(loaded(&path, None)),
                    Err(e) => assert!(!e.to_string().contains('\n'), "{e:?}"),
                }
            }
        }
    }
}
