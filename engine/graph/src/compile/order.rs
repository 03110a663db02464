//! Phase 4: a topological order (Kahn 1962), the pass declared first going first among those that are
//! ready, or with a seed any of them.

use super::lives::{Life, Lives, contains};
use crate::declaration::Declaration;
use crate::error::GraphError;
use crate::handle::{ImageRange, ResourceId};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// For each pass, the passes that must come after it.
type Successors = Vec<Vec<usize>>;

/// A read that must come before the write that replaces what it reads.
#[derive(Clone, Copy, Debug)]
struct ReadBefore {
    resource: ResourceId,
    version: u32,
}

pub(super) fn order(
    declaration: &Declaration,
    lives: &Lives,
    seed: Option<u64>,
) -> Result<Vec<usize>, GraphError> {
    let count = declaration.passes.len();
    let mut edges = BTreeMap::new();
    for (index, resource) in declaration.resources.iter().enumerate() {
        let id = ResourceId(index as u32);
        let (mips, layers) = resource.desc.subresources();
        let whole = ImageRange { base_mip: 0, mips, base_layer: 0, layers };
        for at in whole.subresources() {
            add_edges(&mut edges, id, lives.life(id), at);
        }
    }
    let mut successors: Successors = vec![Vec::new(); count];
    let mut waits_for = vec![0usize; count];
    for (from, to) in edges.keys() {
        successors[*from].push(*to);
        waits_for[*to] += 1;
    }
    let rank = |pass: usize| Reverse((seed.map_or(0, |seed| shuffled(seed, pass)), pass));
    let mut ready: BinaryHeap<_> = (0..count).filter(|pass| waits_for[*pass] == 0).map(rank).collect();
    let mut order = Vec::with_capacity(count);
    while let Some(Reverse((_, pass))) = ready.pop() {
        order.push(pass);
        for next in &successors[pass] {
            waits_for[*next] -= 1;
            if waits_for[*next] == 0 {
                ready.push(rank(*next));
            }
        }
    }
    if order.len() == count { Ok(order) } else { Err(cycle(declaration, &edges, &successors)) }
}

/// A rank that is as good as random: splitmix64 (Steele, Lea and Flood 2014).
fn shuffled(seed: u64, pass: usize) -> u64 {
    let mut bits = seed.wrapping_add((pass as u64).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ bits >> 31
}

/// Adds what one subresource demands: writer before reader, reader before the next writer, writer before the
/// next writer. Only the second kind can point backwards in the order of declaration, and it alone is named.
fn add_edges(
    edges: &mut BTreeMap<(usize, usize), Option<ReadBefore>>,
    resource: ResourceId,
    life: &Life,
    at: (u32, u32),
) {
    let mut add = |from: usize, to: usize, read: Option<ReadBefore>| {
        // A pass that reads and writes one part waits only for the passes before it.
        if from != to {
            edges.entry((from, to)).or_insert(read);
        }
    };
    let writes: Vec<_> = life.writes.iter().filter(|write| contains(write.range, at)).collect();
    for pair in writes.windows(2) {
        add(pair[0].pass, pair[1].pass, None);
    }
    for read in life.reads.iter().filter(|read| contains(read.range, at)) {
        let next = writes.partition_point(|write| write.version <= read.version);
        if let Some(writer) = next.checked_sub(1).map(|last| writes[last].pass) {
            add(writer, read.pass, None);
        }
        if let Some(writer) = writes.get(next) {
            add(read.pass, writer.pass, Some(ReadBefore { resource, version: read.version }));
        }
    }
}

/// Names a read that closes a cycle: it points backwards, and its writer leads on to the reader.
fn cycle(
    declaration: &Declaration,
    edges: &BTreeMap<(usize, usize), Option<ReadBefore>>,
    successors: &Successors,
) -> GraphError {
    let name = |pass: usize| declaration.passes[pass].name.clone();
    let backwards = edges.iter().filter(|((reader, writer), _)| reader > writer);
    for ((reader, writer), read) in backwards {
        if let (Some(read), true) = (read, leads_to(successors, *writer, *reader)) {
            return GraphError::Cycle {
                resource: declaration.resources[read.resource.index()].name.clone(),
                version: read.version,
                reader: name(*reader),
                writer: name(*writer),
            };
        }
    }
    GraphError::Pass {
        pass: declaration.passes.iter().map(|pass| pass.name.as_str()).collect::<Vec<_>>().join("`, `"),
        problem: "wait for each other".to_owned(),
        mend: "use only handles this graph returned, each after it was returned".to_owned(),
    }
}

fn leads_to(successors: &Successors, from: usize, to: usize) -> bool {
    let mut seen = vec![false; successors.len()];
    let mut stack = vec![from];
    while let Some(pass) = stack.pop() {
        if pass == to {
            return true;
        }
        if !std::mem::replace(&mut seen[pass], true) {
            stack.extend(&successors[pass]);
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::validate::validate;
    use crate::{Access, BufferDesc, Graph, Limits, PassKind};

    fn run(graph: &mut Graph<()>) -> Result<Vec<usize>, GraphError> {
        validate(&mut graph.declaration, &Limits::default())?;
        order(&graph.declaration, &Lives::of(&graph.declaration), None)
    }

    #[test]
    fn a_late_reader_of_an_old_version_goes_before_its_overwriting_and_the_rest_stay() {
        let mut graph = Graph::new();
        let buffer = graph.create_buffer("b", BufferDesc::new(4));
        let old = graph.pass("0", PassKind::Compute).write(buffer, Access::ComputeStorageWrite);
        graph.pass("1", PassKind::Compute);
        graph.pass("2", PassKind::Compute).write(old, Access::ComputeStorageWrite);
        graph.pass("3", PassKind::Compute);
        graph.pass("4", PassKind::Compute).read(&old, Access::ComputeStorageRead);
        assert_eq!(run(&mut graph), Ok(vec![0, 1, 3, 4, 2]));
    }

    #[test]
    fn a_reader_of_both_versions_in_turn_is_a_cycle() {
        let mut graph = Graph::new();
        let [a, b] = ["a", "b"].map(|name| graph.create_buffer(name, BufferDesc::new(4)));
        let old = graph.pass("first", PassKind::Compute).write(a, Access::ComputeStorageWrite);
        let mut second = graph.pass("second", PassKind::Compute);
        second.write(old, Access::ComputeStorageWrite);
        let b = second.write(b, Access::ComputeStorageWrite);
        let mut third = graph.pass("third", PassKind::Compute);
        third.read(&old, Access::ComputeStorageRead).read(&b, Access::ComputeStorageRead);
        let (resource, reader, writer) = ("a".into(), "third".into(), "second".into());
        assert_eq!(run(&mut graph), Err(GraphError::Cycle { resource, version: 1, reader, writer }));
    }
}
