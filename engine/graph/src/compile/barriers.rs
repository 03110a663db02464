//! Phase 7: the barriers between epochs, from entry to exit, subresource by subresource.

use super::coalesce::coalesce;
use super::epochs::{Epoch, Slot, push};
use super::lives::contains;
use super::scope::{EVERYWHERE, NOWHERE, Scope, one_of};
use crate::access::{State, writes};
use crate::declaration::Declaration;
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
            let (entry, exit) = ends(declaration, id, (mip, layer));
            let range = ImageRange { base_mip: mip, mips: 1, base_layer: layer, layers: 1 };
            let mut row = Row { plan: &mut plan, id, desc: &resource.desc, range, limits };
            let found = entry.filter(|entry| !row.is_foreign(entry.queue_family)).map(Epoch::of_host);
            let epochs = epochs_at(declaration, order, id, (mip, layer), found.as_ref());
            row.emit(epochs, entry, exit, found.as_ref());
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
fn epochs_at(
    declaration: &Declaration,
    order: &[usize],
    id: ResourceId,
    at: (u32, u32),
    found: Option<&Epoch>,
) -> Vec<Epoch> {
    let mut epochs = Vec::new();
    for (step, pass) in order.iter().enumerate() {
        let uses = declaration.passes[*pass].uses.iter();
        for used in uses.filter(|used| used.resource == id && contains(used.range, at)) {
            push(&mut epochs, Epoch::of_use(step, used), found);
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
    fn emit(
        &mut self,
        mut epochs: Vec<Epoch>,
        entry: Option<State>,
        exit: Option<State>,
        found: Option<&Epoch>,
    ) {
        if epochs.is_empty() && (entry.is_none() || entry == exit) {
            return;
        }
        let release_to = exit.map(|state| state.queue_family).filter(|family| self.is_foreign(*family));
        if let Some(exit) = exit {
            add_exit(&mut epochs, entry, exit, release_to.is_some(), found);
        }
        let (before, visible) = match entry {
            Some(entry) => self.enter(entry, epochs.first(), release_to.is_some()),
            None => (before_transient(epochs.last(), exit.is_some_and(|exit| self.waits(exit))), NOWHERE),
        };
        self.between(before, visible, &mut epochs);
        let last = epochs.last().copied().unwrap_or(before);
        match (release_to, entry, exit) {
            (Some(family), ..) => self.release(&last, family),
            (None, Some(_), Some(exit)) => self.cover_reads(epochs.last(), exit),
            _ => {}
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
    fn enter(&mut self, entry: State, first: Option<&Epoch>, released: bool) -> (Epoch, Scope) {
        let host = Epoch::of_host(entry);
        if !self.is_foreign(entry.queue_family) {
            let visible = if host.is_idle() { EVERYWHERE } else { (host.stage, host.access) };
            return (host, visible);
        }
        // Waiting at stages of the first use chains with a semaphore that the host waits for there.
        let chained = first.map(|first| first.stage).filter(|stage| !stage.is_empty());
        let stage = chained.unwrap_or(PipelineStageFlags2::ALL_COMMANDS);
        let same_layout = first.filter(|first| first.layout == entry.layout);
        let access = same_layout.map_or(AccessFlags2::NONE, |first| first.access);
        let stage = if same_layout.is_some() { stage } else { one_of(stage) };
        let acquired = Epoch { stage, access: AccessFlags2::NONE, ..host };
        let opened = if first.is_none() && !released { NOWHERE } else { (stage, access) };
        let barrier = self.barrier(&acquired, &acquired, opened, Cause::Acquire);
        let families = (entry.queue_family, self.limits.queue_family);
        push_barrier(&mut self.plan.acquires, self.desc, with_families(barrier, families));
        // The acquire itself orders a first use in the same layout; a layout change must wait for the acquire.
        let before = if same_layout.is_some() { Epoch::of_host(State::idle(entry.layout)) } else { acquired };
        (before, (stage, access))
    }

    /// A host that waits for an import's exit state has to have waited for every read of the plan too, or its next
    /// write would race with them.
    fn cover_reads(&mut self, last: Option<&Epoch>, exit: State) {
        let Some(last) = last.filter(|last| !last.writes() && !exit.stage.is_empty()) else { return };
        let everything = exit.stage.contains(PipelineStageFlags2::ALL_COMMANDS);
        let others = if everything { PipelineStageFlags2::NONE } else { last.stage & !exit.stage };
        if !others.is_empty() && !writes(exit.access) {
            let reads = Epoch { stage: others, ..*last };
            let barrier =
                self.barrier(&reads, &reads, (exit.stage, AccessFlags2::NONE), Cause::ReadAfterRead);
            push_barrier(&mut self.plan.exits, self.desc, barrier);
        }
    }

    fn release(&mut self, last: &Epoch, family: u32) {
        let barrier = self.barrier(last, last, NOWHERE, Cause::Release);
        let families = (self.limits.queue_family, family);
        push_barrier(&mut self.plan.releases, self.desc, with_families(barrier, families));
    }

    /// A barrier between each epoch and the next, where one is needed. `visible` is where the contents are visible
    /// before the first.
    fn between(&mut self, before: Epoch, visible: Scope, epochs: &mut [Epoch]) {
        let mut visible = [visible, NOWHERE];
        let mut previous = before;
        for epoch in epochs {
            let layout_changes = previous.layout != epoch.layout;
            let reads_on = !layout_changes && !previous.writes() && !epoch.writes();
            if reads_on && epoch.opens.0.is_empty() {
                epoch.also_waits_for(&previous);
            } else if layout_changes || !previous.is_idle() {
                let cause = match (previous.writes(), epoch.writes()) {
                    (true, false) => Cause::ReadAfterWrite,
                    (true, true) => Cause::WriteAfterWrite,
                    _ if previous.is_idle() => Cause::Layout,
                    (false, true) => Cause::WriteAfterRead,
                    (false, false) => Cause::ReadAfterRead,
                };
                let to = match (reads_on, layout_changes || previous.writes()) {
                    (true, _) => epoch.opens,
                    (false, true) => (epoch.stage, epoch.access),
                    // The earlier write is available already, and perhaps visible.
                    (false, false) => (epoch.stage, epoch.unseen(&visible)),
                };
                visible = if reads_on { [visible[0], to] } else { [to, NOWHERE] };
                let mut barrier = self.barrier(&previous, epoch, to, cause);
                if reads_on && epoch.begin != Slot::End && one_of(previous.stage) != previous.stage {
                    // To see what was written, one stage is enough; whoever writes next waits for all.
                    barrier.src_stage = one_of(previous.stage);
                    epoch.also_waits_for(&previous);
                }
                push_barrier(self.plan.slot(epoch.begin), self.desc, barrier);
            }
            previous = *epoch;
        }
    }

    fn barrier(
        &self,
        from: &Epoch,
        to: &Epoch,
        (dst_stage, dst_access): Scope,
        cause: Cause,
    ) -> ImageBarrier {
        let discards = from.layout != to.layout && !to.keeps;
        ImageBarrier {
            resource: self.id,
            range: self.range,
            aspects: match self.desc {
                ResourceDesc::Image(image) => image.aspects(),
                ResourceDesc::Buffer(_) => ImageAspectFlags::empty(),
            },
            src_stage: from.stage,
            src_access: from.written(),
            dst_stage,
            dst_access,
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
fn add_exit(
    epochs: &mut Vec<Epoch>,
    entry: Option<State>,
    exit: State,
    released: bool,
    found: Option<&Epoch>,
) {
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
        let stage = if idle { PipelineStageFlags2::ALL_COMMANDS } else { one_of(last.stage) };
        host = Epoch { stage, access: AccessFlags2::NONE, ..host };
    }
    let nothing_to_do = host.layout == last.layout && (released || host.is_idle());
    if !nothing_to_do {
        push(epochs, host, found);
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
