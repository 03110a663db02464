//! Vulkan's functions, found through the host's get-proc-addr and probed before anything is loaded.
//!
//! ash replaces a null pointer by a stub that panics when called. Every function this library calls is
//! therefore asked for by name first, and a null one is an error that names it.

use crate::error::GpuError;
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

/// Device functions the library calls; all are core in Vulkan 1.3.
pub(crate) const DEVICE: &[&CStr] = &[
    c"vkAllocateDescriptorSets",
    c"vkAllocateMemory",
    c"vkBindBufferMemory",
    c"vkBindImageMemory",
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

/// The tables of one device.
pub(crate) struct Functions {
    pub instance: ash::Instance,
    pub device: ash::Device,
    /// Present when VK_EXT_debug_utils is enabled.
    pub debug: Option<ash::ext::debug_utils::DeviceFn>,
}

/// A function's address, or null.
type Address = *const c_void;

/// Probes every name, then loads ash's tables.
///
/// # Safety
/// The handles are alive and belong together; the get-proc-addr functions are theirs.
pub(crate) unsafe fn load(
    get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    get_device_proc_addr: Option<vk::PFN_vkGetDeviceProcAddr>,
    instance: vk::Instance,
    device: vk::Device,
    debug_utils: bool,
) -> Result<Functions, GpuError> {
    let instance_address = |name: &CStr| -> Address {
        // SAFETY: the caller vouches for function and handle; the name ends in a nul.
        address(unsafe { get_instance_proc_addr(instance, name.as_ptr()) })
    };
    let get_device_proc_addr = match get_device_proc_addr {
        Some(function) => function,
        None => {
            // SAFETY: as above; the function of that name has that type.
            unsafe {
                std::mem::transmute::<vk::PFN_vkVoidFunction, Option<vk::PFN_vkGetDeviceProcAddr>>(
                    get_instance_proc_addr(instance, c"vkGetDeviceProcAddr".as_ptr()),
                )
            }
            .ok_or(GpuError::MissingFunction { name: "vkGetDeviceProcAddr" })?
        }
    };
    let device_address = |name: &CStr| -> Address {
        // SAFETY: as above.
        address(unsafe { get_device_proc_addr(device, name.as_ptr()) })
    };
    probe(INSTANCE, instance_address)?;
    probe(DEVICE, device_address)?;
    // Some loaders give the extension's device functions only through the instance.
    let debug_address = |name: &CStr| match device_address(name) {
        address if address.is_null() => instance_address(name),
        address => address,
    };
    if debug_utils {
        probe(DEBUG, debug_address)?;
    }
    // SAFETY: the addresses come from the handles' own get-proc-addr.
    unsafe {
        Ok(Functions {
            instance: ash::Instance::load_with(instance_address, instance),
            device: ash::Device::load_with(device_address, device),
            debug: debug_utils.then(|| ash::ext::debug_utils::DeviceFn::load(debug_address)),
        })
    }
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
