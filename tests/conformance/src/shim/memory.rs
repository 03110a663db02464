//! A device on which no memory is both the device's and the CPU's, as cards have it whose memory cannot be mapped: the
//! true device's memory is told as two types, one that the device alone reaches and one that the CPU maps. What goes
//! from one to the other has to be copied.

use super::{real, watch};
use airglow_gpu::ash::vk::{self, Handle, MemoryPropertyFlags as Flags};
use std::collections::BTreeMap;
use std::ffi::{CStr, c_char};
use std::mem::transmute;

/// The type that the device alone reaches, and the one that the CPU maps, in the order they are told.
const TOLD: [Flags; 2] = [
    Flags::DEVICE_LOCAL,
    Flags::from_raw(
        Flags::HOST_VISIBLE.as_raw() | Flags::HOST_COHERENT.as_raw() | Flags::HOST_CACHED.as_raw(),
    ),
];
/// What both types are on the true device.
const NEEDED: Flags = Flags::from_raw(
    Flags::DEVICE_LOCAL.as_raw() | Flags::HOST_VISIBLE.as_raw() | Flags::HOST_COHERENT.as_raw(),
);

/// Memory by the type it was told as.
#[derive(Default)]
pub(super) struct Separate {
    /// The true type behind both; none where memory is told as it is.
    truth: Option<u32>,
    told: BTreeMap<u64, u32>,
    /// Allocations of each type so far.
    made: [u64; 2],
}

impl Separate {
    /// Tells memory as two types from here on, where the device has one that can be both.
    pub(super) fn begin(&mut self, memory: &vk::PhysicalDeviceMemoryProperties) -> bool {
        let types = memory.memory_types_as_slice();
        self.truth = types.iter().position(|found| found.property_flags.contains(NEEDED)).map(|at| at as u32);
        self.truth.is_some()
    }

    /// Whether memory is told as two types.
    pub(super) fn is_told(&self) -> bool {
        self.truth.is_some()
    }

    /// Allocations of memory that the device alone reaches, and of memory that the CPU maps.
    pub(super) fn made(&self) -> [u64; 2] {
        self.made
    }
}

/// The memory of a physical device as it is told.
pub(super) unsafe extern "system" fn properties(
    _: vk::PhysicalDevice,
    out: *mut vk::PhysicalDeviceMemoryProperties,
) {
    let mut told = vk::PhysicalDeviceMemoryProperties::default();
    (told.memory_type_count, told.memory_heap_count) = (2, 2);
    for (index, flags) in TOLD.into_iter().enumerate() {
        told.memory_types[index] = vk::MemoryType { property_flags: flags, heap_index: index as u32 };
        let local = [vk::MemoryHeapFlags::DEVICE_LOCAL, vk::MemoryHeapFlags::empty()][index];
        told.memory_heaps[index] = vk::MemoryHeap { size: 1 << 32, flags: local };
    }
    // SAFETY: the caller has room for them.
    unsafe { out.write(told) };
}

/// The types that a resource may have, as they are told: both, where the true one may be had.
pub(super) fn requirements(found: &mut vk::MemoryRequirements) {
    watch(|watch| {
        if let Some(truth) = watch.separate.truth {
            found.memory_type_bits = if found.memory_type_bits & (1 << truth) != 0 { 0b11 } else { 0 };
        }
    });
}

/// The true allocation behind one that is asked for.
pub(super) fn asked(info: &vk::MemoryAllocateInfo<'static>) -> vk::MemoryAllocateInfo<'static> {
    let truth = watch(|watch| watch.separate.truth).unwrap_or(info.memory_type_index);
    vk::MemoryAllocateInfo { memory_type_index: truth, ..*info }
}

/// Notes what memory was asked for as.
pub(super) fn note(info: &vk::MemoryAllocateInfo<'_>, memory: vk::DeviceMemory) {
    watch(|watch| {
        let separate = &mut watch.separate;
        if separate.truth.is_some() {
            separate.told.insert(memory.as_raw(), info.memory_type_index);
            separate
                .made
                .iter_mut()
                .skip(info.memory_type_index as usize)
                .take(1)
                .for_each(|made| *made += 1);
        }
    });
}

/// Whether the CPU maps the memory.
pub(super) fn maps(memory: vk::DeviceMemory) -> bool {
    watch(|watch| watch.separate.told.get(&memory.as_raw()).is_none_or(|told| *told == 1))
}

/// The get-proc-addr that tells memory so, in front of the loader's.
pub(super) unsafe extern "system" fn get_instance_proc_addr(
    instance: vk::Instance,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    const PROPERTIES: &CStr = c"vkGetPhysicalDeviceMemoryProperties";
    // SAFETY: the library passes names that end in a nul; the true function has the signature of its name.
    unsafe {
        if CStr::from_ptr(name) == PROPERTIES {
            return Some(
                transmute::<vk::PFN_vkGetPhysicalDeviceMemoryProperties, unsafe extern "system" fn()>(
                    properties,
                ),
            );
        }
        transmute::<usize, vk::PFN_vkGetInstanceProcAddr>(real(super::LOADER))(instance, name)
    }
}
