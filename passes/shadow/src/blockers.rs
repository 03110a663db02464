//! The spheres of a frame, in the space of their receivers.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::{DMat3, DMat4, DVec3};

use crate::spheres::Node;
use crate::{ShadowError, Sphere};

/// Nodes of a range: 16 KiB of spheres, the smallest uniform range of any device.
pub(crate) const RANGE: usize = 1024;
/// Most spheres of one instance's frame, with the nodes of their hierarchy.
pub const MAX_SPHERES: usize = 16 * RANGE;

/// The spheres that a pass reads when it is recorded. Clones share them.
#[derive(Clone, Debug, Default)]
pub struct Blockers(Arc<Mutex<Vec<Range>>>);

/// What one uniform range holds, in the space of the receivers: always [`RANGE`] of each.
#[derive(Clone, Debug)]
pub(crate) struct Range {
    /// Centre and radius.
    pub spheres: Vec<[f32; 4]>,
    /// Ratio, place of the holder or -1, 1 where it holds others.
    pub nodes: Vec<[f32; 4]>,
    count: usize,
}

impl Range {
    fn new() -> Self {
        Self { spheres: vec![[0.0; 4]; RANGE], nodes: vec![[0.0; 4]; RANGE], count: 0 }
    }

    /// Nodes.
    pub(crate) fn len(&self) -> usize {
        self.count
    }

    fn push(&mut self, sphere: [f32; 4], node: [f32; 4]) {
        if let (Some(to), Some(of)) = (self.spheres.get_mut(self.count), self.nodes.get_mut(self.count)) {
            (*to, *of) = (sphere, node);
            self.count += 1;
        }
    }
}

impl Blockers {
    /// Sets the spheres from the next recording on, without hierarchy. `receiver_from_world` takes them to the object space
    /// of the receivers: a rotation or mirroring, a uniform scale, a translation. Spheres of radius 0 block nothing.
    ///
    /// # Errors
    /// As [`Self::set_nodes`].
    pub fn set(&self, spheres: &[Sphere], receiver_from_world: DMat4) -> Result<(), ShadowError> {
        let nodes: Vec<Node> = spheres.iter().map(|sphere| Node::alone(*sphere)).collect();
        self.set_nodes(&nodes, receiver_from_world)
    }

    /// Sets the nodes of hierarchies, each after the one that holds it and before that one's next neighbour, as
    /// [`Hierarchy::posed`](crate::spheres::Hierarchy::posed) gives them; those of several sets may follow one another.
    ///
    /// # Errors
    /// [`ShadowError::Range`] for a sphere that is not finite, a negative radius, a ratio that is not 0 or more, a node
    /// that holds fewer than it says, and for a matrix that makes a sphere something else; [`ShadowError::Length`] for more
    /// than [`MAX_SPHERES`]. Nothing is changed then.
    pub fn set_nodes(&self, nodes: &[Node], receiver_from_world: DMat4) -> Result<(), ShadowError> {
        if nodes.len() > MAX_SPHERES {
            let (what, expected, actual) = ("spheres, at most", MAX_SPHERES, nodes.len());
            return Err(ShadowError::Length { what, expected, actual });
        }
        let scale = uniform_scale(DMat3::from_mat4(receiver_from_world))?;
        for (at, node) in nodes.iter().enumerate() {
            node.check(nodes.len() - at)?;
        }
        let moved = |sphere: &Sphere| {
            let center = receiver_from_world.transform_point3(sphere.center);
            center.extend(scale * sphere.radius).as_vec4().to_array()
        };
        *self.lock() = packed(nodes, moved);
        Ok(())
    }

    /// Whether nothing blocks.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.lock().iter().all(|range| range.spheres.iter().all(|sphere| sphere[3] <= 0.0))
    }

    /// Whether some sphere hides `reach` or more of a half space from somewhere within `bound`, in the space of the receivers;
    /// see [`Settings::reach`](crate::Settings::reach). Where none does, all receivers in it see everything, and a host may
    /// take an instance's dynamic visibility for nothing that frame, as relighting's `Shown::set_shadowed` does.
    #[must_use]
    pub fn reach(&self, bound: &Sphere, reach: f64) -> bool {
        let reaches = |[x, y, z, radius]: &[f32; 4]| {
            let distance = DVec3::new(f64::from(*x), f64::from(*y), f64::from(*z)).distance(bound.center);
            let center = DVec3::X * (distance - bound.radius).max(0.0);
            *radius > 0.0 && Sphere { center, radius: f64::from(*radius) }.cap(DVec3::ZERO).height >= reach
        };
        self.lock().iter().any(|range| range.spheres.iter().any(reaches))
    }

    /// The ranges to be dispatched one after the other: one at least.
    pub(crate) fn ranges(&self) -> Vec<Range> {
        let held = self.lock();
        if held.is_empty() { vec![Range::new()] } else { held.clone() }
    }

    fn lock(&self) -> MutexGuard<'_, Vec<Range>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Nodes in ranges. A range holds whole subtrees: a node whose own is larger than what is left of a range begins the next
/// one, and one whose own no range holds is left out, so that what it holds is never stood for by it.
fn packed(nodes: &[Node], moved: impl Fn(&Sphere) -> [f32; 4]) -> Vec<Range> {
    let mut ranges = Vec::new();
    let mut range = Range::new();
    // Ends of the subtrees a node lies in, and where their nodes stand.
    let mut holders: Vec<(usize, f32)> = Vec::new();
    for (at, node) in nodes.iter().enumerate() {
        holders.retain(|(end, _)| at < *end);
        if node.subtree > RANGE {
            continue;
        }
        if holders.is_empty() && range.count + node.subtree > RANGE {
            ranges.push(std::mem::replace(&mut range, Range::new()));
        }
        let holder = holders.last().map_or(-1.0, |(_, place)| *place);
        let holds = if node.subtree > 1 { 1.0 } else { 0.0 };
        holders.push((at + node.subtree, range.count as f32));
        range.push(moved(&node.sphere), [node.ratio as f32, holder, holds, 0.0]);
    }
    ranges.push(range);
    ranges
}

/// The factor of all lengths.
fn uniform_scale(matrix: DMat3) -> Result<f64, ShadowError> {
    let scale = matrix.determinant().abs().cbrt();
    let square = matrix.transpose() * matrix / (scale * scale);
    let uneven =
        (square - DMat3::IDENTITY).to_cols_array().into_iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    if uneven < 1e-4 && scale > 0.0 && scale.is_finite() {
        return Ok(scale);
    }
    let (what, range) =
        ("the unevenness of a receiver's matrix", "a rotation times a uniform scale, to 1e-4");
    Err(ShadowError::Range { what, value: uneven, range })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    #[test]
    fn spheres_follow_the_matrix() {
        let blockers = Blockers::default();
        let turn = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
        let matrix =
            DMat4::from_scale_rotation_translation(DVec3::splat(2.0), turn, DVec3::new(0.0, 0.0, 5.0));
        blockers.set(&[Sphere { center: DVec3::X, radius: 0.5 }], matrix).unwrap();
        let spheres = &blockers.ranges()[0].spheres;
        let expected = [0.0, 2.0, 5.0, 1.0];
        assert!(spheres[0].iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{:?}", spheres[0]);
        assert!(!blockers.is_empty());
        blockers.set(&[Sphere { center: DVec3::X, radius: 0.0 }], DMat4::IDENTITY).unwrap();
        assert!(blockers.is_empty());
    }

    #[test]
    fn a_bound_is_reached_from_near_and_not_from_afar() {
        let blockers = Blockers::default();
        let bound = Sphere { center: DVec3::ZERO, radius: 2.0 };
        assert!(!blockers.reach(&bound, 0.0));
        let at = |x: f64| [Sphere { center: DVec3::X * x, radius: 0.1 }];
        // From 30 away a sphere of 0.1 hides 5.6e-6 of a half space.
        for (x, reached) in [(0.0, true), (2.0, true), (10.0, true), (32.0, false)] {
            blockers.set(&at(x), DMat4::IDENTITY).unwrap();
            assert_eq!(blockers.reach(&bound, 1e-5), reached, "{x}");
        }
        blockers.set(&at(32.0), DMat4::from_translation(DVec3::X * -20.0)).unwrap();
        assert!(blockers.reach(&bound, 1e-5));
    }

    #[test]
    fn what_is_no_sphere_is_refused_and_nothing_changes() {
        let blockers = Blockers::default();
        let good = Sphere { center: DVec3::ONE, radius: 1.0 };
        blockers.set(&[good], DMat4::IDENTITY).unwrap();
        for bad in [
            Sphere { radius: -1.0, ..good },
            Sphere { radius: f64::NAN, ..good },
            Sphere { center: DVec3::INFINITY, ..good },
        ] {
            assert!(blockers.set(&[good, bad], DMat4::IDENTITY).is_err(), "{bad:?}");
        }
        for bad in [DMat4::ZERO, DMat4::from_scale(DVec3::new(1.0, 1.0, 1.1)), DMat4::NAN] {
            assert!(blockers.set(&[good], bad).is_err(), "{bad:?}");
        }
        assert!(blockers.set(&vec![good; MAX_SPHERES + 1], DMat4::IDENTITY).is_err());
        assert_eq!(blockers.ranges()[0].len(), 1);
    }
}
