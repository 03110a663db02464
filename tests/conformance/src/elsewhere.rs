//! A room whose resources another queue family has before and after it, such as another device's or another process's.

use super::roads::foreign;
use super::{Declared, Given, HostResource, Refusal, Road, Room};
use crate::shim::Call;
use airglow_gpu::ash::vk;
use airglow_gpu::{Context, Recorder, Requirements};
use airglow_graph::Access;

/// A room that finds and leaves all that a host gives it in the hands of a queue family.
pub struct Elsewhere<R> {
    /// The room.
    pub room: R,
    /// Who has its resources: the index of a family, `VK_QUEUE_FAMILY_EXTERNAL`, `VK_QUEUE_FAMILY_FOREIGN_EXT`.
    pub family: u32,
}

impl<R: Room> Room for Elsewhere<R> {
    fn requirements(&self) -> Requirements {
        self.room.requirements()
    }

    fn resources(&self) -> Vec<HostResource> {
        let elsewhere = |resource: HostResource| HostResource {
            entry: resource.entry.on_queue_family(self.family),
            exit: resource.exit.on_queue_family(self.family),
            ..resource
        };
        self.room.resources().into_iter().map(elsewhere).collect()
    }

    fn add(&mut self, to: &mut Declared<'_>) -> Result<(), Refusal> {
        self.room.add(to)
    }

    fn accesses(&mut self, context: &Context) -> Result<Vec<Option<(Access, Access)>>, Refusal> {
        self.room.accesses(context)
    }

    fn record(&mut self, recorder: &mut Recorder<'_>, host: &[Given]) -> Result<(), Refusal> {
        self.room.record(recorder, host)
    }
}

/// Our plan takes each such resource once and gives it back once; a recorded room leaves that to the host.
pub(super) fn check_families(
    calls: &[Call],
    resources: &[HostResource],
    given: &[Given],
    own: u32,
    road: Road,
) -> Result<(), Refusal> {
    for (resource, given) in resources.iter().zip(given) {
        let found = transfers(calls, given);
        let ways = [
            (resource.entry, (resource.entry.queue_family, own)),
            (resource.exit, (own, resource.exit.queue_family)),
        ];
        let ours = ways.iter().filter(|(state, _)| road == Road::Graph && foreign(*state, own));
        let wanted: Vec<_> = ours.map(|(_, families)| *families).collect();
        if found != wanted {
            let problem = format!("{} goes between queue families {found:?}, not {wanted:?}", resource.name);
            return Err(format!("{road:?}: {problem}").into());
        }
    }
    Ok(())
}

/// Families that a resource goes between, in order; once for all parts of an image.
fn transfers(calls: &[Call], given: &Given) -> Vec<(u32, u32)> {
    let of = |call: &Call| -> Vec<(u32, u32)> {
        match given {
            Given::Buffer(buffer) => {
                let own = call.buffers.iter().filter(|barrier| barrier.buffer == buffer.raw());
                own.map(|b| (b.src_queue_family_index, b.dst_queue_family_index)).collect()
            }
            Given::Image(image) => {
                let own = call.images.iter().filter(|barrier| barrier.image == image.raw());
                own.map(|b| (b.src_queue_family_index, b.dst_queue_family_index)).collect()
            }
        }
    };
    let mut found: Vec<_> = calls.iter().flat_map(of).filter(|(from, to)| from != to).collect();
    found.dedup();
    found.retain(|(from, to)| *from != vk::QUEUE_FAMILY_IGNORED && *to != vk::QUEUE_FAMILY_IGNORED);
    found
}
