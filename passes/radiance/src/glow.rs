//! What emitters would send if nothing hid them, from their sizes and distances alone: what keeps a sample in a shadow
//! from being taken for its whole node.

use glam::DVec3;

use crate::Triangle;

/// A triangle that emits, seen from afar.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Glow {
    /// Its centre, metres.
    pub centre: DVec3,
    /// Its area, m2.
    pub area: f64,
    /// Its radiance, W/sr/m2, linear RGB.
    pub radiance: DVec3,
}

impl Glow {
    /// Those of the triangles that emit.
    #[must_use]
    pub fn of(triangles: &[Triangle]) -> Vec<Self> {
        let glow = |triangle: &Triangle| {
            let [a, b, c] = triangle.corners;
            let area = 0.5 * (b - a).cross(c - a).length();
            Self { centre: (a + b + c) / 3.0, area, radiance: triangle.radiance }
        };
        triangles.iter().filter(|triangle| triangle.emits()).map(glow).collect()
    }

    /// Its part of [`Incident::slope`](crate::Incident::slope) at a point that sees it from before: radiance times solid
    /// angle over distance, the solid angle at most that of a half space.
    #[must_use]
    pub fn slope(&self, point: DVec3) -> DVec3 {
        let near = point.distance(self.centre).max((self.area / std::f64::consts::TAU).sqrt());
        if near > 0.0 { self.radiance * (self.area / near.powi(3)) } else { DVec3::ZERO }
    }
}
