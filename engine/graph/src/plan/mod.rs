//! The plan: what to do, in which order, behind which barriers, and what is not done and why.

mod barrier;
mod bytes;
mod difference;
mod json;
mod mermaid;
mod sharing;
mod text;

pub use barrier::{Barriers, BufferBarrier, Cause, ImageBarrier};
pub use bytes::PlanBytes;
pub use difference::{PlanDifference, Resized};
pub use sharing::{Handover, Placement, Sharing};

use crate::access::{Access, State};
use crate::declaration::{LeftOut, RoomPipelines};
use crate::handle::{Handle, ImageRange, Kind, ResourceId};
use crate::pass::PassKind;
use crate::resource::{Origin, ResourceDesc};
use ash::vk;

/// A compiled frame, as data.
///
/// To execute: [`acquires`](Self::acquires), then for each step its barriers and its pass, then
/// [`final_barriers`](Self::final_barriers), then [`releases`](Self::releases). The same plan may be recorded
/// again on the same queue without waiting: the first barrier of each transient waits for the last use of the
/// execution before.
#[derive(Clone, Debug)]
pub struct Plan<R> {
    pub(crate) steps: Vec<Step<R>>,
    pub(crate) resources: Vec<PlanResource>,
    pub(crate) acquires: Barriers,
    pub(crate) final_barriers: Barriers,
    pub(crate) releases: Barriers,
    pub(crate) culled: Vec<Culled>,
    pub(crate) left_out: Vec<LeftOut>,
    pub(crate) pipelines: Vec<RoomPipelines>,
    pub(crate) histories: Vec<PlanHistory>,
    pub(crate) queue_family: u32,
}

/// One pass of the plan, and the barriers before it.
#[derive(Clone, Debug)]
pub struct Step<R> {
    /// The pass's name.
    pub name: String,
    /// What it records.
    pub kind: PassKind,
    /// Whether it was marked as suitable for an asynchronous queue.
    pub async_suitable: bool,
    /// Barriers to record before it, in one call.
    pub barriers: Barriers,
    /// What it uses, in the order declared.
    pub accesses: Vec<PlanAccess>,
    /// What its recorder needs.
    pub payload: R,
}

/// One use of one resource, for hosts with a frame graph of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlanAccess {
    /// The resource.
    pub resource: ResourceId,
    /// The part of it; one mip and one layer for a buffer.
    pub range: ImageRange,
    /// The use.
    pub access: Access,
    /// Its stages.
    pub stage: vk::PipelineStageFlags2,
    /// Its memory accesses.
    pub flags: vk::AccessFlags2,
    /// The layout during it; `UNDEFINED` for a buffer.
    pub layout: vk::ImageLayout,
    /// The version used; for a write, the version written over.
    pub version: u32,
    /// The version a write makes.
    pub output: Option<u32>,
    /// Whether contents from before are needed.
    pub keeps_contents: bool,
}

/// A resource of the plan.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanResource {
    /// Its name.
    pub name: String,
    /// What it is; the usage of a transient includes what the steps need.
    pub desc: ResourceDesc,
    /// Imported or transient.
    pub origin: Origin,
    /// First and last step that use it; `None` if no step does, and then a transient need not exist.
    pub lifetime: Option<Lifetime>,
    /// The parts that were exported by name, and the state each is left in.
    pub exports: Vec<PlanExport>,
    /// Bytes, where known before allocation.
    pub bytes: Option<u64>,
}

/// A part of a resource that outlives the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlanExport {
    /// The part of it; one mip and one layer for a buffer.
    pub range: ImageRange,
    /// Its version.
    pub version: u32,
    /// The state it is left in.
    pub state: State,
}

/// The two halves of a resource that remembers one frame.
///
/// Before the first execution the host fills `previous` and brings it into `resting`; between executions it
/// swaps what it imports as the one and as the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlanHistory {
    /// What the execution before wrote.
    pub previous: ResourceId,
    /// What this execution writes.
    pub current: ResourceId,
    /// The state both are found and left in.
    pub resting: State,
}

/// A span of steps, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Lifetime {
    /// Index of the first step.
    pub first: usize,
    /// Index of the last step.
    pub last: usize,
}

/// A pass the plan does without, because nothing needs it.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Culled {
    /// The pass's name.
    pub pass: String,
    /// Why nothing needs it.
    pub reason: CullReason,
}

/// Why nothing needs a pass.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub enum CullReason {
    /// It writes nothing.
    WritesNothing,
    /// Nothing reads what it writes.
    Unread {
        /// What it writes.
        resources: Vec<String>,
    },
    /// Only passes that are culled themselves read what it writes.
    ReadOnlyByCulled {
        /// What it writes.
        resources: Vec<String>,
        /// The culled passes that would have read it.
        readers: Vec<String>,
    },
}

impl<R> Plan<R> {
    /// The passes in order.
    pub fn steps(&self) -> &[Step<R>] {
        &self.steps
    }

    /// Every declared resource, by [`ResourceId::index`].
    pub fn resources(&self) -> &[PlanResource] {
        &self.resources
    }

    /// The resource a handle names, or `None` for a handle of another graph.
    pub fn resource<T: Kind>(&self, handle: &Handle<T>) -> Option<&PlanResource> {
        self.resources.get(handle.resource.index())
    }

    /// Ownership taken from other queue families, before the first step; layouts are unchanged.
    pub fn acquires(&self) -> &Barriers {
        &self.acquires
    }

    /// Barriers after the last step that bring imports and exports into their exit states.
    pub fn final_barriers(&self) -> &Barriers {
        &self.final_barriers
    }

    /// Ownership given to other queue families, after the final barriers; layouts are unchanged.
    pub fn releases(&self) -> &Barriers {
        &self.releases
    }

    /// Passes nothing needs, in the order declared.
    pub fn culled(&self) -> &[Culled] {
        &self.culled
    }

    /// What the declaring code left out, in its order.
    pub fn left_out(&self) -> &[LeftOut] {
        &self.left_out
    }

    /// Pipelines that rooms hold ready, in the order they said so.
    pub fn pipelines(&self) -> &[RoomPipelines] {
        &self.pipelines
    }

    /// Resources that remember one frame, in the order declared.
    pub fn histories(&self) -> &[PlanHistory] {
        &self.histories
    }

    /// The queue family the plan is for ([`Limits::queue_family`](crate::Limits::queue_family)).
    pub fn queue_family(&self) -> u32 {
        self.queue_family
    }

    /// Every use of every step, in order: (step index, use).
    pub fn accesses(&self) -> impl Iterator<Item = (usize, &PlanAccess)> {
        self.steps
            .iter()
            .enumerate()
            .flat_map(|(i, step)| step.accesses.iter().map(move |access| (i, access)))
    }

    /// The same plan with other payloads; `map` sees each step's name and payload, in order.
    pub fn map_payload<S>(self, mut map: impl FnMut(&str, R) -> S) -> Plan<S> {
        let step = |step: Step<R>| Step {
            payload: map(&step.name, step.payload),
            name: step.name,
            kind: step.kind,
            async_suitable: step.async_suitable,
            barriers: step.barriers,
            accesses: step.accesses,
        };
        Plan {
            steps: self.steps.into_iter().map(step).collect(),
            resources: self.resources,
            acquires: self.acquires,
            final_barriers: self.final_barriers,
            releases: self.releases,
            culled: self.culled,
            left_out: self.left_out,
            pipelines: self.pipelines,
            histories: self.histories,
            queue_family: self.queue_family,
        }
    }
}
