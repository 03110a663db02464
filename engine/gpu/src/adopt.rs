//! What a host hands over when its device is adopted.

use crate::allocator::Allocator;
use crate::feature::FeatureSet;
use crate::options::Options;
use crate::requirements::Requirements;
use ash::vk;

/// A device as its host states it.
///
/// A host on another version of ash, or on none, makes the handles with `vk::Handle::from_raw`.
pub struct AdoptInfo<'a> {
    /// The loader's function, or the host's own in front of it.
    pub get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    /// The device's function; `None` asks the instance for it.
    pub get_device_proc_addr: Option<vk::PFN_vkGetDeviceProcAddr>,
    /// The instance.
    pub instance: vk::Instance,
    /// API version the instance was created for.
    pub api_version: u32,
    /// The physical device.
    pub physical_device: vk::PhysicalDevice,
    /// The device.
    pub device: vk::Device,
    /// Family of the queue that recorded commands will be submitted to.
    pub queue_family: u32,
    /// Features the host enabled; [`FeatureSet::of`] reads them from its structures.
    pub features: FeatureSet,
    /// Extensions the host enabled, of instance and device. `VK_EXT_debug_utils` among them turns on names and labels.
    pub extensions: &'a [&'a str],
    /// What the rooms in use ask for; [`Requirements::engine`] is added to it.
    pub requirements: &'a Requirements,
    /// The host's memory, or `None` for blocks of our own.
    pub allocator: Option<Box<dyn Allocator>>,
    /// The host's pipeline cache, or null.
    pub pipeline_cache: vk::PipelineCache,
    /// How many frames may be on the device or being recorded at once, at least 1.
    pub frames_in_flight: u32,
    /// Choices that no host has to make.
    pub options: Options,
}
