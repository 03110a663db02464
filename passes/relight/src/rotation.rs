//! Rotations of light, prepared on the CPU: unit quaternions in f64, rounded once.

use airglow_math::{MathError, World};
use glam::{DMat3, DQuat};

use crate::RelightError;
use crate::constants::Pair;
use crate::order::MAX_ORDER;

/// How far a matrix may be from a scaled rotation, relative to its scale.
const TOLERANCE: f64 = 1e-4;

/// How an instance lies in the world, scale and place apart: `d -> q d q^-1`, with an inversion `d -> -q d q^-1`.
///
/// Every mirroring is a rotation followed by the inversion, so instances that are mirrored share the transfer that was
/// baked in object space with those that are not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orientation {
    /// The rotation from object space to the world, of any length but zero.
    pub rotation: DQuat,
    /// Whether the inversion follows.
    pub inverted: bool,
}

impl Orientation {
    /// Object space is world space.
    pub const IDENTITY: Self = Self { rotation: DQuat::IDENTITY, inverted: false };

    /// The sign of band `l` under the inversion: `Y_lm(-s) = (-1)^l Y_lm(s)`.
    #[must_use]
    pub fn band_sign(&self, l: usize) -> f64 {
        if self.inverted && l % 2 == 1 { -1.0 } else { 1.0 }
    }
}

impl From<DQuat> for Orientation {
    fn from(rotation: DQuat) -> Self {
        Self { rotation, inverted: false }
    }
}

/// A turn of light as `rotate.comp` takes it: a unit quaternion x, y, z, w. Of the two that are one rotation it is the
/// one whose w is negative, be it negative zero, where an inversion follows.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct Turn([f32; 4]);

impl Turn {
    /// By a unit quaternion.
    pub(crate) fn new(unit: DQuat, inverted: bool) -> Self {
        let turn = unit.as_quat();
        Self(if turn.w.is_sign_negative() == inverted { turn } else { -turn }.to_array())
    }
}

/// What each band of a light is multiplied with, red, green and blue.
pub(crate) type Filter = [[f64; 3]; MAX_ORDER];

/// Leaves every band as it is.
pub(crate) const OPEN: Filter = [[1.0; 3]; MAX_ORDER];

/// Push constants of `rotate.comp`: nothing of a frame's factors is uploaded for each instance.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct RotateConstants {
    strides: Pair,
    factors: [[f32; 3]; MAX_ORDER],
}

impl RotateConstants {
    /// With a factor on each band of a light.
    pub(crate) fn new(strides: Pair, factor: f64, filter: &Filter) -> Self {
        let factors = filter.map(|band| band.map(|channel| (factor * channel) as f32));
        Self { strides, factors }
    }
}

/// What the host's world makes of a light before an instance sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightFrame {
    /// From the axes of the light's coefficients to the host's.
    pub orientation: Orientation,
    /// A factor on the light: the pre-exposure.
    pub factor: f64,
    /// Factors on each band of it.
    pub filter: Filter,
}

impl LightFrame {
    /// Of light about the host's own axes.
    pub(crate) fn host(world: &World) -> Self {
        Self { orientation: Orientation::IDENTITY, factor: world.pre_exposure, filter: OPEN }
    }

    /// Of an environment, whose centre looks forward and whose first row is up.
    pub(crate) fn map(world: &World) -> Result<Self, RelightError> {
        Ok(Self { orientation: instance_rotation(world.axes.host_from_airglow())?, ..Self::host(world) })
    }

    /// From the light's coefficients, turned by `light` in the host's world, to the object space of an instance.
    pub(crate) fn turn(&self, light: DQuat, instance: Orientation) -> Result<Turn, RelightError> {
        let rotation = object_space(light, instance.rotation)? * self.orientation.rotation;
        let inverted = instance.inverted != self.orientation.inverted;
        Ok(Turn::new(rotation, inverted))
    }
}

/// The quaternion of length one in the same direction.
///
/// # Errors
/// [`RelightError::Math`] when it is zero or not finite.
pub fn normalised(q: DQuat) -> Result<DQuat, RelightError> {
    let largest = q.to_array().into_iter().map(f64::abs).fold(0.0, f64::max);
    if !q.is_finite() || largest == 0.0 {
        return Err(MathError::Quaternion { x: q.x, y: q.y, z: q.z, w: q.w }.into());
    }
    // Dividing first keeps the squares of very large and very small quaternions in range.
    Ok(DQuat::from_array(q.to_array().map(|c| c / largest)).normalize())
}

/// The rotation that takes the environment's light into an instance's object space, where its transfer was baked:
/// `instance^-1 environment`.
///
/// # Errors
/// [`RelightError::Math`] when either is zero or not finite.
pub fn object_space(environment: DQuat, instance: DQuat) -> Result<DQuat, RelightError> {
    Ok((normalised(instance)?.inverse() * normalised(environment)?).normalize())
}

/// The rotation in the upper left of an instance's matrix (columns are the images of the axes), and whether the matrix
/// mirrors.
///
/// Transfer baked in object space holds for every rotation, mirroring, translation and uniform scale of the object,
/// and for nothing else.
///
/// # Errors
/// [`RelightError::Matrix`] for a sheared or unevenly scaled matrix, and for one that is not finite or flattens the
/// object.
pub fn instance_rotation(matrix: DMat3) -> Result<Orientation, RelightError> {
    let refuse = |problem| Err(RelightError::Matrix { problem });
    let determinant = matrix.determinant();
    if !matrix.is_finite() || !determinant.is_finite() {
        return refuse("is not finite");
    }
    let scale = determinant.abs().cbrt();
    if scale == 0.0 {
        return refuse("flattens the object");
    }
    let unit = matrix * (determinant.signum() / scale);
    let deviation = (unit.transpose() * unit - DMat3::IDENTITY).to_cols_array();
    if deviation.iter().any(|value| value.abs() > TOLERANCE) {
        return refuse("shears the object or scales it unevenly");
    }
    Ok(Orientation { rotation: DQuat::from_mat3(&unit).normalize(), inverted: determinant < 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn a_scaled_rotation_is_recovered() {
        let q = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 2.1);
        let found = instance_rotation(DMat3::from_quat(q) * 3.5).unwrap();
        assert!(found.rotation.dot(q).abs() > 1.0 - 1e-14, "{found:?} and {q}");
        assert!(!found.inverted);
    }

    #[test]
    fn a_mirroring_is_a_rotation_and_the_inversion() {
        let turn = DMat3::from_axis_angle(DVec3::new(-0.3, 0.4, 1.0).normalize(), 0.8);
        for axis in [DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, 1.0, -1.0), DVec3::NEG_ONE] {
            let matrix = turn * DMat3::from_diagonal(axis) * 0.25;
            let found = instance_rotation(matrix).unwrap();
            assert!(found.inverted);
            for d in [DVec3::X, DVec3::Y, DVec3::new(0.6, 0.0, 0.8)] {
                let (ours, truth) = (-(found.rotation * d), matrix * d / 0.25);
                assert!(ours.distance(truth) < 1e-14, "{ours} and {truth}");
            }
        }
    }

    #[test]
    fn what_transfer_cannot_follow_is_refused() {
        let sheared = DMat3::from_cols(DVec3::X, DVec3::new(0.5, 1.0, 0.0), DVec3::Z);
        let uneven = DMat3::from_diagonal(DVec3::new(1.0, 2.0, 1.0));
        let flat = DMat3::from_diagonal(DVec3::new(1.0, 0.0, 1.0));
        for (matrix, word) in [(sheared, "shears"), (uneven, "unevenly"), (flat, "flattens")] {
            let message = instance_rotation(matrix).unwrap_err().to_string();
            assert!(
                message.contains(word) && message.contains("bake its transfer in world space"),
                "{message}"
            );
        }
        assert!(instance_rotation(DMat3::from_diagonal(DVec3::new(f64::NAN, 1.0, 1.0))).is_err());
    }

    #[test]
    fn quaternions_of_any_length_are_accepted_but_zero() {
        for length in [1e-300, 1.0, 7.0, 1e300] {
            let q = normalised(DQuat::from_xyzw(0.0, length, 0.0, 0.0)).unwrap();
            assert_eq!(q, DQuat::from_xyzw(0.0, 1.0, 0.0, 0.0));
        }
        assert!(normalised(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0)).is_err());
        assert!(normalised(DQuat::from_xyzw(0.0, f64::INFINITY, 0.0, 0.0)).is_err());
    }
}
