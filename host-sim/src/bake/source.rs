//! What all baked text has in common: tables of texels.
//!
//! A table is one byte string and a loop that the compiler runs, not one expression a texel: a
//! compiler reads that a hundred times faster.

use std::fmt::{self, Write as _};

/// Bytes in a line of a byte string.
const LINE: usize = 24;

/// Where the core's users find its colours.
macro_rules! colour {
    ($name:literal) => {
        concat!("multum::embedded_graphics::pixelcolor::", $name)
    };
}

/// What a table consists of: texels or blocks of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Unit {
    /// Its type.
    pub(super) of: &'static str,
    /// Bytes in memory.
    pub(super) size: usize,
    /// One of the array `bytes`.
    made: &'static str,
}

impl Unit {
    /// A colour as the display has it, the low byte first.
    pub(super) const RGB565: Self = Self {
        of: colour!("Rgb565"),
        size: 2,
        made: concat!(
            "let [low, high] = bytes;\n    ",
            colour!("Rgb565"),
            "::new(high >> 3, high << 3 | low >> 5, low)"
        ),
    };
    /// Red, green, blue.
    pub(super) const RGB888: Self = Self {
        of: colour!("Rgb888"),
        size: 3,
        made: concat!(
            "let [r, g, b] = bytes;\n    ",
            colour!("Rgb888"),
            "::new(r, g, b)"
        ),
    };
    /// Luma.
    pub(super) const GRAY8: Self = Self {
        of: colour!("Gray8"),
        size: 1,
        made: concat!("let [luma] = bytes;\n    ", colour!("Gray8"), "::new(luma)"),
    };
    /// Colour and one bit of alpha, the low byte first.
    pub(super) const RGBA5551: Self = Self {
        of: "multum::colour::Rgba5551",
        size: 2,
        made: "multum::colour::Rgba5551(u16::from_le_bytes(bytes))",
    };
    /// Red, green, blue, alpha.
    pub(super) const RGBA8888: Self = Self {
        of: "multum::colour::Rgba8888",
        size: 4,
        made: "multum::colour::Rgba8888(bytes)",
    };
    /// 4x4 texels.
    pub(super) const BC1: Self = Self {
        of: "[u8; 8]",
        size: 8,
        made: "bytes",
    };

    /// Two functions that the compiler runs: `one` makes a unit of its bytes, `table` as many as
    /// are wanted.
    pub(super) fn functions(&self, one: &str, table: &str) -> String {
        let Self { of, size, made } = self;
        format!(
            r#"
const fn {one}(bytes: [u8; {size}]) -> {of} {{
    {made}
}}

const fn {table}<const N: usize>(bytes: &[u8]) -> [{of}; N] {{
    let (pieces, rest) = bytes.as_chunks::<{size}>();
    assert!(pieces.len() == N && rest.is_empty(), "{size} bytes each");
    let mut table = [{one}([0; {size}]); N];
    let mut i = 0;
    while i < N {{
        table[i] = {one}(pieces[i]);
        i += 1;
    }}
    table
}}
"#
        )
    }
}

/// The text as it grows.
#[derive(Default)]
pub(super) struct Source(pub(super) String);

impl Source {
    pub(super) fn line(&mut self, line: fmt::Arguments<'_>) {
        // Writing to a string does not fail.
        _ = writeln!(self.0, "{line}");
    }

    /// A private table, made by the function `table` of [`Unit::functions`].
    pub(super) fn table(&mut self, name: &str, unit: Unit, table: &str, bytes: &[u8]) {
        // Loops over texels run in the compiler for long, and end.
        self.line(format_args!(
            "#[allow(long_running_const_eval)]\nstatic {name}: [{}; {}] = {table}({});",
            unit.of,
            bytes.len() / unit.size,
            byte_string(bytes)
        ));
    }
}

/// Bytes as a literal; a long one has many lines.
pub(super) fn byte_string(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(5 * bytes.len() + 8);
    text += "b\"";
    for line in bytes.chunks(LINE) {
        if bytes.len() > LINE {
            text += "\\\n    ";
        }
        for byte in line {
            _ = write!(text, "\\x{byte:02x}");
        }
    }
    text + "\""
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_byte_strings_have_many_lines() {
        assert_eq!(byte_string(&[0, 255, 34]), r#"b"\x00\xff\x22""#);
        let text = byte_string(&[7; LINE + 1]);
        let expected = format!("b\"\\\n    {}\\\n    \\x07\"", r"\x07".repeat(LINE));
        assert_eq!(text, expected);
    }
}
