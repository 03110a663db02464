//! Phase 5: passes that reach no export, no import and no side effect are left out, with the reason.

use super::lives::Lives;
use crate::declaration::Declaration;
use crate::handle::{ImageRange, ResourceId};
use crate::plan::{CullReason, Culled};
use crate::resource::Origin;

pub(super) struct Cull {
    /// By index of declaration.
    pub alive: Vec<bool>,
    pub culled: Vec<Culled>,
}

pub(super) fn cull(declaration: &Declaration, lives: &Lives) -> Cull {
    let mut alive = vec![false; declaration.passes.len()];
    let mut needed = roots(declaration, lives);
    while let Some(pass) = needed.pop() {
        if std::mem::replace(&mut alive[pass], true) {
            continue;
        }
        for used in declaration.passes[pass].uses.iter().filter(|used| used.keeps) {
            needed.extend(lives.writers(used.resource, used.version, used.range));
        }
    }
    let dead = (0..alive.len()).filter(|pass| !alive[*pass]);
    let culled = dead
        .map(|pass| Culled {
            pass: declaration.passes[pass].name.clone(),
            reason: reason(declaration, lives, pass),
        })
        .collect();
    Cull { alive, culled }
}

/// Passes needed for their own sake: side effects, and writers of what outlives the plan.
fn roots(declaration: &Declaration, lives: &Lives) -> Vec<usize> {
    let passes = declaration.passes.iter().enumerate();
    let mut roots: Vec<usize> = passes.filter(|(_, pass)| pass.side_effect).map(|(i, _)| i).collect();
    for export in &declaration.exports {
        roots.extend(lives.writers(export.resource, export.version, export.range));
    }
    for (index, resource) in declaration.resources.iter().enumerate() {
        if let Origin::Imported { .. } = resource.origin {
            let (mips, layers) = resource.desc.subresources();
            let whole = ImageRange { base_mip: 0, mips, base_layer: 0, layers };
            roots.extend(lives.writers(ResourceId(index as u32), u32::MAX, whole));
        }
    }
    roots
}

/// Why nothing needs a pass that is not alive.
fn reason(declaration: &Declaration, lives: &Lives, pass: usize) -> CullReason {
    let writes = declaration.passes[pass].uses.iter().filter(|used| used.output.is_some());
    let mut written: Vec<ResourceId> = writes.map(|used| used.resource).collect();
    written.sort_unstable();
    written.dedup();
    if written.is_empty() {
        return CullReason::WritesNothing;
    }
    let mut readers: Vec<usize> = Vec::new();
    for resource in &written {
        let reads = lives.life(*resource).reads.iter();
        let of_this = reads.filter(|r| lives.writers(*resource, r.version, r.range).contains(&pass));
        readers.extend(of_this.map(|read| read.pass));
    }
    readers.sort_unstable();
    readers.dedup();
    let resources = written.iter().map(|r| declaration.resources[r.index()].name.clone()).collect();
    if readers.is_empty() {
        CullReason::Unread { resources }
    } else {
        let readers = readers.iter().map(|reader| declaration.passes[*reader].name.clone()).collect();
        CullReason::ReadOnlyByCulled { resources, readers }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::validate::validate;
    use crate::{Access, BufferDesc, Graph, GraphError, ImageDesc, Limits, PassKind};

    fn run(graph: &mut Graph<()>) -> Result<Cull, GraphError> {
        validate(&mut graph.declaration, &Limits::default())?;
        Ok(cull(&graph.declaration, &Lives::of(&graph.declaration)))
    }

    #[test]
    fn what_reaches_nothing_is_culled_and_says_why() {
        let mut graph = Graph::new();
        let (write, read) = (Access::ComputeStorageWrite, Access::ComputeStorageRead);
        let desc = BufferDesc::new(4);
        let a = graph.pass("kept", PassKind::Compute).create_buffer("a", desc, write);
        let b = graph.pass("first", PassKind::Compute).create_buffer("b", desc, write);
        let mut second = graph.pass("second", PassKind::Compute);
        second.read(&b, read);
        second.create_buffer("c", desc, write);
        graph.pass("idle", PassKind::Compute).read(&a, read);
        graph.pass("watcher", PassKind::Compute).side_effect();
        graph.export(a, Access::VertexBuffer);
        let cull = run(&mut graph).unwrap();
        assert_eq!(cull.alive, [true, false, false, false, true]);
        let (resources, readers) = (vec!["b".into()], vec!["second".into()]);
        let reasons: Vec<_> = cull.culled.into_iter().map(|culled| culled.reason).collect();
        let unread = CullReason::Unread { resources: vec!["c".into()] };
        let expected =
            [CullReason::ReadOnlyByCulled { resources, readers }, unread, CullReason::WritesNothing];
        assert_eq!(reasons, expected);
    }

    #[test]
    fn only_writers_of_the_mips_wanted_are_kept() {
        let mut graph = Graph::new();
        let desc = ImageDesc { mips: 2, ..ImageDesc::new_2d(2, 2, ash::vk::Format::R32_SFLOAT) };
        let image = graph.create_image("i", desc);
        let write = Access::ComputeStorageWrite;
        let image = graph.pass("mip 0", PassKind::Compute).write(image.mip(0), write);
        let image = graph.pass("mip 1", PassKind::Compute).write(image.mip(1), write);
        graph.export(image.mip(0), Access::FragmentSampled);
        assert_eq!(run(&mut graph).unwrap().alive, [true, false]);
    }
}
