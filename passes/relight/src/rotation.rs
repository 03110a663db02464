//! Rotations of light, prepared on the CPU: unit quaternions in f64, rounded once.

use airglow_math::MathError;
use glam::{DMat3, DQuat};

use crate::RelightError;

/// How far a matrix may be from a scaled rotation, relative to its scale.
const TOLERANCE: f64 = 1e-4;

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

/// The rotation in the upper left of an instance's matrix (columns are the images of the axes).
///
/// Transfer baked in object space holds for every rotation, translation and uniform scale of the object, and for
/// nothing else.
///
/// # Errors
/// [`RelightError::Matrix`] for a mirrored, sheared or unevenly scaled matrix, and for one that is not finite or
/// flattens the object.
pub fn instance_rotation(matrix: DMat3) -> Result<DQuat, RelightError> {
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
    if determinant < 0.0 {
        return refuse("mirrors the object");
    }
    Ok(DQuat::from_mat3(&unit).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn a_scaled_rotation_is_recovered() {
        let q = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 2.1);
        let found = instance_rotation(DMat3::from_quat(q) * 3.5).unwrap();
        assert!(found.dot(q).abs() > 1.0 - 1e-14, "{found} and {q}");
    }

    #[test]
    fn what_transfer_cannot_follow_is_refused() {
        let mirror = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
        let uneven = DMat3::from_diagonal(DVec3::new(1.0, 2.0, 1.0));
        let flat = DMat3::from_diagonal(DVec3::new(1.0, 0.0, 1.0));
        for (matrix, word) in [(mirror, "mirrors"), (uneven, "unevenly"), (flat, "flattens")] {
            let message = instance_rotation(matrix).unwrap_err().to_string();
            assert!(message.contains(word), "{message}");
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
