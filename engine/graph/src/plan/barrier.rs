//! Barriers as data: what `VkBufferMemoryBarrier2` and `VkImageMemoryBarrier2` hold, without handles.

use crate::handle::{ImageRange, ResourceId};
use ash::vk;

/// Why a barrier is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
pub enum Cause {
    /// Written, then read.
    ReadAfterWrite,
    /// Written, then overwritten.
    WriteAfterWrite,
    /// Read, then overwritten: execution only.
    WriteAfterRead,
    /// Read, then read in another layout or where the first read's barrier did not reach.
    ReadAfterRead,
    /// Nothing pending: the layout only.
    Layout,
    /// Taken from another queue family.
    Acquire,
    /// Given to another queue family.
    Release,
}

/// A barrier on a whole buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BufferBarrier {
    /// The buffer.
    pub resource: ResourceId,
    /// Stages waited for.
    pub src_stage: vk::PipelineStageFlags2,
    /// Writes made available.
    pub src_access: vk::AccessFlags2,
    /// Stages that wait.
    pub dst_stage: vk::PipelineStageFlags2,
    /// Accesses the writes are made visible to.
    pub dst_access: vk::AccessFlags2,
    /// Giving queue family, or `QUEUE_FAMILY_IGNORED`.
    pub src_queue_family: u32,
    /// Taking queue family, or `QUEUE_FAMILY_IGNORED`.
    pub dst_queue_family: u32,
    /// Why it is there.
    pub cause: Cause,
    /// Index of the last step waited for; `None` for what happened before the plan.
    pub after: Option<usize>,
}

/// A barrier on a range of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageBarrier {
    /// The image.
    pub resource: ResourceId,
    /// Its mips and layers, resolved.
    pub range: ImageRange,
    /// The aspects of its format.
    pub aspects: vk::ImageAspectFlags,
    /// Stages waited for.
    pub src_stage: vk::PipelineStageFlags2,
    /// Writes made available.
    pub src_access: vk::AccessFlags2,
    /// Stages that wait.
    pub dst_stage: vk::PipelineStageFlags2,
    /// Accesses the writes are made visible to.
    pub dst_access: vk::AccessFlags2,
    /// Layout before; `UNDEFINED` where the contents do not matter.
    pub old_layout: vk::ImageLayout,
    /// Layout after.
    pub new_layout: vk::ImageLayout,
    /// Giving queue family, or `QUEUE_FAMILY_IGNORED`.
    pub src_queue_family: u32,
    /// Taking queue family, or `QUEUE_FAMILY_IGNORED`.
    pub dst_queue_family: u32,
    /// Why it is there.
    pub cause: Cause,
    /// Index of the last step waited for; `None` for what happened before the plan.
    pub after: Option<usize>,
}

/// Barriers for one `vkCmdPipelineBarrier2`, ordered by resource, then range.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Barriers {
    /// On buffers.
    pub buffers: Vec<BufferBarrier>,
    /// On images.
    pub images: Vec<ImageBarrier>,
}

impl Barriers {
    /// Whether there is nothing to record.
    pub fn is_empty(&self) -> bool {
        self.buffers.is_empty() && self.images.is_empty()
    }

    /// Number of barriers.
    pub fn len(&self) -> usize {
        self.buffers.len() + self.images.len()
    }
}
