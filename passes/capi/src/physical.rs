//! What a host's physical device supports, asked through the host's own functions.

use std::ffi::c_char;

use airglow_gpu::ash::{self, vk, vk::Handle};
use airglow_gpu::{Feature, FeatureSet, Offer, Requirements};

use crate::input::{Versioned, array, string};
use crate::status::{AirglowStatus, Failure};

/// A Vulkan function of whatever type; cast `vkGetInstanceProcAddr` to it.
pub type AirglowFunction = Option<unsafe extern "system" fn()>;

/// A physical device, to be asked what it supports before there is a device.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowPhysicalDevice {
    /// `sizeof(AirglowPhysicalDevice)`.
    pub struct_size: u32,
    /// The queue family that commands will be submitted to.
    pub queue_family: u32,
    /// `vkGetInstanceProcAddr`, the loader's or the host's own in front of it.
    pub get_instance_proc_addr: AirglowFunction,
    /// The `VkInstance`.
    pub instance: u64,
    /// The `VkPhysicalDevice`; Vulkan 1.3 or newer.
    pub physical_device: u64,
}

// SAFETY: `#[repr(C)]`, its size first, integers and an optional function; fields of 8 bytes are at multiples of 8.
unsafe impl Versioned for AirglowPhysicalDevice {
    const OLDEST: usize = size_of::<Self>();
}

/// The features that the names of an array name; names unknown here are of no use here.
///
/// # Safety
/// As [`array`] and [`string`].
pub(crate) unsafe fn features_named(
    names: *const *const c_char,
    count: usize,
) -> Result<FeatureSet, Failure> {
    let mut set = FeatureSet::default();
    // SAFETY: the caller's promise is ours.
    unsafe {
        for &name in array(names, count, "feature_names")? {
            let name = string(name, "a feature name", "")?;
            set = Feature::ALL
                .iter()
                .filter(|known| known.name() == name)
                .fold(set, |set, &known| set.with(known));
        }
    }
    Ok(set)
}

/// `function` as `vkGetInstanceProcAddr`.
///
/// # Safety
/// It is null or that function.
pub(crate) unsafe fn get_instance_proc_addr(
    function: AirglowFunction,
) -> Result<vk::PFN_vkGetInstanceProcAddr, Failure> {
    let function = function.ok_or_else(|| Failure::argument("get_instance_proc_addr", "it is null"))?;
    // SAFETY: the caller's promise is ours; both are function pointers of one calling convention.
    Ok(unsafe { std::mem::transmute::<unsafe extern "system" fn(), vk::PFN_vkGetInstanceProcAddr>(function) })
}

/// What a physical device supports.
pub(crate) struct Supported {
    instance: ash::Instance,
    device: vk::PhysicalDevice,
    queue_family: u32,
    pub features: FeatureSet,
}

impl Supported {
    /// # Safety
    /// The handles are alive and belong together.
    pub(crate) unsafe fn ask(device: &AirglowPhysicalDevice) -> Result<Self, Failure> {
        if device.instance == 0 || device.physical_device == 0 {
            return Err(Failure::argument("device", "instance or physical_device is null"));
        }
        let (raw, physical) =
            (vk::Instance::from_raw(device.instance), vk::PhysicalDevice::from_raw(device.physical_device));
        // SAFETY: the caller vouches for function and handles; what is called is looked up first, because ash puts a
        // function that panics in the place of a null one.
        unsafe {
            let find = get_instance_proc_addr(device.get_instance_proc_addr)?;
            for name in [
                c"vkEnumerateDeviceExtensionProperties",
                c"vkGetPhysicalDeviceFeatures2",
                c"vkGetPhysicalDeviceFormatProperties",
                c"vkGetPhysicalDeviceProperties",
                c"vkGetPhysicalDeviceQueueFamilyProperties",
            ] {
                if find(raw, name.as_ptr()).is_none() {
                    let name = name.to_string_lossy();
                    return Err(Failure::new(
                        AirglowStatus::Missing,
                        format!(
                            "get_instance_proc_addr returned null for {name}; make the instance for Vulkan 1.3"
                        ),
                    ));
                }
            }
            let instance =
                ash::Instance::load_with(|name| std::mem::transmute(find(raw, name.as_ptr())), raw);
            if instance.get_physical_device_properties(physical).api_version < vk::API_VERSION_1_3 {
                let problem = "it is below Vulkan 1.3, of which its features are asked; switch the required ones on, \
                               with the extensions for them, and let adopt say what is missing";
                return Err(Failure::argument("device", problem));
            }
            let features = FeatureSet::supported(&instance, physical);
            Ok(Self { instance, device: physical, queue_family: device.queue_family, features })
        }
    }

    pub(crate) fn offer(&self, asked: &Requirements) -> Result<Offer, Failure> {
        // SAFETY: `ask` was promised that the handles are alive; its functions were looked up.
        let (mut offer, extensions) = unsafe {
            let offer = Offer::read(&self.instance, self.device, self.queue_family, asked);
            (offer, self.instance.enumerate_device_extension_properties(self.device))
        };
        let extensions = extensions.map_err(|result| Failure {
            vulkan_result: result.as_raw(),
            ..Failure::new(
                AirglowStatus::Vulkan,
                format!("vkEnumerateDeviceExtensionProperties returned {result:?}"),
            )
        })?;
        let name = |properties: &vk::ExtensionProperties| {
            Some(properties.extension_name_as_c_str().ok()?.to_string_lossy().into_owned())
        };
        offer.extensions = extensions.iter().filter_map(name).collect();
        offer.features = self.features;
        Ok(offer)
    }
}
