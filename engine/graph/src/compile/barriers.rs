//! Phase 7: the barriers between epochs, from entry to exit, subresource by subresource.

use super::coalesce::coalesce;
use super::epochs::{Epoch, Slot, push};
use super::lives::contains;
use crate::access::State;
use crate::graph::Declaration;
use crate::handle::{ImageRange, ResourceId};
use crate::options::Limits;
use crate::plan::{Barriers, BufferBarrier, Cause, ImageBarrier};
use crate::resource::{Origin, ResourceDesc};
use ash::vk::{AccessFlags2, ImageAspectFlags, ImageLayout, PipelineStageFlags2, QUEUE_FAMILY_IGNORED};

/// Every barrier of a plan.
pub(super) struct PlanBarriers {
    pub acquires: Barriers,
    /// Before each step, in order.
    pub steps: Vec<Barriers>,
    pub exits: Barriers,
    pub releases: Barriers,
}

impl PlanBarriers {
    fn slot(&mut self, slot: Slot) -> &mut Barriers {
        match slot {
            Slot::Step(step) => &mut self.steps[step],
            Slot::End => &mut self.exits,
        }
    }
}

pub(super) fn barriers(declaration: &Declaration, order: &[usize], limits: &Limits) -> PlanBarriers {
    let mut plan = PlanBarriers {
        acquires: Barriers::default(),
        steps: vec![Barriers::default(); order.len()],
        exits: Barriers::default(),
        releases: Barriers::default(),
    };
    for (index, resource) in declaration.resources.iter().enumerate() {
        let id = ResourceId(index as u32);
        let (mips, layers) = resource.desc.subresources();
        let whole = ImageRange { base_mip: 0, mips, base_layer: 0, layers };
        for (mip, layer) in whole.subresources() {
            let epochs = epochs_at(declaration, order, id, (mip, layer));
            let (entry, exit) = ends(declaration, id, (mip, layer));
            let range = ImageRange { base_mip: mip, mips: 1, base_layer: layer, layers: 1 };
            let mut row = Row { plan: &mut plan, id, desc: &resource.desc, range, limits };
            row.emit(epochs, entry, exit);
        }
    }
    coalesce(&mut plan.acquires.images);
    coalesce(&mut plan.exits.images);
    coalesce(&mut plan.releases.images);
    for step in &mut plan.steps {
        coalesce(&mut step.images);
    }
    plan
}

/// What the passes do with one subresource.
fn epochs_at(declaration: &Declaration, order: &[usize], id: ResourceId, at: (u32, u32)) -> Vec<Epoch> {
    let mut epochs = Vec::new();
    for (step, pass) in order.iter().enumerate() {
        let uses = declaration.passes[*pass].uses.iter();
        for used in uses.filter(|used| used.resource == id && contains(used.range, at)) {
            push(&mut epochs, Epoch::of_use(step, used));
        }
    }
    epochs
}

/// The host's state before (imports only) and after (imports and exports).
fn ends(declaration: &Declaration, id: ResourceId, at: (u32, u32)) -> (Option<State>, Option<State>) {
    let mut exports = declaration.exports.iter();
    let exported = exports.find(|e| e.resource == id && contains(e.range, at)).map(|e| e.state);
    match declaration.resources[id.index()].origin {
        Origin::Imported { entry, exit } => (Some(entry), Some(exported.unwrap_or(exit))),
        Origin::Transient => (None, exported),
    }
}

/// One subresource, and where its barriers go.
struct Row<'a> {
    plan: &'a mut PlanBarriers,
    id: ResourceId,
    desc: &'a ResourceDesc,
    range: ImageRange,
    limits: &'a Limits,
}

impl Row<'_> {
    fn emit(&mut self, mut epochs: Vec<Epoch>, entry: Option<State>, exit: Option<State>) {
        if epochs.is_empty() && (entry.is_none() || entry == exit) {
            return;
        }
        let release_to = exit.map(|state| state.queue_family).filter(|family| self.is_foreign(*family));
        if let Some(exit) = exit {
            add_exit(&mut epochs, entry, exit, release_to.is_some());
        }
        let before = match entry {
            Some(entry) => self.enter(entry, epochs.first()),
            None => before_transient(epochs.last(), exit.is_some_and(|exit| self.waits(exit))),
        };
        let last = epochs.last().copied().unwrap_or(before);
        self.between(before, &mut epochs);
        if let Some(family) = release_to {
            self.release(&last, family);
        }
    }

    fn is_foreign(&self, family: u32) -> bool {
        family != QUEUE_FAMILY_IGNORED && family != self.limits.queue_family
    }

    /// Whether the host itself waits for what it gets in this state, and then before the plan runs again.
    fn waits(&self, exit: State) -> bool {
        self.is_foreign(exit.queue_family) || Epoch::of_host(exit).is_idle()
    }

    /// The epoch before the plan; takes ownership first where another family has it.
    fn enter(&mut self, entry: State, first: Option<&Epoch>) -> Epoch {
        let host = Epoch::of_host(entry);
        if !self.is_foreign(entry.queue_family) {
            return host;
        }
        // Waiting at the stages of the first use chains with a semaphore that the host waits for there.
        let chained = first.map(|first| first.stage).filter(|stage| !stage.is_empty());
        let stage = chained.unwrap_or(PipelineStageFlags2::ALL_COMMANDS);
        let same_layout = first.filter(|first| first.layout == entry.layout);
        let access = same_layout.map_or(AccessFlags2::NONE, |first| first.access);
        let acquired = Epoch { stage, access: AccessFlags2::NONE, ..host };
        let barrier = self.barrier(&acquired, &Epoch { access, ..acquired }, Cause::Acquire);
        let families = (entry.queue_family, self.limits.queue_family);
        push_barrier(&mut self.plan.acquires, self.desc, with_families(barrier, families));
        // The acquire itself orders a first use in the same layout; a layout change must wait for the acquire.
        if same_layout.is_some() { Epoch::of_host(State::idle(entry.layout)) } else { acquired }
    }

    fn release(&mut self, last: &Epoch, family: u32) {
        let nothing = Epoch { stage: PipelineStageFlags2::NONE, access: AccessFlags2::NONE, ..*last };
        let mut barrier = self.barrier(last, &nothing, Cause::Release);
        barrier.src_access = last.written();
        let families = (self.limits.queue_family, family);
        push_barrier(&mut self.plan.releases, self.desc, with_families(barrier, families));
    }

    /// A barrier between each epoch and the next, where one is needed.
    fn between(&mut self, before: Epoch, epochs: &mut [Epoch]) {
        let mut previous = before;
        for epoch in epochs {
            let layout_changes = previous.layout != epoch.layout;
            if previous.covers(epoch) {
                // Both read: whoever writes next waits for both.
                epoch.stage |= previous.stage;
            } else if layout_changes || !previous.is_idle() {
                let cause = match (previous.writes(), epoch.writes()) {
                    (true, false) => Cause::ReadAfterWrite,
                    (true, true) => Cause::WriteAfterWrite,
                    _ if previous.is_idle() => Cause::Layout,
                    (false, true) => Cause::WriteAfterRead,
                    (false, false) => Cause::ReadAfterRead,
                };
                let barrier = self.barrier(&previous, epoch, cause);
                push_barrier(self.plan.slot(epoch.begin), self.desc, barrier);
            }
            previous = *epoch;
        }
    }

    fn barrier(&self, from: &Epoch, to: &Epoch, cause: Cause) -> ImageBarrier {
        let layout_changes = from.layout != to.layout;
        // A write after reads needs no memory dependency: the earlier write is available already.
        let memory = from.writes() || layout_changes || to.reads_before() || cause == Cause::Acquire;
        let discards = layout_changes && !to.keeps;
        ImageBarrier {
            resource: self.id,
            range: self.range,
            aspects: match self.desc {
                ResourceDesc::Image(image) => image.aspects(),
                ResourceDesc::Buffer(_) => ImageAspectFlags::empty(),
            },
            src_stage: from.stage,
            src_access: from.written(),
            dst_stage: to.stage,
            dst_access: if memory { to.access } else { AccessFlags2::NONE },
            old_layout: if discards { ImageLayout::UNDEFINED } else { from.layout },
            new_layout: to.layout,
            src_queue_family: QUEUE_FAMILY_IGNORED,
            dst_queue_family: QUEUE_FAMILY_IGNORED,
            cause,
            after: from.last,
        }
    }
}

/// Appends the host's use after the plan. A state with nothing pending adds a barrier only for its layout.
fn add_exit(epochs: &mut Vec<Epoch>, entry: Option<State>, exit: State, released: bool) {
    let mut host = Epoch::of_host(exit);
    let last = epochs.last().copied().or(entry.map(Epoch::of_host));
    let Some(last) = last else { return };
    if host.layout == ImageLayout::UNDEFINED {
        host.layout = last.layout;
    }
    if released {
        // The taking family sees to its own accesses; here only the layout is brought about.
        // Some stage has to stand between the layout change and the release.
        let idle = last.stage.is_empty();
        let stage = if idle { PipelineStageFlags2::ALL_COMMANDS } else { last.stage };
        host = Epoch { stage, access: AccessFlags2::NONE, ..host };
    }
    let nothing_to_do = host.layout == last.layout && (released || host.is_idle());
    if !nothing_to_do {
        push(epochs, host);
    }
}

/// What the execution of the same plan before this one left of a transient: contents nobody wants, and uses
/// that the first write must wait for.
fn before_transient(last: Option<&Epoch>, host_waits: bool) -> Epoch {
    let undefined = Epoch::of_host(State::UNDEFINED);
    match last {
        Some(last) if !host_waits => Epoch { stage: last.stage, access: last.written(), ..undefined },
        _ => undefined,
    }
}

fn with_families(barrier: ImageBarrier, (from, to): (u32, u32)) -> ImageBarrier {
    ImageBarrier { src_queue_family: from, dst_queue_family: to, ..barrier }
}

/// Files a barrier under buffers or images.
fn push_barrier(barriers: &mut Barriers, desc: &ResourceDesc, barrier: ImageBarrier) {
    if desc.is_image() {
        barriers.images.push(barrier);
        return;
    }
    let ImageBarrier { resource, src_stage, src_access, dst_stage, dst_access, cause, after, .. } = barrier;
    let ImageBarrier { src_queue_family, dst_queue_family, .. } = barrier;
    barriers.buffers.push(BufferBarrier {
        resource,
        src_stage,
        src_access,
        dst_stage,
        dst_access,
        src_queue_family,
        dst_queue_family,
        cause,
        after,
    });
}
