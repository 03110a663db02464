//! A second opinion on plans, by brute force: replays every barrier of a plan over every subresource, twice in
//! a row, and looks at every pair of accesses. It shares no code with the compiler.
//!
//! An access is remembered with the stages known to come after it and, if it wrote, where its write is visible.
//! A barrier extends both for every access in its first scope, directly or through an earlier barrier.

use airglow_graph::{
    Barriers, BufferBarrier, ImageBarrier, ImageRange, Origin, Plan, PlanAccess, PlanResource, ResourceDesc,
    State,
};
use ash::vk::{AccessFlags2 as A, ImageLayout, PipelineStageFlags2 as S, QUEUE_FAMILY_IGNORED};

/// What a plan does, open to mutation.
#[derive(Clone)]
pub struct Trace {
    pub family: u32,
    pub resources: Vec<PlanResource>,
    pub acquires: Barriers,
    pub steps: Vec<(Barriers, Vec<PlanAccess>)>,
    pub exits: Barriers,
    pub releases: Barriers,
}

impl Trace {
    pub fn of<R>(plan: &Plan<R>, family: u32) -> Self {
        Self {
            family,
            resources: plan.resources().to_vec(),
            acquires: plan.acquires().clone(),
            steps: plan.steps().iter().map(|s| (s.barriers.clone(), s.accesses.clone())).collect(),
            exits: plan.final_barriers().clone(),
            releases: plan.releases().clone(),
        }
    }

    fn batches(&mut self) -> impl Iterator<Item = &mut Barriers> {
        let steps = self.steps.iter_mut().map(|step| &mut step.0);
        [&mut self.acquires].into_iter().chain(steps).chain([&mut self.exits, &mut self.releases])
    }

    /// For each barrier, the same trace without it.
    pub fn without_one_barrier(&self) -> Vec<Self> {
        let counts = self.clone().batches().map(|b| (b.buffers.len(), b.images.len())).collect::<Vec<_>>();
        let mut mutants = Vec::new();
        for (batch, (buffers, images)) in counts.into_iter().enumerate() {
            for i in 0..buffers + images {
                let mut mutant = self.clone();
                match mutant.batches().nth(batch) {
                    Some(barriers) if i < buffers => _ = barriers.buffers.remove(i),
                    Some(barriers) => _ = barriers.images.remove(i - buffers),
                    None => continue,
                }
                mutants.push(mutant);
            }
        }
        mutants
    }

    /// The first thing wrong, or `Ok`.
    pub fn check(&self) -> Result<(), String> {
        for (index, resource) in self.resources.iter().enumerate() {
            let (mips, layers) = match resource.desc {
                ResourceDesc::Buffer(_) => (1, 1),
                ResourceDesc::Image(image) => (image.mips, image.layers),
            };
            for at in (0..mips).flat_map(|mip| (0..layers).map(move |layer| (mip, layer))) {
                let replayed = Subresource::new(self, index, at).replay();
                replayed.map_err(|e| format!("{} mip {} layer {}: {e}", resource.name, at.0, at.1))?;
            }
        }
        Ok(())
    }
}

/// An access, or a layout transition or ownership transfer (which has no stage of its own).
#[derive(Clone, Debug)]
struct Event {
    who: String,
    stage: S,
    writes: bool,
    written: A,
    after: S,
    available: bool,
    visible: Vec<(S, A)>,
}

fn is_write(access: A) -> bool {
    let reads = A::INDIRECT_COMMAND_READ
        | A::INDEX_READ
        | A::VERTEX_ATTRIBUTE_READ
        | A::UNIFORM_READ
        | A::SHADER_STORAGE_READ
        | A::SHADER_SAMPLED_READ
        | A::COLOR_ATTACHMENT_READ
        | A::DEPTH_STENCIL_ATTACHMENT_READ
        | A::TRANSFER_READ
        | A::HOST_READ;
    !reads.contains(access)
}

fn bits(access: A, writes: bool) -> A {
    let bits = (0..64).map(|bit| A::from_raw(1 << bit));
    bits.filter(|bit| access.contains(*bit) && is_write(*bit) == writes).fold(A::NONE, |a, b| a | b)
}

/// `ALL_COMMANDS` stands for every stage.
fn holds(scope: S, stage: S) -> bool {
    scope.contains(S::ALL_COMMANDS) || scope.contains(stage)
}

fn meets(a: S, b: S) -> bool {
    let all = S::ALL_COMMANDS;
    a.intersects(b) || (a.contains(all) && !b.is_empty()) || (b.contains(all) && !a.is_empty())
}

struct Subresource<'a> {
    trace: &'a Trace,
    index: usize,
    at: (u32, u32),
    is_image: bool,
    events: Vec<Event>,
    layout: ImageLayout,
    owner: u32,
    round: u32,
    /// The version its contents are of; `None` without contents.
    contents: Option<u32>,
}

impl<'a> Subresource<'a> {
    fn new(trace: &'a Trace, index: usize, at: (u32, u32)) -> Self {
        let is_image = matches!(trace.resources[index].desc, ResourceDesc::Image(_));
        let (layout, owner) = (ImageLayout::UNDEFINED, trace.family);
        Self { trace, index, at, is_image, events: Vec::new(), layout, owner, round: 0, contents: None }
    }

    fn within(&self, range: ImageRange) -> bool {
        (range.base_mip..range.base_mip + range.mips).contains(&self.at.0)
            && (range.base_layer..range.base_layer + range.layers).contains(&self.at.1)
    }

    fn accesses(&self) -> Vec<(usize, PlanAccess)> {
        let steps = self.trace.steps.iter().enumerate();
        let all = steps.flat_map(|(i, (_, accesses))| accesses.iter().map(move |a| (i, *a)));
        all.filter(|(_, a)| a.resource.index() == self.index && self.within(a.range)).collect()
    }

    fn replay(mut self) -> Result<(), String> {
        let resource = &self.trace.resources[self.index];
        let export = resource.exports.iter().find(|e| self.within(e.range)).map(|e| e.state);
        let (entry, exit) = match resource.origin {
            Origin::Imported { entry, exit } => (Some(entry), Some(export.unwrap_or(exit))),
            Origin::Transient => (None, export),
        };
        let accesses = self.accesses();
        if accesses.is_empty() && (entry == exit || entry.is_none()) {
            return Ok(());
        }
        for round in 0..2 {
            self.round = round;
            self.enter(entry);
            self.batch(&self.trace.acquires)?;
            for (i, (barriers, _)) in self.trace.steps.iter().enumerate() {
                self.batch(barriers)?;
                for (_, access) in accesses.iter().filter(|(step, _)| *step == i) {
                    self.pass_access(i, access)?;
                }
            }
            self.batch(&self.trace.exits)?;
            self.batch(&self.trace.releases)?;
            self.leave(exit)?;
        }
        Ok(())
    }

    fn family(&self, state: State) -> u32 {
        if state.queue_family == QUEUE_FAMILY_IGNORED { self.trace.family } else { state.queue_family }
    }

    fn enter(&mut self, entry: Option<State>) {
        let Some(entry) = entry else {
            (self.layout, self.contents, self.owner) = (ImageLayout::UNDEFINED, None, self.trace.family);
            return;
        };
        let filled = !self.is_image || entry.layout != ImageLayout::UNDEFINED;
        (self.layout, self.contents, self.owner) = (entry.layout, filled.then_some(0), self.family(entry));
        self.events.clear();
        if self.owner != self.trace.family || entry.stage.is_empty() {
            return;
        }
        let written = bits(entry.access, true);
        let writes = !written.is_empty();
        let visible = Vec::new();
        let (stage, after) = (entry.stage, S::NONE);
        let who = "the host before".to_owned();
        self.events.push(Event { who, stage, writes, written, after, available: false, visible });
        if !writes {
            // What the host reads was written before that, and is visible where the host reads it.
            let visible = vec![(entry.stage, entry.access)];
            let (stage, after, who) = (S::NONE, entry.stage, "what the host wrote".to_owned());
            let written = A::NONE;
            self.events.push(Event { who, stage, writes: true, written, after, available: true, visible });
        }
    }

    fn leave(&mut self, exit: Option<State>) -> Result<(), String> {
        let Some(exit) = exit else { return Ok(()) };
        let newest = self.accesses().iter().filter_map(|(_, a)| a.output).max();
        if newest.is_some() && newest != self.contents {
            return Err(format!("leaves version {:?} instead of {newest:?}", self.contents));
        }
        if self.is_image && exit.layout != ImageLayout::UNDEFINED && exit.layout != self.layout {
            return Err(format!("leaves in {:?} instead of {:?}", self.layout, exit.layout));
        }
        if self.owner != self.family(exit) {
            return Err(format!("leaves to family {} instead of {}", self.owner, self.family(exit)));
        }
        if self.owner != self.trace.family || exit.stage.is_empty() {
            // The host waits by means of its own.
            self.events.clear();
        } else {
            self.access(
                &format!("the host after round {}", self.round),
                exit.stage,
                bits(exit.access, false),
                bits(exit.access, true),
            )?;
        }
        Ok(())
    }

    fn batch(&mut self, barriers: &Barriers) -> Result<(), String> {
        let mut here = Vec::new();
        for b in barriers.buffers.iter().filter(|b| b.resource.index() == self.index) {
            let BufferBarrier { resource, src_stage, src_access, dst_stage, dst_access, .. } = *b;
            let BufferBarrier { src_queue_family, dst_queue_family, cause, after, .. } = *b;
            let range = ImageRange { base_mip: 0, mips: 1, base_layer: 0, layers: 1 };
            let (old_layout, new_layout) = (ImageLayout::UNDEFINED, ImageLayout::UNDEFINED);
            let aspects = Default::default();
            #[rustfmt::skip]
            here.push(ImageBarrier { resource, range, aspects, src_stage, src_access, dst_stage, dst_access,
                old_layout, new_layout, src_queue_family, dst_queue_family, cause, after });
        }
        let images = barriers.images.iter().filter(|b| b.resource.index() == self.index);
        here.extend(images.filter(|b| self.within(b.range)).copied());
        match here.as_slice() {
            [] => Ok(()),
            [barrier] => self.barrier(barrier),
            _ => Err("two barriers in one batch".to_owned()),
        }
    }

    fn barrier(&mut self, b: &ImageBarrier) -> Result<(), String> {
        let transfers = b.src_queue_family != b.dst_queue_family;
        let changes = transfers || (self.is_image && b.old_layout != b.new_layout);
        for e in &mut self.events {
            let direct = !e.stage.is_empty() && holds(b.src_stage, e.stage);
            if direct || meets(b.src_stage, e.after) {
                e.available |= direct && b.src_access.contains(e.written);
                e.after |= b.dst_stage;
                if e.available {
                    e.visible.push((b.dst_stage, b.dst_access));
                }
                if e.available || !e.writes {
                    continue;
                }
            }
            if changes {
                return Err(format!("the transition after {:?} races with {}", b.after, e.who));
            }
        }
        let discards = b.old_layout == ImageLayout::UNDEFINED;
        if self.is_image && b.old_layout != self.layout && !discards {
            return Err(format!("a barrier from {:?} where it is in {:?}", b.old_layout, self.layout));
        }
        if self.is_image && discards {
            self.contents = None;
        }
        if transfers {
            if self.owner != b.src_queue_family {
                return Err(format!("family {} gives what it does not own", b.src_queue_family));
            }
            self.owner = b.dst_queue_family;
        }
        if changes {
            self.layout = b.new_layout;
            self.events.clear();
            let visible = vec![(b.dst_stage, b.dst_access)];
            let (stage, written, after) = (S::NONE, A::NONE, b.dst_stage);
            let who = "a transition".to_owned();
            self.events.push(Event { who, stage, writes: true, written, after, available: true, visible });
        }
        Ok(())
    }

    fn pass_access(&mut self, step: usize, a: &PlanAccess) -> Result<(), String> {
        if self.is_image && a.layout != self.layout {
            return Err(format!("step {step} wants {:?}, finds {:?}", a.layout, self.layout));
        }
        if self.owner != self.trace.family {
            return Err(format!("step {step} uses what family {} owns", self.owner));
        }
        if a.keeps_contents {
            let outputs = self.accesses().into_iter().filter_map(|(_, other)| other.output);
            let wanted = outputs.filter(|output| *output <= a.version).max().unwrap_or(0);
            if self.contents != Some(wanted) {
                return Err(format!("step {step} wants version {wanted}, finds {:?}", self.contents));
            }
        }
        let reads = if a.keeps_contents { bits(a.flags, false) } else { A::NONE };
        self.access(&format!("step {step} of round {}", self.round), a.stage, reads, bits(a.flags, true))?;
        if let Some(output) = a.output {
            if self.contents.is_some_and(|contents| contents >= output) {
                return Err(format!("step {step} writes {output} over {:?}", self.contents));
            }
            self.contents = Some(output);
        }
        Ok(())
    }

    /// Looks at the pair with every access before.
    fn access(&mut self, who: &str, stage: S, reads: A, written: A) -> Result<(), String> {
        let writes = !written.is_empty();
        for e in self.events.iter().filter(|e| e.who != who && (e.writes || writes)) {
            if !holds(e.after, stage) {
                return Err(format!("{who} is not ordered after {}", e.who));
            }
            if e.writes && !e.available {
                return Err(format!("{who} comes before the write of {} is available", e.who));
            }
            let seen = |(s, a): &(S, A)| holds(*s, stage) && a.contains(reads);
            if e.writes && !reads.is_empty() && !e.visible.iter().any(seen) {
                return Err(format!("the write of {} is not visible to {who}", e.who));
            }
        }
        let (after, visible) = (S::NONE, Vec::new());
        let who = who.to_owned();
        self.events.push(Event { who, stage, writes, written, after, available: false, visible });
        Ok(())
    }
}
