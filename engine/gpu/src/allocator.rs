//! Where device memory comes from: a small trait a host can implement, and a default behind it.

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan as sub;
use std::collections::BTreeMap;
use std::ffi::c_void;
use std::ptr::NonNull;

/// Who touches the memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Location {
    /// The device only.
    Device,
    /// Written by the CPU, read by the device; mapped and coherent.
    Upload,
    /// Written by the device, read by the CPU; mapped and coherent, cached where there is a choice.
    Readback,
}

/// What is asked of an [`Allocator`].
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// Name of the resource, for reports.
    pub name: &'a str,
    /// Size in bytes, alignment and allowed memory types.
    pub requirements: vk::MemoryRequirements,
    /// Who touches the memory.
    pub location: Location,
    /// True for buffers, false for images with optimal tiling.
    pub linear: bool,
}

/// A piece of device memory.
#[derive(Debug)]
pub struct Allocation {
    /// The memory object.
    pub memory: vk::DeviceMemory,
    /// Where the piece starts, in bytes.
    pub offset: u64,
    /// Its size in bytes; at least what was asked for.
    pub size: u64,
    /// Where its first byte is mapped, if it is.
    pub mapped: Option<NonNull<c_void>>,
    /// The allocator's own number for it.
    pub token: u64,
}

// SAFETY: the pointer is an address in mapped device memory, valid on every thread; who uses it takes a lock.
unsafe impl Send for Allocation {}
// SAFETY: as above; a shared reference only copies the address.
unsafe impl Sync for Allocation {}

/// A source of device memory. Calls come one at a time, from any thread.
///
/// # Safety
/// `allocate` returns memory of the context's device that meets the request (type, alignment, size), overlaps no
/// other live allocation, and stays valid until it is freed. For [`Location::Upload`] and [`Location::Readback`]
/// it is host-coherent and `mapped` points to at least `size` bytes; for `Upload` and `Readback` no one else
/// writes through the mapping.
pub unsafe trait Allocator: Send {
    /// Finds memory for `request`, or says in words why not.
    fn allocate(&mut self, request: &Request<'_>) -> Result<Allocation, String>;

    /// Takes back what [`Allocator::allocate`] gave.
    fn free(&mut self, allocation: Allocation);
}

/// The default [`Allocator`]: gpu-allocator's blocks.
pub struct BlockAllocator {
    inner: sub::Allocator,
    live: BTreeMap<u64, sub::Allocation>,
    next: u64,
}

impl BlockAllocator {
    /// An allocator for `device`.
    pub(crate) fn new(
        instance: &ash::Instance,
        device: &ash::Device,
        physical_device: vk::PhysicalDevice,
    ) -> Result<Self, String> {
        let inner = sub::Allocator::new(&sub::AllocatorCreateDesc {
            instance: instance.clone(),
            device: device.clone(),
            physical_device,
            debug_settings: Default::default(),
            buffer_device_address: false,
            allocation_sizes: Default::default(),
        })
        .map_err(|error| error.to_string())?;
        Ok(Self { inner, live: BTreeMap::new(), next: 0 })
    }
}

// SAFETY: gpu-allocator hands out disjoint pieces of live memory of the requested type and alignment, and maps
// what is asked for as CpuToGpu or GpuToCpu, both of which it takes from coherent memory types only.
unsafe impl Allocator for BlockAllocator {
    fn allocate(&mut self, request: &Request<'_>) -> Result<Allocation, String> {
        let location = match request.location {
            Location::Device => MemoryLocation::GpuOnly,
            Location::Upload => MemoryLocation::CpuToGpu,
            Location::Readback => MemoryLocation::GpuToCpu,
        };
        let piece = self
            .inner
            .allocate(&sub::AllocationCreateDesc {
                name: request.name,
                requirements: request.requirements,
                location,
                linear: request.linear,
                allocation_scheme: sub::AllocationScheme::GpuAllocatorManaged,
            })
            .map_err(|error| error.to_string())?;
        let token = self.next;
        self.next += 1;
        let allocation = Allocation {
            // SAFETY: the memory is only bound and mapped through the allocation, never freed directly.
            memory: unsafe { piece.memory() },
            offset: piece.offset(),
            size: piece.size(),
            mapped: piece.mapped_ptr(),
            token,
        };
        self.live.insert(token, piece);
        Ok(allocation)
    }

    fn free(&mut self, allocation: Allocation) {
        if let Some(piece) = self.live.remove(&allocation.token) {
            // Freeing fails only for an allocation of another allocator, which the token rules out.
            let _ = self.inner.free(piece);
        }
    }
}
