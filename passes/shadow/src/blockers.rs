//! The spheres of a frame, in the space of their receivers.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::{DMat3, DMat4};

use crate::{ShadowError, Sphere};

/// Most spheres of one instance's frame: 16 KiB, the smallest uniform range of any device.
pub const MAX_SPHERES: usize = 1024;

/// The spheres that a pass reads when it is recorded. Clones share them.
#[derive(Clone, Debug, Default)]
pub struct Blockers(Arc<Mutex<Vec<[f32; 4]>>>);

impl Blockers {
    /// Sets the spheres from the next recording on. `receiver_from_world` takes them to the object space of the receivers:
    /// a rotation or mirroring, a uniform scale, a translation. Spheres of radius 0 block nothing.
    ///
    /// # Errors
    /// [`ShadowError::Range`] for a sphere that is not finite or a negative radius, and for a matrix that makes a sphere
    /// something else; [`ShadowError::Length`] for more than [`MAX_SPHERES`]. Nothing is changed then.
    pub fn set(&self, spheres: &[Sphere], receiver_from_world: DMat4) -> Result<(), ShadowError> {
        if spheres.len() > MAX_SPHERES {
            let (what, expected, actual) = ("spheres, at most", MAX_SPHERES, spheres.len());
            return Err(ShadowError::Length { what, expected, actual });
        }
        let scale = uniform_scale(DMat3::from_mat4(receiver_from_world))?;
        for sphere in spheres {
            if !sphere.center.is_finite() {
                let value = sphere.center.x + sphere.center.y + sphere.center.z;
                return Err(ShadowError::Range {
                    what: "the centre of a sphere",
                    value,
                    range: "finite numbers",
                });
            }
            if !(sphere.radius >= 0.0 && sphere.radius.is_finite()) {
                let value = sphere.radius;
                return Err(ShadowError::Range { what: "the radius of a sphere", value, range: "0 or more" });
            }
        }
        let moved = |sphere: &Sphere| {
            let center = receiver_from_world.transform_point3(sphere.center);
            center.extend(scale * sphere.radius).as_vec4().to_array()
        };
        let mut held = self.lock();
        held.clear();
        held.extend(spheres.iter().map(moved));
        Ok(())
    }

    /// Whether nothing blocks.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.lock().iter().all(|sphere| sphere[3] <= 0.0)
    }

    /// Reads the spheres: centre and radius.
    pub(crate) fn with<T>(&self, read: impl FnOnce(&[[f32; 4]]) -> T) -> T {
        read(&self.lock())
    }

    fn lock(&self) -> MutexGuard<'_, Vec<[f32; 4]>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The factor of all lengths.
fn uniform_scale(matrix: DMat3) -> Result<f64, ShadowError> {
    let scale = matrix.determinant().abs().cbrt();
    let square = matrix.transpose() * matrix / (scale * scale);
    let uneven =
        (square - DMat3::IDENTITY).to_cols_array().into_iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    if uneven < 1e-4 && scale > 0.0 && scale.is_finite() {
        return Ok(scale);
    }
    let (what, range) =
        ("the unevenness of a receiver's matrix", "a rotation times a uniform scale, to 1e-4");
    Err(ShadowError::Range { what, value: uneven, range })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};

    #[test]
    fn spheres_follow_the_matrix() {
        let blockers = Blockers::default();
        let turn = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
        let matrix =
            DMat4::from_scale_rotation_translation(DVec3::splat(2.0), turn, DVec3::new(0.0, 0.0, 5.0));
        blockers.set(&[Sphere { center: DVec3::X, radius: 0.5 }], matrix).unwrap();
        blockers.with(|spheres| {
            let expected = [0.0, 2.0, 5.0, 1.0];
            assert!(spheres[0].iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{spheres:?}");
        });
        assert!(!blockers.is_empty());
        blockers.set(&[Sphere { center: DVec3::X, radius: 0.0 }], DMat4::IDENTITY).unwrap();
        assert!(blockers.is_empty());
    }

    #[test]
    fn what_is_no_sphere_is_refused_and_nothing_changes() {
        let blockers = Blockers::default();
        let good = Sphere { center: DVec3::ONE, radius: 1.0 };
        blockers.set(&[good], DMat4::IDENTITY).unwrap();
        for bad in [
            Sphere { radius: -1.0, ..good },
            Sphere { radius: f64::NAN, ..good },
            Sphere { center: DVec3::INFINITY, ..good },
        ] {
            assert!(blockers.set(&[good, bad], DMat4::IDENTITY).is_err(), "{bad:?}");
        }
        for bad in [DMat4::ZERO, DMat4::from_scale(DVec3::new(1.0, 1.0, 1.1)), DMat4::NAN] {
            assert!(blockers.set(&[good], bad).is_err(), "{bad:?}");
        }
        assert!(blockers.set(&vec![good; MAX_SPHERES + 1], DMat4::IDENTITY).is_err());
        blockers.with(|spheres| assert_eq!(spheres.len(), 1));
    }
}
