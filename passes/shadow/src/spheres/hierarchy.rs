//! A hierarchy over the spheres of a set, and the ratios its nodes count by.
//!
//! After Ren et al. 2006: a node stands for the spheres it holds where it is seen small, its logarithm scaled by the ratio
//! `sum f_node . f_held / sum f_node . f_node` to theirs. They take the ratio at each cluster of receivers; here it is taken
//! once, over points all around, and spheres of the set have ratios too: spheres that overlap hide the same light, which a
//! sum of logarithms of few bands counts for each. Their ratios are the least squares of the logarithm of what they leave
//! to be seen together.

use std::f64::consts::PI;
use std::ops::Range;

use airglow_math::sequence::{hammersley, uniform_sphere};
use airglow_math::sh::zonal::rotate_to_direction;
use glam::DVec3;

use crate::circle::Cap;
use crate::logarithm::{CLIP, Logarithm};
use crate::order::check_order;
use crate::reference::{caps, truth};
use crate::table::{Tables, looked_up};
use crate::{ShadowError, Sphere};

/// Directions that points look from.
const DIRECTIONS: u32 = 64;
/// Their distances from the middle, over the radius of the ball around the set.
const DISTANCES: [f64; 4] = [0.6, 1.0, 1.7, 4.0];
/// Degree of the rule that visibility is projected by.
const DEGREE: usize = 120;
/// Rounds of coordinate descent.
const ROUNDS: usize = 40;
/// Pull of a ratio towards the common one, over the mean square of a sphere's logarithm.
const PULL: f64 = 0.1;

/// A node in a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// A ball around what it holds, or a sphere of the set.
    pub sphere: Sphere,
    /// What its logarithm is multiplied by, 0 or more.
    pub ratio: f64,
    /// Nodes of its subtree, itself included, which follow it; 1 for a sphere of the set.
    pub subtree: usize,
}

impl Node {
    /// A sphere without hierarchy.
    #[must_use]
    pub fn alone(sphere: Sphere) -> Self {
        Self { sphere, ratio: 1.0, subtree: 1 }
    }

    /// Refuses what is no node of a list in which so many are left.
    pub(crate) fn check(&self, left: usize) -> Result<(), ShadowError> {
        let refuse = |what, value, range| Err(ShadowError::Range { what, value, range });
        let Sphere { center, radius } = self.sphere;
        if !center.is_finite() {
            return refuse("the centre of a sphere", center.x + center.y + center.z, "finite numbers");
        }
        if !(radius >= 0.0 && radius.is_finite()) {
            return refuse("the radius of a sphere", radius, "0 or more");
        }
        if !(self.ratio >= 0.0 && self.ratio.is_finite()) {
            return refuse("the ratio of a node", self.ratio, "0 or more");
        }
        if !(1..=left).contains(&self.subtree) {
            return refuse("the nodes below a node", self.subtree as f64, "1 to as many as follow it");
        }
        Ok(())
    }
}

/// The tree of a set of spheres in the order that [`Node`]s are listed in.
#[derive(Clone, Debug, PartialEq)]
pub struct Hierarchy {
    /// By node: the sphere of the set it is, or none; nodes of its subtree; its ratio, of inner nodes over the share of
    /// the squares of radii.
    nodes: Vec<(Option<usize>, usize, f64)>,
    spheres: usize,
}

impl Hierarchy {
    /// Of a set as it rests, with the ratios of an order; deterministic.
    ///
    /// # Errors
    /// [`ShadowError::Order`]; [`ShadowError::Range`] for a sphere that is not finite or a negative radius.
    pub fn new(spheres: &[Sphere], order: usize) -> Result<Self, ShadowError> {
        let mut hierarchy = Self::without_ratios(spheres)?;
        let views = Views::new(spheres, order)?;
        let leaves = views.ratios();
        let posed = hierarchy.posed_with(spheres, |leaf| leaves.get(leaf).copied().unwrap_or(1.0));
        for (at, node) in posed.iter().enumerate() {
            let (leaf, subtree, _) = hierarchy.nodes[at];
            hierarchy.nodes[at].2 = match leaf {
                Some(leaf) => leaves.get(leaf).copied().unwrap_or(1.0),
                None => {
                    let held = posed[at..at + subtree].iter().filter(|held| held.subtree == 1);
                    views.ratio(node, held)? / node.ratio.max(f64::MIN_POSITIVE)
                }
            };
        }
        Ok(hierarchy)
    }

    /// All ratios 1: nodes take the light of all that they hold, and what overlaps counts twice.
    ///
    /// # Errors
    /// [`ShadowError::Range`] for a sphere that is not finite or a negative radius.
    pub fn without_ratios(spheres: &[Sphere]) -> Result<Self, ShadowError> {
        for sphere in spheres {
            Node::alone(*sphere).check(1)?;
        }
        let mut leaves: Vec<usize> = (0..spheres.len()).collect();
        let mut nodes = Vec::with_capacity(2 * spheres.len());
        let all = Range { start: 0, end: leaves.len() };
        let mut open = Vec::from([all]);
        while let Some(range) = open.pop() {
            match range.len() {
                0 => {}
                1 => nodes.push((Some(leaves[range.start]), 1, 1.0)),
                length => {
                    nodes.push((None, 2 * length - 1, 1.0));
                    let middle = range.start + length / 2;
                    halve(spheres, &mut leaves[range.clone()]);
                    open.push(middle..range.end);
                    open.push(range.start..middle);
                }
            }
        }
        Ok(Self { nodes, spheres: spheres.len() })
    }

    /// The nodes for the spheres of the set in a pose.
    ///
    /// # Errors
    /// [`ShadowError::Length`] unless there are as many as the set has.
    pub fn posed(&self, spheres: &[Sphere]) -> Result<Vec<Node>, ShadowError> {
        if spheres.len() != self.spheres {
            let (what, actual) = ("spheres of the set", spheres.len());
            return Err(ShadowError::Length { what, expected: self.spheres, actual });
        }
        let mut ratios = vec![1.0; self.spheres];
        for (leaf, _, ratio) in &self.nodes {
            if let Some(place) = leaf.and_then(|leaf| ratios.get_mut(leaf)) {
                *place = *ratio;
            }
        }
        Ok(self.posed_with(spheres, |leaf| ratios[leaf]))
    }

    /// Nodes with these ratios of the set's spheres.
    fn posed_with(&self, spheres: &[Sphere], ratio: impl Fn(usize) -> f64) -> Vec<Node> {
        let mut posed: Vec<Node> = Vec::with_capacity(self.nodes.len());
        let mut squares = vec![0.0; self.nodes.len()];
        posed.resize(self.nodes.len(), Node::alone(Sphere { center: DVec3::ZERO, radius: 0.0 }));
        for (at, &(leaf, subtree, of_share)) in self.nodes.iter().enumerate().rev() {
            if let Some(leaf) = leaf {
                let sphere = spheres[leaf];
                posed[at] = Node { sphere, ratio: ratio(leaf), subtree };
                squares[at] = posed[at].ratio * sphere.radius * sphere.radius;
            } else {
                let (first, second) = (at + 1, at + 1 + posed[at + 1].subtree);
                let sphere = around(posed[first].sphere, posed[second].sphere);
                squares[at] = squares[first] + squares[second];
                let share = squares[at] / (sphere.radius * sphere.radius).max(f64::MIN_POSITIVE);
                posed[at] = Node { sphere, ratio: of_share * share, subtree };
            }
        }
        posed
    }
}

/// Puts the half of the spheres that lies lower along their longest side first.
fn halve(spheres: &[Sphere], leaves: &mut [usize]) {
    let center = |leaf: &usize| spheres[*leaf].center;
    let low = leaves.iter().map(center).fold(DVec3::INFINITY, DVec3::min);
    let high = leaves.iter().map(center).fold(DVec3::NEG_INFINITY, DVec3::max);
    let axis = (high - low).max_position();
    let middle = leaves.len() / 2;
    leaves.select_nth_unstable_by(middle, |a, b| center(a)[axis].total_cmp(&center(b)[axis]).then(a.cmp(b)));
}

/// The smallest ball around two.
fn around(a: Sphere, b: Sphere) -> Sphere {
    let across = b.center - a.center;
    let distance = across.length();
    if distance + b.radius <= a.radius {
        return a;
    }
    if distance + a.radius <= b.radius {
        return b;
    }
    let radius = 0.5 * (distance + a.radius + b.radius);
    Sphere { center: a.center + (radius - a.radius) / distance * across, radius }
}

/// What a set looks like from all around.
struct Views {
    order: usize,
    tables: Tables,
    points: Vec<DVec3>,
    /// By sphere: its logarithms from all points, over the norm of the logarithm of what the set leaves to be seen there.
    logarithms: Vec<Vec<f64>>,
    /// Those of what the set leaves to be seen, of norm 1 each.
    together: Vec<f64>,
}

impl Views {
    fn new(spheres: &[Sphere], order: usize) -> Result<Self, ShadowError> {
        check_order(order)?;
        let (tables, logarithm) = (Tables::new(order, CLIP)?, Logarithm::new(order, CLIP)?);
        let mut views = Self {
            order,
            tables,
            points: Vec::new(),
            logarithms: vec![Vec::new(); spheres.len()],
            together: Vec::new(),
        };
        let ball = spheres.iter().copied().filter(|sphere| sphere.radius > 0.0).reduce(around);
        let Some(ball) = ball else { return Ok(views) };
        let places = DISTANCES.iter().flat_map(|distance| {
            let direction = |i| uniform_sphere(hammersley(i, DIRECTIONS));
            (0..DIRECTIONS).map(move |i| ball.center + distance * ball.radius * direction(i))
        });
        for point in places {
            let caps = caps(spheres, point);
            if caps.iter().any(|cap| cap.height >= 1.0) {
                continue;
            }
            let together = logarithm.of(&truth(order, DEGREE, &caps)?)?;
            let norm = together.iter().map(|value| value * value).sum::<f64>().sqrt();
            if norm > 1e-12 {
                views.points.push(point);
                views.together.extend(together.iter().map(|value| value / norm));
                for (column, cap) in caps.iter().enumerate() {
                    let of_cap = views.logarithm(cap)?;
                    views.logarithms[column].extend(of_cap.iter().map(|value| value / norm));
                }
            }
        }
        Ok(views)
    }

    fn logarithm(&self, cap: &Cap) -> Result<Vec<f64>, ShadowError> {
        let mut out = vec![0.0; self.order * self.order];
        rotate_to_direction(&looked_up(self.order, &self.tables.logarithm, cap.height), cap.axis, &mut out)?;
        Ok(out)
    }

    /// The ratios of the spheres: least squares with a pull towards a common one, by coordinate descent, none negative.
    fn ratios(&self) -> Vec<f64> {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut all = vec![0.0; self.together.len()];
        for column in &self.logarithms {
            all.iter_mut().zip(column).for_each(|(sum, value)| *sum += value);
        }
        let common = if self.together.is_empty() { 1.0 } else { dot(&all, &self.together) / dot(&all, &all) };
        let squares: Vec<f64> = self.logarithms.iter().map(|column| dot(column, column)).collect();
        let pull = PULL * squares.iter().sum::<f64>() / squares.len().max(1) as f64;
        let mut ratios = vec![common; squares.len()];
        let mut left: Vec<f64> = self.together.iter().zip(&all).map(|(t, a)| t - common * a).collect();
        for _ in 0..ROUNDS {
            for ((ratio, column), square) in ratios.iter_mut().zip(&self.logarithms).zip(&squares) {
                let slope = dot(column, &left) + pull * (common - *ratio);
                let next = (*ratio + slope / (square + pull).max(f64::MIN_POSITIVE)).max(0.0);
                let step = next - *ratio;
                left.iter_mut().zip(column).for_each(|(left, value)| *left -= step * value);
                *ratio = next;
            }
        }
        ratios
    }

    /// The ratio of a node to those it holds, over all points that it does not hold.
    fn ratio<'a>(
        &self,
        node: &Node,
        held: impl Iterator<Item = &'a Node> + Clone,
    ) -> Result<f64, ShadowError> {
        let (mut across, mut square) = (0.0, 0.0);
        for point in &self.points {
            let cap = node.sphere.cap(*point);
            // Nodes stand for others where they are seen small.
            if cap.height > 1.0 - (PI / 6.0).cos() {
                continue;
            }
            let whole = self.logarithm(&cap)?;
            let mut sum = vec![0.0; whole.len()];
            for held in held.clone() {
                let of_held = self.logarithm(&held.sphere.cap(*point))?;
                sum.iter_mut().zip(of_held).for_each(|(sum, value)| *sum += held.ratio * value);
            }
            across += whole.iter().zip(&sum).map(|(a, b)| a * b).sum::<f64>();
            square += whole.iter().map(|a| a * a).sum::<f64>();
        }
        Ok(if square > 0.0 { across / square } else { node.ratio })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Exponential;
    use crate::reference::{Reference, rms};

    /// A row of spheres, each half within the next.
    fn row(count: usize) -> Vec<Sphere> {
        (0..count).map(|i| Sphere { center: DVec3::X * (0.1 * i as f64), radius: 0.2 }).collect()
    }

    #[test]
    fn nodes_hold_their_subtrees_in_every_pose() {
        let rest = row(13);
        let hierarchy = Hierarchy::without_ratios(&rest).unwrap();
        let bent: Vec<Sphere> = rest
            .iter()
            .map(|sphere| Sphere {
                center: DVec3::new(sphere.center.x, sphere.center.x.powi(2), 0.3),
                ..*sphere
            })
            .collect();
        for pose in [&rest, &bent] {
            let nodes = hierarchy.posed(pose).unwrap();
            assert_eq!((nodes.len(), nodes[0].subtree), (25, 25));
            let mut leaves: Vec<f64> =
                nodes.iter().filter(|node| node.subtree == 1).map(|node| node.sphere.center.x).collect();
            leaves.sort_by(f64::total_cmp);
            assert!(leaves.windows(2).all(|pair| pair[0] < pair[1]) && leaves.len() == 13, "{leaves:?}");
            for (at, node) in nodes.iter().enumerate() {
                for held in &nodes[at..at + node.subtree] {
                    let reach = (held.sphere.center - node.sphere.center).length() + held.sphere.radius;
                    assert!(reach <= node.sphere.radius * (1.0 + 1e-12), "{held:?} in {node:?}");
                }
            }
        }
        assert!(hierarchy.posed(&rest[1..]).is_err());
        assert!(Hierarchy::without_ratios(&[]).unwrap().posed(&[]).unwrap().is_empty());
    }

    #[test]
    fn ratios_bring_overlapping_spheres_near_what_they_hide_together() {
        let spheres = row(12);
        let hierarchy = Hierarchy::new(&spheres, 4).unwrap();
        assert_eq!(hierarchy, Hierarchy::new(&spheres, 4).unwrap(), "the same set, the same ratios");
        let nodes = hierarchy.posed(&spheres).unwrap();
        let reference = Reference::new(4).unwrap();
        let (mut plain, mut better, mut coarse) = (0.0, 0.0, 0.0);
        for point in [DVec3::new(0.5, 1.4, 0.2), DVec3::new(-1.0, 0.3, 1.0), DVec3::new(2.2, -0.8, 0.1)] {
            let seen = truth(4, 300, &caps(&spheres, point)).unwrap();
            let error = |nodes: &[Node]| {
                let mut sum = vec![0.0; 16];
                for node in nodes {
                    let of_node = reference.log_visibility(&[node.sphere.cap(point)]).unwrap();
                    sum.iter_mut().zip(of_node).for_each(|(sum, value)| *sum += node.ratio * value);
                }
                rms(&reference.evaluator().exponential(Exponential::Operator, &sum).unwrap(), &seen)
            };
            let leaves: Vec<Node> = nodes.iter().copied().filter(|node| node.subtree == 1).collect();
            let alone: Vec<Node> = spheres.iter().map(|sphere| Node::alone(*sphere)).collect();
            let cut: Vec<Node> = nodes.iter().copied().filter(|node| node.subtree == 5).collect();
            plain += error(&alone);
            better += error(&leaves);
            coarse += error(&cut);
        }
        assert!(better < 0.35 * plain, "{better} of {plain}");
        assert!(coarse < 0.6 * plain, "{coarse} of {plain}");
    }

    #[test]
    fn points_and_nothing_have_ratios_too() {
        let point = Sphere { center: DVec3::ONE, radius: 0.0 };
        for spheres in [&[][..], &[point], &[point, point], &[point, Sphere { radius: 1.0, ..point }]] {
            let nodes = Hierarchy::new(spheres, 3).unwrap().posed(spheres).unwrap();
            assert!(nodes.iter().all(|node| node.check(nodes.len()).is_ok()), "{nodes:?}");
        }
        assert!(Hierarchy::new(&[Sphere { radius: -1.0, ..point }], 4).is_err());
        assert!(Hierarchy::new(&row(2), 7).is_err());
    }
}
