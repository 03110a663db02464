//! Safe recording into a host's command buffer.
//!
//! A [`Recorder`] checks what it is given (kinds, counts, sizes, alignments, usages, limits, order of calls) before
//! it records, so that a pass that forbids `unsafe` gets an error where Vulkan would have undefined behaviour. What
//! it cannot see remains with the caller and is stated by the plan, tested under validation:
//! - barriers and image layouts: they are the plan's, from the accesses declared; a resource used otherwise than
//!   declared is a hazard;
//! - what shaders and indirect arguments index: out of range is undefined unless `robustBufferAccess` is enabled;
//! - that SPIR-V matches its stated interface.
//!
//! Command-buffer state changed: pipelines, descriptor set 0 and push constants of both bind points, vertex buffers,
//! index buffer, viewport 0, scissor 0. Nothing is restored; rendering and labels are closed again.

mod binding;
mod commands;
mod copy;
mod crumbs;
mod draw;
mod rendering;

pub use binding::Binding;
pub use rendering::{ColorAttachment, DepthAttachment, Load, Rendering};

use crate::context::Context;
use crate::counts::Counts;
use crate::error::GpuError;
use crate::memory::BufferSlice;
use crate::pipeline::{ComputePipeline, GraphicsPipeline, PipelineCore};
use ash::vk;
use bytemuck::Pod;

/// The pipeline bound last.
enum Bound {
    Compute(ComputePipeline),
    Graphics(GraphicsPipeline),
}

impl Bound {
    fn core(&self) -> &PipelineCore {
        match self {
            Self::Compute(pipeline) => &pipeline.core,
            Self::Graphics(pipeline) => &pipeline.0.core,
        }
    }
}

/// Records commands of one frame into a command buffer of the host's.
pub struct Recorder<'a> {
    context: &'a Context,
    command_buffer: vk::CommandBuffer,
    bound: Option<Bound>,
    /// Whether the push constants of the pipeline bound last were given.
    pushed: bool,
    draw: draw::DrawState,
    pub(crate) counts: Counts,
}

impl<'a> Recorder<'a> {
    /// A recorder into `command_buffer`, for the context's present frame.
    ///
    /// # Safety
    /// The command buffer is in the recording state, outside rendering, primary, from a pool of the adopted queue
    /// family, and used by no one else while the recorder lives. It is submitted at most once, in this frame, and its
    /// work is done before frame + `frames_in_flight` begins.
    pub unsafe fn new(context: &'a Context, command_buffer: vk::CommandBuffer) -> Self {
        Self {
            context,
            command_buffer,
            bound: None,
            pushed: false,
            draw: Default::default(),
            counts: Counts::default(),
        }
    }

    /// The context recorded for.
    pub fn context(&self) -> &'a Context {
        self.context
    }

    /// The host's command buffer, for commands of its own.
    pub fn command_buffer(&self) -> vk::CommandBuffer {
        self.command_buffer
    }

    /// What was recorded so far; within a plan, since the pass began.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    fn device(&self) -> &'a ash::Device {
        self.context.shared.device()
    }

    /// Copies `data` into memory that lives as long as the frame, to be bound as uniform or storage buffer, drawn from
    /// or copied from. Aligned for all of these.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for no data; errors of making a buffer when the frame's memory has to grow.
    pub fn upload<T: Pod>(&mut self, data: &[T]) -> Result<BufferSlice, GpuError> {
        self.context.slot().upload(data)
    }

    /// Binds a compute pipeline and everything it takes; `bindings` in any order.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] unless `bindings` are exactly those the pipeline states, with right kinds, usages,
    /// alignments and ranges.
    pub fn bind_compute(&mut self, pipeline: &ComputePipeline, bindings: &[Binding]) -> Result<(), GpuError> {
        self.bind(Bound::Compute(pipeline.clone()), vk::PipelineBindPoint::COMPUTE, bindings)
    }

    /// Binds a graphics pipeline and everything it takes; `bindings` in any order.
    ///
    /// # Errors
    /// As [`Recorder::bind_compute`].
    pub fn bind_graphics(
        &mut self,
        pipeline: &GraphicsPipeline,
        bindings: &[Binding],
    ) -> Result<(), GpuError> {
        self.bind(Bound::Graphics(pipeline.clone()), vk::PipelineBindPoint::GRAPHICS, bindings)
    }

    fn bind(
        &mut self,
        bound: Bound,
        point: vk::PipelineBindPoint,
        bindings: &[Binding],
    ) -> Result<(), GpuError> {
        let core = bound.core();
        if !std::sync::Arc::ptr_eq(&core.shared, &self.context.shared) {
            return Err(GpuError::misuse(&*core.name, "the pipeline was made by another context"));
        }
        let set = binding::descriptor_set(self.context, core, bindings)?;
        // SAFETY: pipeline, layout and set are alive and fit each other; what the set refers to is retired with the
        // frame at the earliest.
        unsafe {
            self.device().cmd_bind_pipeline(self.command_buffer, point, core.pipeline);
            if let Some(set) = set {
                self.device().cmd_bind_descriptor_sets(
                    self.command_buffer,
                    point,
                    core.layout,
                    0,
                    &[set],
                    &[],
                );
            }
        }
        self.counts.bound_bytes += bindings.iter().map(Binding::bytes).sum::<u64>();
        self.pushed = core.interface.push_constant_size == 0;
        self.bound = Some(bound);
        Ok(())
    }

    /// Gives the pipeline bound last its push constants.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if no pipeline is bound or `T` has another size than the pipeline states.
    pub fn push_constants<T: Pod>(&mut self, constants: &T) -> Result<(), GpuError> {
        let Some(bound) = &self.bound else {
            return Err(GpuError::misuse("push_constants", "bind a pipeline first"));
        };
        let core = bound.core();
        let (size, stated) = (size_of::<T>(), core.interface.push_constant_size);
        if size != stated as usize {
            let problem = format!("{size} bytes of push constants given, {stated} stated by the pipeline");
            return Err(GpuError::misuse(&*core.name, problem));
        }
        // SAFETY: the range is the layout's whole range, checked against the limits when it was made.
        unsafe {
            self.device().cmd_push_constants(
                self.command_buffer,
                core.layout,
                core.interface.stages,
                0,
                bytemuck::bytes_of(constants),
            );
        }
        self.pushed = true;
        Ok(())
    }

    /// The pipeline bound last, if it is ready for work of its kind.
    fn ready(&self, call: &'static str) -> Result<&Bound, GpuError> {
        let Some(bound) = &self.bound else {
            return Err(GpuError::misuse(call, "bind a pipeline first"));
        };
        if !self.pushed {
            return Err(GpuError::misuse(&*bound.core().name, "give it its push constants first"));
        }
        Ok(bound)
    }

    pub(crate) fn outside_rendering(&self, call: &'static str) -> Result<(), GpuError> {
        match self.draw.is_rendering() {
            true => Err(GpuError::misuse(call, "not allowed within rendering; end it first")),
            false => Ok(()),
        }
    }

    /// Ends what a pass left open, and says so.
    pub(crate) fn end_pass(&mut self) -> Result<(), GpuError> {
        self.bound = None;
        if self.draw.is_rendering() {
            self.end_rendering()?;
            return Err(GpuError::misuse("begin_rendering", "the pass did not end its rendering"));
        }
        self.draw = Default::default();
        Ok(())
    }
}
