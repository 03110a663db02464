//! A tree that was kept: what a cache file holds is a tree again, or is refused.

use crate::{Hierarchy, Node, RadianceError};

impl Hierarchy {
    /// The tree of these [`nodes`](Self::nodes) and [`vertices`](Self::vertices): what [`Hierarchy::build`] once gave. Bounds
    /// are taken as they are; shape, order and numbers are looked at.
    ///
    /// # Errors
    /// [`RadianceError::Setting`] for what no tree is.
    pub fn from_parts(nodes: Vec<Node>, vertices: Vec<u32>) -> Result<Self, RadianceError> {
        let tree = Self { nodes, vertices };
        match tree.fault() {
            None => Ok(tree),
            Some(fault) => Err(RadianceError::setting("the kept tree", fault, "what a tree was built to")),
        }
    }

    /// What makes it no tree.
    fn fault(&self) -> Option<String> {
        let count = self.vertices.len();
        if self.nodes.len() != (2 * count).saturating_sub(1) {
            return Some(format!("{} nodes over {count} vertices", self.nodes.len()));
        }
        let mut seen = vec![false; count];
        for vertex in &self.vertices {
            match seen.get_mut(*vertex as usize) {
                Some(seen) if !*seen => *seen = true,
                _ => return Some(format!("vertex {vertex}, twice or past the last")),
            }
        }
        let mut open = if count > 0 { vec![(0, 0, count)] } else { Vec::new() };
        while let Some((number, first, count)) = open.pop() {
            let node = &self.nodes[number];
            if (node.first as usize, node.count as usize) != (first, count) || !is_sound(node) {
                return Some(format!("node {number}: {node:?}"));
            }
            if count > 1 {
                let half = count.div_ceil(2);
                open.extend([(number + 1, first, half), (number + 2 * half, first + half, count - half)]);
            }
        }
        None
    }
}

fn is_sound(node: &Node) -> bool {
    let places = node.mean.iter().chain(&node.low).chain(&node.high);
    let sizes = [node.reach, node.radius, node.transfer, node.transfer_rms, node.spread];
    places.chain(&sizes).all(|number| number.is_finite()) && sizes.iter().all(|size| *size >= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ops::ControlFlow;

    #[test]
    fn a_kept_tree_is_the_tree_and_what_is_none_is_refused() {
        let positions: Vec<[f32; 3]> =
            (0..37).map(|i| [(i as f32).sin(), (2.3 * i as f32).cos(), 0.1]).collect();
        let tree = Hierarchy::build(&positions, &[], &mut |_, _| ControlFlow::Continue(())).unwrap();
        let parts = || (tree.nodes().to_vec(), tree.vertices().to_vec());
        let (nodes, vertices) = parts();
        assert_eq!(Hierarchy::from_parts(nodes, vertices).unwrap(), tree);
        assert!(Hierarchy::from_parts(Vec::new(), Vec::new()).unwrap().nodes().is_empty());
        let refused = |change: &dyn Fn(&mut Vec<Node>, &mut Vec<u32>)| {
            let (mut nodes, mut vertices) = parts();
            change(&mut nodes, &mut vertices);
            Hierarchy::from_parts(nodes, vertices).unwrap_err().to_string()
        };
        assert!(refused(&|nodes, _| nodes.truncate(5)).contains("5 nodes over 37"));
        assert!(refused(&|_, vertices| vertices[3] = vertices[4]).contains("twice"));
        assert!(refused(&|_, vertices| vertices[3] = 99).contains("vertex 99"));
        assert!(refused(&|nodes, _| nodes[7].count = 1 << 30).contains("node 7"));
        assert!(refused(&|nodes, _| nodes[9].reach = f32::NAN).contains("node 9"));
        assert!(refused(&|nodes, _| nodes[9].transfer = -1.0).contains("node 9"));
    }
}
