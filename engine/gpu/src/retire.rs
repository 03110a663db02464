//! Deferred destruction: what is dropped is destroyed once the frames that may still use it are done.

use crate::allocator::Allocation;
use ash::vk;

/// A Vulkan object that nothing on the CPU refers to any more.
pub(crate) enum Retired {
    Buffer {
        raw: vk::Buffer,
        memory: Option<Allocation>,
        ledger: usize,
    },
    Image {
        raw: vk::Image,
        views: Vec<vk::ImageView>,
        memory: Option<Allocation>,
        ledger: usize,
    },
    Views(Vec<vk::ImageView>),
    /// Memory in which others were placed, destroyed before.
    Heap {
        memory: Option<Allocation>,
        ledger: usize,
    },
    Pipeline {
        pipeline: vk::Pipeline,
        layout: vk::PipelineLayout,
        set_layout: vk::DescriptorSetLayout,
    },
    Sampler(vk::Sampler),
    QueryPool(vk::QueryPool),
}

impl Retired {
    /// Destroys the object, and returns the memory and the ledger entry that are free again.
    ///
    /// # Safety
    /// No work on the device uses the object any more.
    pub(crate) unsafe fn destroy(self, device: &ash::Device) -> Option<(Option<Allocation>, usize)> {
        // SAFETY: the caller vouches that the device is done with the object; it came from this device, and
        // this value was its only owner.
        unsafe {
            match self {
                Self::Buffer { raw, memory, ledger } => {
                    device.destroy_buffer(raw, None);
                    return Some((memory, ledger));
                }
                Self::Image { raw, views, memory, ledger } => {
                    views.into_iter().for_each(|view| device.destroy_image_view(view, None));
                    device.destroy_image(raw, None);
                    return Some((memory, ledger));
                }
                Self::Views(views) => {
                    views.into_iter().for_each(|view| device.destroy_image_view(view, None))
                }
                Self::Heap { memory, ledger } => return Some((memory, ledger)),
                Self::Pipeline { pipeline, layout, set_layout } => {
                    device.destroy_pipeline(pipeline, None);
                    device.destroy_pipeline_layout(layout, None);
                    device.destroy_descriptor_set_layout(set_layout, None);
                }
                Self::Sampler(sampler) => device.destroy_sampler(sampler, None),
                Self::QueryPool(pool) => device.destroy_query_pool(pool, None),
            }
        }
        None
    }
}
