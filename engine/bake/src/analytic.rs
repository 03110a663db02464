//! Unshadowed vectors in closed form, never by rays.

use airglow_math::MathError;
use airglow_math::sh::zonal;
use glam::{DVec3, Mat4};

use crate::mesh::{Mesh, Placement};
use crate::settings::{MAX_ORDER, check_order};
use crate::{BakeError, Baked, Stats, Transfer};

/// Band factors of the clamped cosine over π: thesis eq. 5.14.
pub(crate) fn cosine_factors(order: usize) -> Result<Vec<f64>, MathError> {
    let factors = zonal::clamped_cosine(order)?;
    Ok(factors.into_iter().map(|factor| factor / std::f64::consts::PI).collect())
}

/// Transfer vectors of vertices that nothing shadows: H(N) = 1/π ∫ max(s·N, 0) y(s) ds (thesis eq. 5.14), in
/// the space `transform` carries the mesh to. Zero normals give zero vectors and are counted.
///
/// # Errors
/// As [`crate::bake`], for the mesh, its transform and the order.
pub fn unshadowed(mesh: &Mesh<'_>, transform: Mat4, order: usize) -> Result<Baked, BakeError> {
    let start = std::time::Instant::now();
    check_order(order)?;
    mesh.check()?;
    let placement = Placement::new(mesh.name, transform)?;
    let factors = cosine_factors(order)?;
    let count = order * order;
    let mut coefficients = vec![0.0_f32; mesh.positions.len() * count];
    let mut stats = Stats { threads: 1, ..Stats::default() };
    let mut vector = [0.0; MAX_ORDER * MAX_ORDER];
    for (normal, out) in mesh.normals.iter().zip(coefficients.chunks_exact_mut(count)) {
        match unit(placement.normal(*normal)) {
            Some(normal) => {
                zonal::rotate_to_direction(&factors, normal, &mut vector[..count])?;
                out.iter_mut().zip(&vector).for_each(|(out, value)| *out = *value as f32);
            }
            None => stats.zero_normals += 1,
        }
    }
    stats.time = start.elapsed();
    let transfer = Transfer { order, vertex_count: mesh.positions.len(), coefficients, visibility: None };
    Ok(Baked { transfer, stats })
}

/// The unit vector along `vector`, whatever its length; `None` for zero.
pub(crate) fn unit(vector: DVec3) -> Option<DVec3> {
    let largest = vector.abs().max_element();
    (largest > 0.0).then(|| (vector / largest).normalize())
}
