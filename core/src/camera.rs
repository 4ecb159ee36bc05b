//! The camera: where it stands, and how wide it sees. What leaves is one matrix from model space
//! to clip space.

use fixed::types::{I8F24, I16F16};

use crate::arith::product;
use crate::error::Error;
use crate::transform::Transform;

/// Smallest near distance: 1/256 unit.
///
/// Clip coordinates resolve 2^-16 unit, so w keeps 8 significant bits at the near plane.
pub const MIN_NEAR: I16F16 = I16F16::from_bits(256);

/// The lens: the scale of x and y against depth, and the near plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Perspective {
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    scale: [I16F16; 2],
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    near: I16F16,
}

impl Perspective {
    /// A lens from its scales: `cot(fov_x / 2)` and `cot(fov_y / 2)`, both positive, and the
    /// distance of the near plane in units.
    ///
    /// # Errors
    ///
    /// [`Error::NearTooSmall`]; [`Error::DegenerateCamera`] for a scale that is not positive.
    pub fn from_scales(x: I16F16, y: I16F16, near: I16F16) -> Result<Self, Error> {
        if near < MIN_NEAR {
            return Err(Error::NearTooSmall);
        }
        if x <= 0 || y <= 0 {
            return Err(Error::DegenerateCamera);
        }
        Ok(Self {
            scale: [x, y],
            near,
        })
    }

    /// Distance of the near plane.
    #[must_use]
    pub const fn near(&self) -> I16F16 {
        self.near
    }

    /// Scales of x and y: half the screen's width (height) is `w / scale` units at depth `w`.
    #[must_use]
    pub const fn scales(&self) -> [I16F16; 2] {
        self.scale
    }
}

/// A camera: a map from world to view space (looking along -z, y up) and a lens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Camera {
    /// World to view.
    pub view: Transform,
    /// The lens.
    pub lens: Perspective,
}

impl Camera {
    /// Model space to clip space, for a mesh that stands in the world by `model`.
    ///
    /// # Errors
    ///
    /// [`Error::Overflow`] where an element leaves its format.
    pub fn to_clip(&self, model: &Transform) -> Result<ToClip, Error> {
        let mut matrix = self.view.after(model)?;
        let [x, y] = self.lens.scale;
        // Depth grows along -z.
        let factors = [x, y, I16F16::NEG_ONE];
        for ((row, t), factor) in matrix.rows_mut().zip(factors) {
            scale_row(row, t, factor)?;
        }
        Ok(ToClip {
            matrix,
            near: self.lens.near,
        })
    }
}

/// Multiplies a row by a factor, rounded to nearest.
// A function of its own, for the flash.
#[inline(never)]
fn scale_row(row: &mut [I8F24; 3], t: &mut I16F16, factor: I16F16) -> Result<(), Error> {
    let scaled = |number: i32| {
        let product = product(number, factor.to_bits());
        i32::try_from((product + (1 << 15)) >> 16).map_err(|_| Error::Overflow)
    };
    for element in row {
        *element = I8F24::from_bits(scaled(element.to_bits())?);
    }
    *t = I16F16::from_bits(scaled(t.to_bits())?);
    Ok(())
}

/// From model space to clip space: gives clip x, y and w, and knows the near plane.
///
/// There is no clip z: the near plane is a bound on w, there is no far plane, and the depth
/// buffer holds 1/w.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ToClip {
    matrix: Transform,
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    near: I16F16,
}

impl ToClip {
    /// Distance of the near plane.
    #[must_use]
    pub const fn near(&self) -> I16F16 {
        self.near
    }

    /// Clip x, y and w of a point.
    pub(crate) fn apply(&self, p: [I16F16; 3]) -> Result<[I16F16; 3], Error> {
        let [x, y, w] = &self.matrix.rows;
        let [tx, ty, tw] = self.matrix.translation;
        Ok([
            Transform::apply_row(x, tx, p)?,
            Transform::apply_row(y, ty, p)?,
            Transform::apply_row(w, tw, p)?,
        ])
    }
}

#[cfg(feature = "camera")]
mod float {
    //! The only floating point in the crate, outside the pipeline: angles and directions become
    //! fixed-point matrices here.
    //!
    //! `micromath` is small and rough (1e-3 in its trigonometry, worse in its square root), so
    //! each matrix is orthonormalised with square roots refined to full single precision: a rough sine turns
    //! the camera by a thousandth, but never shears or scales the picture.
    //!
    //! Its functions are called by the trait's name: as methods, `sin` and `cos` would mean the
    //! standard library's wherever a dependency links it, and the PC would see another picture
    //! than the chip.

    use fixed::types::{I8F24, I16F16};
    use micromath::F32Ext;

    use super::{Camera, Perspective};
    use crate::angle::sin_cos;
    use crate::error::Error;
    use crate::transform::Transform;

    /// 1 / sqrt(x) for a positive finite x: micromath's estimate, then Newton steps
    /// `y (3 - x y^2) / 2`, each squaring the error: 5 % -> 0.4 % -> 2e-5 -> 7e-10.
    fn inverse_sqrt(x: f32) -> f32 {
        let mut y = F32Ext::invsqrt(x);
        for _ in 0..3 {
            y *= 1.5 - 0.5 * x * y * y;
        }
        y
    }

    fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
        let ([ax, ay, az], [bx, by, bz]) = (a, b);
        ax * bx + ay * by + az * bz
    }

    fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
        let ([ax, ay, az], [bx, by, bz]) = (a, b);
        [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]
    }

    fn unit(a: [f32; 3]) -> Result<[f32; 3], Error> {
        let square = dot(a, a);
        if !(square > 1e-12 && square < 1e12) {
            return Err(Error::DegenerateCamera);
        }
        let scale = inverse_sqrt(square);
        Ok(a.map(|e| e * scale))
    }

    fn row(a: [f32; 3]) -> Result<[I8F24; 3], Error> {
        let [a, b, c] = a.map(I8F24::checked_from_num);
        match (a, b, c) {
            (Some(a), Some(b), Some(c)) => Ok([a, b, c]),
            _ => Err(Error::Overflow),
        }
    }

    fn number(a: f32) -> Result<I16F16, Error> {
        I16F16::checked_from_num(a).ok_or(Error::Overflow)
    }

    impl Perspective {
        /// A lens from the vertical field of view in radians (above 0, below pi), the aspect
        /// ratio width / height, and the near distance in units.
        ///
        /// # Errors
        ///
        /// [`Error::DegenerateCamera`], [`Error::NearTooSmall`], [`Error::Overflow`].
        pub fn new(fov_y: f32, aspect: f32, near: f32) -> Result<Self, Error> {
            check_lens(fov_y, aspect, near)?;
            let half = 0.5 * fov_y;
            let y = F32Ext::cos(half) / F32Ext::sin(half);
            Self::from_scales(number(y / aspect)?, number(y)?, number(near)?)
        }

        /// As [`Self::new`], with [`sin_cos`] instead of micromath: the scales are right to 2^-20
        /// of their value and then rounded to 16.16, where micromath is off by up to 1 % for small
        /// fields of view.
        ///
        /// # Errors
        ///
        /// [`Error::DegenerateCamera`], [`Error::NearTooSmall`], [`Error::Overflow`].
        pub fn precise(fov_y: f32, aspect: f32, near: f32) -> Result<Self, Error> {
            check_lens(fov_y, aspect, near)?;
            let [sine, cosine] = sin_cos(0.5 * fov_y).ok_or(Error::DegenerateCamera)?;
            let y = cosine / sine;
            Self::from_scales(number(y / aspect)?, number(y)?, number(near)?)
        }
    }

    fn check_lens(fov_y: f32, aspect: f32, near: f32) -> Result<(), Error> {
        if fov_y > 0.0 && fov_y < core::f32::consts::PI && aspect > 0.0 && near.is_finite() {
            Ok(())
        } else {
            Err(Error::DegenerateCamera)
        }
    }

    impl Transform {
        /// A turn by `angle` radians about an axis through the origin, counter-clockwise when the
        /// axis points at the viewer (Rodrigues' formula).
        ///
        /// # Errors
        ///
        /// [`Error::DegenerateCamera`] for an axis without direction or an angle that is not
        /// finite.
        pub fn rotation(axis: [f32; 3], angle: f32) -> Result<Self, Error> {
            if !angle.is_finite() {
                return Err(Error::DegenerateCamera);
            }
            Self::turn(axis, [F32Ext::sin(angle), F32Ext::cos(angle)])
        }

        /// As [`Self::rotation`], with [`sin_cos`] instead of micromath: the angle is right to
        /// 2^-21 instead of about 2^-10.
        ///
        /// # Errors
        ///
        /// [`Error::DegenerateCamera`] for an axis without direction or an angle beyond
        /// [`MAX_ANGLE`](crate::angle::MAX_ANGLE).
        pub fn rotation_precise(axis: [f32; 3], angle: f32) -> Result<Self, Error> {
            Self::turn(axis, sin_cos(angle).ok_or(Error::DegenerateCamera)?)
        }

        /// A turn about an axis by the angle with this sine and cosine.
        fn turn(axis: [f32; 3], [sine, cosine]: [f32; 2]) -> Result<Self, Error> {
            let [x, y, z] = unit(axis)?;
            // A sine and a cosine whose squares sum to one, whatever their own errors.
            let [s, c, _] = unit([sine, cosine, 0.0])?;
            let t = 1.0 - c;
            Ok(Self {
                rows: [
                    row([t * x * x + c, t * x * y - s * z, t * x * z + s * y])?,
                    row([t * x * y + s * z, t * y * y + c, t * y * z - s * x])?,
                    row([t * x * z - s * y, t * y * z + s * x, t * z * z + c])?,
                ],
                translation: Self::IDENTITY.translation,
            })
        }
    }

    impl Camera {
        /// A camera at `eye` that looks at `target`, with `up` upwards in the picture; world
        /// units.
        ///
        /// # Errors
        ///
        /// [`Error::DegenerateCamera`] if they give no direction, [`Error::Overflow`] if the eye
        /// is farther than 32767 units from the origin.
        pub fn look_at(
            eye: [f32; 3],
            target: [f32; 3],
            up: [f32; 3],
            lens: Perspective,
        ) -> Result<Self, Error> {
            let ([ex, ey, ez], [tx, ty, tz]) = (eye, target);
            // Gram-Schmidt: back, then right, then up, each a unit vector normal to the others.
            let back = unit([ex - tx, ey - ty, ez - tz])?;
            let right = unit(cross(unit(up)?, back))?;
            let up = cross(back, right);
            let rotation = Self {
                view: Transform {
                    rows: [row(right)?, row(up)?, row(back)?],
                    translation: Transform::IDENTITY.translation,
                },
                lens,
            };
            let to_eye = Transform::translation([number(-ex)?, number(-ey)?, number(-ez)?]);
            Ok(Self {
                view: rotation.view.after(&to_eye)?,
                lens,
            })
        }
    }
}
