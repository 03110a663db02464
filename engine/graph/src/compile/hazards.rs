//! Phase 3: versions form one chain, nothing is read that nobody wrote, nothing exported is overwritten.

use super::lives::Lives;
use crate::declaration::{Declaration, Half, Resource};
use crate::error::GraphError;
use crate::handle::{ImageRange, ResourceId};
use crate::resource::Origin;
use ash::vk;

pub(super) fn hazards(declaration: &Declaration, lives: &Lives) -> Result<(), GraphError> {
    for resource in &declaration.resources {
        check_chain(declaration, resource)?;
    }
    for pass in &declaration.passes {
        for used in pass.uses.iter().filter(|used| used.keeps) {
            if let Some((mip, layer)) =
                first_unwritten(declaration, lives, used.resource, used.version, used.range)
            {
                return Err(GraphError::ReadOfNeverWritten {
                    resource: declaration.resources[used.resource.index()].name.clone(),
                    version: used.version,
                    mip,
                    layer,
                    pass: pass.name.clone(),
                });
            }
        }
    }
    check_exports(declaration, lives)?;
    check_histories(declaration, lives)
}

/// Version n + 1 must be written over version n.
fn check_chain(declaration: &Declaration, resource: &Resource) -> Result<(), GraphError> {
    let name = |pass: usize| declaration.passes[pass].name.clone();
    for (i, version) in resource.versions.iter().enumerate() {
        let parent = version.parent as usize;
        if parent == i {
            continue;
        }
        if parent > i {
            return Err(GraphError::Pass {
                pass: name(version.writer),
                problem: format!("it writes version {parent} of `{}`, which is not there yet", resource.name),
                mend: "use only handles this graph returned".to_owned(),
            });
        }
        let newest_writer = name(resource.versions[i - 1].writer);
        return Err(if parent + 1 == i {
            GraphError::TwoWriters {
                resource: resource.name.clone(),
                version: version.parent,
                first: newest_writer,
                second: name(version.writer),
            }
        } else {
            GraphError::WriteToOldVersion {
                resource: resource.name.clone(),
                version: version.parent,
                pass: name(version.writer),
                newest: version.parent + (i - parent) as u32,
                newest_writer,
            }
        });
    }
    Ok(())
}

/// The first mip and layer of a range in which a version has no contents.
fn first_unwritten(
    declaration: &Declaration,
    lives: &Lives,
    resource: ResourceId,
    version: u32,
    range: ImageRange,
) -> Option<(u32, u32)> {
    let declared = &declaration.resources[resource.index()];
    let filled_before = match declared.origin {
        Origin::Transient => false,
        _ if declared.half == Some(Half::Current) => false,
        Origin::Imported { entry, .. } => {
            !declared.desc.is_image() || entry.layout != vk::ImageLayout::UNDEFINED
        }
    };
    let mut at = range.subresources();
    if filled_before { None } else { at.find(|at| lives.writer(resource, version, *at).is_none()) }
}

fn check_exports(declaration: &Declaration, lives: &Lives) -> Result<(), GraphError> {
    for export in &declaration.exports {
        let resource = &declaration.resources[export.resource.index()];
        let unwritten = first_unwritten(declaration, lives, export.resource, export.version, export.range);
        if let Some((mip, layer)) = unwritten {
            return Err(GraphError::Export {
                resource: resource.name.clone(),
                problem: format!(
                    "nothing has written mip {mip}, layer {layer} of version {}",
                    export.version
                ),
                mend: "export the handle that the pass writing it returned".to_owned(),
            });
        }
        let life = lives.life(export.resource);
        let later = |version: u32| version > export.version;
        if let Some(write) = life.writes.iter().find(|w| later(w.version) && w.range.overlaps(export.range)) {
            let exported = life.writes.iter().find(|w| w.version == export.version);
            return Err(GraphError::UseAfterExport {
                resource: resource.name.clone(),
                version: export.version,
                exported_writer: exported.map(|w| declaration.passes[w.pass].name.clone()),
                pass: declaration.passes[write.pass].name.clone(),
            });
        }
    }
    Ok(())
}

/// What the next frame finds as the previous half has been written in this one.
fn check_histories(declaration: &Declaration, lives: &Lives) -> Result<(), GraphError> {
    let unused = |id| lives.life(id).reads.is_empty() && lives.life(id).writes.is_empty();
    for (index, resource) in declaration.resources.iter().enumerate() {
        let current = ResourceId(index as u32);
        if resource.half != Some(Half::Current) || (unused(current) && unused(ResourceId(index as u32 - 1))) {
            continue;
        }
        let (mips, layers) = resource.desc.subresources();
        let whole = ImageRange { base_mip: 0, mips, base_layer: 0, layers };
        if let Some((mip, layer)) = first_unwritten(declaration, lives, current, u32::MAX, whole) {
            return Err(GraphError::Resource {
                resource: resource.name.clone(),
                problem: format!(
                    "nothing writes mip {mip}, layer {layer}, which the next frame would find as the previous half"
                ),
                mend: "write all of the current half in every frame that uses the history".to_owned(),
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::validate::validate;
    use crate::{Access, Buffer, BufferDesc, Graph, Handle, Limits, PassKind};

    const WRITE: Access = Access::ComputeStorageWrite;

    fn run(graph: &mut Graph<()>) -> Result<(), GraphError> {
        validate(&mut graph.declaration, &Limits::default())?;
        hazards(&graph.declaration, &Lives::of(&graph.declaration))
    }

    fn write(graph: &mut Graph<()>, pass: &str, handle: Handle<Buffer>) -> Handle<Buffer> {
        graph.pass(pass, PassKind::Compute).write(handle, WRITE)
    }

    #[test]
    fn two_writers_and_old_versions_are_told_apart() {
        let mut graph = Graph::new();
        let buffer = graph.create_buffer("b", BufferDesc::new(4));
        let next = write(&mut graph, "one", buffer);
        assert_eq!(run(&mut graph), Ok(()));
        let mut two = graph.clone();
        write(&mut two, "two", buffer);
        let (resource, first, second) = ("b".into(), "one".into(), "two".into());
        assert_eq!(run(&mut two), Err(GraphError::TwoWriters { resource, version: 0, first, second }));
        write(&mut graph, "two", next);
        write(&mut graph, "three", buffer);
        let (resource, pass, newest_writer) = ("b".into(), "three".into(), "two".into());
        let expected = GraphError::WriteToOldVersion { resource, version: 0, pass, newest: 2, newest_writer };
        assert_eq!(run(&mut graph), Err(expected));
    }

    #[test]
    fn reading_what_nobody_wrote_is_an_error() {
        let mut graph = Graph::new();
        let buffer = graph.create_buffer("b", BufferDesc::new(4));
        graph.pass("reader", PassKind::Compute).read(&buffer, Access::ComputeStorageRead);
        let message = run(&mut graph).unwrap_err().to_string();
        assert!(message.contains("`reader` reads `b`") && message.contains("earlier pass"), "{message}");
    }

    #[test]
    fn overwriting_what_was_exported_is_an_error() {
        let mut graph = Graph::new();
        let buffer = graph.create_buffer("b", BufferDesc::new(4));
        let first = write(&mut graph, "one", buffer);
        graph.export(first, Access::VertexBuffer);
        assert_eq!(run(&mut graph), Ok(()));
        write(&mut graph, "two", first);
        let message = run(&mut graph).unwrap_err().to_string();
        assert!(message.contains("`two` writes `b`") && message.contains("by `one`"), "{message}");
    }

    /// The message about a history of which one pass reads the previous half and writes these mips of the other.
    fn history_message(mips: u32, access: Access) -> Option<String> {
        let mut graph = Graph::new();
        let desc = crate::ImageDesc { mips: 2, ..crate::ImageDesc::new_2d(4, 4, vk::Format::R32_SFLOAT) };
        let history = graph.history_image("history", desc, access);
        let mut pass = graph.pass("accumulate", PassKind::Compute);
        pass.read(&history.previous, Access::ComputeSampled);
        pass.write(history.current.mips(0, mips), WRITE);
        run(&mut graph).err().map(|error| error.to_string())
    }

    #[test]
    fn the_current_half_of_a_history_is_written_whole_and_rests_in_a_state_that_reads() {
        assert_eq!(history_message(2, Access::ComputeSampled), None);
        let partly = history_message(1, Access::ComputeSampled).unwrap_or_default();
        assert!(partly.contains("history (current)") && partly.contains("mip 1"), "{partly}");
        let resting = history_message(2, WRITE).unwrap_or_default();
        assert!(resting.contains("a state that reads"), "{resting}");
    }

    #[test]
    fn the_halves_of_a_history_keep_their_roles() {
        let mut graph = Graph::new();
        let history = graph.history_buffer("history", BufferDesc::new(4), Access::ComputeStorageRead);
        let old = graph.clone();
        write(&mut graph, "writes the past", history.previous);
        assert!(run(&mut graph).is_err_and(|error| error.to_string().contains("write its current half")));
        let mut graph = old;
        let mut pass = graph.pass("reads what is two frames old", PassKind::Compute);
        pass.write(history.current, Access::ComputeStorageReadWrite);
        assert!(matches!(run(&mut graph), Err(GraphError::ReadOfNeverWritten { .. })));
    }
}
