//! Resources that remember one frame, on the device: both halves of each, swapped from frame to frame.

use crate::allocator::Location;
use crate::context::Context;
use crate::error::GpuError;
use crate::memory::{Buffer, Image, Label};
use crate::resources::{Concrete, Imports, Record};
use airglow_graph::{BufferDesc, ImageDesc, Plan, PlanHistory, ResourceDesc};
use ash::vk;

/// The halves of a plan's histories. A plan made anew with the same histories (a resize apart) goes on with them.
pub struct Histories {
    pairs: Vec<Pair>,
    /// Which half of each pair is `previous` next.
    previous: usize,
}

struct Pair {
    of_plan: PlanHistory,
    halves: [Concrete; 2],
}

impl Histories {
    /// Makes both halves of each history of `plan`, charged to owner `history`. They are to be cleared, or filled by
    /// the host, before the first frame.
    ///
    /// # Errors
    /// Those of making buffers and images; what was made until then is freed.
    pub fn prepare(context: &Context, plan: &Plan<Record>) -> Result<Self, GpuError> {
        let pairs = plan.histories().iter().map(|of_plan| Pair::new(context, plan, of_plan));
        Ok(Self { pairs: pairs.collect::<Result<_, _>>()?, previous: 0 })
    }

    /// Sets every half to zero and brings it into its resting state.
    ///
    /// # Safety
    /// `command_buffer` is recording outside rendering on the context's device, and runs before the first frame and
    /// after every frame that used these halves.
    pub unsafe fn clear(&self, context: &Context, command_buffer: vk::CommandBuffer) {
        for pair in &self.pairs {
            for half in &pair.halves {
                match half {
                    Concrete::Buffer(buffer) => clear_buffer(context, command_buffer, buffer),
                    Concrete::Image(image) => {
                        clear_image(context, command_buffer, image, pair.of_plan.resting.layout);
                    }
                }
            }
        }
    }

    /// Stands the halves in for the plan's, so that the next recording reads what the one before wrote. Once for each
    /// recording.
    pub fn turn(&mut self, imports: &mut Imports) {
        for Pair { of_plan, halves } in &self.pairs {
            imports.set_index(of_plan.previous.index(), halves[self.previous].clone());
            imports.set_index(of_plan.current.index(), halves[1 - self.previous].clone());
        }
        self.previous = 1 - self.previous;
    }
}

impl Pair {
    fn new(context: &Context, plan: &Plan<Record>, of_plan: &PlanHistory) -> Result<Self, GpuError> {
        let half = |index: usize| {
            let resource = plan.resources().get(index);
            let Some(resource) = resource else {
                return Err(GpuError::misuse("a history", "the plan has no such resource"));
            };
            let label = Label::new("history", &resource.name);
            Ok(match resource.desc {
                ResourceDesc::Buffer(desc) => {
                    let usage = desc.usage | vk::BufferUsageFlags::TRANSFER_DST;
                    let desc = BufferDesc { usage, ..desc };
                    Concrete::Buffer(context.create_buffer(label, &desc, Location::Device)?)
                }
                ResourceDesc::Image(desc) => {
                    let usage = desc.usage | vk::ImageUsageFlags::TRANSFER_DST;
                    Concrete::Image(context.create_image(label, &ImageDesc { usage, ..desc })?)
                }
            })
        };
        let halves = [half(of_plan.previous.index())?, half(of_plan.current.index())?];
        Ok(Self { of_plan: *of_plan, halves })
    }
}

fn clear_buffer(context: &Context, command_buffer: vk::CommandBuffer, buffer: &Buffer) {
    let barrier = vk::BufferMemoryBarrier2::default()
        .src_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
        .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
        .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
        .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
        .buffer(buffer.raw())
        .size(vk::WHOLE_SIZE);
    let device = context.shared.device();
    // SAFETY: a live buffer of this device with TRANSFER_DST; `Histories::clear` has the caller vouch for the rest.
    unsafe {
        device.cmd_fill_buffer(command_buffer, buffer.raw(), 0, vk::WHOLE_SIZE, 0);
        let barriers = [barrier];
        let info = vk::DependencyInfo::default().buffer_memory_barriers(&barriers);
        device.cmd_pipeline_barrier2(command_buffer, &info);
    }
}

fn clear_image(
    context: &Context,
    command_buffer: vk::CommandBuffer,
    image: &Image,
    resting: vk::ImageLayout,
) {
    let aspects = image.desc().aspects();
    let range = vk::ImageSubresourceRange {
        aspect_mask: aspects,
        level_count: vk::REMAINING_MIP_LEVELS,
        layer_count: vk::REMAINING_ARRAY_LAYERS,
        ..Default::default()
    };
    let writable = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
    let barrier = vk::ImageMemoryBarrier2::default().image(image.raw()).subresource_range(range);
    let open = barrier
        .dst_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
        .dst_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
        .new_layout(writable);
    let rest = barrier
        .src_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
        .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
        .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
        .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
        .old_layout(writable)
        .new_layout(resting);
    let device = context.shared.device();
    // SAFETY: a live image of this device with TRANSFER_DST; `Histories::clear` has the caller vouch for the rest.
    unsafe {
        let barriers = [open];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barriers);
        device.cmd_pipeline_barrier2(command_buffer, &info);
        if aspects.contains(vk::ImageAspectFlags::COLOR) {
            let zero = vk::ClearColorValue::default();
            device.cmd_clear_color_image(command_buffer, image.raw(), writable, &zero, &[range]);
        } else {
            let zero = vk::ClearDepthStencilValue::default();
            device.cmd_clear_depth_stencil_image(command_buffer, image.raw(), writable, &zero, &[range]);
        }
        let barriers = [rest];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barriers);
        device.cmd_pipeline_barrier2(command_buffer, &info);
    }
}
