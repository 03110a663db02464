//! A device of its own, for command-line tools and tests: never for hosts.
//!
//! What opens here goes through the same road as any host's device: [`OpenDevice::adopt`] calls
//! [`Context::adopt`] with raw handles. Submitting and waiting live here only.

mod instance;
mod messages;
mod select;
mod submit;

pub use messages::{Message, MessageLog};
pub use select::{DeviceKind, DeviceLine, Selector};
pub use submit::{FrameLoop, FrameSemaphores};

use crate::adopt::AdoptInfo;
use crate::context::Context;
use crate::error::GpuError;
use crate::feature::{FeatureSet, FeatureStructs};
use crate::options::Options;
use crate::requirements::Requirements;
use ash::vk;
use instance::Instance;
use std::ffi::CStr;

/// How a device is opened.
#[derive(Clone, Debug)]
pub struct OpenOptions<'a> {
    /// Which device.
    pub selector: Selector,
    /// Core and synchronisation validation, with every message from warnings up collected. Fails without the layer.
    pub validation: bool,
    /// What will run on it; [`Requirements::engine`] is added. Optional features and extensions are enabled where
    /// supported.
    pub requirements: &'a Requirements,
    /// Instance extensions beside VK_EXT_debug_utils, such as those a window needs.
    pub instance_extensions: &'a [&'a CStr],
    /// Device extensions, such as VK_KHR_swapchain.
    pub device_extensions: &'a [&'a CStr],
}

impl<'a> OpenOptions<'a> {
    /// A real GPU if there is one, no validation, nothing beyond `requirements`.
    pub fn new(requirements: &'a Requirements) -> Self {
        Self {
            selector: Selector::default(),
            validation: false,
            requirements,
            instance_extensions: &[],
            device_extensions: &[],
        }
    }
}

/// An instance, a device and a queue of our own.
///
/// Every [`Context`] adopted from it, and everything made from those, must be dropped before it.
pub struct OpenDevice {
    device: ash::Device,
    command_pool: vk::CommandPool,
    queue: vk::Queue,
    queue_family: u32,
    physical_device: vk::PhysicalDevice,
    line: DeviceLine,
    features: FeatureSet,
    extensions: Vec<String>,
    requirements: Requirements,
    /// Dropped after the device is destroyed.
    instance: Instance,
}

/// Every device the loader knows, in its order.
///
/// # Errors
/// [`GpuError::Misuse`] without a Vulkan loader, [`GpuError::Vulkan`] if it fails.
pub fn devices() -> Result<Vec<DeviceLine>, GpuError> {
    let instance = Instance::new(&[], false)?;
    Ok(select::list(&instance.raw)?.into_iter().map(|(_, line)| line).collect())
}

impl OpenDevice {
    /// Opens a device.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] without a loader, without a device that `selector` means (all are listed), or without the
    /// validation layer; [`GpuError::Missing`] or [`GpuError::Vulkan`] if the device lacks what is asked for.
    pub fn open(options: &OpenOptions<'_>) -> Result<Self, GpuError> {
        let requirements = Requirements::engine().and(options.requirements);
        let instance = Instance::new(options.instance_extensions, options.validation)?;
        let (physical_device, line) = select::choose(&instance.raw, &options.selector)?;
        let queue_family = select::queue_family(&instance.raw, physical_device, requirements.queue)?;
        let supported = select::supported(&instance.raw, physical_device, &line)?;
        let features = requirements.features_to_enable(supported).intersection(supported);
        let optional = select::optional_extensions(&instance.raw, physical_device, &requirements)?;
        let extensions = [options.device_extensions, &required(&requirements)?, &optional].concat();
        let device = make_device(&instance.raw, physical_device, queue_family, features, &extensions)?;
        let info = vk::CommandPoolCreateInfo::default()
            .queue_family_index(queue_family)
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
        // SAFETY: the device was made with one queue of that family; on an error it is destroyed again.
        let (queue, pool) = unsafe {
            let pool = device.create_command_pool(&info, None).inspect_err(|_| device.destroy_device(None));
            (device.get_device_queue(queue_family, 0), pool)
        };
        let names = extensions.iter().map(|name| name.to_string_lossy().into_owned());
        let debug_utils = instance.debug_utils.then(|| "VK_EXT_debug_utils".to_owned());
        Ok(Self {
            command_pool: pool.map_err(GpuError::vulkan("vkCreateCommandPool"))?,
            device,
            queue,
            queue_family,
            physical_device,
            line,
            features,
            extensions: names.chain(debug_utils).collect(),
            requirements,
            instance,
        })
    }

    /// What an engine would hand to [`Context::adopt`], for `frames_in_flight` frames. `extensions` takes the names.
    pub fn adopt_info<'a>(
        &'a self,
        extensions: &'a mut Vec<&'a str>,
        frames_in_flight: u32,
    ) -> AdoptInfo<'a> {
        extensions.extend(self.extensions.iter().map(String::as_str));
        AdoptInfo {
            get_instance_proc_addr: self.instance.entry.static_fn().get_instance_proc_addr,
            get_device_proc_addr: Some(self.instance.raw.fp_v1_0().get_device_proc_addr),
            instance: self.instance.raw.handle(),
            api_version: vk::API_VERSION_1_3,
            physical_device: self.physical_device,
            device: self.device.handle(),
            queue_family: self.queue_family,
            features: self.features,
            extensions,
            requirements: &self.requirements,
            allocator: None,
            pipeline_cache: vk::PipelineCache::null(),
            frames_in_flight,
            options: Options::default(),
        }
    }

    /// Adopts the device by the public road.
    ///
    /// # Errors
    /// Those of [`Context::adopt`].
    ///
    /// # Safety
    /// The context and everything made from it are dropped before this device, and only when
    /// [`OpenDevice::wait_idle`] has returned since the last submission.
    pub unsafe fn adopt(&self, frames_in_flight: u32) -> Result<Context, GpuError> {
        let mut extensions = Vec::new();
        // SAFETY: the handles are ours and alive, what was enabled is stated as it was; the rest is the caller's.
        unsafe { Context::adopt(self.adopt_info(&mut extensions, frames_in_flight)) }
    }

    /// The device's name, driver and kind.
    pub fn line(&self) -> &DeviceLine {
        &self.line
    }

    /// Warnings and errors of the validation layers; empty without validation.
    pub fn messages(&self) -> MessageLog {
        self.instance.messenger.as_ref().map(|messenger| messenger.log.clone()).unwrap_or_default()
    }

    /// ash's instance.
    pub fn instance(&self) -> &ash::Instance {
        &self.instance.raw
    }

    /// ash's entry.
    pub fn entry(&self) -> &ash::Entry {
        &self.instance.entry
    }

    /// The physical device.
    pub fn physical_device(&self) -> vk::PhysicalDevice {
        self.physical_device
    }

    /// ash's device.
    pub fn device(&self) -> &ash::Device {
        &self.device
    }

    /// The queue.
    pub fn queue(&self) -> vk::Queue {
        self.queue
    }

    /// The queue's family.
    pub fn queue_family(&self) -> u32 {
        self.queue_family
    }
}

impl Drop for OpenDevice {
    fn drop(&mut self) {
        // SAFETY: contexts are gone (see `adopt`); children go before parents. Waiting fails only on a lost device,
        // which may be destroyed all the same.
        unsafe {
            let _ = self.device.device_wait_idle();
            self.device.destroy_command_pool(self.command_pool, None);
            self.device.destroy_device(None);
        }
    }
}

/// Extensions that this opener can enable: those that need no structure of their own.
const KNOWN: [&CStr; 4] = [
    ash::khr::swapchain::NAME,
    ash::khr::push_descriptor::NAME,
    ash::khr::calibrated_timestamps::NAME,
    ash::ext::calibrated_timestamps::NAME,
];

/// Names of the extensions required, ready for Vulkan.
fn required(requirements: &Requirements) -> Result<Vec<&'static CStr>, GpuError> {
    let find = |name: &&str| KNOWN.into_iter().find(|known| known.to_bytes() == name.as_bytes());
    let unknown = |name: &str| GpuError::misuse(name, "an extension that this opener does not know");
    requirements.extensions.iter().map(|name| find(name).ok_or_else(|| unknown(name))).collect()
}

fn make_device(
    instance: &ash::Instance,
    physical_device: vk::PhysicalDevice,
    queue_family: u32,
    features: FeatureSet,
    extensions: &[&CStr],
) -> Result<ash::Device, GpuError> {
    let names: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
    let queues =
        [vk::DeviceQueueCreateInfo::default().queue_family_index(queue_family).queue_priorities(&[1.0])];
    let FeatureStructs { core, mut v11, mut v12, mut v13 } = features.structs();
    let info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(&names)
        .enabled_features(&core)
        .push_next(&mut v11)
        .push_next(&mut v12)
        .push_next(&mut v13);
    // SAFETY: the features are supported, the queue family exists, and an unknown extension is refused.
    unsafe { instance.create_device(physical_device, &info, None) }
        .map_err(GpuError::vulkan("vkCreateDevice"))
}
