//! Textured meshes from Wavefront OBJ and glTF files. A file enters; what leaves are tables that
//! the core accepts, each with its picture. The readers turn either format into raw meshes in
//! the file's own numbers; `pack` then fits these to the core's ranges.

mod gltf;
mod obj;
pub(crate) mod pack;

use std::path::Path;
use std::sync::Arc;

use multum::geometry::Vertex;

use crate::error::Error;
use crate::file;
use crate::picture::Picture;
use crate::texgen::{self, Projection};

/// Triangles that share one picture.
#[derive(Clone, Debug)]
pub struct Part {
    /// Corners; positions are scaled by [`Model::scale`].
    pub vertices: Vec<Vertex>,
    /// Counter-clockwise seen from the front. [`multum::geometry::Mesh::new`] accepts both tables.
    pub triangles: Vec<[u16; 3]>,
    /// The texture.
    pub picture: Arc<Picture>,
}

/// All that is drawn of a file.
#[derive(Clone, Debug)]
pub struct Model {
    /// At least one, each with at least one triangle.
    pub parts: Vec<Part>,
    /// What the file's positions were multiplied by: a power of two, 1 unless the largest
    /// coordinate is above 1024 or below 1/4.
    pub scale: f32,
    /// Middle of the box around all vertices, scaled.
    pub centre: [f32; 3],
    /// Distance from the centre to the farthest vertex, scaled. Zero if all vertices coincide.
    pub radius: f32,
    /// What the user should know: pictures resampled, things in the file that are not drawn.
    pub notices: Vec<String>,
}

impl Model {
    /// Triangles of all parts.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.parts.iter().map(|part| part.triangles.len()).sum()
    }
}

/// Loads a `.obj` (with its MTL), `.glb` or `.gltf` file. `texture`, where given, is used for
/// everything, and the file's own pictures are not read.
///
/// # Errors
///
/// [`Error::Read`] for the model, a buffer or a picture that cannot be read; [`Error::Content`]
/// for what is in them; [`Error::Core`] if the core refuses the tables.
pub fn load(path: &Path, texture: Option<&Path>) -> Result<Model, Error> {
    read(Source::new(path), path, texture)
}

/// Loads a file as [`load`] does, but with texture coordinates that a projection gives: the file
/// needs none, and those it has are not used.
///
/// # Errors
///
/// Those of [`load`], and of [`texgen::apply`] for too many `repeats`.
pub fn load_projected(
    path: &Path,
    texture: Option<&Path>,
    projection: Projection,
    repeats: [f32; 2],
) -> Result<Model, Error> {
    let mut source = Source::new(path);
    source.projected = true;
    let mut model = read(source, path, texture)?;
    texgen::apply(&mut model.parts, projection, repeats)?;
    Ok(model)
}

fn read(mut source: Source, path: &Path, texture: Option<&Path>) -> Result<Model, Error> {
    let read = match path.extension().map(|e| e.to_ascii_lowercase()) {
        Some(e) if e == "obj" => obj::read,
        Some(e) if e == "glb" || e == "gltf" => gltf::read,
        _ => {
            return Err(source.error(
                "not a mesh by its name",
                "give a file whose name ends in .obj, .glb or .gltf",
            ));
        }
    };
    if let Some(texture) = texture {
        let (picture, notice) = Picture::load(texture)?;
        source.notices.extend(notice);
        source.texture = Some(Arc::new(picture));
    }
    let meshes = read(path, &mut source)?;
    if meshes.iter().all(|mesh| mesh.triangles.is_empty()) {
        return Err(source.error(
            "no triangles",
            "export the model again with its faces as a mesh",
        ));
    }
    let parts = pack::surfaces(meshes, &mut source)?;
    pack::model(&parts, source)
}

/// The file that is being read, and what was found out on the way.
struct Source {
    /// How the file is called in errors.
    place: String,
    /// How the file is called in notices.
    name: String,
    /// The picture that the user gave for everything.
    texture: Option<Arc<Picture>>,
    /// Whether texture coordinates come from positions, and the file's are all read as zero.
    projected: bool,
    notices: Vec<String>,
}

impl Source {
    fn new(path: &Path) -> Self {
        Self {
            place: path.display().to_string(),
            name: file::name(path),
            texture: None,
            projected: false,
            notices: Vec::new(),
        }
    }

    fn error(&self, problem: &str, remedy: &str) -> Error {
        Error::content(&self.place, problem, remedy)
    }

    /// Notes something once.
    fn notice(&mut self, text: &str) {
        let notice = crate::error::one_line(&format!("{}: {text}", self.name));
        if !self.notices.contains(&notice) {
            self.notices.push(notice);
        }
    }

    /// The error for a mesh that cannot be textured.
    fn no_uv(&self, mesh: &str) -> Error {
        self.error(
            &format!("{mesh} has no texture coordinates"),
            "unwrap it (UVs) in the modelling program and export the file again, or give --texgen",
        )
    }
}

/// A mesh with the numbers of its file.
struct RawMesh {
    /// How errors call it, such as `mesh 'Cube'`.
    name: String,
    positions: Vec<[f32; 3]>,
    /// As many as positions, v down.
    uvs: Vec<[f32; 2]>,
    /// Below the number of positions.
    triangles: Vec<[u32; 3]>,
    surface: Surface,
}

/// What covers a mesh.
enum Surface {
    Picture(Arc<Picture>),
    /// A material without a picture, and its colour in sRGB.
    Colour {
        material: String,
        rgb: [u8; 3],
    },
}
