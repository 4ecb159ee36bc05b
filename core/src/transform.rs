//! Affine maps of space in fixed point: model to world, world to view.

use fixed::types::{I8F24, I16F16};

use crate::arith::product;
use crate::error::Error;

/// An affine map, `p' = M p + t`.
///
/// `M` is 3 x 3, row by row, in 8.24 (magnitudes below 128); `t` in 16.16 units. A rotation is
/// thus exact to 2^-25 an element, 1/4096 unit at a position of 8192.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Transform {
    /// The matrix, by rows.
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    pub rows: [[I8F24; 3]; 3],
    /// The translation.
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    pub translation: [I16F16; 3],
}

impl Transform {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self {
        rows: [
            [I8F24::ONE, I8F24::ZERO, I8F24::ZERO],
            [I8F24::ZERO, I8F24::ONE, I8F24::ZERO],
            [I8F24::ZERO, I8F24::ZERO, I8F24::ONE],
        ],
        translation: [I16F16::ZERO; 3],
    };

    /// A move by `offset` units.
    #[must_use]
    pub const fn translation(offset: [I16F16; 3]) -> Self {
        Self {
            rows: Self::IDENTITY.rows,
            translation: offset,
        }
    }

    /// A scaling by `factors` along the axes.
    #[must_use]
    pub const fn scale(factors: [I8F24; 3]) -> Self {
        let [x, y, z] = factors;
        Self {
            rows: [
                [x, I8F24::ZERO, I8F24::ZERO],
                [I8F24::ZERO, y, I8F24::ZERO],
                [I8F24::ZERO, I8F24::ZERO, z],
            ],
            translation: [I16F16::ZERO; 3],
        }
    }

    /// The map that applies `inner` first and `self` after it; each element rounded to nearest.
    ///
    /// # Errors
    ///
    /// [`Error::Overflow`] where an element leaves its format.
    pub fn after(&self, inner: &Self) -> Result<Self, Error> {
        let mut joined = *self;
        for (row, t) in joined.rows_mut() {
            inner.under_row(row, t)?;
        }
        Ok(joined)
    }

    /// The rows, each with its element of the translation.
    pub(crate) fn rows_mut(&mut self) -> impl Iterator<Item = (&mut [I8F24; 3], &mut I16F16)> {
        self.rows.iter_mut().zip(&mut self.translation)
    }

    /// A row of the map that applies `self` first, from a row of the one after it.
    // A function of its own: three copies take three times the flash, once a mesh.
    #[inline(never)]
    fn under_row(&self, row: &mut [I8F24; 3], t: &mut I16F16) -> Result<(), Error> {
        let factors = row.map(I8F24::to_bits);
        let [a, b, c] = &self.rows;
        for (to, ((a, b), c)) in row.iter_mut().zip(a.iter().zip(b).zip(c)) {
            *to = I8F24::from_bits(dot(factors, [a, b, c].map(|e| e.to_bits()))?);
        }
        let moved = dot(factors, self.translation.map(I16F16::to_bits))?;
        *t = t
            .checked_add(I16F16::from_bits(moved))
            .ok_or(Error::Overflow)?;
        Ok(())
    }

    /// One row of the map applied to a point that keeps to
    /// [`MAX_POSITION`](crate::geometry::MAX_POSITION), in 16.16.
    #[inline]
    pub(crate) fn apply_row(row: &[I8F24; 3], t: I16F16, p: [I16F16; 3]) -> Result<I16F16, Error> {
        let mut sum = ROUND;
        for (a, b) in row.iter().zip(p) {
            // Three products of at most 2^31 * 2^29 stay below 2^63.
            sum = sum.wrapping_add(product(a.to_bits(), b.to_bits()));
        }
        // |sum >> 24| < 2^39, so the addition cannot overflow.
        i32::try_from((sum >> 24) + i64::from(t.to_bits()))
            .map(I16F16::from_bits)
            .map_err(|_| Error::Overflow)
    }
}

/// Half a unit of a product of an 8.24 number, for rounding to nearest.
const ROUND: i64 = 1 << 23;

/// The sum of three products with 8.24 numbers, in the other factor's format.
#[inline(never)]
fn dot(a: [i32; 3], b: [i32; 3]) -> Result<i32, Error> {
    let mut sum = ROUND;
    for (a, b) in a.iter().zip(b) {
        sum = sum.checked_add(product(*a, b)).ok_or(Error::Overflow)?;
    }
    i32::try_from(sum >> 24).map_err(|_| Error::Overflow)
}
