//! Buffers and ranges of them.

use super::Label;
use super::heap::Heap;
use crate::allocator::{Allocation, Location};
use crate::error::GpuError;
use crate::retire::Retired;
use crate::shared::{Shared, lock};
use airglow_graph::BufferDesc;
use ash::vk;
use bytemuck::Pod;
use std::ffi::c_void;
use std::ptr::NonNull;
use std::sync::{Arc, Mutex};

/// A buffer. Clones refer to the same buffer; the last one dropped retires it.
#[derive(Clone)]
pub struct Buffer(Arc<Inner>);

struct Inner {
    shared: Arc<Shared>,
    raw: vk::Buffer,
    name: String,
    desc: BufferDesc,
    /// The memory, and the lock that makes mapped access one at a time. `None`: placed in a heap, or imported.
    memory: Mutex<Option<Allocation>>,
    mapped: Option<Mapped>,
    /// What it is placed in.
    heap: Option<Heap>,
    ledger: usize,
}

/// Where the first byte of an upload or readback buffer is mapped.
#[derive(Clone, Copy)]
struct Mapped(NonNull<c_void>);

// SAFETY: an address in mapped device memory, valid on every thread; it is only used under `Inner::memory`'s lock.
unsafe impl Send for Mapped {}
// SAFETY: as above.
unsafe impl Sync for Mapped {}

impl Buffer {
    pub(crate) fn new(
        shared: &Arc<Shared>,
        label: Label<'_>,
        desc: &BufferDesc,
        location: Location,
    ) -> Result<Self, GpuError> {
        if desc.size == 0 {
            return Err(GpuError::misuse(label.name, "a buffer needs at least one byte"));
        }
        if desc.size > shared.facts.max_allocation {
            let (what, size) = (label.name.to_owned(), desc.size);
            let allowed = shared.facts.max_allocation;
            return Err(GpuError::TooLarge { what, size, limit: "maxMemoryAllocationSize", allowed });
        }
        let device = shared.device();
        let info = vk::BufferCreateInfo::default().size(desc.size).usage(desc.usage);
        // SAFETY: a live device and a complete description; on an error the buffer made so far is destroyed.
        let (raw, memory) = unsafe {
            let raw = device.create_buffer(&info, None).map_err(GpuError::vulkan("vkCreateBuffer"))?;
            let memory = shared
                .allocate(label.name, device.get_buffer_memory_requirements(raw), location, true)
                .inspect_err(|_| device.destroy_buffer(raw, None))?;
            if let Err(result) = device.bind_buffer_memory(raw, memory.memory, memory.offset) {
                device.destroy_buffer(raw, None);
                shared.free(memory);
                return Err(GpuError::Vulkan { call: "vkBindBufferMemory", result });
            }
            (raw, memory)
        };
        shared.name(raw, vk::ObjectType::BUFFER, label.name);
        let ledger = shared.ledger().add(label.owner, memory.size);
        let mapped = memory.mapped.filter(|_| location != Location::Device).map(Mapped);
        let mut inner = Inner::new(shared, raw, label, desc, ledger);
        (inner.memory, inner.mapped) = (Mutex::new(Some(memory)), mapped);
        Ok(Self(Arc::new(inner)))
    }

    /// A buffer that was bound to a place in `heap`.
    pub(crate) fn placed(
        shared: &Arc<Shared>,
        raw: vk::Buffer,
        label: Label<'_>,
        desc: &BufferDesc,
        heap: &Heap,
    ) -> Self {
        shared.name(raw, vk::ObjectType::BUFFER, label.name);
        let mut inner = Inner::new(shared, raw, label, desc, shared.ledger().add(label.owner, 0));
        inner.heap = Some(heap.clone());
        Self(Arc::new(inner))
    }

    /// A buffer whose memory is the host's.
    pub(crate) fn imported(
        shared: &Arc<Shared>,
        raw: vk::Buffer,
        label: Label<'_>,
        desc: &BufferDesc,
    ) -> Self {
        Self(Arc::new(Inner::new(shared, raw, label, desc, shared.ledger().add(label.owner, 0))))
    }

    /// The Vulkan handle, for the host's own commands. It dies with the last clone, frames later.
    pub fn raw(&self) -> vk::Buffer {
        self.0.raw
    }

    /// The name it was made with.
    pub fn name(&self) -> &str {
        &self.0.name
    }

    /// Size in bytes.
    pub fn size(&self) -> u64 {
        self.0.desc.size
    }

    /// What it is: size and usage. The same description imports it into a graph.
    pub fn desc(&self) -> &BufferDesc {
        &self.0.desc
    }

    /// The range of `size` bytes from byte `offset`.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if the range is empty or leaves the buffer.
    pub fn slice(&self, offset: u64, size: u64) -> Result<BufferSlice, GpuError> {
        self.check_range(offset, size)?;
        Ok(BufferSlice { buffer: self.clone(), offset, size })
    }

    /// Copies `data` into the buffer from byte `offset` on. Only for [`Location::Upload`] buffers.
    ///
    /// What the device reads meanwhile is undefined: write only what no frame in flight uses, or use
    /// [`Recorder::upload`](crate::Recorder::upload).
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if the buffer is not mapped or the data leaves it.
    pub fn write<T: Pod>(&self, offset: u64, data: &[T]) -> Result<(), GpuError> {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        if bytes.is_empty() {
            return Ok(());
        }
        let start = self.mapped_range(offset, bytes.len() as u64)?;
        let _one_at_a_time = lock(&self.0.memory);
        // SAFETY: the range lies in the mapping, which lives as long as the buffer; the lock excludes other CPU
        // access, and the slice is ordinary memory.
        unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr(), start, bytes.len()) };
        Ok(())
    }

    /// Copies `count` values out of the buffer from byte `offset` on. For mapped buffers.
    ///
    /// The device must have finished writing them, with a barrier to the host.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if the buffer is not mapped or the range leaves it.
    pub fn read<T: Pod>(&self, offset: u64, count: usize) -> Result<Vec<T>, GpuError> {
        let size = count as u64 * size_of::<T>() as u64;
        if size == 0 {
            return Ok(Vec::new());
        }
        let start = self.mapped_range(offset, size)?;
        let mut values = vec![T::zeroed(); count];
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut values);
        let _one_at_a_time = lock(&self.0.memory);
        // SAFETY: as in `write`, in the other direction.
        unsafe { std::ptr::copy_nonoverlapping(start, bytes.as_mut_ptr(), bytes.len()) };
        Ok(values)
    }

    fn mapped_range(&self, offset: u64, size: u64) -> Result<*mut u8, GpuError> {
        self.check_range(offset, size)?;
        let Some(Mapped(start)) = self.0.mapped else {
            return Err(GpuError::misuse(
                self.name(),
                "not mapped; make it with Location::Upload or Readback",
            ));
        };
        // SAFETY: the offset was checked to lie within the mapping.
        Ok(unsafe { start.as_ptr().cast::<u8>().add(offset as usize) })
    }

    fn check_range(&self, offset: u64, size: u64) -> Result<(), GpuError> {
        let fits = offset.checked_add(size).is_some_and(|end| size > 0 && end <= self.size());
        if !fits {
            let problem = format!("{size} bytes from byte {offset} are not within its {} bytes", self.size());
            return Err(GpuError::misuse(self.name(), problem));
        }
        Ok(())
    }

    pub(crate) fn belongs_to(&self, shared: &Arc<Shared>) -> bool {
        Arc::ptr_eq(&self.0.shared, shared)
    }
}

impl Inner {
    /// A buffer without memory of its own.
    fn new(
        shared: &Arc<Shared>,
        raw: vk::Buffer,
        label: Label<'_>,
        desc: &BufferDesc,
        ledger: usize,
    ) -> Self {
        Self {
            shared: Arc::clone(shared),
            raw,
            name: label.name.to_owned(),
            desc: *desc,
            memory: Mutex::default(),
            mapped: None,
            heap: None,
            ledger,
        }
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        let memory = lock(&self.memory).take();
        if memory.is_none() && self.heap.is_none() {
            return self.shared.ledger().remove(self.ledger, 0);
        }
        self.shared.retire(Retired::Buffer { raw: self.raw, memory, ledger: self.ledger });
    }
}

/// A range of a buffer.
#[derive(Clone)]
pub struct BufferSlice {
    pub(crate) buffer: Buffer,
    pub(crate) offset: u64,
    pub(crate) size: u64,
}

impl BufferSlice {
    /// The buffer.
    pub fn buffer(&self) -> &Buffer {
        &self.buffer
    }

    /// First byte.
    pub fn offset(&self) -> u64 {
        self.offset
    }

    /// Size in bytes.
    pub fn size(&self) -> u64 {
        self.size
    }
}

/// The whole buffer.
impl From<&Buffer> for BufferSlice {
    fn from(buffer: &Buffer) -> Self {
        Self { buffer: buffer.clone(), offset: 0, size: buffer.size() }
    }
}

impl From<&BufferSlice> for BufferSlice {
    fn from(slice: &BufferSlice) -> Self {
        slice.clone()
    }
}
