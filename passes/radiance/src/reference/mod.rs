//! Incident radiance in f64: what everything else is measured against.

use crate::{Glow, Hierarchy, RadianceError, Refined, Settings, Triangle, check, refine};

mod cube;
mod polygon;
mod slope;
mod sphere;
#[cfg(test)]
mod tests;

pub use cube::Cube;
pub use polygon::{polygon, triangles};
pub use sphere::sphere;

/// Samples of triangles for a receiver, all by cube maps; none where nothing emits.
///
/// # Errors
/// [`RadianceError::Value`] for a faulty triangle; otherwise as [`refine`].
pub fn sample(
    hierarchy: &Hierarchy,
    settings: &Settings,
    cube: &Cube,
    triangles: &[Triangle],
) -> Result<Refined, RadianceError> {
    check(triangles)?;
    if !triangles.iter().any(Triangle::emits) {
        return Ok(Refined::default());
    }
    refine(hierarchy, settings, &Glow::of(triangles), &mut |points| {
        points.iter().map(|point| cube.sample(*point, triangles)).collect()
    })
}
