//! Scenes as Rust source, for chips that have no file system: tables that lie in flash, checked by
//! the compiler. A scene comes in with its meshes and textures loaded; what leaves is the text of
//! a module that a build script writes to its output directory.
//!
//! The text names the core's types by their full paths and expects two types of the including
//! module, `Scene` and `Part`, with the fields of [`BakedScene`] and [`BakedPart`], where a part's
//! tables have become `mesh: Mesh<'static>` and `texture: Texture<'static, Rgb565>` and `parts` is
//! a `&'static [Part]`.

use std::fmt::Write as _;

use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::embedded_graphics::pixelcolor::raw::ToBytes as _;
use multum::geometry::Vertex;
use multum::setup::Cull;
use multum::transform::Transform;

/// A mesh, its texture and its place in the world.
#[derive(Clone, Debug)]
pub struct BakedPart<'a> {
    /// The vertex table.
    pub vertices: &'a [Vertex],
    /// The triangles, as numbers of vertices.
    pub triangles: &'a [[u16; 3]],
    /// Texels in a row of the texture; a power of two.
    pub width: u32,
    /// Rows of the texture; a power of two.
    pub height: u32,
    /// The texture, row by row from the top. It repeats beyond its edges.
    pub texels: &'a [Rgb565],
    /// Model to world.
    pub model: Transform,
}

/// What is drawn, from where, and how.
#[derive(Clone, Debug)]
pub struct BakedScene<'a> {
    /// The name that it is asked for by.
    pub name: &'a str,
    /// Where the camera stands, in world units.
    pub eye: [f32; 3],
    /// What it looks at, in world units.
    pub look: [f32; 3],
    /// The direction that is up in the picture.
    pub up: [f32; 3],
    /// Vertical field of view in radians.
    pub fov_y: f32,
    /// Distance of the near plane in world units.
    pub near: f32,
    /// Whether it needs a depth buffer.
    pub depth: bool,
    /// Which triangles are left out.
    pub cull: Cull,
    /// What stands in the world, in the order of drawing.
    pub parts: Vec<BakedPart<'a>>,
}

/// The source of a module with one public item, `SCENE`.
///
/// Nothing is checked here: tables that the core refuses are refused when the source is compiled.
/// A texture that several parts share is written once.
#[must_use]
pub fn rust_source(scene: &BakedScene<'_>) -> String {
    let mut source = Source(String::new());
    source.line(format_args!("// The scene {:?}, baked.", scene.name));
    let mut textures: Vec<&[Rgb565]> = Vec::new();
    let mut parts = String::new();
    for (number, part) in scene.parts.iter().enumerate() {
        source.vertices(number, part.vertices);
        source.triangles(number, part.triangles);
        let texture = textures
            .iter()
            .position(|known| *known == part.texels)
            .unwrap_or_else(|| {
                source.texels(textures.len(), part.texels);
                textures.push(part.texels);
                textures.len() - 1
            });
        _ = writeln!(
            parts,
            "    Part {{ mesh: mesh(&VERTICES_{number}, &TRIANGLES_{number}), \
             texture: texture(&TEXELS_{texture}, {}, {}), model: {} }},",
            part.width,
            part.height,
            transform(&part.model)
        );
    }
    source.line(format_args!(
        "static PARTS: [Part; {}] = [\n{parts}];",
        scene.parts.len()
    ));
    source.line(format_args!(
        "/// The scene `{}`.\npub static SCENE: Scene = Scene {{ name: {:?}, eye: {}, look: {}, \
         up: {}, fov_y: {}, near: {}, depth: {}, cull: multum::setup::Cull::{:?}, parts: &PARTS }};",
        scene.name,
        scene.name,
        floats(scene.eye),
        floats(scene.look),
        floats(scene.up),
        float(scene.fov_y),
        float(scene.near),
        scene.depth,
        scene.cull,
    ));
    source.line(format_args!("{HELPERS}"));
    source.0
}

/// What turns tables into checked objects while the firmware is compiled.
///
/// Texels are one byte string and a loop, not one expression each: a compiler reads that a
/// hundred times faster.
const HELPERS: &str = r#"
const fn texels<const N: usize>(bytes: &[u8]) -> [multum::embedded_graphics::pixelcolor::Rgb565; N] {
    use multum::embedded_graphics::pixelcolor::Rgb565;
    assert!(bytes.len() == 2 * N, "a texel has two bytes");
    let mut texels = [Rgb565::new(0, 0, 0); N];
    let mut i = 0;
    while i < N {
        let (low, high) = (bytes[2 * i], bytes[2 * i + 1]);
        texels[i] = Rgb565::new(high >> 3, high << 3 | low >> 5, low);
        i += 1;
    }
    texels
}

const fn mesh(
    vertices: &'static [multum::geometry::Vertex],
    triangles: &'static [[u16; 3]],
) -> multum::geometry::Mesh<'static> {
    match multum::geometry::Mesh::new(vertices, triangles) {
        Ok(mesh) => mesh,
        Err(_) => panic!("the core refuses this mesh"),
    }
}

const fn texture(
    texels: &'static [multum::embedded_graphics::pixelcolor::Rgb565],
    width: u32,
    height: u32,
) -> multum::texture::Texture<'static, multum::embedded_graphics::pixelcolor::Rgb565> {
    match multum::texture::Texture::new(texels, width, height) {
        Ok(texture) => texture,
        Err(_) => panic!("the core refuses this texture"),
    }
}

const fn transform(rows: [[i32; 3]; 3], translation: [i32; 3]) -> multum::transform::Transform {
    use multum::fixed::types::{I8F24, I16F16};
    const fn row(row: [i32; 3]) -> [I8F24; 3] {
        [I8F24::from_bits(row[0]), I8F24::from_bits(row[1]), I8F24::from_bits(row[2])]
    }
    let [x, y, z] = translation;
    multum::transform::Transform {
        rows: [row(rows[0]), row(rows[1]), row(rows[2])],
        translation: [I16F16::from_bits(x), I16F16::from_bits(y), I16F16::from_bits(z)],
    }
}
"#;

/// The text as it grows.
struct Source(String);

impl Source {
    fn line(&mut self, line: std::fmt::Arguments<'_>) {
        // Writing to a string does not fail.
        _ = writeln!(self.0, "{line}");
    }

    fn vertices(&mut self, number: usize, vertices: &[Vertex]) {
        self.line(format_args!(
            "static VERTICES_{number}: [multum::geometry::Vertex; {}] = [",
            vertices.len()
        ));
        for Vertex { position, uv } in vertices {
            self.line(format_args!(
                "    multum::geometry::Vertex::from_bits({:?}, {:?}),",
                position.map(|c| c.to_bits()),
                uv.map(|c| c.to_bits())
            ));
        }
        self.line(format_args!("];"));
    }

    fn triangles(&mut self, number: usize, triangles: &[[u16; 3]]) {
        self.line(format_args!(
            "static TRIANGLES_{number}: [[u16; 3]; {}] = {triangles:?};",
            triangles.len()
        ));
    }

    fn texels(&mut self, number: usize, texels: &[Rgb565]) {
        let mut bytes = String::with_capacity(8 * texels.len());
        for byte in texels.iter().flat_map(|texel| texel.to_le_bytes()) {
            _ = write!(bytes, "\\x{byte:02x}");
        }
        self.line(format_args!(
            "static TEXELS_{number}: [multum::embedded_graphics::pixelcolor::Rgb565; {}] = texels(b\"{bytes}\");",
            texels.len()
        ));
    }
}

/// An affine map by its raw bits.
fn transform(map: &Transform) -> String {
    format!(
        "transform({:?}, {:?})",
        map.rows.map(|row| row.map(|e| e.to_bits())),
        map.translation.map(|e| e.to_bits())
    )
}

/// A number by its bits: a decimal might be read back as its neighbour.
fn float(value: f32) -> String {
    format!("f32::from_bits({:#010x})", value.to_bits())
}

fn floats(values: [f32; 3]) -> String {
    let [x, y, z] = values.map(float);
    format!("[{x}, {y}, {z}]")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shared_textures_are_written_once_and_numbers_as_bits() {
        let vertices = [Vertex::from_bits([1, -2, 3], [4, -5])];
        let texels = [Rgb565::new(31, 0, 1)];
        let part = BakedPart {
            vertices: &vertices,
            triangles: &[[0, 0, 0]],
            width: 1,
            height: 1,
            texels: &texels,
            model: Transform::IDENTITY,
        };
        let source = rust_source(&BakedScene {
            name: "two",
            eye: [1.0, 0.0, 0.0],
            look: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            fov_y: 1.0,
            near: 0.5,
            depth: true,
            cull: Cull::Back,
            parts: vec![part.clone(), part],
        });
        assert!(source.contains("Vertex::from_bits([1, -2, 3], [4, -5])"));
        assert!(source.contains("TEXELS_0: ") && !source.contains("TEXELS_1"));
        assert!(source.contains(r#"texels(b"\x01\xf8")"#));
        assert!(source.contains("near: f32::from_bits(0x3f000000), depth: true"));
        assert!(source.contains("TRIANGLES_1), texture: texture(&TEXELS_0, 1, 1)"));
    }
}
