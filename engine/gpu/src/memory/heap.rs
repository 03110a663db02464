//! Memory that several resources are placed in.

use super::Label;
use crate::allocator::{Allocation, Location};
use crate::error::GpuError;
use crate::retire::Retired;
use crate::shared::Shared;
use ash::vk;
use std::sync::Arc;

/// Device memory that is charged as a whole. Clones refer to the same; the last one dropped, after all that was placed in
/// it, retires it.
#[derive(Clone)]
pub(crate) struct Heap(Arc<Inner>);

struct Inner {
    shared: Arc<Shared>,
    memory: Option<Allocation>,
    ledger: usize,
}

impl Heap {
    /// Memory of that size for buffers, or for images with optimal tiling.
    pub fn new(
        shared: &Arc<Shared>,
        label: Label<'_>,
        requirements: vk::MemoryRequirements,
        buffers: bool,
    ) -> Result<Self, GpuError> {
        let memory = shared.allocate(label.name, requirements, Location::Device, buffers)?;
        let ledger = shared.ledger().add(label.owner, memory.size);
        Ok(Self(Arc::new(Inner { shared: Arc::clone(shared), memory: Some(memory), ledger })))
    }

    /// Where its byte `offset` is.
    pub fn place(&self, offset: u64) -> (vk::DeviceMemory, u64) {
        self.0.memory.as_ref().map_or_else(Default::default, |memory| (memory.memory, memory.offset + offset))
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        self.shared.retire(Retired::Heap { memory: self.memory.take(), ledger: self.ledger });
    }
}
