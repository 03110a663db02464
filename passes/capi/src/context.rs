//! The library's side of a host's device: adopted from handles, dropped when the device is done with it.

use std::ffi::{c_char, c_void};
use std::mem::offset_of;
use std::sync::Arc;

use airglow_gpu::ash::{vk, vk::Handle};
use airglow_gpu::{AdoptInfo, Allocator, Context, FeatureSet, GpuError, Options};
use serde_json::json;

use crate::allocator::{AirglowAllocator, HostAllocator};
use crate::input::{Versioned, array, exclusive, shared, store, string, take, versioned};
use crate::physical::{AirglowFunction, features_named, get_instance_proc_addr};
use crate::requirements::AirglowRequirements;
use crate::status::{AirglowError, AirglowStatus, Failure, edge};
use crate::text::{AirglowText, write_text};

/// A device as the library sees it. Many can live in one process. Any thread may use it; `airglow_context_begin_frame`
/// and `airglow_context_drop` are to be called while no other call uses it.
pub struct AirglowContext {
    pub(crate) context: Arc<Context>,
}

/// A device as its host states it. Handles are Vulkan's own as integers, 0 for null.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowAdoptInfo {
    /// `sizeof(AirglowAdoptInfo)`.
    pub struct_size: u32,
    /// API version the instance was made for, as `VK_MAKE_API_VERSION` packs it.
    pub api_version: u32,
    /// What the passes in use ask for; null for the library alone. Read during the call.
    pub requirements: *const AirglowRequirements,
    /// `vkGetInstanceProcAddr`, the loader's or the host's own in front of it.
    pub get_instance_proc_addr: AirglowFunction,
    /// `vkGetDeviceProcAddr`; null asks the instance for it.
    pub get_device_proc_addr: AirglowFunction,
    /// The `VkInstance`.
    pub instance: u64,
    /// The `VkPhysicalDevice`.
    pub physical_device: u64,
    /// The `VkDevice`.
    pub device: u64,
    /// Family of the queue that commands will be submitted to.
    pub queue_family: u32,
    /// How many frames may be on the device or being recorded at once, at least 1.
    pub frames_in_flight: u32,
    /// The `VkDeviceCreateInfo` that the device was made with, or null: extensions and features are read from it, its
    /// `pEnabledFeatures` and its `pNext` chain, during the call. What is named below is added.
    pub device_create_info: *const c_void,
    /// Names of extensions that the host enabled, of instance and device. `VK_EXT_debug_utils` among them turns on names
    /// and labels.
    pub extension_names: *const *const c_char,
    /// How many.
    pub extension_count: usize,
    /// Names of features that the host enabled, as their fields are called in the Vulkan specification.
    pub feature_names: *const *const c_char,
    /// How many.
    pub feature_count: usize,
    /// The host's memory, or null for blocks of the library's own. Copied; what it points at lives as long as the
    /// context and all that was made from it.
    pub allocator: *const AirglowAllocator,
    /// The host's `VkPipelineCache`, or 0.
    pub pipeline_cache: u64,
    /// Most bytes of device memory that all made from the context may hold; 0 for no bound.
    pub memory_budget: u64,
    /// 1: each step writes its number where `airglow_context_last_pass_reached` finds it after a loss. It keeps passes
    /// from overlapping: for hunting a loss, not for shipping.
    pub breadcrumbs: u32,
    /// Not used; 0.
    pub reserved: u32,
    /// Where a JSON array of what the device lacks is written, one text each, when adopting fails for that; or null.
    pub missing: *mut AirglowText,
}

// SAFETY: `#[repr(C)]`, its size first, integers, pointers and optional functions; fields of 8 bytes are at multiples
// of 8.
unsafe impl Versioned for AirglowAdoptInfo {
    const OLDEST: usize = offset_of!(Self, extension_names);
}

/// Adopts the host's device. Nothing is submitted, waited for or started, now or later.
///
/// # Safety
/// The handles are alive and belong together, and `info` states truly what was enabled on them. Instance and device
/// outlive the context and all that was made from it; before the last of those is dropped, the device has finished all
/// work recorded through it. The pipeline cache is not used by another thread while pipelines are made.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_context_adopt(
    info: *const AirglowAdoptInfo,
    context: *mut *mut AirglowContext,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers and handles.
    unsafe {
        edge(error, || {
            store(context, "context", || {
                let context = Arc::new(adopt(&versioned(info, "info")?)?);
                Ok(Box::into_raw(Box::new(AirglowContext { context })))
            })
        })
    }
}

/// # Safety
/// As [`airglow_context_adopt`].
unsafe fn adopt(info: &AirglowAdoptInfo) -> Result<Context, Failure> {
    for (name, handle) in
        [("instance", info.instance), ("physical_device", info.physical_device), ("device", info.device)]
    {
        if handle == 0 {
            return Err(Failure::argument(name, "it is null"));
        }
    }
    // SAFETY: the caller vouches for pointers, functions and handles.
    unsafe {
        let (extensions, features) = enabled(info)?;
        let none = airglow_gpu::Requirements::engine();
        let requirements = match info.requirements.is_null() {
            true => &none,
            false => &shared(info.requirements, "requirements")?.asked,
        };
        let options = Options {
            memory_budget: Some(info.memory_budget).filter(|budget| *budget > 0),
            breadcrumbs: info.breadcrumbs != 0,
            ..Options::default()
        };
        let adopted = Context::adopt(AdoptInfo {
            get_instance_proc_addr: get_instance_proc_addr(info.get_instance_proc_addr)?,
            get_device_proc_addr: std::mem::transmute::<AirglowFunction, Option<vk::PFN_vkGetDeviceProcAddr>>(
                info.get_device_proc_addr,
            ),
            instance: vk::Instance::from_raw(info.instance),
            api_version: info.api_version,
            physical_device: vk::PhysicalDevice::from_raw(info.physical_device),
            device: vk::Device::from_raw(info.device),
            queue_family: info.queue_family,
            features,
            extensions: &extensions,
            requirements,
            allocator: allocator(info.allocator)?,
            pipeline_cache: vk::PipelineCache::from_raw(info.pipeline_cache),
            frames_in_flight: info.frames_in_flight,
            options,
        });
        if let (Err(GpuError::Missing(missing)), false) = (&adopted, info.missing.is_null()) {
            let texts: Vec<_> = missing.iter().map(ToString::to_string).collect();
            // A list that was cut says its length; the message names everything too.
            let _ = write_text(info.missing, &json!(texts).to_string());
        }
        Ok(adopted?)
    }
}

/// Extensions and features that the host enabled, by either way of saying so.
///
/// # Safety
/// As [`airglow_context_adopt`]; what `info` points at outlives the result.
pub(crate) unsafe fn enabled<'a>(info: &AirglowAdoptInfo) -> Result<(Vec<&'a str>, FeatureSet), Failure> {
    // SAFETY: the caller's promise is ours.
    unsafe {
        let (mut extensions, features) = created(info.device_create_info.cast())?;
        for &name in array(info.extension_names, info.extension_count, "extension_names")? {
            extensions.push(string(name, "an extension name", "")?);
        }
        let named = features_named(info.feature_names, info.feature_count)?;
        Ok((extensions, features.iter().chain(named.iter()).collect()))
    }
}

/// Extensions and features that a `VkDeviceCreateInfo` enabled.
///
/// # Safety
/// `info` is null or valid, and outlives the result.
unsafe fn created<'a>(info: *const vk::DeviceCreateInfo<'a>) -> Result<(Vec<&'a str>, FeatureSet), Failure> {
    if info.is_null() {
        return Ok((Vec::new(), FeatureSet::default()));
    }
    // SAFETY: the caller vouches for the structure and all it points at.
    unsafe {
        let info = shared(info, "device_create_info")?;
        if info.s_type != vk::StructureType::DEVICE_CREATE_INFO {
            return Err(Failure::argument("device_create_info", "its sType is of another structure"));
        }
        let count = info.enabled_extension_count as usize;
        let names = array(info.pp_enabled_extension_names, count, "ppEnabledExtensionNames")?;
        let names: Result<_, _> = names.iter().map(|&name| string(name, "an extension name", "")).collect();
        Ok((names?, FeatureSet::of_chain(info.p_next, info.p_enabled_features.as_ref())))
    }
}

/// # Safety
/// As [`AirglowAllocator`] says.
unsafe fn allocator(host: *const AirglowAllocator) -> Result<Option<Box<dyn Allocator>>, Failure> {
    if host.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's promise is ours.
    let host = HostAllocator::new(unsafe { versioned(host, "allocator")? });
    match host {
        Some(host) => Ok(Some(Box::new(host))),
        None => Err(Failure::argument("allocator", "it needs both functions")),
    }
}

/// Starts frame `frame`: memory of the frame `frames_in_flight` earlier is used again, and what was dropped that long
/// ago is destroyed. Frame 0 has begun when the context is made; frames count up.
///
/// # Safety
/// The device has finished everything recorded in frames up to `frame - frames_in_flight`, and those command buffers
/// will not be submitted again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_context_begin_frame(
    context: *const AirglowContext,
    frame: u64,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the context and for the frames.
    unsafe { edge(error, || Ok(shared(context, "context")?.context.begin_frame(frame)?)) }
}

/// What the device memory is held for, as JSON: `[{"owner": "relight", "bytes": 1024, "objects": 2}]`, sorted by owner.
///
/// # Safety
/// `text` as `AirglowText` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_context_memory_json(
    context: *const AirglowContext,
    text: *mut AirglowText,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let report = shared(context, "context")?.context.memory_report();
            let rows: Vec<_> = report
                .iter()
                .map(|row| json!({ "owner": row.owner, "bytes": row.bytes, "objects": row.objects }))
                .collect();
            write_text(text, &json!(rows).to_string())
        })
    }
}

/// How far a device came.
#[repr(C)]
pub struct AirglowPassReached {
    /// 1 if a step was begun; 0 without breadcrumbs, or when no step of the frames in flight was begun.
    pub reached: u32,
    /// 1 if the step was done, too.
    pub finished: u32,
    /// The frame of the step.
    pub frame: u64,
}

/// The last step that the device began, by the breadcrumbs it wrote, for after a loss; `name` gets the step's name.
///
/// # Safety
/// `reached` may be written; `name` as `AirglowText` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_context_last_pass_reached(
    context: *const AirglowContext,
    reached: *mut AirglowPassReached,
    name: *mut AirglowText,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let reached = exclusive(reached, "reached")?;
            let last = shared(context, "context")?.context.last_pass_reached()?;
            *reached =
                last.as_ref().map_or(AirglowPassReached { reached: 0, finished: 0, frame: 0 }, |last| {
                    AirglowPassReached { reached: 1, finished: last.finished.into(), frame: last.frame }
                });
            write_text(name, last.as_ref().map_or("", |last| &last.pass))
        })
    }
}

/// Drops the context. What was made from it may be dropped before or after. Null is nothing.
///
/// # Safety
/// The pointer is not used again. When the context and all that was made from it are dropped, the device exists and has
/// finished all work recorded through them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_context_drop(context: *mut AirglowContext) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { edge(std::ptr::null_mut(), || take(context)) };
}
