//! Whether a ray meets a triangle, without gaps along shared edges.
//!
//! Signed volumes of the ray and the three edges (Plücker coordinates; Shevtsov, Soupikov, Kapustin 2007),
//! relative to the ray's origin. An edge shared by two triangles gives both the same value with the opposite
//! sign, bit for bit, because it is built from the difference and the sum of the same two rounded points: a ray
//! cannot slip between them, as it can where barycentric coordinates are compared with 1 - u - v.

use glam::{Vec3A, Vec3Swizzles};

/// Three points, one coordinate axis per vector: lane k belongs to point k.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    x: Vec3A,
    y: Vec3A,
    z: Vec3A,
}

/// A half line: t > 0, up to `reach`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    /// Start.
    pub origin: Vec3A,
    /// Unit direction.
    pub direction: Vec3A,
    /// Largest t that counts.
    pub reach: f32,
}

impl Triangle {
    pub(crate) fn new(points: [Vec3A; 3]) -> Self {
        let [a, b, c] = points;
        Self { x: Vec3A::new(a.x, b.x, c.x), y: Vec3A::new(a.y, b.y, c.y), z: Vec3A::new(a.z, b.z, c.z) }
    }

    /// Barycentric weights of the second and third point where the segment meets the triangle, from either
    /// side; `None` if it does not. Segments in the triangle's plane miss.
    #[inline(always)]
    pub(crate) fn meet(&self, segment: &Segment) -> Option<[f32; 2]> {
        let (x, y, z) = (self.x - segment.origin.x, self.y - segment.origin.y, self.z - segment.origin.z);
        let (next_x, next_y, next_z) = (x.yzx(), y.yzx(), z.yzx());
        // Lane k is the edge from point k to point k+1.
        let (edge_x, edge_y, edge_z) = (next_x - x, next_y - y, next_z - z);
        let (sum_x, sum_y, sum_z) = (next_x + x, next_y + y, next_z + z);
        let d = segment.direction;
        let volume = (edge_y * sum_z - edge_z * sum_y) * d.x
            + (edge_z * sum_x - edge_x * sum_z) * d.y
            + (edge_x * sum_y - edge_y * sum_x) * d.z;
        let inside = volume.cmpge(Vec3A::ZERO).all() || volume.cmple(Vec3A::ZERO).all();
        if !inside {
            return None;
        }
        let first = Vec3A::new(edge_x.x, edge_y.x, edge_z.x);
        let second = Vec3A::new(edge_x.y, edge_y.y, edge_z.y);
        let normal = first.cross(second);
        let distance = normal.dot(Vec3A::new(x.x, y.x, z.x)) / normal.dot(d);
        // A vanishing denominator gives NaN or infinity; neither passes.
        if !(distance > 0.0 && distance <= segment.reach && distance.is_finite()) {
            return None;
        }
        // The volume at edge k weighs the point opposite to it.
        let total = volume.x + volume.y + volume.z;
        Some([volume.z / total, volume.x / total])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_and_sides() {
        let points = [Vec3A::new(1.0, 0.0, 2.0), Vec3A::new(4.0, 1.0, 3.0), Vec3A::new(0.0, 5.0, 1.0)];
        let triangle = Triangle::new(points);
        let target = points[0] * 0.5 + points[1] * 0.2 + points[2] * 0.3;
        for origin in [Vec3A::new(0.0, 0.0, 9.0), Vec3A::new(2.0, 2.0, -9.0)] {
            let direction = (target - origin).normalize();
            let hit = triangle.meet(&Segment { origin, direction, reach: f32::INFINITY }).unwrap();
            assert!((hit[0] - 0.2).abs() < 1e-5 && (hit[1] - 0.3).abs() < 1e-5, "{hit:?} for 0.2, 0.3");
            assert!(
                triangle.meet(&Segment { origin, direction: -direction, reach: f32::INFINITY }).is_none()
            );
            assert!(triangle.meet(&Segment { origin, direction, reach: 1.0 }).is_none());
        }
    }

    #[test]
    fn a_point_or_a_line_is_never_met() {
        for points in [[Vec3A::ONE; 3], [Vec3A::X, Vec3A::X * 2.0, Vec3A::X * 3.0]] {
            let segment = Segment { origin: Vec3A::ZERO, direction: points[0].normalize(), reach: 9.0 };
            assert!(Triangle::new(points).meet(&segment).is_none());
        }
    }
}
