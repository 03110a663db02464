//! The host's memory behind two callbacks.

use std::ffi::{CString, c_char, c_void};
use std::ptr::NonNull;

use airglow_gpu::ash::{vk, vk::Handle};
use airglow_gpu::{Allocation, Allocator, Location, Request};

use crate::input::Versioned;

/// Who touches a piece of memory.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowLocation {
    /// The device only.
    Device = 0,
    /// Written by the CPU, read by the device: mapped, host-coherent.
    Upload = 1,
    /// Written by the device, read by the CPU: mapped, host-coherent, cached where there is a choice.
    Readback = 2,
}

/// Device memory that the library asks the host for.
#[repr(C)]
pub struct AirglowMemoryRequest {
    /// Name of the resource, valid during the call.
    pub name: *const c_char,
    /// Bytes.
    pub size: u64,
    /// Alignment of the offset in bytes.
    pub alignment: u64,
    /// Memory types allowed, as `VkMemoryRequirements::memoryTypeBits`.
    pub memory_type_bits: u32,
    /// An `AirglowLocation`.
    pub location: u32,
    /// 1 for a buffer, 0 for an image with optimal tiling.
    pub linear: u32,
    /// Not used.
    pub reserved: u32,
}

/// A piece of device memory that the host gives.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowAllocation {
    /// The `VkDeviceMemory`.
    pub memory: u64,
    /// Where the piece starts, in bytes.
    pub offset: u64,
    /// Its bytes, at least what was asked for.
    pub size: u64,
    /// Where its first byte is mapped; null for memory of the device only.
    pub mapped: *mut c_void,
    /// The host's own number for it, handed back when it is freed.
    pub token: u64,
}

/// The host's memory. Calls come one at a time, on the threads that call the library.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowAllocator {
    /// `sizeof(AirglowAllocator)`.
    pub struct_size: u32,
    /// Not used.
    pub reserved: u32,
    /// Handed to both functions.
    pub user: *mut c_void,
    /// Fills the allocation and returns 0, or returns a `VkResult` below 0. The memory is the context's device's, meets
    /// the request, overlaps no other live piece, and stays until it is freed.
    pub allocate: Option<
        unsafe extern "C" fn(
            user: *mut c_void,
            request: *const AirglowMemoryRequest,
            allocation: *mut AirglowAllocation,
        ) -> i32,
    >,
    /// Takes back what `allocate` gave.
    pub free: Option<unsafe extern "C" fn(user: *mut c_void, allocation: *const AirglowAllocation)>,
}

// SAFETY: `#[repr(C)]`, its size first, integers, a pointer and optional functions; fields of 8 bytes are at multiples
// of 8.
unsafe impl Versioned for AirglowAllocator {
    const OLDEST: usize = size_of::<Self>();
}

/// An [`AirglowAllocator`] that has both functions.
pub(crate) struct HostAllocator {
    user: *mut c_void,
    allocate: unsafe extern "C" fn(*mut c_void, *const AirglowMemoryRequest, *mut AirglowAllocation) -> i32,
    free: unsafe extern "C" fn(*mut c_void, *const AirglowAllocation),
}

impl HostAllocator {
    /// `None` where a function is null.
    pub(crate) fn new(host: AirglowAllocator) -> Option<Self> {
        Some(Self { user: host.user, allocate: host.allocate?, free: host.free? })
    }
}

// SAFETY: `AirglowAllocator` says that calls come on any thread; the pointer is only handed back to the host.
unsafe impl Send for HostAllocator {}

// SAFETY: `AirglowAllocator` asks of the host what this trait asks of its implementers; what can be checked is checked.
unsafe impl Allocator for HostAllocator {
    fn allocate(&mut self, request: &Request<'_>) -> Result<Allocation, String> {
        let name = CString::new(request.name).unwrap_or_default();
        let location = match request.location {
            Location::Device => AirglowLocation::Device,
            Location::Upload => AirglowLocation::Upload,
            Location::Readback => AirglowLocation::Readback,
        };
        let asked = AirglowMemoryRequest {
            name: name.as_ptr(),
            size: request.requirements.size,
            alignment: request.requirements.alignment,
            memory_type_bits: request.requirements.memory_type_bits,
            location: location as u32,
            linear: u32::from(request.linear),
            reserved: 0,
        };
        let mut given =
            AirglowAllocation { memory: 0, offset: 0, size: 0, mapped: std::ptr::null_mut(), token: 0 };
        // SAFETY: the host's function with the host's pointer; both structures outlive the call.
        let result = unsafe { (self.allocate)(self.user, &raw const asked, &raw mut given) };
        if result != 0 {
            return Err(format!("the host's allocator returned {:?}", vk::Result::from_raw(result)));
        }
        let mapped = NonNull::new(given.mapped);
        let unmapped = location != AirglowLocation::Device && mapped.is_none();
        let aligned = given.offset.checked_rem(asked.alignment).unwrap_or(0) == 0;
        if given.memory == 0 || given.size < asked.size || unmapped || !aligned {
            // SAFETY: the piece that the host's other function just gave.
            unsafe { (self.free)(self.user, &raw const given) };
            return Err(
                "the host's allocator gave memory that is null, too small, misaligned or not mapped".into()
            );
        }
        let memory = vk::DeviceMemory::from_raw(given.memory);
        Ok(Allocation { memory, offset: given.offset, size: given.size, mapped, token: given.token })
    }

    fn free(&mut self, allocation: Allocation) {
        let given = AirglowAllocation {
            memory: allocation.memory.as_raw(),
            offset: allocation.offset,
            size: allocation.size,
            mapped: allocation.mapped.map_or(std::ptr::null_mut(), NonNull::as_ptr),
            token: allocation.token,
        };
        // SAFETY: the host's function with a piece that its other one gave.
        unsafe { (self.free)(self.user, &raw const given) };
    }
}
