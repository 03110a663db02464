//! What a plan does, as plain data of the checker's own, open to mutation.

use airglow_graph::{Barriers, BufferBarrier, ImageBarrier, ImageRange, Plan};
use airglow_graph::{PlanAccess, PlanHistory, PlanResource};
use ash::vk::{AccessFlags2, ImageAspectFlags, ImageLayout, PipelineStageFlags2};

/// A barrier on a buffer or a range of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the fields are those of `VkImageMemoryBarrier2`")]
pub struct Barrier {
    /// Index of the resource.
    pub resource: usize,
    /// Mips and layers; one of each for a buffer.
    pub range: ImageRange,
    pub aspects: ImageAspectFlags,
    pub src_stage: PipelineStageFlags2,
    pub src_access: AccessFlags2,
    pub dst_stage: PipelineStageFlags2,
    pub dst_access: AccessFlags2,
    pub old_layout: ImageLayout,
    pub new_layout: ImageLayout,
    pub src_queue_family: u32,
    pub dst_queue_family: u32,
}

/// What a moment is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Ownership is taken from other queue families.
    Acquire,
    /// A pass runs.
    Pass,
    /// The host's states are brought about.
    Exit,
    /// Ownership is given to other queue families.
    Release,
}

/// One batch of barriers, and the pass it stands before, if any.
#[derive(Clone, Debug)]
pub struct Moment {
    /// The pass's name, or what the moment is.
    pub name: String,
    /// What it is for.
    pub role: Role,
    /// Recorded in one call, first.
    pub barriers: Vec<Barrier>,
    /// What the pass does then.
    pub uses: Vec<PlanAccess>,
}

/// A plan in the order of execution.
#[derive(Clone, Debug)]
pub struct Trace {
    /// The queue family it runs on.
    pub queue_family: u32,
    /// Its resources.
    pub resources: Vec<PlanResource>,
    /// Resources that remember one frame.
    pub histories: Vec<PlanHistory>,
    /// Acquires, each pass, exits, releases.
    pub moments: Vec<Moment>,
}

impl Trace {
    /// The trace of a plan, from its public data.
    pub fn of<R>(plan: &Plan<R>) -> Self {
        let around = |role: Role, name: &str, barriers: &Barriers| Moment {
            name: name.to_owned(),
            role,
            barriers: all(barriers),
            uses: Vec::new(),
        };
        let mut moments = vec![around(Role::Acquire, "acquires", plan.acquires())];
        moments.extend(plan.steps().iter().map(|step| Moment {
            name: format!("pass `{}`", step.name),
            role: Role::Pass,
            barriers: all(&step.barriers),
            uses: step.accesses.clone(),
        }));
        moments.push(around(Role::Exit, "final barriers", plan.final_barriers()));
        moments.push(around(Role::Release, "releases", plan.releases()));
        Self {
            queue_family: plan.queue_family(),
            resources: plan.resources().to_vec(),
            histories: plan.histories().to_vec(),
            moments,
        }
    }

    /// Every barrier: index of its moment, index in the moment, barrier.
    pub fn barriers(&self) -> impl Iterator<Item = (usize, usize, &Barrier)> {
        let moments = self.moments.iter().enumerate();
        moments.flat_map(|(i, moment)| moment.barriers.iter().enumerate().map(move |(j, b)| (i, j, b)))
    }
}

fn all(barriers: &Barriers) -> Vec<Barrier> {
    let buffers = barriers.buffers.iter().map(of_buffer);
    buffers.chain(barriers.images.iter().map(of_image)).collect()
}

fn of_buffer(barrier: &BufferBarrier) -> Barrier {
    Barrier {
        resource: barrier.resource.index(),
        range: ImageRange { base_mip: 0, mips: 1, base_layer: 0, layers: 1 },
        aspects: ImageAspectFlags::empty(),
        src_stage: barrier.src_stage,
        src_access: barrier.src_access,
        dst_stage: barrier.dst_stage,
        dst_access: barrier.dst_access,
        old_layout: ImageLayout::UNDEFINED,
        new_layout: ImageLayout::UNDEFINED,
        src_queue_family: barrier.src_queue_family,
        dst_queue_family: barrier.dst_queue_family,
    }
}

fn of_image(barrier: &ImageBarrier) -> Barrier {
    Barrier {
        resource: barrier.resource.index(),
        range: barrier.range,
        aspects: barrier.aspects,
        src_stage: barrier.src_stage,
        src_access: barrier.src_access,
        dst_stage: barrier.dst_stage,
        dst_access: barrier.dst_access,
        old_layout: barrier.old_layout,
        new_layout: barrier.new_layout,
        src_queue_family: barrier.src_queue_family,
        dst_queue_family: barrier.dst_queue_family,
    }
}
