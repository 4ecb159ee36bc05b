//! Textures by themselves, with or without their mip levels; several pictures become an atlas.
//!
//! The text holds one public item with the texture's name, a `static` wherever the core has a
//! constructor that the compiler can run; of an atlas also `RECTANGLES`.

use multum::embedded_graphics::pixelcolor::raw::ToBytes as _;
use multum::embedded_graphics::pixelcolor::{Rgb565, Rgb888};
use multum::pyramid::average::Average;
use multum::pyramid::{level_size, levels};
use multum::texture::Bc1;

use super::source::{Source, Unit, byte_string};
use crate::atlas::{self, Rectangle};
use crate::error::Error;
use crate::filtering::{AVERAGES, FORMATS, Format, name_of};
use crate::picture::Picture;
use crate::reference::Beyond;
use crate::stored::{Indexed, Stored, Texels};

/// Which levels of a texture are baked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Levels {
    /// Down to one texel.
    #[default]
    All,
    /// The finest.
    One,
}

/// Levels by name.
pub const LEVELS: [(&str, Levels); 2] = [("all", Levels::All), ("one", Levels::One)];

/// What becomes of pictures.
#[derive(Clone, Copy, Debug, Default)]
pub struct Plan {
    /// How texels are stored.
    pub format: Format,
    /// How levels are averaged.
    pub average: Average,
    /// Which levels.
    pub levels: Levels,
    /// In an atlas: texels around each picture that repeat its edge, at least.
    pub padding: Option<u32>,
}

/// A texture as text.
#[derive(Clone, Debug)]
pub struct Baked {
    /// A module's text.
    pub source: String,
    /// Width and height in texels.
    pub size: (u32, u32),
    /// How many levels it has.
    pub levels: u32,
    /// Bytes of its tables, which will lie in flash.
    pub bytes: usize,
}

/// The name of a `static`: capital letters, digits and single underscores, no digit first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name(String);

impl Name {
    /// Checks a name.
    ///
    /// # Errors
    ///
    /// [`Error::Content`] for a name that Rust refuses or warns of.
    pub fn new(name: &str) -> Result<Self, Error> {
        let first = name.starts_with(|c: char| c.is_ascii_uppercase() || c == '_');
        let all = name
            .chars()
            .all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_');
        if first && all && name != "_" && !name.contains("__") {
            Ok(Self(name.to_owned()))
        } else {
            Err(Error::content(
                "--name",
                &format!("'{name}' cannot be the name of a static"),
                "give capital letters, digits and single underscores, no digit first, such as BRICK_WALL",
            ))
        }
    }

    /// The name that a file's stem gives: in upper snake case.
    ///
    /// # Errors
    ///
    /// As [`Name::new`].
    pub fn of_stem(stem: &str) -> Result<Self, Error> {
        let mut name = String::new();
        let mut small = false;
        for c in stem.chars() {
            let c = if c.is_alphanumeric() { c } else { '_' };
            let repeated = c == '_' && name.ends_with('_');
            if small && c.is_ascii_uppercase() {
                name.push('_');
            }
            if !repeated {
                name.push(c.to_ascii_uppercase());
            }
            small = c.is_ascii_lowercase();
        }
        Self::new(&name)
    }

    /// The name of a function, in lower snake case.
    fn function(&self) -> Result<String, Error> {
        let name = self.0.to_ascii_lowercase();
        if KEYWORDS.contains(&name.as_str()) {
            return Err(Error::content(
                "--name",
                &format!("palettes with levels need a function, and '{name}' is a keyword of Rust"),
                "give another --name, or --levels one",
            ));
        }
        Ok(name)
    }
}

/// Words that no function can be called (The Rust Reference, "Keywords": strict and reserved, all
/// editions up to 2024).
const KEYWORDS: [&str; 51] = [
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate",
    "do", "dyn", "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl",
    "in", "let", "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub", "ref",
    "return", "self", "static", "struct", "super", "trait", "true", "try", "type", "typeof",
    "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

/// The source of a module with a texture of this name.
///
/// One picture is the texture. Several become an atlas; the text before each is what the firmware
/// will know it by, in `RECTANGLES`.
///
/// # Errors
///
/// [`Error::Content`] without pictures, for padding around a single one, for an atlas that is too
/// large, and for a name that is taken.
pub fn texture_source(
    name: &Name,
    pictures: &[(String, Picture)],
    plan: &Plan,
) -> Result<Baked, Error> {
    if let [(_, picture)] = pictures {
        if plan.padding.is_some() {
            return Err(Error::content(
                "--padding",
                "a single picture is no atlas and has no neighbours",
                "leave it out, or give several pictures",
            ));
        }
        return bake(name, picture, None, plan);
    }
    if name.0 == RECTANGLES {
        return Err(Error::content(
            "--name",
            "RECTANGLES is the name of the atlas' table",
            "give another",
        ));
    }
    let padding = plan.padding.unwrap_or(0);
    let padded = pictures
        .iter()
        .map(|(_, picture)| atlas::padded(picture, padding, Beyond::Clamp))
        .collect::<Result<Vec<_>, _>>()?;
    let pieces: Vec<&Picture> = padded.iter().map(|padded| &padded.picture).collect();
    let atlas = atlas::pack(&pieces)?;
    let rectangles: Vec<_> = pictures
        .iter()
        .zip(padded.iter().zip(&atlas.rectangles))
        .map(|((label, _), (padded, cell))| {
            let inside = Rectangle {
                left: cell.left + padded.inside.left,
                top: cell.top + padded.inside.top,
                ..padded.inside
            };
            (label.as_str(), inside)
        })
        .collect();
    bake(name, &atlas.picture, Some(&rectangles), plan)
}

/// The table of an atlas.
const RECTANGLES: &str = "RECTANGLES";

fn bake(
    name: &Name,
    picture: &Picture,
    rectangles: Option<&[(&str, Rectangle)]>,
    plan: &Plan,
) -> Result<Baked, Error> {
    let stored = Stored::new(picture, plan.format, plan.average)?;
    let (width, height) = stored.size();
    let mut text = Text {
        source: Source::default(),
        name,
        size: (width, height),
        levels: match plan.levels {
            Levels::All => levels(width, height),
            Levels::One => 1,
        },
        bytes: 0,
        contents: match rectangles {
            Some(rectangles) => format!("An atlas of {} pictures", rectangles.len()),
            None => "A picture".to_owned(),
        },
    };
    match stored.texels() {
        Texels::Palette8(indexed) => text.indexed(indexed, 8, plan.levels)?,
        Texels::Palette4(indexed) => text.indexed(indexed, 4, plan.levels)?,
        Texels::Morton(texels) => {
            text.plain("Morton", Unit::RGB565, &rgb565(texels), plan.levels);
        }
        Texels::Rgb565(texels) => {
            text.plain("Texture", Unit::RGB565, &rgb565(texels), plan.levels);
        }
        Texels::Rgb888(texels) => {
            let bytes: Vec<u8> = texels
                .iter()
                .flat_map(|t: &Rgb888| t.to_be_bytes())
                .collect();
            text.plain("Texture", Unit::RGB888, &bytes, plan.levels);
        }
        Texels::Gray8(texels) => {
            let bytes: Vec<u8> = texels.iter().flat_map(|t| t.to_be_bytes()).collect();
            text.plain("Texture", Unit::GRAY8, &bytes, plan.levels);
        }
        Texels::Rgba5551(texels) => {
            let bytes: Vec<u8> = texels.iter().flat_map(|t| t.0.to_le_bytes()).collect();
            text.plain("Texture", Unit::RGBA5551, &bytes, plan.levels);
        }
        Texels::Rgba8888(texels) => {
            let bytes: Vec<u8> = texels.iter().flat_map(|t| t.0).collect();
            text.plain("Texture", Unit::RGBA8888, &bytes, plan.levels);
        }
        Texels::Bc1(blocks) => {
            text.plain("Bc1", Unit::BC1, blocks.as_flattened(), plan.levels);
        }
    }
    if let Some(rectangles) = rectangles {
        text.rectangles(rectangles, plan);
    }
    let mut source = header(&text, plan);
    source += &text.source.0;
    Ok(Baked {
        source,
        size: text.size,
        levels: text.levels,
        bytes: text.bytes,
    })
}

fn rgb565(texels: &[Rgb565]) -> Vec<u8> {
    texels.iter().flat_map(|t| t.to_le_bytes()).collect()
}

/// What made the text, and what it costs.
fn header(text: &Text<'_>, plan: &Plan) -> String {
    let format = name_of(&FORMATS, plan.format);
    let mut command = format!(
        "host-sim bake --name {} --format {format} --levels {}",
        text.name.0,
        name_of(&LEVELS, plan.levels)
    );
    if plan.levels == Levels::All {
        command += &format!(" --average {}", name_of(&AVERAGES, plan.average));
    }
    if let Some(padding) = plan.padding {
        command += &format!(" --padding {padding}");
    }
    let (width, height) = text.size;
    format!(
        "// Made by {command}\n// {}, {width}x{height} texels, {}, {} bytes in flash.\n\n",
        text.contents,
        count(text.levels),
        text.bytes
    )
}

/// Levels in words.
fn count(levels: u32) -> String {
    match levels {
        1 => "1 level".to_owned(),
        n => format!("{n} levels"),
    }
}

/// What is written of one texture.
struct Text<'a> {
    source: Source,
    name: &'a Name,
    size: (u32, u32),
    levels: u32,
    /// Of all tables.
    bytes: usize,
    /// One picture or several.
    contents: String,
}

impl Text<'_> {
    /// The documentation of the public item.
    fn documentation(&mut self) {
        let (width, height) = self.size;
        self.source.line(format_args!(
            "/// {}, {width}x{height} texels, {}.",
            self.contents,
            count(self.levels)
        ));
    }

    /// A private table of units, made by [`Self::functions`].
    fn table(&mut self, suffix: &str, unit: Unit, bytes: &[u8]) {
        let name = &self.name.0;
        let function = name.to_ascii_lowercase();
        self.bytes += bytes.len();
        self.source.table(
            &format!("{name}_{suffix}"),
            unit,
            &format!("{function}_table"),
            bytes,
        );
    }

    /// The functions that make tables. Their names are the texture's with more behind, so that
    /// they are never equal to it.
    fn functions(&mut self, unit: Unit) {
        let name = self.name.0.to_ascii_lowercase();
        let functions = unit.functions(&format!("{name}_unit"), &format!("{name}_table"));
        self.source.0 += &functions;
    }

    /// A format whose levels lie in one table.
    fn plain(&mut self, format: &str, unit: Unit, bytes: &[u8], levels: Levels) {
        let (width, height) = self.size;
        let name = &self.name.0;
        // BC1 has but one colour.
        let (of, any) = if format == "Bc1" {
            ("'static".to_owned(), "'_")
        } else {
            (format!("'static, {}", unit.of), "'_, _")
        };
        let (of, new, bytes) = match levels {
            Levels::All => (
                format!("multum::pyramid::Pyramid<multum::texture::{format}<{of}>>"),
                format!("multum::pyramid::Pyramid::<multum::texture::{format}<{any}>>"),
                bytes,
            ),
            Levels::One => {
                let units = if format == "Bc1" {
                    Bc1::blocks(width, height)
                } else {
                    width as usize * height as usize
                };
                (
                    format!("multum::texture::{format}<{of}>"),
                    format!("multum::texture::{format}"),
                    &bytes[..units * unit.size],
                )
            }
        };
        let item = format!(
            "pub static {name}: {of} =\n    {};\n",
            checked(&format!("{new}::new(&{name}_TEXELS, {width}, {height})"), 1)
        );
        self.documentation();
        self.source.line(format_args!("{item}"));
        self.table("TEXELS", unit, bytes);
        self.functions(unit);
    }

    /// Level 0 as indices; with levels, the others as colours.
    fn indexed(&mut self, texels: &Indexed, bits: u32, levels: Levels) -> Result<(), Error> {
        let (width, height) = self.size;
        let name = &self.name.0.clone();
        let colour = Unit::RGB565.of;
        let finest = format!(
            "multum::texture::Indexed::new(&{name}_INDICES, &{name}_PALETTE, {width}, {height})"
        );
        match levels {
            Levels::One => {
                self.documentation();
                self.source.line(format_args!(
                    "#[allow(long_running_const_eval)]\npub static {name}: multum::texture::Indexed<'static, {colour}, {bits}> =\n    {};\n",
                    checked(&finest, 1)
                ));
            }
            Levels::All => {
                let function = self.name.function()?;
                let level =
                    format!("multum::pyramid::build::IndexedOrDirect<'static, {colour}, {bits}>");
                self.documentation();
                self.source.line(format_args!(
                    "///\n/// Level 0 has palette indices, the others colours. A pyramid of both is put together when\n\
                     /// the program starts; its levels are checked by the compiler.\n///\n/// # Errors\n///\n\
                     /// None: the levels are complete.\n\
                     pub fn {function}() -> Result<\n    multum::pyramid::Pyramid<{level}>,\n    multum::error::Error,\n> {{\n    \
                     multum::pyramid::Pyramid::from_levels(&{name}_LEVELS)\n}}\n"
                ));
                self.source.line(format_args!(
                    "#[allow(long_running_const_eval)]\nstatic {name}_LEVELS: [{level}; {}] = [\n    \
                     multum::pyramid::build::IndexedOrDirect::Indexed({}),",
                    self.levels,
                    checked(&finest, 1)
                ));
                for number in 1..self.levels {
                    let (width, height) = level_size(width, height, number);
                    let new = format!(
                        "multum::texture::Texture::new(&{name}_LEVEL_{number}, {width}, {height})"
                    );
                    self.source.line(format_args!(
                        "    multum::pyramid::build::IndexedOrDirect::Direct({}),",
                        checked(&new, 1)
                    ));
                }
                self.source.line(format_args!("];\n"));
            }
        }
        self.bytes += texels.indices.len();
        self.source.line(format_args!(
            "static {name}_INDICES: [u8; {}] = *{};",
            texels.indices.len(),
            byte_string(&texels.indices)
        ));
        self.table("PALETTE", Unit::RGB565, &rgb565(&texels.palette));
        let mut rest = &texels.coarser[..];
        for number in 1..self.levels {
            let (width, height) = level_size(width, height, number);
            let (level, after) = rest.split_at((width * height) as usize);
            self.table(&format!("LEVEL_{number}"), Unit::RGB565, &rgb565(level));
            rest = after;
        }
        self.functions(Unit::RGB565);
        Ok(())
    }

    /// Where the pictures of an atlas lie.
    fn rectangles(&mut self, rectangles: &[(&str, Rectangle)], plan: &Plan) {
        let (width, height) = self.size;
        let mut text = "\n/// Name, left, top, width and height of each picture, in texels of level 0 from the upper left\n\
             /// corner: what `multum::texture::Window::new` takes.\n"
            .to_owned();
        if plan.levels == Levels::All && plan.padding.is_none() {
            text += "///\n/// In level n all four are divided by 2^n, without a remainder until the picture's shorter\n\
                     /// side is one texel.\n";
        }
        if let Some(padding) = plan.padding {
            text += &format!(
                "///\n/// Each has its edges repeated around it (--padding {padding}), for meshes whose coordinates lie in\n\
                 /// the atlas: (left + u * width) / {width} and (top + v * height) / {height}.\n"
            );
        }
        text += &format!(
            "pub const {RECTANGLES}: [(&str, u32, u32, u32, u32); {}] = [\n",
            rectangles.len()
        );
        for (label, r) in rectangles {
            text += &format!(
                "    ({label:?}, {}, {}, {}, {}),\n",
                r.left, r.top, r.width, r.height
            );
        }
        self.source.line(format_args!("{text}];"));
    }
}

/// A call of a constructor of the core that the compiler makes.
fn checked(call: &str, depth: usize) -> String {
    let indent = "    ".repeat(depth);
    format!(
        "match {call} {{\n{indent}    Ok(texture) => texture,\n{indent}    \
         Err(_) => panic!(\"the core refuses this texture\"),\n{indent}}}"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(name: &str) -> Name {
        Name::new(name).expect("a name")
    }

    fn grey(width: u32, height: u32) -> Picture {
        let pixels = (0..width * height).map(|i| [i as u8; 3]);
        Picture::new(width, height, pixels.collect()).expect("powers of two")
    }

    fn baked(pictures: &[(&str, Picture)], plan: Plan) -> Baked {
        let pictures: Vec<_> = pictures
            .iter()
            .map(|(label, picture)| ((*label).to_owned(), picture.clone()))
            .collect();
        texture_source(&name("T"), &pictures, &plan).expect("pictures that can be baked")
    }

    #[test]
    fn names_are_those_that_rust_takes_without_a_warning() {
        for good in ["A", "_1", "BRICK_2", "_"] {
            assert_eq!(Name::new(good).is_ok(), good != "_", "{good}");
        }
        for bad in [
            "", "brick", "3D", "A-B", "A B", "A__B", "\u{c4}", "A\n", "Brick",
        ] {
            assert!(Name::new(bad).is_err(), "{bad}");
        }
        for (stem, expected) in [
            ("brick", "BRICK"),
            ("brickWall 2", "BRICK_WALL_2"),
            ("a--b.c", "A_B_C"),
            ("RGB565", "RGB565"),
        ] {
            assert_eq!(Name::of_stem(stem).expect(stem), name(expected));
        }
        for bad in ["", "3d", "-", "stra\u{df}e"] {
            assert!(Name::of_stem(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn keywords_are_no_functions_but_may_be_statics() {
        let pictures = [("a".to_owned(), grey(1, 1))];
        let of = |format, levels| {
            let plan = Plan {
                format,
                levels,
                ..Plan::default()
            };
            texture_source(&name("CRATE"), &pictures, &plan)
        };
        assert!(of(Format::Palette8, Levels::All).is_err());
        assert!(of(Format::Palette8, Levels::One).is_ok());
        assert!(of(Format::Rgb565, Levels::All).is_ok());
        assert!(KEYWORDS.is_sorted());
    }

    /// Bytes from the formats' definitions: 4x2 texels, with levels 4x2 + 2x1 + 1x1 = 11, of BC1 a
    /// block for each level.
    #[test]
    fn bytes_in_flash_are_those_of_the_levels_baked() {
        for (format, all, one) in [
            (Format::Rgb565, 22, 16),
            (Format::Rgb888, 33, 24),
            (Format::Gray8, 11, 8),
            (Format::Rgba5551, 22, 16),
            (Format::Rgba8888, 44, 32),
            (Format::Bc1, 24, 8),
            (Format::Morton, 22, 16),
            // 8 indices of a byte or half of one, 8 colours, and 3 texels of the other levels.
            (Format::Palette8, 8 + 16 + 6, 8 + 16),
            (Format::Palette4, 4 + 16 + 6, 4 + 16),
        ] {
            for (levels, bytes, count) in [(Levels::All, all, 3), (Levels::One, one, 1)] {
                let plan = Plan {
                    format,
                    levels,
                    ..Plan::default()
                };
                let baked = baked(&[("grey", grey(4, 2))], plan);
                assert_eq!((baked.bytes, baked.levels), (bytes, count), "{format:?}");
                assert_eq!(baked.size, (4, 2));
                let said = format!(", {bytes} bytes in flash.");
                assert!(
                    baked
                        .source
                        .lines()
                        .nth(1)
                        .is_some_and(|l| l.ends_with(&said))
                );
            }
        }
    }

    #[test]
    fn rectangles_are_those_of_the_atlas() {
        let pictures = [("wall \"a\"", grey(4, 4)), ("b", grey(4, 4))];
        let plain = baked(&pictures, Plan::default());
        assert_eq!(plain.size, (8, 4));
        for line in [
            "pub const RECTANGLES: [(&str, u32, u32, u32, u32); 2] = [",
            "    (\"wall \\\"a\\\"\", 0, 0, 4, 4),",
            "    (\"b\", 4, 0, 4, 4),",
        ] {
            assert!(plain.source.lines().any(|l| l == line), "{}", plain.source);
        }
        // Cells of 8x8, each with its picture in the middle.
        let plan = Plan {
            padding: Some(2),
            ..Plan::default()
        };
        let padded = baked(&pictures, plan);
        assert_eq!(padded.size, (16, 8));
        assert!(padded.source.contains("(\"b\", 10, 2, 4, 4),"));
    }

    #[test]
    fn what_makes_no_atlas_is_refused() {
        let one = [("a".to_owned(), grey(1, 1))];
        let plan = Plan {
            padding: Some(0),
            ..Plan::default()
        };
        assert!(texture_source(&name("T"), &one, &plan).is_err());
        assert!(texture_source(&name("T"), &[], &Plan::default()).is_err());
        let two = [one[0].clone(), one[0].clone()];
        assert!(texture_source(&name("RECTANGLES"), &two, &plan).is_err());
    }
}
