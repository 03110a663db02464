//! What gives light: triangles of uniform radiance and spheres, in the receiver's object space.

use glam::DVec3;

use crate::RadianceError;

/// A triangle that emits the same radiance from both sides; one of radiance zero blocks light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Corners, metres.
    pub corners: [DVec3; 3],
    /// Linear RGB radiance, W/sr/m2, zero or more.
    pub radiance: DVec3,
}

impl Triangle {
    /// Whether any light leaves it.
    #[must_use]
    pub fn emits(&self) -> bool {
        self.radiance.max_element() > 0.0
    }
}

/// A sphere that emits the same radiance everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre, metres.
    pub centre: DVec3,
    /// Radius, metres, zero or more.
    pub radius: f64,
    /// Linear RGB radiance, W/sr/m2, zero or more.
    pub radiance: DVec3,
}

/// Refuses what is not finite and radiance below zero.
///
/// # Errors
/// [`RadianceError::Value`] names the first such triangle.
pub fn check(triangles: &[Triangle]) -> Result<(), RadianceError> {
    let sound = |triangle: &Triangle| {
        triangle.corners.iter().all(|corner| corner.is_finite())
            && triangle.radiance.is_finite()
            && triangle.radiance.min_element() >= 0.0
    };
    match triangles.iter().position(|triangle| !sound(triangle)) {
        None => Ok(()),
        Some(index) => Err(RadianceError::Value {
            what: "emitter triangle",
            index,
            value: format!("{:?}", triangles[index]),
        }),
    }
}
