//! What is remembered of an access: what comes after it, and where its write is visible.

use ash::vk::{AccessFlags2 as A, PipelineStageFlags2 as S};

/// Who made an access.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Actor {
    /// The host's use before the plan.
    HostBefore,
    /// The host's write before the reads in which the plan finds a resource.
    HostWrote,
    /// The host's use after the plan.
    HostAfter,
    /// The pass of a moment.
    Pass(usize),
    /// A layout transition or ownership transfer of a moment.
    Transition(usize),
}

/// An access, or a layout transition or ownership transfer (which has no stage of its own).
#[derive(Clone, Debug)]
pub(crate) struct Event {
    pub actor: Actor,
    /// Which of the executions in a row it is of.
    pub round: u32,
    pub stage: S,
    pub writes: bool,
    /// What has to be made available; nothing for a transition, which does so itself.
    pub written: A,
    /// Stages known to come after it.
    pub after: S,
    pub available: bool,
    pub visible: Vec<(S, A)>,
}

/// How a barrier's first scope meets an event.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Meeting {
    No,
    /// Through an earlier barrier.
    Chained,
    Direct,
}

impl Event {
    /// An access nothing is known to come after.
    pub fn access(actor: Actor, round: u32, stage: S, written: A) -> Self {
        let writes = !written.is_empty();
        Self { actor, round, stage, writes, written, after: S::NONE, available: false, visible: Vec::new() }
    }

    /// A write that is over, available, and visible to one scope.
    pub fn past_write(actor: Actor, round: u32, stage: S, access: A) -> Self {
        Self {
            actor,
            round,
            stage: S::NONE,
            writes: true,
            written: A::NONE,
            after: stage,
            available: true,
            visible: vec![(stage, access)],
        }
    }

    /// Lets a barrier act, and says how it met the event.
    pub fn pass_barrier(&mut self, (src_stage, src_access): (S, A), dst: (S, A)) -> Meeting {
        let direct = !self.stage.is_empty() && holds(src_stage, self.stage);
        if !direct && !meets(src_stage, self.after) {
            return Meeting::No;
        }
        self.available |= direct && grants(src_access, self.written);
        self.after |= dst.0;
        if self.available {
            self.visible.push(dst);
        }
        if direct { Meeting::Direct } else { Meeting::Chained }
    }

    /// Whether its write is visible to all of an access.
    pub fn is_visible_to(&self, stage: S, access: A) -> bool {
        self.visible.iter().any(|(s, a)| holds(*s, stage) && grants(*a, access))
    }
}

/// Whether a scope holds every stage; `ALL_COMMANDS` stands for all.
pub(crate) fn holds(scope: S, stage: S) -> bool {
    scope.contains(S::ALL_COMMANDS) || scope.contains(stage)
}

/// Whether accesses hold all of others; `MEMORY_READ` and `MEMORY_WRITE` stand for every read and write.
pub(crate) fn grants(access: A, wanted: A) -> bool {
    let mut missing = wanted & !access;
    if access.contains(A::MEMORY_WRITE) {
        missing &= !written(missing);
    }
    if access.contains(A::MEMORY_READ) {
        missing &= written(missing);
    }
    missing.is_empty()
}

/// Whether two scopes share a stage, so that barriers chain.
fn meets(a: S, b: S) -> bool {
    let all = S::ALL_COMMANDS;
    a.intersects(b) || (a.contains(all) && !b.is_empty()) || (b.contains(all) && !a.is_empty())
}

/// The writes among accesses: whatever is not known to read.
pub(crate) fn written(access: A) -> A {
    let reads = A::INDIRECT_COMMAND_READ
        | A::INDEX_READ
        | A::VERTEX_ATTRIBUTE_READ
        | A::UNIFORM_READ
        | A::INPUT_ATTACHMENT_READ
        | A::SHADER_READ
        | A::SHADER_STORAGE_READ
        | A::SHADER_SAMPLED_READ
        | A::COLOR_ATTACHMENT_READ
        | A::DEPTH_STENCIL_ATTACHMENT_READ
        | A::TRANSFER_READ
        | A::HOST_READ
        | A::MEMORY_READ;
    A::from_raw(access.as_raw() & !reads.as_raw())
}
