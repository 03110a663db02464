//! Single rays of a mesh's vertices, from the origins that the bake uses: for a caller that integrates something
//! else than the basis, such as a reference renderer.

use glam::{DVec3, Mat4};

use crate::vertices::Vertices;
use crate::{BakeError, Mesh, Occluders, Settings};

/// The vertices of a mesh, ready to be asked what they see.
pub struct Probe<'a>(Vertices<'a>);

impl std::fmt::Debug for Probe<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Probe").field("vertices", &self.0.len()).finish_non_exhaustive()
    }
}

impl<'a> Probe<'a> {
    /// Carries the mesh to the space of the `occluders`, as [`crate::bake()`] does. `reach` is the longest ray,
    /// metres, positive.
    ///
    /// # Errors
    /// As [`crate::bake()`].
    pub fn new(
        mesh: &Mesh<'_>,
        transform: Mat4,
        occluders: &'a Occluders<'a>,
        reach: f32,
    ) -> Result<Self, BakeError> {
        let settings = Settings { order: 1, rays: 1, reach, ..Settings::default() };
        settings.check()?;
        mesh.check()?;
        Ok(Self(Vertices::new(mesh, transform, occluders, &settings)?))
    }

    /// Number of vertices.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.0.len()
    }

    /// Unit normal of a vertex in the occluders' space; `None` for a zero normal or no such vertex.
    #[must_use]
    pub fn normal(&self, vertex: usize) -> Option<DVec3> {
        self.0.normal(vertex)
    }

    /// Whether nothing blocks the ray from a vertex along the unit `direction`, whichever side of the surface
    /// that is on. False for a vertex without normal.
    #[must_use]
    pub fn sees(&self, vertex: usize, direction: DVec3) -> bool {
        self.normal(vertex).is_some_and(|normal| self.0.sees(vertex, normal, direction))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_blocks_the_rays_that_meet_it_and_no_others() {
        let floor = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
        let mesh =
            Mesh { name: "floor", positions: &floor, normals: &[[0.0, 1.0, 0.0]; 3], indices: &[0, 1, 2] };
        let wall = [[-1.0, -1.0, -1.0], [-1.0, -1.0, 9.0], [-1.0, 9.0, -1.0]];
        let wall =
            Mesh { name: "wall", positions: &wall, normals: &[[1.0, 0.0, 0.0]; 3], indices: &[0, 1, 2] };
        let occluders = Occluders::build(&[mesh.occluder(), wall.occluder()]).unwrap();
        let probe = Probe::new(&mesh, Mat4::IDENTITY, &occluders, f32::INFINITY).unwrap();
        assert_eq!((probe.vertex_count(), probe.normal(0), probe.normal(3)), (3, Some(DVec3::Y), None));
        for (direction, seen) in [([-1.0, 0.1, 0.0], false), ([1.0, 0.1, 0.0], true), ([0.0, 1.0, 0.0], true)]
        {
            let direction = DVec3::from(direction).normalize();
            assert_eq!(probe.sees(0, direction), seen, "{direction}");
        }
        let short = Probe::new(&mesh, Mat4::IDENTITY, &occluders, 0.5).unwrap();
        assert!(short.sees(0, DVec3::new(-1.0, 0.1, 0.0).normalize()), "the wall is out of reach");
    }
}
