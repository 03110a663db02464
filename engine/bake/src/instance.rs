//! Which instances may share one object-space bake, and how light reaches their object space.
//!
//! A transfer vector lives in the directions of its object space. An instance placed by M may use it if M's
//! linear part is s Q, with s > 0 and Q orthogonal: occlusion and angles are then the same. Light coefficients
//! are carried to object space by L_o(o) = L_w(Q o). A mirroring Q is -R with R a rotation, and the inversion
//! o -> -o multiplies band l by (-1)^l.

use glam::{DMat3, DQuat, Mat4};

/// Relative deviation of M^T M from s² I up to which an instance counts as uniformly scaled. Matrices composed
/// in f32 stay two orders of magnitude below it.
pub const UNIFORM_TOLERANCE: f64 = 1e-4;

/// How to carry light coefficients from world space to an instance's object space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightFrame {
    /// Rotates world directions to object directions: rotate the light's coefficients by it.
    pub world_to_object: DQuat,
    /// Afterwards change the sign of the odd bands (l = 1, 3, 5): the instance is mirrored.
    pub inverted: bool,
}

/// Why an instance cannot share an object-space bake.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NotShared {
    /// Scaled differently along different axes, or sheared.
    #[error(
        "the instance is scaled by {smallest} to {largest} depending on direction, which bends occlusion and normals; bake this instance on its own, in world space"
    )]
    NotUniform {
        /// Smallest length of a unit vector after the transform, a lower bound.
        smallest: f64,
        /// Largest length of a unit vector after the transform, an upper bound.
        largest: f64,
    },
    /// Singular, projective or not finite.
    #[error("the instance's matrix is singular, projective or not finite; give it an affine, invertible one")]
    Degenerate,
}

impl LightFrame {
    /// Classifies an instance's object-to-world matrix: rotation, uniform scale, reflection and translation
    /// pass.
    ///
    /// # Errors
    /// [`NotShared`] says what else the matrix does and what to do instead.
    pub fn of_instance(object_to_world: Mat4) -> Result<Self, NotShared> {
        let matrix = object_to_world.as_dmat4();
        if !matrix.is_finite() || matrix.row(3) != glam::DVec4::W {
            return Err(NotShared::Degenerate);
        }
        let linear = DMat3::from_mat4(matrix);
        let gram = linear.transpose() * linear;
        let scale_squared = (gram.x_axis.x + gram.y_axis.y + gram.z_axis.z) / 3.0;
        if scale_squared <= 0.0 || !scale_squared.is_finite() {
            return Err(NotShared::Degenerate);
        }
        let deviation = gram - DMat3::from_diagonal(glam::DVec3::splat(scale_squared));
        // The Frobenius norm bounds how far each squared singular value is from the mean.
        let bound = deviation.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt();
        if bound > UNIFORM_TOLERANCE * scale_squared {
            return Err(NotShared::NotUniform {
                smallest: (scale_squared - bound).max(0.0).sqrt(),
                largest: (scale_squared + bound).sqrt(),
            });
        }
        let inverted = linear.determinant() < 0.0;
        let scale = if inverted { -scale_squared.sqrt() } else { scale_squared.sqrt() };
        let rotation = DQuat::from_mat3(&(linear * (1.0 / scale))).normalize();
        Ok(Self { world_to_object: rotation.conjugate(), inverted })
    }

    /// The sign band `l` takes after the rotation.
    #[must_use]
    pub fn band_sign(&self, l: usize) -> f64 {
        if self.inverted && l % 2 == 1 { -1.0 } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Quat, Vec3};

    #[test]
    fn rotation_scale_and_reflection_keep_directions() {
        let turn = Quat::from_euler(glam::EulerRot::XYZ, 0.3, -1.2, 2.5);
        for scale in [Vec3::splat(2.5), Vec3::new(-0.1, 0.1, 0.1), Vec3::new(3.0, -3.0, -3.0), -Vec3::ONE] {
            let matrix = Mat4::from_scale_rotation_translation(scale, turn, Vec3::new(5.0, 6.0, 7.0));
            let frame = LightFrame::of_instance(matrix).unwrap();
            assert_eq!(frame.inverted, scale.x * scale.y * scale.z < 0.0);
            let object = glam::DVec3::new(0.2, -0.5, 0.8).normalize();
            let world = DMat3::from_mat4(matrix.as_dmat4()) * object;
            let sign = if frame.inverted { -1.0 } else { 1.0 };
            let back = frame.world_to_object * world.normalize() * sign;
            assert!((back - object).length() < 1e-6, "{back} for {object}");
        }
    }

    #[test]
    fn other_matrices_are_refused() {
        let stretched = Mat4::from_scale(Vec3::new(1.0, 1.001, 1.0));
        assert!(matches!(LightFrame::of_instance(stretched), Err(NotShared::NotUniform { .. })));
        let mut sheared = Mat4::IDENTITY;
        sheared.y_axis.x = 0.01;
        assert!(matches!(LightFrame::of_instance(sheared), Err(NotShared::NotUniform { .. })));
        let mut projective = Mat4::IDENTITY;
        projective.x_axis.w = 0.5;
        for bad in [Mat4::ZERO, Mat4::NAN, projective] {
            assert_eq!(LightFrame::of_instance(bad), Err(NotShared::Degenerate));
        }
    }
}
