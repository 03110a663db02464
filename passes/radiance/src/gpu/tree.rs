//! The tree over a receiver's vertices as kernels read it: `radiance/tree.glsl`, seen from the host.

use airglow_gpu::GpuError;
use bytemuck::{Pod, Zeroable};

use crate::{Hierarchy, Node, OVERLAP, Oracle};

/// A node: half the size of [`Node`], so that the tree of two million vertices fits into one binding of 128 MiB.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct DeviceNode {
    /// Where its sample is taken, metres.
    pub mean: [f32; 3],
    /// Radius about the mean that holds the domains of its own sample and of every sample below.
    pub bound: f32,
    /// Radius about the mean that holds its vertices.
    pub reach: f32,
    /// [`Oracle::weight`]; below 0 where no vertex reflects light.
    pub weight: f32,
    /// Vertices.
    pub count: u32,
    /// The colour that a change of its light of norm 1 makes, root mean square over all vertices.
    pub share: f32,
}

/// The nodes in the tree's order.
pub fn nodes(hierarchy: &Hierarchy, oracle: Oracle) -> Vec<DeviceNode> {
    let vertices = hierarchy.vertices().len();
    let node = |node: &Node| DeviceNode {
        mean: node.mean,
        bound: rounded_up(OVERLAP * f64::from(node.reach)),
        reach: node.reach,
        weight: if node.transfer == 0.0 { -1.0 } else { oracle.weight(node, vertices) as f32 },
        count: node.count,
        share: oracle.share(node, vertices) as f32,
    };
    let mut nodes: Vec<_> = hierarchy.nodes().iter().map(node).collect();
    // The nodes above one are those whose range of nodes holds it.
    let mut above: Vec<usize> = Vec::new();
    for below in 0..nodes.len() {
        while above.last().is_some_and(|node| below >= node + 2 * nodes[*node].count as usize - 1) {
            above.pop();
        }
        let (centre, domain) = (hierarchy.nodes()[below].point(), OVERLAP * f64::from(nodes[below].reach));
        for node in &above {
            let bound = rounded_up(hierarchy.nodes()[*node].point().distance(centre) + domain);
            nodes[*node].bound = nodes[*node].bound.max(bound);
        }
        above.push(below);
    }
    nodes
}

/// More than `length` by what rounding here and in the kernel may take away.
fn rounded_up(length: f64) -> f32 {
    (length * (1.0 + 1e-6)) as f32
}

/// Most vertices whose tree fits into a binding of `range` bytes.
///
/// # Errors
/// [`GpuError::Misuse`] for a tree that does not.
pub fn check_range(nodes: usize, range: u64) -> Result<(), GpuError> {
    let bytes = (nodes * size_of::<DeviceNode>()) as u64;
    match bytes <= range {
        true => Ok(()),
        false => {
            let problem = format!("its tree takes {bytes} bytes, a binding {range}: give fewer vertices");
            Err(GpuError::misuse("the receiver", problem))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ops::ControlFlow;

    /// Every domain at or below a node lies within its bound, and what reflects nothing says so.
    #[test]
    fn bounds_hold_what_lies_below() {
        let positions: Vec<[f32; 3]> =
            (0..200).map(|i| [(i as f32).sin(), (1.7 * i as f32).cos(), 0.01 * i as f32]).collect();
        let transfer: Vec<f32> = (0..200).map(|i| if i % 7 < 3 { 0.0 } else { 1.0 }).collect();
        let tree = Hierarchy::build(&positions, &transfer, &mut |_, _| ControlFlow::Continue(())).unwrap();
        let nodes = nodes(&tree, Oracle::Transfer);
        for (i, node) in nodes.iter().enumerate() {
            for below in &tree.nodes()[i..][..2 * node.count as usize - 1] {
                let far = tree.nodes()[i].point().distance(below.point());
                let domain = far + OVERLAP * f64::from(below.reach);
                assert!(domain <= f64::from(node.bound), "node {i}: {domain} > {}", node.bound);
            }
            assert_eq!(node.weight < 0.0, tree.nodes()[i].transfer == 0.0, "node {i}");
        }
        assert!(check_range(1 << 22, 128 << 20).is_ok() && check_range((1 << 22) + 1, 128 << 20).is_err());
    }
}
