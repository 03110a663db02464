//! Vulkan's functions, found through the host's get-proc-addr and probed before anything is loaded.
//!
//! What is core in one version was an extension's before; drivers, layers and engines' own get-proc-addr know one name,
//! the other, or both. Both are asked for, the one that suits the device's version first.
//!
//! ash replaces a null pointer by a stub that panics when called. Every function this library calls is
//! therefore asked for by name first, and a null one is an error that names it.

use crate::adopt::AdoptInfo;
use crate::error::GpuError;
use crate::requirements::CALIBRATED_TIMESTAMPS;
use ash::vk;
use std::ffi::{CStr, c_char, c_void};

/// Instance functions the library calls.
pub(crate) const INSTANCE: &[&CStr] = &[
    c"vkGetPhysicalDeviceProperties",
    c"vkGetPhysicalDeviceMemoryProperties",
    c"vkGetPhysicalDeviceProperties2",
    c"vkGetPhysicalDeviceFormatProperties",
    c"vkGetPhysicalDeviceImageFormatProperties",
    c"vkGetPhysicalDeviceQueueFamilyProperties",
];

/// Device functions the library calls, by their names in Vulkan 1.3.
pub(crate) const DEVICE: &[&CStr] = &[
    c"vkAllocateDescriptorSets",
    c"vkAllocateMemory",
    c"vkBindBufferMemory",
    c"vkBindImageMemory",
    c"vkCmdBeginQuery",
    c"vkCmdBeginRendering",
    c"vkCmdBindDescriptorSets",
    c"vkCmdBindIndexBuffer",
    c"vkCmdBindPipeline",
    c"vkCmdBindVertexBuffers",
    c"vkCmdCopyBuffer",
    c"vkCmdCopyBufferToImage",
    c"vkCmdCopyImageToBuffer",
    c"vkCmdDispatch",
    c"vkCmdDispatchIndirect",
    c"vkCmdDraw",
    c"vkCmdDrawIndexed",
    c"vkCmdDrawIndexedIndirect",
    c"vkCmdDrawIndirect",
    c"vkCmdEndQuery",
    c"vkCmdEndRendering",
    c"vkCmdFillBuffer",
    c"vkCmdPipelineBarrier2",
    c"vkCmdPushConstants",
    c"vkCmdResetQueryPool",
    c"vkCmdSetScissor",
    c"vkCmdSetViewport",
    c"vkCmdWriteTimestamp2",
    c"vkCreateBuffer",
    c"vkCreateComputePipelines",
    c"vkCreateDescriptorPool",
    c"vkCreateDescriptorSetLayout",
    c"vkCreateGraphicsPipelines",
    c"vkCreateImage",
    c"vkCreateImageView",
    c"vkCreatePipelineLayout",
    c"vkCreateQueryPool",
    c"vkCreateSampler",
    c"vkCreateShaderModule",
    c"vkDestroyBuffer",
    c"vkDestroyDescriptorPool",
    c"vkDestroyDescriptorSetLayout",
    c"vkDestroyImage",
    c"vkDestroyImageView",
    c"vkDestroyPipeline",
    c"vkDestroyPipelineLayout",
    c"vkDestroyQueryPool",
    c"vkDestroySampler",
    c"vkDestroyShaderModule",
    c"vkFreeMemory",
    c"vkGetBufferMemoryRequirements",
    c"vkGetImageMemoryRequirements",
    c"vkGetQueryPoolResults",
    c"vkMapMemory",
    c"vkResetDescriptorPool",
    c"vkUnmapMemory",
    c"vkUpdateDescriptorSets",
];

/// Functions of VK_EXT_debug_utils that the library calls when the host enabled the extension.
const DEBUG: &[&CStr] =
    &[c"vkSetDebugUtilsObjectNameEXT", c"vkCmdBeginDebugUtilsLabelEXT", c"vkCmdEndDebugUtilsLabelEXT"];

/// The function of VK_KHR_calibrated_timestamps; VK_EXT_calibrated_timestamps has it by its name from before.
const CALIBRATED: &[&CStr] = &[c"vkGetCalibratedTimestampsKHR"];

/// The tables of one device.
pub(crate) struct Functions {
    pub instance: ash::Instance,
    pub device: ash::Device,
    /// Present when VK_EXT_debug_utils is enabled.
    pub debug: Option<ash::ext::debug_utils::DeviceFn>,
    /// Present when an extension for calibrated timestamps is enabled.
    pub calibrated_timestamps: Option<vk::PFN_vkGetCalibratedTimestampsKHR>,
}

/// A function's address, or null.
type Address = *const c_void;

/// Core names and the names they had before.
const PROMOTED: &[(&CStr, &CStr)] = &[
    (c"vkCmdBeginRendering", c"vkCmdBeginRenderingKHR"),
    (c"vkCmdEndRendering", c"vkCmdEndRenderingKHR"),
    (c"vkCmdPipelineBarrier2", c"vkCmdPipelineBarrier2KHR"),
    (c"vkCmdWriteTimestamp2", c"vkCmdWriteTimestamp2KHR"),
    (c"vkGetPhysicalDeviceProperties2", c"vkGetPhysicalDeviceProperties2KHR"),
    (c"vkGetCalibratedTimestampsKHR", c"vkGetCalibratedTimestampsEXT"),
];

/// `name` by either of its names.
fn either(name: &CStr, core_first: bool, lookup: impl Fn(&CStr) -> Address) -> Address {
    let Some((core, before)) = PROMOTED.iter().find(|(core, _)| *core == name) else { return lookup(name) };
    let [first, second] = if core_first { [core, before] } else { [before, core] };
    match lookup(first) {
        found if !found.is_null() => found,
        _ => lookup(second),
    }
}

/// Probes every name, then loads ash's tables.
///
/// # Safety
/// The handles are alive and belong together; the get-proc-addr functions are theirs.
pub(crate) unsafe fn load(info: &AdoptInfo<'_>) -> Result<Functions, GpuError> {
    let get_instance_proc_addr = info.get_instance_proc_addr;
    let instance_address = |name: &CStr| -> Address {
        // SAFETY: the caller vouches for function and handle; the name ends in a nul.
        address(unsafe { get_instance_proc_addr(info.instance, name.as_ptr()) })
    };
    let core_first = info.api_version >= vk::API_VERSION_1_1;
    let instance_address = |name: &CStr| either(name, core_first, instance_address);
    probe(INSTANCE, instance_address)?;
    // SAFETY: the addresses come from the handle's own get-proc-addr.
    let instance = unsafe { ash::Instance::load_with(instance_address, info.instance) };
    let get_device_proc_addr = match info.get_device_proc_addr {
        Some(function) => function,
        None => {
            // SAFETY: as above; the function of that name has that type.
            unsafe {
                std::mem::transmute::<vk::PFN_vkVoidFunction, Option<vk::PFN_vkGetDeviceProcAddr>>(
                    get_instance_proc_addr(info.instance, c"vkGetDeviceProcAddr".as_ptr()),
                )
            }
            .ok_or(GpuError::MissingFunction { name: "vkGetDeviceProcAddr" })?
        }
    };
    // SAFETY: the caller vouches for the handle; the function was probed.
    let properties = unsafe { instance.get_physical_device_properties(info.physical_device) };
    // Below 1.3 some drivers answer to core names all the same, with functions that do nothing good.
    let core_first = properties.api_version.min(info.api_version) >= vk::API_VERSION_1_3;
    let device_address = |name: &CStr| -> Address {
        // SAFETY: as for the instance.
        either(name, core_first, |name| address(unsafe { get_device_proc_addr(info.device, name.as_ptr()) }))
    };
    probe(DEVICE, device_address)?;
    // Some loaders give the extension's device functions only through the instance.
    let debug_address = |name: &CStr| match device_address(name) {
        address if address.is_null() => instance_address(name),
        address => address,
    };
    let debug_utils = info.extensions.contains(&"VK_EXT_debug_utils");
    if debug_utils {
        probe(DEBUG, debug_address)?;
    }
    let calibrated = CALIBRATED_TIMESTAMPS.iter().any(|name| info.extensions.contains(name));
    let calibrated_timestamps = match calibrated {
        true => {
            probe(CALIBRATED, device_address)?;
            let address = device_address(CALIBRATED[0]);
            // SAFETY: the address is that of the function, by one of its two names, which has this type.
            Some(unsafe { std::mem::transmute::<Address, vk::PFN_vkGetCalibratedTimestampsKHR>(address) })
        }
        false => None,
    };
    // SAFETY: as for the instance.
    let device = unsafe { ash::Device::load_with(device_address, info.device) };
    let debug = debug_utils.then(|| ash::ext::debug_utils::DeviceFn::load(debug_address));
    Ok(Functions { instance, device, debug, calibrated_timestamps })
}

fn address(function: Option<unsafe extern "system" fn()>) -> Address {
    function.map_or(std::ptr::null(), |function| function as Address)
}

/// The first of `names` that `lookup` does not know, as an error.
fn probe(names: &'static [&'static CStr], lookup: impl Fn(&CStr) -> Address) -> Result<(), GpuError> {
    match names.iter().find(|name| lookup(name).is_null()) {
        Some(name) => Err(GpuError::MissingFunction { name: name.to_str().unwrap_or("(unnamed)") }),
        None => Ok(()),
    }
}

/// `text` as a nul-terminated string of at most 127 bytes, without touching the heap.
pub(crate) fn with_c_string<R>(text: &str, run: impl FnOnce(*const c_char) -> R) -> R {
    let mut bytes = [0u8; 128];
    let length = text.len().min(bytes.len() - 1);
    bytes[..length].copy_from_slice(&text.as_bytes()[..length]);
    run(bytes.as_ptr().cast())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn either_name_serves() {
        let (core, before) = (c"vkCmdPipelineBarrier2", c"vkCmdPipelineBarrier2KHR");
        let known = |names: &'static [&'static CStr]| {
            move |name: &CStr| match names.iter().position(|known| *known == name) {
                Some(index) => (index + 1) as Address,
                None => std::ptr::null(),
            }
        };
        for core_first in [false, true] {
            assert_eq!(either(core, core_first, known(&[c"vkCmdPipelineBarrier2"])) as usize, 1);
            assert_eq!(either(core, core_first, known(&[c"vkCmdPipelineBarrier2KHR"])) as usize, 1);
            assert!(either(core, core_first, known(&[])).is_null());
            assert!(either(c"vkCmdDraw", core_first, known(&[c"vkCmdDrawKHR"])).is_null());
        }
        let both = known(&[c"vkCmdPipelineBarrier2", c"vkCmdPipelineBarrier2KHR"]);
        assert_eq!((either(core, true, both) as usize, either(core, false, both) as usize), (1, 2));
        assert!(PROMOTED.contains(&(core, before)));
        let called = |name| [DEVICE, INSTANCE, CALIBRATED].iter().any(|names| names.contains(&name));
        assert!(PROMOTED.iter().all(|(core, _)| called(*core)));
    }
}
