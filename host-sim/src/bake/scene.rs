//! Whole scenes. One comes in with its meshes and textures loaded; what leaves is the text of a
//! module that a build script writes to its output directory.
//!
//! The text expects three types of the including module: `Scene` (name, eye, look, up, fov_y in
//! radians, near, depth, cull, background and parts, a `&'static [Part]`), `Part` (mesh, skin,
//! stand) and `Skin` (`Plain`, a texture, or `Levels`, a reference to a pyramid).

use std::fmt::Write as _;
use std::sync::Arc;

use multum::embedded_graphics::pixelcolor::Rgb565;
use multum::embedded_graphics::pixelcolor::raw::ToBytes as _;
use multum::embedded_graphics::prelude::*;
use multum::geometry::Vertex;
use multum::pyramid::average::Average;
use multum::pyramid::{self, build::build};
use multum::transform::Transform;

use super::source::{Source, Unit};
use crate::error::Error;
use crate::picture::Picture;
use crate::reference::Beyond;
use crate::scene::{BACKGROUND, Scene};

/// What is baked of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Skin {
    /// The finest level.
    Plain,
    /// All levels, averaged so.
    Levels(Average),
}

/// The source of a module with one public item, `SCENE`.
///
/// A picture that several props share is written once.
///
/// # Errors
///
/// [`Error::Content`] for a texture that does not repeat: baked scenes have no other wrap mode.
/// Tables that the core refuses are refused when the source is compiled.
pub fn rust_source(scene: &Scene, skin: Skin) -> Result<String, Error> {
    let mut source = Source::default();
    source.line(format_args!("// The scene {:?}, baked.", scene.name));
    let mut textures: Vec<&Arc<Picture>> = Vec::new();
    let mut parts = String::new();
    for (number, prop) in scene.props.iter().enumerate() {
        if prop.wrap != Beyond::Repeat {
            return Err(Error::content(
                &format!("scene {}", scene.name),
                "a texture that does not repeat",
                "bake scenes with repeating textures only",
            ));
        }
        let part = &prop.part;
        source.vertices(number, &part.vertices);
        source.triangles(number, &part.triangles);
        let known = textures
            .iter()
            .position(|known| Arc::ptr_eq(known, &part.picture));
        let texture = match known {
            Some(number) => number,
            None => {
                let texels = texels(&part.picture, skin)?;
                let bytes: Vec<u8> = texels
                    .iter()
                    .flat_map(|texel| texel.to_le_bytes())
                    .collect();
                let name = format!("TEXELS_{}", textures.len());
                source.table(&name, Unit::RGB565, "texels", &bytes);
                if let Skin::Levels(_) = skin {
                    source.line(format_args!(
                        "static LEVELS_{}: {PYRAMID_TYPE} = pyramid(&{name}, {}, {});",
                        textures.len(),
                        part.picture.width(),
                        part.picture.height()
                    ));
                }
                textures.push(&part.picture);
                textures.len() - 1
            }
        };
        let skin = match skin {
            Skin::Plain => format!(
                "Plain(texture(&TEXELS_{texture}, {}, {}))",
                part.picture.width(),
                part.picture.height()
            ),
            Skin::Levels(_) => format!("Levels(&LEVELS_{texture})"),
        };
        _ = writeln!(
            parts,
            "    Part {{ mesh: mesh(&VERTICES_{number}, &TRIANGLES_{number}), \
             skin: Skin::{skin}, stand: {} }},",
            transform(&prop.stand)
        );
    }
    source.line(format_args!(
        "static PARTS: [Part; {}] = [\n{parts}];",
        scene.props.len()
    ));
    let view = &scene.view;
    source.line(format_args!(
        "/// The scene `{}`.\npub static SCENE: Scene = Scene {{ name: {:?}, eye: {}, look: {}, \
         up: {}, fov_y: {}, near: {}, depth: {}, cull: multum::setup::Cull::{:?}, background: {}, \
         parts: &PARTS }};",
        scene.name,
        scene.name,
        floats(view.eye),
        floats(view.look),
        floats(view.up),
        float(view.fov_y_radians()),
        float(view.near),
        scene.depth,
        scene.cull,
        colour(BACKGROUND),
    ));
    let helper = match skin {
        Skin::Plain => TEXTURE,
        Skin::Levels(_) => PYRAMID,
    };
    let texels = Unit::RGB565.functions("colour", "texels");
    source.line(format_args!("{texels}{HELPERS}{helper}"));
    Ok(source.0)
}

/// The texels of a picture, and of its levels.
fn texels(picture: &Picture, skin: Skin) -> Result<Vec<Rgb565>, Error> {
    let mut texels = picture.rgb565();
    if let Skin::Levels(average) = skin {
        let (width, height) = (picture.width(), picture.height());
        texels.resize(pyramid::texels(width, height), Rgb565::BLACK);
        build(&mut texels, width, height, average).map_err(|e| Error::core("pyramid", e))?;
    }
    Ok(texels)
}

/// What turns tables into checked objects while the firmware is compiled.
const HELPERS: &str = r#"
const fn mesh(
    vertices: &'static [multum::geometry::Vertex],
    triangles: &'static [[u16; 3]],
) -> multum::geometry::Mesh<'static> {
    match multum::geometry::Mesh::new(vertices, triangles) {
        Ok(mesh) => mesh,
        Err(_) => panic!("the core refuses this mesh"),
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

/// The same for a texture of one level.
const TEXTURE: &str = r#"
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
"#;

/// What the text calls a pyramid.
const PYRAMID_TYPE: &str = "multum::pyramid::Pyramid<multum::texture::Texture<'static, \
     multum::embedded_graphics::pixelcolor::Rgb565>>";

/// The same for all levels.
const PYRAMID: &str = r#"
const fn pyramid(
    texels: &'static [multum::embedded_graphics::pixelcolor::Rgb565],
    width: u32,
    height: u32,
) -> multum::pyramid::Pyramid<
    multum::texture::Texture<'static, multum::embedded_graphics::pixelcolor::Rgb565>,
> {
    match multum::pyramid::Pyramid::<multum::texture::Texture<'_, _>>::new(texels, width, height) {
        Ok(pyramid) => pyramid,
        Err(_) => panic!("the core refuses this pyramid"),
    }
}
"#;

impl Source {
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
}

/// An affine map by its raw bits.
fn transform(map: &Transform) -> String {
    format!(
        "transform({:?}, {:?})",
        map.rows.map(|row| row.map(|e| e.to_bits())),
        map.translation.map(|e| e.to_bits())
    )
}

/// A colour by its raw bits.
fn colour(colour: Rgb565) -> String {
    format!("colour({:?})", colour.to_le_bytes())
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
    use multum::setup::Cull;

    use super::*;
    use crate::model::Part;
    use crate::scene::{Prop, View};

    fn scene(wrap: Beyond) -> Scene {
        let picture = Arc::new(Picture::new(1, 1, vec![[255, 0, 8]]).expect("one pixel"));
        let prop = Prop {
            part: Part {
                vertices: vec![Vertex::from_bits([1, -2, 3], [4, -5])],
                triangles: vec![[0, 0, 0]],
                picture,
            },
            stand: Transform::IDENTITY,
            wrap,
        };
        Scene {
            name: "two".to_owned(),
            view: View {
                eye: [1.0, 0.0, 0.0],
                look: [0.0; 3],
                up: [0.0, 1.0, 0.0],
                fov_y: 60.0,
                near: 0.5,
            },
            units: 1.0,
            props: vec![prop.clone(), prop],
            cull: Cull::Back,
            depth: true,
        }
    }

    #[test]
    fn shared_textures_are_written_once_and_numbers_as_bits() {
        let source =
            rust_source(&scene(Beyond::Repeat), Skin::Plain).expect("a scene that can be baked");
        assert!(source.contains("Vertex::from_bits([1, -2, 3], [4, -5])"));
        assert!(source.contains("TEXELS_0: ") && !source.contains("TEXELS_1"));
        assert!(source.contains(r#"texels(b"\x01\xf8")"#));
        assert!(source.contains("near: f32::from_bits(0x3f000000), depth: true"));
        assert!(source.contains("TRIANGLES_1), skin: Skin::Plain(texture(&TEXELS_0, 1, 1))"));
    }

    #[test]
    fn levels_are_written_with_the_finest() {
        let mut scene = scene(Beyond::Repeat);
        let pixels = vec![[0, 0, 0], [0, 0, 0], [248, 0, 0], [248, 0, 0]];
        let picture = Arc::new(Picture::new(2, 2, pixels).expect("two by two"));
        scene.props.truncate(1);
        scene.props[0].part.picture = picture;
        let skin = Skin::Levels(Average::Stored);
        let source = rust_source(&scene, skin).expect("a scene that can be baked");
        // Red of 0, 0, 30, 30: 15.
        assert!(source.contains("Rgb565; 5]"), "{source}");
        assert!(source.contains(r#"\x00\xf0\x00\xf0\x00\x78""#), "{source}");
        assert!(source.contains(" = pyramid(&TEXELS_0, 2, 2);"));
        assert!(source.contains("skin: Skin::Levels(&LEVELS_0)"));
    }

    #[test]
    fn wrap_modes_that_a_baked_scene_has_not_are_refused() {
        assert!(rust_source(&scene(Beyond::Mirror), Skin::Plain).is_err());
    }
}
