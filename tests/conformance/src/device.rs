//! A host's device, as the kit is given it.

use airglow_gpu::FeatureSet;
use airglow_gpu::ash::vk;

/// A host's device as it states it.
#[derive(Clone, Copy)]
pub struct HostDevice<'a> {
    /// The loader's function.
    pub get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    /// The device's function; a room gets one with the kit listening behind it.
    pub get_device_proc_addr: vk::PFN_vkGetDeviceProcAddr,
    /// The instance.
    pub instance: vk::Instance,
    /// API version of the instance.
    pub api_version: u32,
    /// The physical device.
    pub physical_device: vk::PhysicalDevice,
    /// The device.
    pub device: vk::Device,
    /// Family of the queue that commands are submitted to.
    pub queue_family: u32,
    /// The queue: it does graphics, compute and transfer.
    pub queue: vk::Queue,
    /// Features enabled.
    pub features: FeatureSet,
    /// Extensions enabled.
    pub extensions: &'a [&'a str],
}
