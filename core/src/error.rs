//! What can be wrong with a caller's data. A leaf: every stage may return these.

use core::fmt;

/// Why a mesh, texture, buffer or camera was refused.
///
/// Every check happens when the object is built, so that the pixel loops have nothing to check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// A triangle names a vertex that the mesh does not have.
    IndexOutOfRange {
        /// Number of the triangle.
        triangle: usize,
    },
    /// A vertex position is farther than [`MAX_POSITION`](crate::geometry::MAX_POSITION) units
    /// from the origin on some axis.
    PositionOutOfRange {
        /// Number of the vertex.
        vertex: usize,
    },
    /// A texture coordinate is beyond [`MAX_UV`](crate::geometry::MAX_UV) repeats.
    UvOutOfRange {
        /// Number of the vertex.
        vertex: usize,
    },
    /// A triangle spans [`MAX_UV_SPAN`](crate::geometry::MAX_UV_SPAN) repeats or more.
    UvSpanTooLarge {
        /// Number of the triangle.
        triangle: usize,
    },
    /// A texture side is zero, not a power of two, or above
    /// [`MAX_TEXTURE_SIZE`](crate::texture::MAX_TEXTURE_SIZE).
    TextureSize {
        /// Texels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// A texel names a colour that its palette does not have.
    PaletteIndex {
        /// The texel's column.
        column: u32,
        /// Its row.
        row: u32,
        /// The number of its colour.
        index: u32,
        /// Colours in the palette.
        colours: usize,
    },
    /// A window reaches beyond its atlas.
    WindowOutOfRange {
        /// First column.
        left: u32,
        /// First row.
        top: u32,
    },
    /// A level of a pyramid does not have half the sides of the one before.
    LevelSize {
        /// Its number; 0 is the finest.
        level: u32,
        /// Texels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// A pyramid does not end with a level of one texel, or has no level at all.
    LevelsMissing {
        /// Levels needed.
        needed: u32,
        /// Levels given.
        given: u32,
    },
    /// A slice does not have the length that its description claims.
    BufferLength {
        /// Elements needed.
        needed: usize,
        /// Elements given.
        given: usize,
    },
    /// A frame or band is empty or reaches beyond
    /// [`MAX_VIEWPORT`](crate::viewport::MAX_VIEWPORT) pixels, or its stride is below its width.
    FrameSize {
        /// Columns.
        width: u32,
        /// Rows, those above the band included.
        height: u32,
    },
    /// The near distance is below [`MIN_NEAR`](crate::camera::MIN_NEAR).
    NearTooSmall,
    /// A camera or a rotation was described by values that are not finite, or that give no
    /// direction (eye and target in one place, an up vector along the view, a field of view
    /// outside 0 to 180 degrees).
    DegenerateCamera,
    /// A matrix element, or a transformed vertex, does not fit its fixed-point format.
    Overflow,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::IndexOutOfRange { triangle } => {
                write!(f, "triangle {triangle} names a vertex that does not exist")
            }
            Self::PositionOutOfRange { vertex } => {
                write!(f, "vertex {vertex} lies beyond 8192 units")
            }
            Self::UvOutOfRange { vertex } => {
                write!(
                    f,
                    "vertex {vertex} has a texture coordinate beyond 127 repeats"
                )
            }
            Self::UvSpanTooLarge { triangle } => {
                write!(
                    f,
                    "triangle {triangle} spans 128 repeats of the texture or more"
                )
            }
            Self::TextureSize { width, height } => write!(
                f,
                "texture of {width}x{height}: both sides must be powers of two up to 4096"
            ),
            Self::PaletteIndex {
                column,
                row,
                index,
                colours,
            } => write!(
                f,
                "the texel in column {column} of row {row} names colour {index} of a palette of {colours}"
            ),
            Self::WindowOutOfRange { left, top } => write!(
                f,
                "the window at column {left}, row {top} reaches beyond its atlas"
            ),
            Self::LevelSize {
                level,
                width,
                height,
            } => write!(
                f,
                "level {level} of a pyramid is {width}x{height}, not half of the one before"
            ),
            Self::LevelsMissing { needed, given } => {
                write!(f, "a pyramid of {given} levels where {needed} are needed")
            }
            Self::BufferLength { needed, given } => {
                write!(f, "a buffer of {given} elements where {needed} are needed")
            }
            Self::FrameSize { width, height } => write!(
                f,
                "frame or band to {width}x{height}: it must be 1x1 to 1024x1024, in a stride not below the width"
            ),
            Self::NearTooSmall => f.write_str("the near distance is below 1/256"),
            Self::DegenerateCamera => {
                f.write_str("the camera or rotation has no direction or is not finite")
            }
            Self::Overflow => {
                f.write_str("a matrix element or a transformed vertex is out of range")
            }
        }
    }
}

impl core::error::Error for Error {}
