//! Vertex normals as the angle-weighted mean of triangle normals: Thuermer and Wuethrich, "Computing Vertex
//! Normals from Polygonal Facets", Journal of Graphics Tools 3(1), 1998. Unlike weights by area, the result does
//! not depend on how a flat face is cut into triangles.

use glam::DVec3;

/// A triangle has no area when twice its area is at most this fraction of its longest edge squared: its height is
/// then lost in the rounding of f32 positions.
const FLAT: f64 = 1e-9;

/// Unit normals, one for each position, smooth over the triangles that share a vertex of `indices`.
///
/// glTF asks for flat normals here, which would split vertices; the order of vertices is kept instead. Vertices
/// that only lie on triangles without area, or on none, get +Y. Indices beyond `positions` are passed over.
pub fn generate_normals(positions: &[[f32; 3]], indices: &[u32]) -> Vec<[f32; 3]> {
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for corners in indices.chunks_exact(3) {
        let Some(points) = corner_positions(positions, corners) else { continue };
        let Some(normal) = unit_normal(points) else { continue };
        for (corner, angle) in corners.iter().zip(corner_angles(points)) {
            sums[*corner as usize] += normal * angle;
        }
    }
    let up = |sum: DVec3| sum.try_normalize().unwrap_or(DVec3::Y).as_vec3().to_array();
    sums.into_iter().map(up).collect()
}

/// How many triangles have no area.
pub fn count_degenerate(positions: &[[f32; 3]], indices: &[u32]) -> usize {
    let flat = |corners: &&[u32]| {
        corner_positions(positions, corners).is_some_and(|points| unit_normal(points).is_none())
    };
    indices.chunks_exact(3).filter(flat).count()
}

/// The three positions of a triangle; `None` if an index is out of range.
pub(super) fn corner_positions(positions: &[[f32; 3]], corners: &[u32]) -> Option<[DVec3; 3]> {
    let point = |corner: usize| {
        let position = positions.get(*corners.get(corner)? as usize)?;
        Some(glam::Vec3::from(*position).as_dvec3())
    };
    Some([point(0)?, point(1)?, point(2)?])
}

/// Unit normal of a counter-clockwise triangle; `None` if it has no area.
pub(super) fn unit_normal([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    let twice_area = (b - a).cross(c - a);
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    if twice_area.length() <= FLAT * longest { None } else { twice_area.try_normalize() }
}

/// Interior angles of a triangle with area, radians.
pub(super) fn corner_angles([a, b, c]: [DVec3; 3]) -> [f64; 3] {
    [(b - a).angle_between(c - a), (c - b).angle_between(a - b), (a - c).angle_between(b - c)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit cube around the origin with shared corners, counter-clockwise from outside.
    fn cube() -> (Vec<[f32; 3]>, Vec<u32>) {
        let bit = |corner: u32, axis: u32| (corner >> axis & 1) as f32 - 0.5;
        let positions = (0..8).map(|corner| [bit(corner, 0), bit(corner, 1), bit(corner, 2)]).collect();
        let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        (positions, faces.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect())
    }

    #[test]
    fn corners_of_a_cube_point_along_the_diagonal_however_faces_are_cut() {
        let (positions, indices) = cube();
        let normals = generate_normals(&positions, &indices);
        for (position, normal) in positions.iter().zip(&normals) {
            let expected = glam::Vec3::from(*position).normalize();
            let distance = glam::Vec3::from(*normal).distance(expected);
            assert!(distance < 1e-6, "normal {normal:?} at {position:?}, expected {expected}");
        }
    }

    #[test]
    fn needles_and_points_have_no_area_however_small_the_mesh() {
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, 1e-3, 0.0]];
        assert_eq!(count_degenerate(&positions, &[0, 1, 2, 1, 1, 3, 0, 1, 3]), 2);
        let tiny = positions.map(|position| position.map(|x| 1e-18 * x));
        assert_eq!(count_degenerate(&tiny, &[0, 1, 2, 1, 1, 3, 0, 1, 3]), 2);
        assert_eq!(generate_normals(&positions, &[0, 1, 2])[0], [0.0, 1.0, 0.0]);
    }

    #[test]
    fn indices_out_of_range_are_passed_over() {
        assert_eq!(generate_normals(&[[0.0; 3]], &[0, 1, 2]), [[0.0, 1.0, 0.0]]);
        assert_eq!(count_degenerate(&[[0.0; 3]], &[0, 1, 2, 0]), 0);
    }
}
