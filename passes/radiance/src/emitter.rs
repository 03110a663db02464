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

/// Splits of the sides of an octahedron that stands for a sphere: 8 * 4^2 triangles.
const SPLITS: u32 = 2;

impl Sphere {
    /// Triangles that stand for it where others hide it: corners on a sphere of so much more radius that the surface is the
    /// same, and with it, by Cauchy, the mean of what is seen from all sides.
    #[must_use]
    pub fn triangles(&self) -> Vec<Triangle> {
        let mut sides = Vec::new();
        for [x, y, z] in [[1, 1, 1], [1, 1, -1], [1, -1, 1], [1, -1, -1]] {
            let axes = [DVec3::X * f64::from(x), DVec3::Y * f64::from(y), DVec3::Z * f64::from(z)];
            sides.extend([axes, [-axes[0], axes[1], axes[2]]]);
        }
        for _ in 0..SPLITS {
            sides = sides.into_iter().flat_map(split).collect();
        }
        let surface: f64 = sides.iter().map(|[a, b, c]| 0.5 * (*b - *a).cross(*c - *a).length()).sum();
        let radius = self.radius * (4.0 * std::f64::consts::PI / surface).sqrt();
        let place = |corner: DVec3| self.centre + radius * corner;
        let side = |corners: [DVec3; 3]| Triangle { corners: corners.map(place), radiance: self.radiance };
        sides.into_iter().map(side).collect()
    }
}

/// A triangle of the unit sphere in four.
fn split([a, b, c]: [DVec3; 3]) -> [[DVec3; 3]; 4] {
    let [ab, bc, ca] = [a + b, b + c, c + a].map(DVec3::normalize);
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}

/// Refuses what is not finite, and radius or radiance below zero.
///
/// # Errors
/// [`RadianceError::Value`] names the first such sphere.
pub fn check_spheres(spheres: &[Sphere]) -> Result<(), RadianceError> {
    let sound = |sphere: &Sphere| {
        let numbers = [sphere.radius, sphere.radiance.x, sphere.radiance.y, sphere.radiance.z];
        sphere.centre.is_finite() && numbers.iter().all(|number| number.is_finite() && *number >= 0.0)
    };
    match spheres.iter().position(|sphere| !sound(sphere)) {
        None => Ok(()),
        Some(index) => Err(RadianceError::Value {
            what: "emitter sphere",
            index,
            value: format!("{:?}", spheres[index]),
        }),
    }
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
