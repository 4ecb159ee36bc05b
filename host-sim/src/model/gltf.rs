//! glTF files, parsed by the `gltf` crate: the meshes of the default scene where its nodes place
//! them, with the base colour texture.
//!
//! The crate trusts offsets, strides and counts, and panics on some that are wrong; so every
//! accessor is checked against its buffer before the crate reads it.

mod accessor;
mod data;

use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::Arc;

use gltf::mesh::Mode;
use gltf::texture::WrappingMode;
use gltf::{Document, Gltf, Material, Node, Primitive};

use self::data::Data;
use super::{RawMesh, Source, Surface};
use crate::error::Error;
use crate::file;
use crate::picture::Picture;

/// Column-major, as in the file.
type Matrix = [[f64; 4]; 4];

/// Reads the meshes of a glTF file.
pub(super) fn read(path: &Path, source: &mut Source) -> Result<Vec<RawMesh>, Error> {
    let bytes = file::read(path)?;
    let (document, blob) = parse(&bytes, source)?;
    let data = Data::load(&document, blob, path, source)?;
    let mut reader = Reader {
        document: &document,
        data,
        pictures: HashMap::new(),
        source,
    };
    reader.scene()
}

/// The document and the binary chunk, both valid as far as the crate looks.
fn parse(bytes: &[u8], source: &Source) -> Result<(Document, Option<Vec<u8>>), Error> {
    let bad = |problem: &str| {
        source.error(
            &format!("not a usable glTF file ({problem})"),
            "export the model again as glTF 2.0",
        )
    };
    // The crate subtracts the header's 12 bytes from the length that the header states.
    let stated = bytes.get(8..12).and_then(|b| b.try_into().ok());
    if bytes.starts_with(b"glTF") && stated.is_none_or(|b| u32::from_le_bytes(b) < 12) {
        return Err(bad("the header is cut off"));
    }
    let unchecked = Gltf::from_slice_without_validation(bytes);
    let Gltf { document, blob } = unchecked.map_err(|e| bad(&e.to_string()))?;
    let root = document.into_json();
    // The crate's validation looks up POSITION without checking that the accessor exists.
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    for accessor in primitives.flat_map(|primitive| primitive.attributes.values()) {
        if accessor.value() >= root.accessors.len() {
            return Err(bad(&format!(
                "an attribute names accessor {accessor}, but the file has {}",
                root.accessors.len()
            )));
        }
    }
    match Document::from_json(root) {
        Ok(document) => Ok((document, blob)),
        Err(gltf::Error::Validation(problems)) if !problems.is_empty() => {
            let (path, problem) = &problems[0];
            let more = match problems.len() {
                1 => String::new(),
                n => format!(" and {} more", n - 1),
            };
            Err(bad(&format!("{path}: {problem}{more}")))
        }
        Err(e) => Err(bad(&e.to_string())),
    }
}

struct Reader<'a, 's> {
    document: &'a Document,
    data: Data,
    /// By number of the image.
    pictures: HashMap<usize, Arc<Picture>>,
    source: &'s mut Source,
}

impl<'a> Reader<'a, '_> {
    fn scene(&mut self) -> Result<Vec<RawMesh>, Error> {
        let mut scenes = self.document.scenes();
        let Some(scene) = self.document.default_scene().or_else(|| scenes.next()) else {
            return Err(self.source.error(
                "no scene",
                "export the model again with a scene that shows it",
            ));
        };
        let mut meshes = Vec::new();
        let mut visited = HashSet::new();
        // Not recursive: a deep file must not exhaust the stack.
        let mut waiting: Vec<(Node<'a>, Matrix)> =
            scene.nodes().map(|node| (node, IDENTITY)).collect();
        waiting.reverse();
        while let Some((node, parent)) = waiting.pop() {
            if !visited.insert(node.index()) {
                return Err(self.source.error(
                    &format!(
                        "node {} has two parents or is its own ancestor",
                        node.index()
                    ),
                    "export the model again as glTF 2.0",
                ));
            }
            let own = node
                .transform()
                .matrix()
                .map(|column| column.map(f64::from));
            let world = product(&parent, &own);
            if let Some(mesh) = node.mesh() {
                // The skeleton places a skinned mesh, not the node; at rest it stays as modelled.
                let matrix = if node.skin().is_some() {
                    self.source
                        .notice("skins are ignored: meshes are drawn as modelled");
                    IDENTITY
                } else {
                    world
                };
                for primitive in mesh.primitives() {
                    let name = mesh.name().map_or_else(
                        || format!("mesh {}", mesh.index()),
                        |n| format!("mesh '{n}'"),
                    );
                    meshes.extend(self.primitive(&primitive, name, &matrix)?);
                }
            }
            let first_child = waiting.len();
            waiting.extend(node.children().map(|child| (child, world)));
            waiting[first_child..].reverse();
        }
        Ok(meshes)
    }

    /// `None` for points and lines.
    fn primitive(
        &mut self,
        primitive: &Primitive<'a>,
        name: String,
        matrix: &Matrix,
    ) -> Result<Option<RawMesh>, Error> {
        let mode = primitive.mode();
        if !matches!(
            mode,
            Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan
        ) {
            self.source.notice("points and lines are not drawn");
            return Ok(None);
        }
        let bad = |problem: &str| {
            self.source.error(
                &format!("{name}: {problem}"),
                "export the model again as glTF 2.0",
            )
        };
        let file_positions = accessor::positions(primitive, &self.data).map_err(|e| bad(&e))?;
        let indices = accessor::indices(primitive, file_positions.len(), &self.data);
        let indices = indices.map_err(|e| bad(&e))?;
        let mut triangles = triangles(mode, &indices).map_err(|e| bad(&e))?;
        if triangles.is_empty() {
            return Ok(None);
        }
        if determinant(matrix) < 0.0 {
            // A mirroring node turns fronts into backs; glTF wants them turned again.
            for triangle in &mut triangles {
                triangle.swap(1, 2);
            }
        }
        let positions: Vec<[f32; 3]> = file_positions
            .iter()
            .map(|&position| transformed(matrix, position))
            .collect();

        let material = primitive.material();
        let texture = material.pbr_metallic_roughness().base_color_texture();
        let transform = texture
            .as_ref()
            .and_then(gltf::texture::Info::texture_transform);
        let set = texture.as_ref().map_or(0, |info| {
            let of_transform = transform.as_ref().and_then(|t| t.tex_coord());
            of_transform.unwrap_or(info.tex_coord())
        });
        let uvs = if self.source.projected {
            Some(vec![[0.0; 2]; positions.len()])
        } else {
            accessor::tex_coords(primitive, set, &self.data).map_err(|e| bad(&e))?
        };
        let Some(mut uvs) = uvs else {
            return Err(self.source.no_uv(&name));
        };
        if uvs.len() != positions.len() {
            return Err(bad(&format!(
                "{} texture coordinates for {} vertices",
                uvs.len(),
                positions.len()
            )));
        }
        if let Some(transform) = transform.filter(|_| !self.source.projected) {
            let (offset, scale) = (transform.offset(), transform.scale());
            for uv in &mut uvs {
                *uv = moved_uv(*uv, offset, transform.rotation(), scale);
            }
        }
        let surface = self.surface(&material)?;
        Ok(Some(RawMesh {
            name,
            positions,
            uvs,
            triangles,
            surface,
        }))
    }

    fn surface(&mut self, material: &Material<'a>) -> Result<Surface, Error> {
        if let Some(texture) = &self.source.texture {
            return Ok(Surface::Picture(Arc::clone(texture)));
        }
        let name = match (material.name(), material.index()) {
            (Some(name), _) => format!("material '{name}'"),
            (None, Some(index)) => format!("material {index}"),
            (None, None) => "a mesh without material".to_owned(),
        };
        let pbr = material.pbr_metallic_roughness();
        let [r, g, b, _] = pbr.base_color_factor();
        let Some(info) = pbr.base_color_texture() else {
            return Ok(Surface::Colour {
                material: name,
                rgb: [r, g, b].map(srgb),
            });
        };
        if [r, g, b] != [1.0; 3] {
            let notice = format!("the colour of {name} is ignored: it has a texture");
            self.source.notice(&notice);
        }
        let sampler = info.texture().sampler();
        if [sampler.wrap_s(), sampler.wrap_t()] != [WrappingMode::Repeat; 2] {
            let notice = format!("the wrap mode of {name} is ignored: its texture repeats");
            self.source.notice(&notice);
        }
        let image = info.texture().source().index();
        if let Some(picture) = self.pictures.get(&image) {
            return Ok(Surface::Picture(Arc::clone(picture)));
        }
        let (picture, notice) = self.data.picture(self.document, image, self.source)?;
        self.source.notices.extend(notice);
        let picture = Arc::new(picture);
        self.pictures.insert(image, Arc::clone(&picture));
        Ok(Surface::Picture(picture))
    }
}

/// Strips and fans become triangles in the order that keeps their fronts.
fn triangles(mode: Mode, indices: &[u32]) -> Result<Vec<[u32; 3]>, String> {
    let from = |i: usize| [indices[i], indices[i + 1], indices[i + 2]];
    let starts = 0..indices.len().saturating_sub(2);
    Ok(match mode {
        Mode::TriangleStrip => starts
            .map(|i| {
                let [a, b, c] = from(i);
                if i % 2 == 0 { [a, b, c] } else { [a, c, b] }
            })
            .collect(),
        Mode::TriangleFan => starts
            .map(|i| [indices[i + 1], indices[i + 2], indices[0]])
            .collect(),
        _ if !indices.len().is_multiple_of(3) => {
            return Err(format!(
                "{} indices do not make whole triangles",
                indices.len()
            ));
        }
        _ => starts.step_by(3).map(from).collect(),
    })
}

const IDENTITY: Matrix = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
    [0.0, 0.0, 0.0, 1.0],
];

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    b.map(|column| [0, 1, 2, 3].map(|row| (0..4).map(|k| a[k][row] * column[k]).sum()))
}

fn transformed(matrix: &Matrix, [x, y, z]: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = [f64::from(x), f64::from(y), f64::from(z)];
    [0, 1, 2].map(|row| {
        (matrix[0][row] * x + matrix[1][row] * y + matrix[2][row] * z + matrix[3][row]) as f32
    })
}

/// Of the part that turns and scales.
fn determinant([a, b, c, _]: &Matrix) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1])
        + c[0] * (a[1] * b[2] - a[2] * b[1])
}

/// `KHR_texture_transform`: scale, then rotation, then offset.
fn moved_uv([u, v]: [f32; 2], offset: [f32; 2], rotation: f32, scale: [f32; 2]) -> [f32; 2] {
    let (sin, cos) = rotation.sin_cos();
    let (u, v) = (u * scale[0], v * scale[1]);
    [cos * u + sin * v + offset[0], cos * v - sin * u + offset[1]]
}

/// A linear channel from 0 to 1 as an 8-bit sRGB value (IEC 61966-2-1).
fn srgb(linear: f32) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded = if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    };
    (encoded * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::{Mode, moved_uv, srgb, triangles};

    #[test]
    fn strips_and_fans_keep_their_fronts() {
        let strip = triangles(Mode::TriangleStrip, &[0, 1, 2, 3, 4]).unwrap();
        assert_eq!(strip, [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        let fan = triangles(Mode::TriangleFan, &[0, 1, 2, 3]).unwrap();
        assert_eq!(fan, [[1, 2, 0], [2, 3, 0]]);
        let list = triangles(Mode::Triangles, &[0, 1, 2, 3, 4, 5]).unwrap();
        assert_eq!(list, [[0, 1, 2], [3, 4, 5]]);
        assert!(triangles(Mode::Triangles, &[0, 1, 2, 3]).is_err());
        assert!(triangles(Mode::TriangleFan, &[0, 1]).unwrap().is_empty());
    }

    /// The extension's own example shows the lower left quadrant.
    #[test]
    fn texture_transform_rotates_as_its_example_says() {
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        for corner in corners {
            let quarter = std::f32::consts::FRAC_PI_2;
            let [u, v] = moved_uv(corner, [0.0, 1.0], quarter, [0.5, 0.5]);
            assert!((-1e-6..=0.5 + 1e-6).contains(&u), "{corner:?}: u {u}");
            assert!((0.5 - 1e-6..=1.0 + 1e-6).contains(&v), "{corner:?}: v {v}");
        }
    }

    #[test]
    fn base_colours_are_encoded() {
        assert_eq!([0.0, 0.216, 1.0, f32::NAN].map(srgb), [0, 128, 255, 0]);
    }
}
