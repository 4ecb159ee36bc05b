//! Wavefront OBJ files with MTL materials, parsed by `tobj`.
//!
//! What `tobj` gets is not the file but a clean copy: only the statements that are drawn, indices
//! absolute and within the tables. `tobj` reports no line numbers, takes a three-point line for a
//! triangle, and some malformed statements make it panic.

use std::cell::RefCell;
use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::{RawMesh, Source, Surface};
use crate::error::Error;
use crate::file;
use crate::picture::Picture;

/// Reads the meshes of an OBJ file.
pub(super) fn read(path: &Path, source: &mut Source) -> Result<Vec<RawMesh>, Error> {
    let text = text(path)?;
    let clean = clean_obj(&text, source)?;
    let directory = path.parent().unwrap_or(Path::new(""));
    let libraries = Libraries {
        place: &source.place,
        directory: directory.to_owned(),
        wanted: source.texture.is_none(),
        seen: RefCell::new(Vec::new()),
        failed: RefCell::new(None),
    };
    let options = tobj::LoadOptions {
        single_index: true,
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
    };
    let parsed = tobj::load_obj_buf(&mut clean.as_bytes(), &options, |name| libraries.load(name));
    let (failed, libraries) = (libraries.failed.into_inner(), libraries.seen.into_inner());
    if let Some(error) = failed {
        return Err(error);
    }
    let usable = |e: tobj::LoadError| {
        source.error(
            &format!("not a usable OBJ file ({e})"),
            "export the model again as Wavefront OBJ",
        )
    };
    let (models, materials) = parsed.map_err(usable)?;
    let materials = materials.map_err(usable)?;
    let surfaces = Surfaces {
        materials: &materials,
        libraries,
        directory,
    };

    let mut pictures = HashMap::new();
    let mut meshes = Vec::new();
    for model in models {
        let mesh = model.mesh;
        let name = format!("mesh '{}'", model.name);
        let triangles: Vec<[u32; 3]> = mesh.indices.as_chunks().0.to_vec();
        if triangles.is_empty() {
            continue;
        }
        let positions = mesh.positions.as_chunks().0.to_vec();
        let uvs: Vec<[f32; 2]> = if source.projected {
            vec![[0.0; 2]; positions.len()]
        } else {
            // v points up in OBJ, down here.
            let coordinates = mesh.texcoords.as_chunks().0.iter();
            coordinates.map(|&[u, v]| [u, 1.0 - v]).collect()
        };
        if uvs.len() != positions.len() {
            return Err(source.no_uv(&name));
        }
        let surface = surfaces.of(mesh.material_id, &mut pictures, source)?;
        meshes.push(RawMesh {
            name,
            positions,
            uvs,
            triangles,
            surface,
        });
    }
    Ok(meshes)
}

/// A text file; bytes that are not UTF-8 occur in comments and names and do no harm there.
fn text(path: &Path) -> Result<String, Error> {
    let bytes = file::read(path)?;
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
    Ok(String::from_utf8_lossy(bytes).into_owned())
}

/// A statement's keyword and the rest of its line.
fn statement(line: &str) -> (&str, &str) {
    let line = line.trim();
    let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    (keyword, rest.trim())
}

/// The statements of the file that are drawn, checked. Positions and texture coordinates are
/// finite, every face names existing ones and has texture coordinates.
fn clean_obj(text: &str, source: &Source) -> Result<String, Error> {
    let at = |line: usize, problem: &str, remedy: &str| {
        source.error(&format!("line {}: {problem}", line + 1), remedy)
    };
    let statements = || text.lines().map(statement).enumerate();
    let count = |keyword| statements().filter(|(_, s)| s.0 == keyword).count();
    let totals = [count("v"), count("vt")];
    let mut seen = [0, 0];
    let mut mesh = "";
    let mut clean = String::with_capacity(text.len());
    // Writing to a string cannot fail.
    for (line, (keyword, rest)) in statements() {
        match keyword {
            "v" => {
                let number = seen[0] + 1;
                let Some([x, y, z]) = numbers(rest) else {
                    let problem = format!("vertex {number} is not three numbers: '{rest}'");
                    return Err(at(line, &problem, "export the model again"));
                };
                if ![x, y, z].iter().all(|x| x.is_finite()) {
                    let problem = format!("vertex {number} is not finite: '{rest}'");
                    return Err(at(line, &problem, "repair the model and export it again"));
                }
                let _ = writeln!(clean, "v {x:e} {y:e} {z:e}");
                seen[0] = number;
            }
            "vt" => {
                let number = seen[1] + 1;
                // A texture coordinate of one number is legal: v is then zero.
                let uv = numbers(rest).or_else(|| numbers(rest).map(|[u]| [u, 0.0]));
                let Some([u, v]) = uv else {
                    let problem =
                        format!("texture coordinate {number} is not two numbers: '{rest}'");
                    return Err(at(line, &problem, "export the model again"));
                };
                if !u.is_finite() || !v.is_finite() {
                    let problem = format!("texture coordinate {number} is not finite: '{rest}'");
                    let remedy =
                        "repair the UVs in the modelling program and export the file again";
                    return Err(at(line, &problem, remedy));
                }
                let _ = writeln!(clean, "vt {u:e} {v:e}");
                seen[1] = number;
            }
            "f" => {
                let corners: Vec<&str> = rest.split_whitespace().collect();
                // Faces of one or two corners have no area.
                if corners.len() < 3 {
                    continue;
                }
                clean.push('f');
                for corner in corners {
                    let mut parts = corner.split('/');
                    let tables = ["vertex", "texture coordinate"].into_iter().enumerate();
                    for (table, what) in tables.take(if source.projected { 1 } else { 2 }) {
                        let part = parts.next().unwrap_or("");
                        if part.is_empty() && table == 1 {
                            let mesh = format!("mesh '{mesh}' (line {})", line + 1);
                            return Err(source.no_uv(&mesh));
                        }
                        let Some(index) = index(part, seen[table], totals[table]) else {
                            let problem = format!(
                                "the face names {what} '{part}', but the file has {}",
                                totals[table]
                            );
                            return Err(at(line, &problem, "export the model again"));
                        };
                        let _ = write!(clean, "{}{index}", if table == 0 { ' ' } else { '/' });
                    }
                }
                clean.push('\n');
            }
            "o" | "g" => {
                mesh = rest;
                let _ = writeln!(clean, "{keyword} {rest}");
            }
            "mtllib" | "usemtl" if !rest.is_empty() => {
                let _ = writeln!(clean, "{keyword} {rest}");
            }
            _ => {}
        }
    }
    Ok(clean)
}

/// The first `N` numbers of a statement.
fn numbers<const N: usize>(rest: &str) -> Option<[f32; N]> {
    let mut words = rest.split_whitespace();
    let mut found = [0.0; N];
    for x in &mut found {
        *x = words.next()?.parse().ok()?;
    }
    Some(found)
}

/// The absolute number, from 1, of what a face names: from the front, or backwards from the last
/// of `seen`.
fn index(text: &str, seen: usize, total: usize) -> Option<usize> {
    let index: i64 = text.parse().ok()?;
    let absolute = if index < 0 {
        (seen as i64).checked_add(index)?.checked_add(1)?
    } else {
        index
    };
    usize::try_from(absolute)
        .ok()
        .filter(|absolute| (1..=total).contains(absolute))
}

/// The MTL files that the OBJ file names.
struct Libraries<'a> {
    /// The OBJ file, and its directory.
    place: &'a str,
    directory: PathBuf,
    /// Whether materials matter at all.
    wanted: bool,
    /// Where MTL files were found.
    seen: RefCell<Vec<PathBuf>>,
    /// `tobj` has no place for our error.
    failed: RefCell<Option<Error>>,
}

impl Libraries<'_> {
    fn load(&self, name: &Path) -> tobj::MTLLoadResult {
        let none = Ok((Vec::new(), Default::default()));
        if !self.wanted {
            return none;
        }
        let path = self.directory.join(name);
        match text(&path) {
            Ok(text) => {
                let parent = path.parent().unwrap_or(Path::new("")).to_owned();
                self.seen.borrow_mut().push(parent);
                tobj::load_mtl_buf(&mut clean_mtl(&text).as_bytes())
            }
            Err(error) => {
                let reason = match error {
                    Error::Read { reason, .. } => reason,
                    other => other.to_string(),
                };
                let error = Error::content(
                    self.place,
                    &format!(
                        "the material file '{}' cannot be read ({reason})",
                        name.display()
                    ),
                    "put it beside the OBJ file or give a picture with --texture FILE",
                );
                self.failed.borrow_mut().get_or_insert(error);
                none
            }
        }
    }
}

/// The statements of an MTL file that are drawn.
fn clean_mtl(text: &str) -> String {
    let mut clean = String::new();
    for (keyword, rest) in text.lines().map(statement) {
        match keyword.to_ascii_lowercase().as_str() {
            "newmtl" if !rest.is_empty() => {
                let _ = writeln!(clean, "newmtl {rest}");
            }
            // One number stands for three. Spectral curves are not supported.
            "kd" => {
                if let Some([r, g, b]) = numbers(rest).or_else(|| numbers(rest).map(|[k]| [k; 3])) {
                    let _ = writeln!(clean, "Kd {r:e} {g:e} {b:e}");
                }
            }
            "map_kd" if !rest.is_empty() => {
                let _ = writeln!(clean, "map_Kd {rest}");
            }
            _ => {}
        }
    }
    clean
}

/// Materials to surfaces.
struct Surfaces<'a> {
    materials: &'a [tobj::Material],
    /// Where pictures are looked for, in this order.
    libraries: Vec<PathBuf>,
    directory: &'a Path,
}

impl Surfaces<'_> {
    fn of(
        &self,
        id: Option<usize>,
        pictures: &mut HashMap<String, Arc<Picture>>,
        source: &mut Source,
    ) -> Result<Surface, Error> {
        if let Some(texture) = &source.texture {
            return Ok(Surface::Picture(Arc::clone(texture)));
        }
        let Some(material) = id.and_then(|id| self.materials.get(id)) else {
            return Ok(Surface::Colour {
                material: "a mesh without material".to_owned(),
                rgb: [255; 3],
            });
        };
        let Some(statement) = &material.diffuse_texture else {
            let channel = |x: f32| (x.clamp(0.0, 1.0) * 255.0).round() as u8;
            return Ok(Surface::Colour {
                material: format!("material '{}'", material.name),
                rgb: material.diffuse.unwrap_or([1.0; 3]).map(channel),
            });
        };
        let (name, has_options) = texture_name(statement);
        if has_options {
            let material = &material.name;
            source.notice(&format!(
                "options of map_Kd are ignored in material '{material}'"
            ));
        }
        if let Some(picture) = pictures.get(name) {
            return Ok(Surface::Picture(Arc::clone(picture)));
        }
        let Some(path) = self.find(name) else {
            return Err(source.error(
                &format!(
                    "the texture '{name}' of material '{}' is missing",
                    material.name
                ),
                "put it beside the MTL file or give a picture with --texture FILE",
            ));
        };
        let (picture, notice) = Picture::load(&path)?;
        source.notices.extend(notice);
        let picture = Arc::new(picture);
        pictures.insert(name.to_owned(), Arc::clone(&picture));
        Ok(Surface::Picture(picture))
    }

    /// The file of a picture: as named, seen from the MTL files and from the OBJ file, with either
    /// slash; or beside them, for exporters write paths of their own machine.
    fn find(&self, name: &str) -> Option<PathBuf> {
        let slashed = name.replace('\\', "/");
        let bare = slashed.rsplit('/').next().unwrap_or(name);
        let directories = || {
            self.libraries
                .iter()
                .map(PathBuf::as_path)
                .chain([self.directory])
        };
        [name, &slashed, bare]
            .iter()
            .flat_map(|name| directories().map(move |directory| directory.join(name)))
            .find(|path| path.is_file())
    }
}

/// The file name of a `map_Kd` statement, and whether options such as `-s 2 2 1` come before it.
fn texture_name(statement: &str) -> (&str, bool) {
    let mut rest = statement.trim();
    let mut has_options = false;
    while rest.starts_with('-') {
        let (option, mut after) = self::statement(rest);
        let (least, most) = match option {
            "-o" | "-s" | "-t" => (1, 3),
            "-mm" => (2, 2),
            "-blendu" | "-blendv" | "-boost" | "-bm" | "-cc" | "-clamp" | "-imfchan"
            | "-texres" | "-type" => (1, 1),
            // A file whose name starts with a dash.
            _ => break,
        };
        for taken in 0..most {
            let (word, remaining) = self::statement(after);
            if taken >= least && word.parse::<f32>().is_err() {
                break;
            }
            after = remaining;
        }
        has_options = true;
        rest = after;
    }
    (rest, has_options)
}

#[cfg(test)]
mod tests {
    use super::{clean_mtl, index, texture_name};

    #[test]
    fn options_before_a_texture_name_are_skipped() {
        assert_eq!(texture_name("a b.png"), ("a b.png", false));
        assert_eq!(texture_name("-s 2 2 1 a b.png"), ("a b.png", true));
        assert_eq!(texture_name("-s 2 -clamp on a.png"), ("a.png", true));
        assert_eq!(texture_name("-mm 0 1 a.png"), ("a.png", true));
        assert_eq!(texture_name("-odd.png"), ("-odd.png", false));
        assert_eq!(texture_name("-s"), ("", true));
    }

    #[test]
    fn face_indices_count_from_either_end() {
        assert_eq!(index("1", 4, 8), Some(1));
        assert_eq!(index("8", 4, 8), Some(8));
        assert_eq!(index("-1", 4, 8), Some(4));
        assert_eq!(index("-4", 4, 8), Some(1));
        for bad in ["0", "9", "-5", "-9223372036854775808", "x", ""] {
            assert_eq!(index(bad, 4, 8), None, "{bad}");
        }
    }

    #[test]
    fn short_colours_do_not_reach_the_parser() {
        let clean = clean_mtl("newmtl a\nKd 0.5\nnewmtl b\nKd spectral x.rfl\nKs 1\nnewmtl c\nKd");
        let (materials, _) = tobj::load_mtl_buf(&mut clean.as_bytes()).unwrap();
        let colours: Vec<_> = materials.iter().map(|m| m.diffuse).collect();
        assert_eq!(colours, [Some([0.5; 3]), None, None]);
    }
}
