//! Spheres that follow a skin: each by the joints of the vertices it stands for.

use std::collections::BTreeMap;

use glam::{DMat4, DVec3};

use super::SphereSet;
use crate::{ShadowError, Sphere};

/// The joints that move a sphere; weights sum to 1, or are all 0 for a sphere that no joint moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SphereWeights {
    /// Indices into the joints of the skin.
    pub joints: [u16; 4],
    /// Share of each.
    pub weights: [f64; 4],
}

/// Weights of the spheres of a mesh: the four largest sums over the vertices of each.
///
/// # Errors
/// [`ShadowError::Length`] unless joints and weights are as many as the vertices the set was fitted to.
pub fn weights(
    set: &SphereSet,
    joints: &[[u16; 4]],
    weights: &[[f32; 4]],
) -> Result<Vec<SphereWeights>, ShadowError> {
    for (what, actual) in [("joints of vertices", joints.len()), ("weights of vertices", weights.len())] {
        let expected = set.assignment.len();
        if actual != expected {
            return Err(ShadowError::Length { what, expected, actual });
        }
    }
    let mut sums = vec![BTreeMap::<u16, f64>::new(); set.spheres.len()];
    for ((at, joints), weights) in set.assignment.iter().zip(joints).zip(weights) {
        let Some(sums) = sums.get_mut(*at as usize) else { continue };
        for (joint, weight) in joints.iter().zip(weights).filter(|(_, weight)| **weight > 0.0) {
            *sums.entry(*joint).or_default() += f64::from(*weight);
        }
    }
    Ok(sums.into_iter().map(largest).collect())
}

/// The four largest, made to sum to 1.
fn largest(sums: BTreeMap<u16, f64>) -> SphereWeights {
    let mut sorted: Vec<(u16, f64)> = sums.into_iter().collect();
    sorted.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let total: f64 = sorted.iter().take(4).map(|(_, weight)| weight).sum();
    let mut found = SphereWeights::default();
    for (place, (joint, weight)) in sorted.into_iter().take(4).enumerate() {
        found.joints[place] = joint;
        found.weights[place] = if total > 0.0 { weight / total } else { 0.0 };
    }
    found
}

/// The spheres in a pose: centres by linear blend skinning with `world_from_mesh` of each joint, radii by the joints' mean
/// scale. A sphere that no joint moves, or whose joint is not there, stays.
#[must_use]
pub fn skinned(spheres: &[Sphere], weights: &[SphereWeights], world_from_mesh: &[DMat4]) -> Vec<Sphere> {
    let moved = |(sphere, bound): (&Sphere, &SphereWeights)| {
        let (mut center, mut scale, mut total) = (DVec3::ZERO, 0.0, 0.0);
        for (joint, weight) in bound.joints.iter().zip(bound.weights) {
            let Some(matrix) = world_from_mesh.get(usize::from(*joint)) else { continue };
            center += weight * matrix.transform_point3(sphere.center);
            scale += weight * matrix.determinant().abs().cbrt();
            total += weight;
        }
        match total > 0.0 {
            true => Sphere { center: center / total, radius: sphere.radius * scale / total },
            false => *sphere,
        }
    };
    spheres.iter().zip(weights).map(moved).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_follow_the_joints_of_their_vertices() {
        let sphere = |x: f64| Sphere { center: DVec3::X * x, radius: 0.5 };
        let set = SphereSet {
            spheres: vec![sphere(0.0), sphere(1.0), sphere(2.0)],
            assignment: vec![0, 0, 1, 2],
            outside: 0.0,
            volume: 0.0,
        };
        let joints = [[0, 1, 0, 0], [1, 0, 0, 0], [1, 9, 0, 0], [0; 4]];
        let shares = [[0.5, 0.5, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0], [0.0; 4]];
        let bound = weights(&set, &joints, &shares).unwrap();
        assert_eq!((bound[0].joints[0], bound[0].weights[0]), (1, 0.75));
        let pose = [DMat4::IDENTITY, DMat4::from_translation(DVec3::Y * 4.0)];
        let moved = skinned(&set.spheres, &bound, &pose);
        assert_eq!(moved[0].center, DVec3::new(0.0, 3.0, 0.0));
        assert_eq!(moved[1].center, DVec3::new(1.0, 4.0, 0.0), "a joint that is not there has no say");
        assert_eq!(moved[2], set.spheres[2], "no weights, no motion");
        assert!(weights(&set, &joints[1..], &shares).is_err());
    }
}
