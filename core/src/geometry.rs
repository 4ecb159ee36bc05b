//! Indexed meshes as they lie in flash. Nothing enters but the caller's tables; what leaves is
//! checked once, so that no later stage has to check an index or a range again.

use fixed::types::I16F16;

use crate::error::Error;

/// Largest magnitude of a vertex position on each axis, in model units.
///
/// It leaves the three products of a matrix row room in 64 bits: `3 * 2^29 * 2^31 + 2^23 < 2^63`.
pub const MAX_POSITION: i32 = 8192;

/// Largest magnitude of a texture coordinate, in repeats of the texture.
pub const MAX_UV: i32 = 127;

/// A triangle's coordinates span less than this many repeats on each axis.
///
/// Differences of two coordinates in 8.24 (see [`Uv`](crate::uv::Uv)) then fit 32 bits.
pub const MAX_UV_SPAN: i32 = 128;

/// A corner of a mesh in model space.
///
/// `position` in model units, right-handed with y up, magnitude at most [`MAX_POSITION`]. `uv` in
/// repeats of the texture, u right and v down from the top-left corner of texel (0, 0), magnitude
/// at most [`MAX_UV`]. Both 16.16: a texture coordinate is exact to 1/64 texel on 1024 texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Vertex {
    /// x, y, z in model units.
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    pub position: [I16F16; 3],
    /// u, v in repeats.
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    pub uv: [I16F16; 2],
}

impl Vertex {
    /// A vertex from the raw bits of its 16.16 numbers: how baked tables are written.
    #[must_use]
    pub const fn from_bits(position: [i32; 3], uv: [i32; 2]) -> Self {
        let [x, y, z] = position;
        let [u, v] = uv;
        Self {
            position: [
                I16F16::from_bits(x),
                I16F16::from_bits(y),
                I16F16::from_bits(z),
            ],
            uv: [I16F16::from_bits(u), I16F16::from_bits(v)],
        }
    }
}

/// Triangles over a shared table of vertices.
///
/// A triangle whose vertices appear counter-clockwise to the viewer shows its front, as in glTF.
/// The tables are borrowed: `&'static` ones stay in flash.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Mesh<'a> {
    vertices: &'a [Vertex],
    triangles: &'a [[u16; 3]],
}

impl<'a> Mesh<'a> {
    /// Checks the tables and joins them. In a `static` the compiler does the checking.
    ///
    /// # Errors
    ///
    /// [`Error::IndexOutOfRange`], [`Error::PositionOutOfRange`], [`Error::UvOutOfRange`] or
    /// [`Error::UvSpanTooLarge`], for the first offender.
    pub const fn new(vertices: &'a [Vertex], triangles: &'a [[u16; 3]]) -> Result<Self, Error> {
        let mut vertex = 0;
        while vertex < vertices.len() {
            let Vertex { position, uv } = &vertices[vertex];
            let mut axis = 0;
            while axis < 3 {
                if position[axis].to_bits().unsigned_abs() > (MAX_POSITION as u32) << 16 {
                    return Err(Error::PositionOutOfRange { vertex });
                }
                axis += 1;
            }
            axis = 0;
            while axis < 2 {
                if uv[axis].to_bits().unsigned_abs() > (MAX_UV as u32) << 16 {
                    return Err(Error::UvOutOfRange { vertex });
                }
                axis += 1;
            }
            vertex += 1;
        }
        let mut triangle = 0;
        while triangle < triangles.len() {
            let [a, b, c] = triangles[triangle];
            let (a, b, c) = (a as usize, b as usize, c as usize);
            let n = vertices.len();
            if a >= n || b >= n || c >= n {
                return Err(Error::IndexOutOfRange { triangle });
            }
            let mut axis = 0;
            while axis < 2 {
                let (i, j, k) = (
                    vertices[a].uv[axis].to_bits(),
                    vertices[b].uv[axis].to_bits(),
                    vertices[c].uv[axis].to_bits(),
                );
                let span = (MAX_UV_SPAN as u32) << 16;
                if i.abs_diff(j) >= span || j.abs_diff(k) >= span || k.abs_diff(i) >= span {
                    return Err(Error::UvSpanTooLarge { triangle });
                }
                axis += 1;
            }
            triangle += 1;
        }
        Ok(Self {
            vertices,
            triangles,
        })
    }

    /// The vertex table.
    #[must_use]
    pub const fn vertices(&self) -> &'a [Vertex] {
        self.vertices
    }

    /// The triangles, as numbers of vertices.
    #[must_use]
    pub const fn triangles(&self) -> &'a [[u16; 3]] {
        self.triangles
    }
}
