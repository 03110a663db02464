//! What one frame in flight borrows and gives back: descriptor sets and a ring of upload memory.

use crate::allocator::Location;
use crate::error::GpuError;
use crate::memory::{Buffer, BufferSlice, Label};
use crate::shared::Shared;
use airglow_graph::BufferDesc;
use ash::vk;
use bytemuck::Pod;
use std::sync::Arc;

/// Descriptor sets in one pool.
const SETS: u32 = 128;
/// Least bytes of an upload buffer.
const CHUNK: u64 = 256 << 10;

/// The slot of one frame in flight. Grows to what a frame needs, then allocates nothing.
pub(crate) struct FrameSlot {
    shared: Arc<Shared>,
    pools: Vec<vk::DescriptorPool>,
    /// The pool that sets are taken from.
    pool: usize,
    chunks: Vec<Buffer>,
    /// The chunk that is filled, and its first free byte.
    chunk: usize,
    free: u64,
}

impl FrameSlot {
    pub(crate) fn new(shared: &Arc<Shared>) -> Self {
        let shared = Arc::clone(shared);
        Self { shared, pools: Vec::new(), pool: 0, chunks: Vec::new(), chunk: 0, free: 0 }
    }

    /// Takes everything back.
    ///
    /// # Safety
    /// The device is done with the frame that used the slot.
    pub(crate) unsafe fn reset(&mut self) -> Result<(), GpuError> {
        for &pool in &self.pools {
            // SAFETY: the caller vouches that no set of the pool is in use.
            unsafe {
                self.shared.device().reset_descriptor_pool(pool, vk::DescriptorPoolResetFlags::empty())
            }
            .map_err(GpuError::vulkan("vkResetDescriptorPool"))?;
        }
        (self.pool, self.chunk, self.free) = (0, 0, 0);
        Ok(())
    }

    /// A descriptor set that lives as long as the frame.
    pub(crate) fn descriptor_set(
        &mut self,
        layout: vk::DescriptorSetLayout,
    ) -> Result<vk::DescriptorSet, GpuError> {
        loop {
            let fresh = self.pool == self.pools.len();
            if fresh {
                let pool = self.make_pool()?;
                self.pools.push(pool);
            }
            let layouts = [layout];
            let mut set = vk::DescriptorSet::null();
            let info = vk::DescriptorSetAllocateInfo::default()
                .descriptor_pool(self.pools[self.pool])
                .set_layouts(&layouts);
            let device = self.shared.device();
            // SAFETY: pool and layout are this device's; `set` has room for the one set asked for.
            let result =
                unsafe { (device.fp_v1_0().allocate_descriptor_sets)(device.handle(), &info, &mut set) };
            match result {
                vk::Result::SUCCESS => return Ok(set),
                vk::Result::ERROR_OUT_OF_POOL_MEMORY | vk::Result::ERROR_FRAGMENTED_POOL if !fresh => {
                    self.pool += 1
                }
                result => return Err(GpuError::Vulkan { call: "vkAllocateDescriptorSets", result }),
            }
        }
    }

    fn make_pool(&self) -> Result<vk::DescriptorPool, GpuError> {
        let sizes = [
            (vk::DescriptorType::STORAGE_BUFFER, 8 * SETS),
            (vk::DescriptorType::UNIFORM_BUFFER, 4 * SETS),
            (vk::DescriptorType::SAMPLED_IMAGE, 8 * SETS),
            (vk::DescriptorType::STORAGE_IMAGE, 4 * SETS),
            (vk::DescriptorType::SAMPLER, 4 * SETS),
        ]
        .map(|(ty, descriptor_count)| vk::DescriptorPoolSize { ty, descriptor_count });
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(SETS).pool_sizes(&sizes);
        // SAFETY: a live device and a complete description.
        unsafe { self.shared.device().create_descriptor_pool(&info, None) }
            .map_err(GpuError::vulkan("vkCreateDescriptorPool"))
    }

    /// Copies `data` into memory that lives as long as the frame.
    pub(crate) fn upload<T: Pod>(&mut self, data: &[T]) -> Result<BufferSlice, GpuError> {
        let size = size_of_val(data) as u64;
        if size == 0 {
            return Err(GpuError::misuse("upload", "nothing to upload; leave the binding or the call out"));
        }
        let limits = &self.shared.facts.limits;
        let alignment = limits
            .min_uniform_buffer_offset_alignment
            .max(limits.min_storage_buffer_offset_alignment)
            .max(16);
        let start = self.free.next_multiple_of(alignment);
        let fits =
            |chunk: &Buffer, start: u64| start.checked_add(size).is_some_and(|end| end <= chunk.size());
        let (chunk, start) = match self.chunks.get(self.chunk) {
            Some(chunk) if fits(chunk, start) => (self.chunk, start),
            _ => (self.next_chunk(size)?, 0),
        };
        (self.chunk, self.free) = (chunk, start + size);
        let buffer = &self.chunks[chunk];
        buffer.write(start, data)?;
        buffer.slice(start, size)
    }

    /// A chunk after the present one with at least `size` bytes, made if there is none.
    fn next_chunk(&mut self, size: u64) -> Result<usize, GpuError> {
        let later = self.chunk + usize::from(self.free > 0);
        if let Some(found) = (later..self.chunks.len()).find(|&chunk| self.chunks[chunk].size() >= size) {
            self.chunks.swap(later, found);
            return Ok(later);
        }
        let usage = vk::BufferUsageFlags::UNIFORM_BUFFER
            | vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::VERTEX_BUFFER
            | vk::BufferUsageFlags::INDEX_BUFFER
            | vk::BufferUsageFlags::INDIRECT_BUFFER
            | vk::BufferUsageFlags::TRANSFER_SRC;
        let label = Label { owner: "airglow", name: "frame upload" };
        let desc = BufferDesc { size: size.max(CHUNK), usage };
        let buffer = Buffer::new(&self.shared, label, &desc, Location::Upload)?;
        let later = later.min(self.chunks.len());
        self.chunks.insert(later, buffer);
        Ok(later)
    }
}

impl Drop for FrameSlot {
    fn drop(&mut self) {
        for &pool in &self.pools {
            // SAFETY: `Context::adopt` has the host promise that the device is idle on our work by now.
            unsafe { self.shared.device().destroy_descriptor_pool(pool, None) };
        }
    }
}
