//! Memory that transients share: places, offsets, the waits it takes, and what it saves.
//!
//! Places are found greedily by size, each at the lowest offset free during its lifetime (Pisarchyk and Lee 2020,
//! "Efficient Memory Management for Deep Neural Net Inference", greedy by size for offset calculation). Before a device is
//! asked, sizes are those of texels and alignments the largest that desktop devices ask for: an estimate.

use super::{Lifetime, Plan, PlanResource};
use crate::access::WRITES;
use crate::handle::ResourceId;
use crate::resource::Origin;
use ash::vk::{AccessFlags2, PipelineStageFlags2};

/// Alignment in bytes of an image's place.
const IMAGE_ALIGNMENT: u64 = 64 * 1024;
/// Alignment in bytes of a buffer's place.
const BUFFER_ALIGNMENT: u64 = 256;

/// Transients in two heaps, buffers and images, so that they need not keep a granularity between them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sharing {
    /// Where each transient of known size is that no export keeps alive, by resource.
    pub placements: Vec<Placement>,
    /// What has to be waited for, by the place it is handed to.
    pub handovers: Vec<Handover>,
    /// Bytes of the heap of buffers.
    pub buffer_heap: u64,
    /// Bytes of the heap of images.
    pub image_heap: u64,
    /// Bytes of the transients placed, each with memory of its own and the same alignment.
    pub apart: u64,
}

/// A place in a heap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placement {
    /// The transient.
    pub resource: ResourceId,
    /// Offset in the heap of its kind, in bytes.
    pub offset: u64,
    /// Size in bytes, alignment included.
    pub bytes: u64,
    /// The steps during which the place is taken.
    pub lifetime: Lifetime,
}

/// A wait between two transients in one place: a global memory barrier, in a call of its own before the barriers
/// of step `before`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Handover {
    /// Index of the step before which it stands: the first that uses `to`.
    pub before: usize,
    /// Who had the place: earlier in this execution, or else in the one before.
    pub from: ResourceId,
    /// Who gets it.
    pub to: ResourceId,
    /// Stages waited for.
    pub src_stage: PipelineStageFlags2,
    /// Writes made available.
    pub src_access: AccessFlags2,
    /// Stages that wait.
    pub dst_stage: PipelineStageFlags2,
    /// Accesses the memory is handed to.
    pub dst_access: AccessFlags2,
}

impl Sharing {
    /// Bytes saved against memory of one's own for each.
    pub fn saved(&self) -> u64 {
        self.apart.saturating_sub(self.buffer_heap.saturating_add(self.image_heap))
    }
}

impl Placement {
    fn end(&self) -> u64 {
        self.offset.saturating_add(self.bytes)
    }

    fn meets_in_time(&self, other: Lifetime) -> bool {
        self.lifetime.first <= other.last && other.first <= self.lifetime.last
    }
}

impl<R> Plan<R> {
    /// What transients would save by sharing memory, and how: an estimate from texels and common alignments.
    pub fn sharing(&self) -> Sharing {
        let estimate = |id: ResourceId| {
            let resource = self.resources.get(id.index())?;
            let alignment = if resource.desc.is_image() { IMAGE_ALIGNMENT } else { BUFFER_ALIGNMENT };
            Some((resource.bytes?, alignment))
        };
        self.sharing_with(estimate)
    }

    /// The same with the size and alignment in bytes that a device asks for each transient; one without either is not
    /// placed.
    pub fn sharing_with(&self, needs: impl Fn(ResourceId) -> Option<(u64, u64)>) -> Sharing {
        let [buffers, images] = [false, true].map(|image| self.place(image, &needs));
        let heap = |placements: &[Placement]| placements.iter().map(Placement::end).max().unwrap_or(0);
        let (buffer_heap, image_heap) = (heap(&buffers), heap(&images));
        let mut handovers = self.handovers(&buffers);
        handovers.extend(self.handovers(&images));
        handovers.sort_by_key(|handover| (handover.before, handover.to, handover.from));
        let mut placements = [buffers, images].concat();
        placements.sort_by_key(|placement| placement.resource);
        let apart = placements.iter().fold(0u64, |sum, placement| sum.saturating_add(placement.bytes));
        Sharing { placements, handovers, buffer_heap, image_heap, apart }
    }

    /// Places the images, or the buffers.
    fn place(&self, images: bool, needs: impl Fn(ResourceId) -> Option<(u64, u64)>) -> Vec<Placement> {
        let mut wanted: Vec<Placement> = Vec::new();
        // One alignment for all, so that offsets, which are sums of sizes, are multiples of each one's own.
        let mut largest = 1;
        for (index, resource) in self.resources.iter().enumerate() {
            let id = ResourceId(index as u32);
            let (Some(lifetime), Some((bytes, alignment))) = (resource.lifetime, needs(id)) else { continue };
            if may_share(resource) && resource.desc.is_image() == images {
                wanted.push(Placement { resource: id, offset: 0, bytes, lifetime });
                largest = largest.max(alignment);
            }
        }
        for place in &mut wanted {
            place.bytes = place.bytes.checked_next_multiple_of(largest).unwrap_or(place.bytes);
        }
        wanted.sort_by_key(|placement| (std::cmp::Reverse(placement.bytes), placement.resource));
        let mut placed: Vec<Placement> = Vec::new();
        for mut next in wanted {
            let mut taken: Vec<&Placement> =
                placed.iter().filter(|p| p.meets_in_time(next.lifetime)).collect();
            taken.sort_by_key(|placement| placement.offset);
            for other in taken {
                if next.end() <= other.offset {
                    break;
                }
                next.offset = next.offset.max(other.end());
            }
            placed.push(next);
        }
        placed
    }

    /// For each place, the waits for those whose bytes it takes over.
    fn handovers(&self, placed: &[Placement]) -> Vec<Handover> {
        let mut handovers = Vec::new();
        for to in placed {
            for from in takes_over(to, placed) {
                let (src_stage, src_access) = self.scope(from);
                let (dst_stage, dst_access) = self.scope(to.resource);
                handovers.push(Handover {
                    before: to.lifetime.first,
                    from,
                    to: to.resource,
                    src_stage,
                    src_access: src_access & WRITES,
                    dst_stage,
                    dst_access,
                });
            }
        }
        handovers
    }

    /// All stages and accesses of a resource.
    fn scope(&self, resource: ResourceId) -> (PipelineStageFlags2, AccessFlags2) {
        let uses = self.accesses().filter(|(_, used)| used.resource == resource);
        uses.fold((PipelineStageFlags2::NONE, AccessFlags2::NONE), |(stage, access), (_, used)| {
            (stage | used.stage, access | used.flags)
        })
    }
}

/// Transients that nothing keeps alive past the plan.
fn may_share(resource: &PlanResource) -> bool {
    resource.origin == Origin::Transient && resource.exports.is_empty()
}

/// Who had some of `to`'s bytes last: backwards in time from its first step, then from the end of the execution
/// before, until every byte has its predecessor. `to` itself may be one, and waits by its own barriers.
fn takes_over(to: &Placement, placed: &[Placement]) -> Vec<ResourceId> {
    let earlier = |p: &Placement| p.lifetime.last < to.lifetime.first;
    let mut others: Vec<&Placement> =
        placed.iter().filter(|p| p.offset < to.end() && to.offset < p.end()).collect();
    others.sort_by_key(|p| std::cmp::Reverse((earlier(p), p.lifetime.last)));
    let mut open = vec![(to.offset, to.end())];
    let mut from = Vec::new();
    for other in others {
        let still = open.iter().flat_map(|&(start, end)| {
            [(start, end.min(other.offset)), (start.max(other.end()), end)].into_iter().filter(|(s, e)| s < e)
        });
        let still: Vec<(u64, u64)> = still.collect();
        if still != open && other.resource != to.resource {
            from.push(other.resource);
        }
        open = still;
    }
    from
}

#[cfg(test)]
mod tests {
    use crate::{Access, BufferDesc, Graph, Limits, PassKind, Plan};

    /// A row of passes, each reading what the one before wrote.
    fn row(sizes: &[u64]) -> Plan<()> {
        let mut graph = Graph::new();
        let mut before = None;
        for size in sizes {
            let mut pass = graph.pass("pass", PassKind::Compute);
            if let Some(before) = before {
                pass.read(&before, Access::ComputeUniform);
            }
            let desc = BufferDesc::new(*size);
            before = Some(pass.create_buffer("buffer", desc, Access::ComputeStorageWrite));
            pass.record(());
        }
        let mut last = graph.pass("last", PassKind::Compute);
        if let Some(before) = before {
            last.read(&before, Access::ComputeUniform).side_effect();
        }
        last.record(());
        graph.compile(&Limits::default()).unwrap()
    }

    #[test]
    fn a_row_of_equal_buffers_needs_the_room_of_two() {
        let sharing = row(&[1024; 5]).sharing();
        assert_eq!((sharing.buffer_heap, sharing.apart, sharing.saved()), (2048, 5 * 1024, 3 * 1024));
        let offsets: Vec<u64> = sharing.placements.iter().map(|placement| placement.offset).collect();
        assert_eq!(offsets, [0, 1024, 0, 1024, 0]);
        // Each waits for the one two before it; the first two for the last two of the execution before.
        let pairs = sharing.handovers.iter().map(|h| (h.from.index(), h.to.index())).collect::<Vec<_>>();
        assert_eq!(pairs, [(4, 0), (3, 1), (0, 2), (1, 3), (2, 4)]);
    }

    #[test]
    fn one_that_takes_over_from_two_waits_for_both() {
        let sharing = row(&[512, 256, 256, 1024, 256]).sharing();
        for a in &sharing.placements {
            for b in sharing.placements.iter().filter(|b| b.resource != a.resource) {
                let in_space = a.offset < b.offset + b.bytes && b.offset < a.offset + a.bytes;
                let in_time = a.lifetime.first <= b.lifetime.last && b.lifetime.first <= a.lifetime.last;
                assert!(!(in_space && in_time), "{a:?} and {b:?}");
            }
        }
        let to_largest = sharing.handovers.iter().filter(|h| h.to.index() == 3);
        assert!(to_largest.count() >= 2, "{:?}", sharing.handovers);
    }
}
