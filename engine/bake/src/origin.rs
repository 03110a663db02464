//! Where a vertex's rays start: off its surface by a bound on rounding errors, as small as that allows.
//!
//! In the manner of Wächter and Binder 2019 (*A Fast and Robust Method for Avoiding Self-Intersection*): the
//! offset grows with the coordinates' magnitude, here also with the size of the triangles around the vertex,
//! because the distance to a triangle's plane is only known to the rounding error of its edges.

use glam::{DVec3, Vec3};

use crate::analytic::unit;

/// Offset along the normal, in units of (largest coordinate + longest edge at the vertex). Sixteen rounding
/// errors: rounding the origin, the relative corners and the plane's distance take fewer than eight.
pub(crate) const OFFSET: f32 = 16.0 * f32::EPSILON / 2.0;
/// Offset in the tangent plane, as a share of the one along the normal, towards the middle of the vertex's own
/// triangles: a vertex at the foot of a wall starts on the inner side of the wall's plane. It shrinks with the
/// cosine between normal and triangle, so that the origin stays outside the vertex's own triangles however steep.
const INWARD: f32 = 0.5;

/// What a vertex's own triangles say of its surroundings.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surroundings {
    /// Sum of the unit directions from the vertex to the middles of its triangles.
    inward: Vec3,
    longest_edge: f32,
    /// Smallest cosine between the vertex's normal and its triangles'.
    flatness: f32,
}

impl Default for Surroundings {
    fn default() -> Self {
        Self { inward: Vec3::ZERO, longest_edge: 0.0, flatness: 1.0 }
    }
}

/// Surroundings of all vertices, from positions and normals in the space baked in. Indices are in range.
pub(crate) fn surroundings(positions: &[[f32; 3]], normals: &[DVec3], indices: &[u32]) -> Vec<Surroundings> {
    let mut all = vec![Surroundings::default(); positions.len()];
    for triangle in indices.chunks_exact(3) {
        let corners = [triangle[0], triangle[1], triangle[2]].map(|i| i as usize);
        for turn in 0..3 {
            let vertex = corners[turn];
            let [a, b, c] = [0, 1, 2].map(|k| DVec3::from(positions[corners[(turn + k) % 3]].map(f64::from)));
            let (Some(normal), Some(face)) = (unit(normals[vertex]), unit((b - a).cross(c - a))) else {
                continue;
            };
            let here = &mut all[vertex];
            here.inward += unit((b - a) + (c - a)).unwrap_or_default().as_vec3();
            here.longest_edge = here.longest_edge.max((b - a).length() as f32).max((c - a).length() as f32);
            here.flatness = here.flatness.min(normal.dot(face).abs() as f32);
        }
    }
    all
}

impl Surroundings {
    /// Start of the rays of the vertex at `position` with unit `normal`, in the same units.
    pub(crate) fn ray_origin(&self, position: [f32; 3], normal: Vec3) -> [f32; 3] {
        let position = Vec3::from(position);
        let offset = OFFSET * (position.abs().max_element() + self.longest_edge);
        let inward = self.inward - normal * self.inward.dot(normal);
        let inward = inward.normalize_or_zero() * (INWARD * self.flatness);
        (position + (normal + inward) * offset).to_array()
    }
}
