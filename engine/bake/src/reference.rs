//! The bake's definition, word for word, in f64: every direction of a fine grid against every triangle.
//!
//! Thesis eq. 5.14 with visibility, t = 1/π ∫ V(s) max(s·N, 0) y(s) ds, and v = ∫ V(s) y(s) ds. No hierarchy, no
//! random numbers, no f32. For tests and reports; its time grows as directions · triangles.

use std::f64::consts::{PI, TAU};

use airglow_math::MathError;
use airglow_math::sh::evaluate;
use glam::{DVec3, Mat4};

use crate::mesh::{Mesh, Occluder};
use crate::{BakeError, BelowHorizon};

/// One vertex's vectors.
#[derive(Clone, Debug, PartialEq)]
pub struct Vectors {
    /// The transfer vector, order² values.
    pub transfer: Vec<f64>,
    /// The visibility vector, order² values.
    pub visibility: Vec<f64>,
}

/// The occluders' triangles in the space baked in. Masks are not followed.
///
/// # Errors
/// Faulty indices or positions, named.
pub fn triangles(occluders: &[Occluder<'_>]) -> Result<Vec<[DVec3; 3]>, BakeError> {
    let mut triangles = Vec::new();
    for occluder in occluders {
        crate::mesh::check_triangles(occluder.name, occluder.positions, occluder.indices)?;
        let point = |index: u32| {
            let position = DVec3::from(occluder.positions[index as usize].map(f64::from));
            occluder.transform.as_dmat4().transform_point3(position)
        };
        triangles.extend(occluder.indices.chunks_exact(3).map(|i| [point(i[0]), point(i[1]), point(i[2])]));
    }
    Ok(triangles)
}

/// Position and unit normal of a vertex in the space `transform` carries the mesh to; `None` for a zero normal
/// or a vertex that is not there.
#[must_use]
pub fn vertex(mesh: &Mesh<'_>, transform: Mat4, vertex: usize) -> Option<(DVec3, DVec3)> {
    let matrix = transform.as_dmat4();
    let position = DVec3::from(mesh.positions.get(vertex)?.map(f64::from));
    let normal = DVec3::from(mesh.normals.get(vertex)?.map(f64::from));
    let normal = glam::DMat3::from_mat4(matrix).inverse().transpose() * normal;
    Some((matrix.transform_point3(position), normal.try_normalize()?))
}

/// Vectors of a vertex by the midpoint rule over `rings` rings of equal height and 4 · `rings` sectors of the
/// upper hemisphere, all cells of one solid angle. Rays start `offset` metres off the vertex along its normal.
///
/// # Errors
/// An order the mathematics room does not know.
pub fn vectors(
    (position, normal): (DVec3, DVec3),
    offset: f64,
    triangles: &[[DVec3; 3]],
    order: usize,
    rings: usize,
    below: BelowHorizon,
) -> Result<Vectors, MathError> {
    let count = order * order;
    let mut sums = Vectors { transfer: vec![0.0; count], visibility: vec![0.0; count] };
    let mut basis = vec![0.0; count];
    let mut lower = vec![0.0; count];
    let mut free_share = 0.0;
    let (across, along) = normal.any_orthonormal_pair();
    let cell = TAU / (4 * rings * rings) as f64;
    for ring in 0..rings {
        let z = (ring as f64 + 0.5) / rings as f64;
        for sector in 0..4 * rings {
            let (sin, cos) = (TAU * (sector as f64 + 0.5) / (4 * rings) as f64).sin_cos();
            let flat = (across * cos + along * sin) * (1.0 - z * z).sqrt();
            evaluate(order, flat - normal * z, &mut basis)?;
            lower.iter_mut().zip(&basis).for_each(|(sum, value)| *sum += value * cell);
            let direction = flat + normal * z;
            if free(position + normal * offset, direction, triangles) {
                free_share += z / PI * cell;
                evaluate(order, direction, &mut basis)?;
                sums.transfer.iter_mut().zip(&basis).for_each(|(sum, value)| *sum += z / PI * value * cell);
                sums.visibility.iter_mut().zip(&basis).for_each(|(sum, value)| *sum += value * cell);
            }
        }
    }
    let visible_below = match below {
        BelowHorizon::Mean => free_share,
        BelowHorizon::Visible => 1.0,
        BelowHorizon::Blocked => 0.0,
    };
    sums.visibility.iter_mut().zip(&lower).for_each(|(sum, value)| *sum += visible_below * value);
    Ok(sums)
}

/// Whether a ray meets none of the triangles.
#[must_use]
pub fn free(origin: DVec3, direction: DVec3, triangles: &[[DVec3; 3]]) -> bool {
    !triangles.iter().any(|triangle| meets(origin, direction, triangle))
}

/// Möller and Trumbore 1997, from both sides.
fn meets(origin: DVec3, direction: DVec3, [a, b, c]: &[DVec3; 3]) -> bool {
    let (first, second, start) = (*b - *a, *c - *a, origin - *a);
    let p = direction.cross(second);
    let determinant = first.dot(p);
    let u = start.dot(p) / determinant;
    let q = start.cross(first);
    let v = direction.dot(q) / determinant;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && second.dot(q) / determinant > 0.0
}
