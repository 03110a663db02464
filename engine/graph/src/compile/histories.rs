//! What compiling does for resources that remember one frame.

use crate::declaration::{Declaration, Half, Resource};
use crate::handle::ResourceId;
use crate::plan::PlanHistory;
use crate::resource::{Origin, ResourceDesc};

/// Halves are declared in pairs, the previous one first.
pub(super) fn histories(declaration: &Declaration) -> Vec<PlanHistory> {
    let resources = declaration.resources.iter().enumerate();
    resources
        .filter_map(|(index, resource)| match (resource.half, resource.origin) {
            (Some(Half::Previous), Origin::Imported { exit, .. }) => Some(PlanHistory {
                previous: ResourceId(index as u32),
                current: ResourceId(index as u32 + 1),
                resting: exit,
            }),
            _ => None,
        })
        .collect()
}

/// The halves change places from frame to frame: each needs the usage of both.
pub(super) fn share_usage(resources: &mut [Resource]) {
    for i in 1..resources.len() {
        let (before, rest) = resources.split_at_mut(i);
        let (Some(previous), Some(current)) = (before.last_mut(), rest.first_mut()) else { continue };
        if current.half != Some(Half::Current) {
            continue;
        }
        match (&mut previous.desc, &mut current.desc) {
            (ResourceDesc::Buffer(previous), ResourceDesc::Buffer(current)) => {
                previous.usage |= current.usage;
                current.usage = previous.usage;
            }
            (ResourceDesc::Image(previous), ResourceDesc::Image(current)) => {
                previous.usage |= current.usage;
                current.usage = previous.usage;
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Access, BufferDesc, Graph, Limits, PassKind};
    use ash::vk::BufferUsageFlags;

    #[test]
    fn halves_that_change_places_have_one_usage() {
        let mut graph = Graph::<()>::new();
        let history = graph.history_buffer("history", BufferDesc::new(16), Access::ComputeStorageRead);
        let mut pass = graph.pass("pass", PassKind::Transfer);
        pass.read(&history.previous, Access::TransferSource);
        pass.write(history.current, Access::TransferDestination);
        pass.record(());
        let plan = graph.compile(&Limits::default()).unwrap();
        for resource in plan.resources() {
            let ResourceDesc::Buffer(desc) = resource.desc else { panic!("a buffer") };
            assert_eq!(desc.usage, BufferUsageFlags::TRANSFER_SRC | BufferUsageFlags::TRANSFER_DST);
        }
    }
}
