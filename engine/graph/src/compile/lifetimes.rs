//! Phase 6: from which step to which step each resource is in use.

use crate::declaration::Declaration;
use crate::plan::{Lifetime, PlanExport, PlanResource};

pub(super) fn lifetimes(declaration: &Declaration, order: &[usize]) -> Vec<PlanResource> {
    let mut lifetimes: Vec<Option<Lifetime>> = vec![None; declaration.resources.len()];
    for (step, pass) in order.iter().enumerate() {
        for used in &declaration.passes[*pass].uses {
            let lifetime = &mut lifetimes[used.resource.index()];
            let first = lifetime.map_or(step, |lifetime| lifetime.first);
            *lifetime = Some(Lifetime { first, last: step });
        }
    }
    let exports = |index: usize| {
        let of_this = declaration.exports.iter().filter(|e| e.resource.index() == index);
        of_this.map(|e| PlanExport { range: e.range, version: e.version, state: e.state }).collect()
    };
    let resources = declaration.resources.iter().zip(lifetimes).enumerate();
    resources
        .map(|(index, (resource, lifetime))| PlanResource {
            name: resource.name.clone(),
            desc: resource.desc,
            origin: resource.origin,
            lifetime,
            exports: exports(index),
            bytes: resource.desc.bytes(),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Access, BufferDesc, Graph, PassKind};

    #[test]
    fn a_lifetime_spans_first_to_last_step_and_skips_what_is_not_ordered() {
        let mut graph = Graph::<()>::new();
        let desc = BufferDesc::new(4);
        let a = graph.pass("0", PassKind::Compute).create_buffer("a", desc, Access::ComputeStorageWrite);
        graph.pass("1", PassKind::Compute).create_buffer("b", desc, Access::ComputeStorageWrite);
        graph.pass("2", PassKind::Compute);
        graph.pass("3", PassKind::Compute).read(&a, Access::ComputeStorageRead);
        let resources = lifetimes(&graph.declaration, &[0, 2, 3]);
        assert_eq!(resources[0].lifetime, Some(Lifetime { first: 0, last: 2 }));
        assert_eq!(resources[1].lifetime, None);
    }
}
