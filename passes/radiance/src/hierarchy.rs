//! The binary bounding-volume tree over a receiver's vertices, by which samples are placed.
//!
//! Sun 2005, section 3.2.2 and algorithm 3.3: top down, split at the median of the longest axis. The split halves the
//! vertices exactly, so the tree of any number of them has one shape, and its array needs no pointers: nodes lie in
//! depth-first order, a node of n vertices has 2n - 1 nodes below and with it, its first half begins right after it.

use std::ops::ControlFlow;

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::RadianceError;

/// Most vertices of a receiver.
pub const MAX_VERTICES: usize = 1 << 26;

/// A set of vertices near one another. 64 bytes; a device reads the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Node {
    /// Mean position of the vertices, where a sample of the node is taken.
    pub mean: [f32; 3],
    /// Largest distance of a vertex from the mean.
    pub reach: f32,
    /// Least coordinates.
    pub low: [f32; 3],
    /// Half the diagonal of the box.
    pub radius: f32,
    /// Greatest coordinates.
    pub high: [f32; 3],
    /// Largest norm of a vertex's transfer vector.
    pub transfer: f32,
    /// Place of its first vertex in [`Hierarchy::vertices`].
    pub first: u32,
    /// Number of its vertices.
    pub count: u32,
    /// Root mean square of the norms of transfer vectors.
    pub transfer_rms: f32,
    /// Root mean square of the distances of its vertices from the mean.
    pub spread: f32,
}

/// The tree, and the order in which it holds the vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct Hierarchy {
    pub(crate) nodes: Vec<Node>,
    pub(crate) vertices: Vec<u32>,
}

impl Hierarchy {
    /// Builds the tree over `positions`, metres, and `transfer`, the vectors of order squared values a vertex, or an
    /// empty slice, which stands for vectors of norm 1. `progress` hears of vertices placed, out of all.
    ///
    /// # Errors
    /// [`RadianceError::Value`] for a position or vector that is not finite; [`RadianceError::Length`] when transfer
    /// is no whole number of values a vertex; [`RadianceError::TooMany`]; [`RadianceError::Cancelled`].
    pub fn build(
        positions: &[[f32; 3]],
        transfer: &[f32],
        progress: &mut dyn FnMut(usize, usize) -> ControlFlow<()>,
    ) -> Result<Self, RadianceError> {
        let count = positions.len();
        if count > MAX_VERTICES {
            return Err(RadianceError::TooMany { count, limit: MAX_VERTICES });
        }
        let norms = norms(positions, transfer)?;
        let mut tree = Self {
            nodes: vec![Node::default(); (2 * count).saturating_sub(1)],
            vertices: (0..count as u32).collect(),
        };
        let mut open = vec![(0, 0, count)];
        while let Some((node, first, count)) = open.pop() {
            let vertices = &mut tree.vertices[first..first + count];
            if count == 0 {
                break;
            }
            let summary = summary(positions, &norms, vertices);
            tree.nodes[node] = Node { first: first as u32, count: count as u32, ..summary };
            if count == 1 {
                if first % 1024 == 0 && progress(first, positions.len()).is_break() {
                    return Err(RadianceError::Cancelled);
                }
                continue;
            }
            let half = count.div_ceil(2);
            let axis = longest_axis(&summary);
            let key = |vertex: &u32| positions[*vertex as usize][axis];
            // Equal coordinates go by number, so that the tree does not depend on the algorithm of selection.
            vertices.select_nth_unstable_by(half, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
            open.push((node + 2 * half, first + half, count - half));
            open.push((node + 1, first, half));
        }
        Ok(tree)
    }

    /// All nodes, depth first; empty without vertices.
    #[must_use]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The vertices in the order of the tree: those of a node are consecutive.
    #[must_use]
    pub fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    /// The numbers of a node's halves; none for a single vertex and for what is no node.
    #[must_use]
    pub fn children(&self, node: usize) -> Option<[usize; 2]> {
        let count = self.nodes.get(node)?.count as usize;
        (count > 1).then(|| [node + 1, node + 2 * count.div_ceil(2)])
    }
}

impl Node {
    /// The mean position in f64.
    #[must_use]
    pub fn point(&self) -> DVec3 {
        DVec3::from(self.mean.map(f64::from))
    }
}

fn norms(positions: &[[f32; 3]], transfer: &[f32]) -> Result<Vec<f64>, RadianceError> {
    let faulty =
        |what, index, value: &[f32]| RadianceError::Value { what, index, value: format!("{value:?}") };
    if let Some(index) = positions.iter().position(|position| position.iter().any(|x| !x.is_finite())) {
        return Err(faulty("position", index, &positions[index]));
    }
    if transfer.is_empty() || positions.is_empty() {
        return Ok(vec![1.0; positions.len()]);
    }
    let width = transfer.len().div_ceil(positions.len());
    if width * positions.len() != transfer.len() {
        let (expected, actual) = (width * positions.len(), transfer.len());
        return Err(RadianceError::Length { what: "transfer", expected, actual });
    }
    let norm = |(index, vector): (usize, &[f32])| {
        let square: f64 = vector.iter().map(|t| f64::from(*t).powi(2)).sum();
        if square.is_finite() { Ok(square.sqrt()) } else { Err(faulty("transfer vector", index, vector)) }
    };
    transfer.chunks_exact(width).enumerate().map(norm).collect()
}

/// What a node says about its vertices. Bounds are rounded up, so that they hold in f32.
fn summary(positions: &[[f32; 3]], norms: &[f64], vertices: &[u32]) -> Node {
    let at = |vertex: &u32| DVec3::from(positions[*vertex as usize].map(f64::from));
    let count = vertices.len() as f64;
    let (mut low, mut high, mut sum) = (DVec3::INFINITY, DVec3::NEG_INFINITY, DVec3::ZERO);
    let (mut transfer, mut power) = (0.0_f64, 0.0);
    for vertex in vertices {
        let (position, norm) = (at(vertex), norms[*vertex as usize]);
        (low, high, sum) = (low.min(position), high.max(position), sum + position / count);
        (transfer, power) = (transfer.max(norm), power + norm * norm / count);
    }
    let mean = sum.as_vec3();
    let (mut reach, mut spread) = (0.0_f64, 0.0);
    for vertex in vertices {
        let square = at(vertex).distance_squared(mean.as_dvec3());
        (reach, spread) = (reach.max(square), spread + square / count);
    }
    Node {
        mean: mean.to_array(),
        reach: up(reach.sqrt()),
        low: low.as_vec3().to_array(),
        radius: up(0.5 * low.distance(high)),
        high: high.as_vec3().to_array(),
        transfer: up(transfer),
        transfer_rms: power.sqrt() as f32,
        spread: spread.sqrt() as f32,
        ..Node::default()
    }
}

/// The least f32 that is not below `value`.
fn up(value: f64) -> f32 {
    let rounded = value as f32;
    if f64::from(rounded) < value { rounded.next_up() } else { rounded }
}

fn longest_axis(node: &Node) -> usize {
    let size = |axis: usize| f64::from(node.high[axis]) - f64::from(node.low[axis]);
    (1..3).fold(0, |longest, axis| if size(axis) > size(longest) { axis } else { longest })
}

#[cfg(test)]
mod tests {
    use super::*;
    use airglow_math::sequence::sobol;
    use proptest::prelude::*;

    fn build(positions: &[[f32; 3]], transfer: &[f32]) -> Result<Hierarchy, RadianceError> {
        Hierarchy::build(positions, transfer, &mut |_, _| ControlFlow::Continue(()))
    }

    fn cloud(count: u32) -> Vec<[f32; 3]> {
        let point = |i| [sobol(i, 1)[0] as f32, sobol(i, 2)[1] as f32, 3.0 * sobol(i, 3)[0] as f32];
        (0..count).map(point).collect()
    }

    proptest! {
        /// Halves share out a node's vertices, and every bound holds for every vertex.
        #[test]
        fn nodes_bound_their_vertices(count in 1..300_u32) {
            let positions = cloud(count);
            let transfer: Vec<f32> = (0..4 * count).map(|i| (i as f32).sin()).collect();
            let tree = build(&positions, &transfer).unwrap();
            prop_assert_eq!(tree.nodes().len(), 2 * count as usize - 1);
            for (i, node) in tree.nodes().iter().enumerate() {
                let vertices = &tree.vertices()[node.first as usize..][..node.count as usize];
                for vertex in vertices {
                    let position = positions[*vertex as usize];
                    let norm = transfer[4 * *vertex as usize..][..4].iter().map(|t| t * t).sum::<f32>().sqrt();
                    let distance = node.point().distance(DVec3::from(position.map(f64::from)));
                    prop_assert!(distance <= f64::from(node.reach), "{distance} > {}", node.reach);
                    prop_assert!(norm <= node.transfer * (1.0 + 1e-6), "{norm} > {}", node.transfer);
                    let [low, at, high] = [node.low, position, node.high].map(glam::Vec3::from);
                    prop_assert!(low.cmple(at).all() && at.cmple(high).all(), "{low} {at} {high}");
                }
                if let Some([one, other]) = tree.children(i).map(|halves| halves.map(|half| tree.nodes()[half])) {
                    prop_assert_eq!([one.first, other.first], [node.first, node.first + one.count]);
                    prop_assert_eq!(one.count + other.count, node.count);
                    prop_assert!(one.count - other.count <= 1);
                }
            }
            let mut all = tree.vertices().to_vec();
            all.sort_unstable();
            prop_assert_eq!(all, (0..count).collect::<Vec<_>>());
        }
    }

    #[test]
    fn splits_at_the_median_of_the_longest_axis() {
        let tree = build(&cloud(64), &[]).unwrap();
        let [one, other] = tree.children(0).unwrap().map(|half| tree.nodes()[half]);
        assert!(one.high[2] <= other.low[2], "{one:?} {other:?}");
        assert_eq!((one.count, other.count), (32, 32));
        assert_eq!(tree.nodes()[0].transfer, 1.0);
    }

    #[test]
    fn coincident_vertices_and_none_are_trees() {
        let tree = build(&[[1.0, 2.0, 3.0]; 5], &[0.0; 20]).unwrap();
        assert!(
            tree.nodes().iter().all(|node| node.radius == 0.0 && node.reach == 0.0 && node.transfer == 0.0)
        );
        assert!(build(&[], &[]).unwrap().nodes().is_empty());
        assert_eq!(tree.children(99), None);
    }

    #[test]
    fn faults_are_named() {
        let error =
            |positions: &[[f32; 3]], transfer: &[f32]| build(positions, transfer).unwrap_err().to_string();
        assert!(error(&[[0.0; 3], [0.0, f32::NAN, 0.0]], &[]).starts_with("position 1"));
        assert!(error(&[[0.0; 3]; 2], &[0.0, f32::INFINITY]).starts_with("transfer vector 1"));
        assert!(error(&[[0.0; 3]; 2], &[0.0; 3]).starts_with("transfer has 3"));
        let stopped = Hierarchy::build(&cloud(4), &[], &mut |_, _| ControlFlow::Break(()));
        assert!(matches!(stopped, Err(RadianceError::Cancelled)));
    }
}
