//! Vertex tangents from texture coordinates: the direction in which u grows, found for each triangle (Lengyel,
//! "Foundations of Game Engine Development 2: Rendering", 2019, section 7.5), averaged by angle and made
//! perpendicular to the normal as MikkTSpace does (Mikkelsen, "Simulation of Wrinkled Surfaces Revisited",
//! 2008), but without splitting vertices, so that their order is kept.

use glam::{DVec2, DVec3};

use super::normals::{corner_angles, corner_positions, unit_normal};

/// Unit tangents (xyz) and the sign of the bitangent (w): bitangent = w * normal x tangent points where the image's
/// up (-v) grows.
///
/// All arrays but `indices` have one entry for each vertex; where lengths differ the shortest counts. A vertex
/// whose triangles have no area in space or in texture space gets any direction perpendicular to its normal. A
/// vertex between mirrored and unmirrored charts gets the sign of the larger angle.
pub fn generate_tangents(
    positions: &[[f32; 3]],
    normals: &[[f32; 3]],
    uv: &[[f32; 2]],
    indices: &[u32],
) -> Vec<[f32; 4]> {
    let count = positions.len().min(normals.len()).min(uv.len());
    let mut tangents = vec![DVec3::ZERO; count];
    let mut signs = vec![0.0; count];
    for corners in indices.chunks_exact(3) {
        if corners.iter().any(|corner| *corner as usize >= count) {
            continue;
        }
        let Some(points) = corner_positions(positions, corners) else { continue };
        if unit_normal(points).is_none() {
            continue;
        }
        let Some((tangent, sign)) = triangle_tangent(points, uv, corners) else { continue };
        for (corner, angle) in corners.iter().zip(corner_angles(points)) {
            let normal = glam::Vec3::from(normals[*corner as usize]).as_dvec3();
            let flat = tangent - normal * normal.dot(tangent);
            tangents[*corner as usize] += flat.normalize_or_zero() * angle;
            signs[*corner as usize] += sign * angle;
        }
    }
    let finish = |((tangent, sign), normal): ((DVec3, f64), &[f32; 3])| {
        let normal = glam::Vec3::from(*normal).as_dvec3();
        let flat = tangent - normal * normal.dot(tangent);
        let unit = flat.try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
        unit.as_vec3().extend(if sign < 0.0 { -1.0 } else { 1.0 }).to_array()
    };
    tangents.into_iter().zip(signs).zip(normals).map(finish).collect()
}

/// The unit direction in which u grows on a triangle, and +1 if its chart is not mirrored, else -1. `None` if the
/// chart has no area.
fn triangle_tangent([a, b, c]: [DVec3; 3], uv: &[[f32; 2]], corners: &[u32]) -> Option<(DVec3, f64)> {
    let at = |corner: usize| {
        let [u, v] = uv[corners[corner] as usize];
        // v counts downwards: turn it up, so that an unmirrored chart is right-handed.
        DVec2::new(f64::from(u), -f64::from(v))
    };
    let (first, second) = (at(1) - at(0), at(2) - at(0));
    let area = first.perp_dot(second);
    let tangent = ((b - a) * second.y - (c - a) * first.y) * area.signum();
    if area == 0.0 { None } else { Some((tangent.try_normalize()?, area.signum())) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    const INDICES: [u32; 6] = [0, 1, 2, 0, 2, 3];

    /// Tangents of the square in z = 0, facing +Z, with texture coordinates by `map`.
    fn of_square(map: impl Fn(f32, f32) -> [f32; 2]) -> Vec<[f32; 4]> {
        let uv = SQUARE.map(|[x, y, _]| map(x, y));
        generate_tangents(&SQUARE, &[[0.0, 0.0, 1.0]; 4], &uv, &INDICES)
    }

    #[test]
    fn the_tangent_follows_u_and_the_bitangent_the_images_up() {
        // (map, direction of growing u, direction of the image's up, which is -v)
        type Case = (fn(f32, f32) -> [f32; 2], Vec3, Vec3);
        let cases: [Case; 4] = [
            (|x, y| [x, 1.0 - y], Vec3::X, Vec3::Y),
            (|x, y| [1.0 - x, 1.0 - y], Vec3::NEG_X, Vec3::Y),
            (|x, y| [y, x], Vec3::Y, Vec3::NEG_X),
            (|x, y| [x, y], Vec3::X, Vec3::NEG_Y),
        ];
        for (case, (map, along_u, up)) in cases.into_iter().enumerate() {
            for [x, y, z, w] in of_square(map) {
                let tangent = Vec3::new(x, y, z);
                let bitangent = w * Vec3::Z.cross(tangent);
                assert!(tangent.distance(along_u) < 1e-6, "case {case}: {tangent}, expected {along_u}");
                assert!(bitangent.distance(up) < 1e-6, "case {case}: {bitangent}, expected {up}");
            }
        }
    }

    #[test]
    fn without_a_chart_any_perpendicular_direction_serves() {
        for [x, y, z, w] in of_square(|_, _| [0.5, 0.5]) {
            assert!((x * x + y * y - 1.0).abs() < 1e-6 && z == 0.0 && w == 1.0, "{x} {y} {z} {w}");
        }
    }
}
