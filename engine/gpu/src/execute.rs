//! From a compiled plan to commands: makes its transients once, then replays barriers and payloads every frame.

use crate::context::Context;
use crate::counts::Counts;
use crate::error::GpuError;
use crate::memory::{Buffer, Image};
use crate::recorder::Recorder;
use crate::resources::{Concrete, Imports, Record, Resources, check_imports};
use crate::timing::Timing;
use crate::transients::{self, Transients};
use airglow_graph::{Barriers, BufferBarrier, Handover, ImageBarrier, Plan, Sharing};
use ash::vk;
use std::time::{Duration, Instant};

/// What a recording took.
#[derive(Clone, Copy, Debug)]
pub struct Recorded {
    /// CPU time of recording, without collecting the timestamps of earlier frames (lavapipe waits for the device
    /// in there).
    pub cpu: Duration,
    /// Passes recorded.
    pub passes: usize,
    /// Barriers recorded.
    pub barriers: usize,
}

/// A plan with its transient resources, ready to be recorded once per frame.
pub struct Execution {
    plan: Plan<Record>,
    transients: Transients,
    /// What each step did when it was recorded last.
    counts: Vec<Counts>,
    /// How transients share memory, where they do.
    sharing: Option<Sharing>,
    /// The waits of that before each step.
    handovers: Vec<Vec<vk::MemoryBarrier2<'static>>>,
    /// Scratch, kept so that a frame allocates nothing.
    buffer_barriers: Vec<vk::BufferMemoryBarrier2<'static>>,
    image_barriers: Vec<vk::ImageMemoryBarrier2<'static>>,
}

impl Execution {
    /// Makes the plan's transient resources, charged to owner `transient`.
    ///
    /// # Errors
    /// [`GpuError::Budget`] for all transients together, before any is made, and those of making buffers and images; what
    /// was made until then is freed.
    pub fn prepare(context: &Context, plan: Plan<Record>) -> Result<Self, GpuError> {
        let transients = transients::apart(context, &plan)?;
        Ok(Self::with(plan, transients, None))
    }

    /// The same with transients in memory that they hand to one another, as [`Plan::sharing_with`] places them by what the
    /// device asks for each: less memory for one more barrier where a place changes hands. Results are the same bits. On a
    /// device that has no memory for all of them together, [`Execution::sharing`] is none and each has its own.
    ///
    /// # Errors
    /// As [`Execution::prepare`].
    pub fn prepare_shared(context: &Context, plan: Plan<Record>) -> Result<Self, GpuError> {
        match transients::shared(context, &plan)? {
            Some((transients, sharing)) => Ok(Self::with(plan, transients, Some(sharing))),
            None => Self::prepare(context, plan),
        }
    }

    fn with(plan: Plan<Record>, transients: Transients, sharing: Option<Sharing>) -> Self {
        let most = |count: fn(&Barriers) -> usize| {
            let steps = plan.steps().iter().map(|step| &step.barriers);
            steps
                .chain([plan.acquires(), plan.final_barriers(), plan.releases()])
                .map(count)
                .max()
                .unwrap_or(0)
        };
        let buffer_barriers = Vec::with_capacity(most(|barriers| barriers.buffers.len()));
        let image_barriers = Vec::with_capacity(most(|barriers| barriers.images.len()));
        let memory = (0..plan.steps().len()).map(|step| plan.step_bytes(step));
        let counts = memory.map(|memory_bytes| Counts { memory_bytes, ..Counts::default() }).collect();
        let mut handovers = vec![Vec::new(); plan.steps().len()];
        for handover in sharing.iter().flat_map(|sharing| &sharing.handovers) {
            handovers[handover.before].push(memory_barrier(handover));
        }
        Self { plan, transients, counts, sharing, handovers, buffer_barriers, image_barriers }
    }

    /// How the plan's transients share memory; `None` where each has its own.
    pub fn sharing(&self) -> Option<&Sharing> {
        self.sharing.as_ref()
    }

    /// The plan.
    pub fn plan(&self) -> &Plan<Record> {
        &self.plan
    }

    /// What each pass did when the plan was recorded last, in the plan's order; before that only its
    /// memory is known.
    pub fn counts(&self) -> &[Counts] {
        &self.counts
    }

    /// Records the plan into `command_buffer`: acquires, each pass behind its barriers and under its label, final
    /// barriers, releases. With `timing`, each pass between two timestamps.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for an import that is missing or not as declared, or the error of a pass. The command
    /// buffer is then incomplete and must not be submitted.
    ///
    /// # Safety
    /// - What [`Recorder::new`] asks of the command buffer.
    /// - Each import is in the entry state its plan declares when the commands begin, and the host takes it over in
    ///   the declared exit state.
    /// - Recordings of one execution run on the device in the order recorded, on one queue.
    /// - Passes use resources as they declared.
    pub unsafe fn record(
        &mut self,
        context: &Context,
        command_buffer: vk::CommandBuffer,
        imports: &Imports,
        mut timing: Option<&mut Timing>,
    ) -> Result<Recorded, GpuError> {
        let Self { plan, transients, counts, handovers, buffer_barriers, image_barriers, .. } = self;
        check_imports(context, plan, imports)?;
        let resources = Resources { plan, transients, imports };
        // SAFETY: the caller vouches for the command buffer.
        let mut recorder = unsafe { Recorder::new(context, command_buffer) };
        let mut count = 0;
        let mut barriers = |barriers: &Barriers| {
            count += barriers.len();
            record_barriers(context, command_buffer, barriers, &resources, buffer_barriers, image_barriers)
        };
        if let Some(timing) = timing.as_deref_mut() {
            timing.begin_frame(context, command_buffer, plan.steps().iter().map(|step| &*step.name))?;
        }
        let start = Instant::now();
        barriers(plan.acquires())?;
        for (index, step) in plan.steps().iter().enumerate() {
            if let Some(timing) = timing.as_deref_mut() {
                timing.begin_pass(command_buffer, index);
            }
            hand_over(context, command_buffer, &handovers[index]);
            barriers(&step.barriers)?;
            recorder.labelled(&step.name, |recorder| {
                recorder.counts = Counts {
                    barriers: (step.barriers.len() + handovers[index].len()) as u64,
                    memory_bytes: counts[index].memory_bytes,
                    ..Counts::default()
                };
                let passed = (step.payload)(recorder, &resources);
                let ended = recorder.end_pass();
                counts[index] = recorder.counts;
                if let Some(timing) = timing.as_deref_mut() {
                    timing.end_pass(command_buffer, index);
                }
                passed.and(ended)
            })?;
        }
        barriers(plan.final_barriers())?;
        barriers(plan.releases())?;
        Ok(Recorded { cpu: start.elapsed(), passes: plan.steps().len(), barriers: count })
    }
}

/// The wait for a place that changes hands.
fn memory_barrier(handover: &Handover) -> vk::MemoryBarrier2<'static> {
    vk::MemoryBarrier2::default()
        .src_stage_mask(handover.src_stage)
        .src_access_mask(handover.src_access)
        .dst_stage_mask(handover.dst_stage)
        .dst_access_mask(handover.dst_access)
}

/// Before the barriers of a step, which then find the places theirs.
fn hand_over(
    context: &Context,
    command_buffer: vk::CommandBuffer,
    handovers: &[vk::MemoryBarrier2<'static>],
) {
    if handovers.is_empty() {
        return;
    }
    let info = vk::DependencyInfo::default().memory_barriers(handovers);
    // SAFETY: `Execution::record` has the caller vouch for the command buffer.
    unsafe { context.shared.device().cmd_pipeline_barrier2(command_buffer, &info) };
}

fn record_barriers(
    context: &Context,
    command_buffer: vk::CommandBuffer,
    barriers: &Barriers,
    resources: &Resources<'_>,
    buffers: &mut Vec<vk::BufferMemoryBarrier2<'static>>,
    images: &mut Vec<vk::ImageMemoryBarrier2<'static>>,
) -> Result<(), GpuError> {
    if barriers.is_empty() {
        return Ok(());
    }
    buffers.clear();
    images.clear();
    for barrier in &barriers.buffers {
        match resources.concrete(barrier.resource.index()) {
            Some(Concrete::Buffer(buffer)) => buffers.push(buffer_barrier(barrier, buffer)),
            _ => {
                return Err(GpuError::misuse(
                    "a buffer barrier",
                    "the plan names a buffer that is not there",
                ));
            }
        }
    }
    for barrier in &barriers.images {
        match resources.concrete(barrier.resource.index()) {
            Some(Concrete::Image(image)) => images.push(image_barrier(barrier, image)),
            _ => {
                return Err(GpuError::misuse(
                    "an image barrier",
                    "the plan names an image that is not there",
                ));
            }
        }
    }
    let info = vk::DependencyInfo::default().buffer_memory_barriers(buffers).image_memory_barriers(images);
    // SAFETY: live resources of this device; `Execution::record` has the caller vouch for the command buffer.
    unsafe { context.shared.device().cmd_pipeline_barrier2(command_buffer, &info) };
    Ok(())
}

fn buffer_barrier(barrier: &BufferBarrier, buffer: &Buffer) -> vk::BufferMemoryBarrier2<'static> {
    vk::BufferMemoryBarrier2::default()
        .src_stage_mask(barrier.src_stage)
        .src_access_mask(barrier.src_access)
        .dst_stage_mask(barrier.dst_stage)
        .dst_access_mask(barrier.dst_access)
        .src_queue_family_index(barrier.src_queue_family)
        .dst_queue_family_index(barrier.dst_queue_family)
        .buffer(buffer.raw())
        .size(vk::WHOLE_SIZE)
}

fn image_barrier(barrier: &ImageBarrier, image: &Image) -> vk::ImageMemoryBarrier2<'static> {
    vk::ImageMemoryBarrier2::default()
        .src_stage_mask(barrier.src_stage)
        .src_access_mask(barrier.src_access)
        .dst_stage_mask(barrier.dst_stage)
        .dst_access_mask(barrier.dst_access)
        .old_layout(barrier.old_layout)
        .new_layout(barrier.new_layout)
        .src_queue_family_index(barrier.src_queue_family)
        .dst_queue_family_index(barrier.dst_queue_family)
        .image(image.raw())
        .subresource_range(vk::ImageSubresourceRange {
            aspect_mask: barrier.aspects,
            base_mip_level: barrier.range.base_mip,
            level_count: barrier.range.mips,
            base_array_layer: barrier.range.base_layer,
            layer_count: barrier.range.layers,
        })
}
