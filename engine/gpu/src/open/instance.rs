//! The system's loader and an instance of our own.

use super::messages::Messenger;
use crate::error::GpuError;
use ash::vk;
use std::ffi::CStr;

const VALIDATION_LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// A loader, an instance, and with validation a messenger; destroyed on drop.
pub(super) struct Instance {
    pub entry: ash::Entry,
    pub raw: ash::Instance,
    pub debug_utils: bool,
    pub messenger: Option<Messenger>,
}

impl Instance {
    /// Opens the loader and makes an instance for Vulkan 1.3, with `VK_EXT_debug_utils` where there is one.
    pub(super) fn new(extensions: &[&CStr], validation: bool) -> Result<Self, GpuError> {
        // SAFETY: the system's Vulkan loader is trusted to be one.
        let entry = unsafe { ash::Entry::load() }.map_err(|error| {
            GpuError::misuse("the Vulkan loader", format!("{error}; install libvulkan1 and a driver"))
        })?;
        if validation && !has_layer(&entry)? {
            let name = VALIDATION_LAYER.to_string_lossy();
            return Err(GpuError::misuse(name, "not installed; install vulkan-validationlayers"));
        }
        let debug_utils = validation || has_debug_utils(&entry)?;
        let mut names: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
        if debug_utils {
            names.push(ash::ext::debug_utils::NAME.as_ptr());
        }
        if validation {
            names.push(ash::ext::validation_features::NAME.as_ptr());
        }
        let layers = [VALIDATION_LAYER.as_ptr()];
        let application = vk::ApplicationInfo::default()
            .application_name(c"airglow")
            .engine_name(c"airglow")
            .api_version(vk::API_VERSION_1_3);
        let mut validation_features = vk::ValidationFeaturesEXT::default()
            .enabled_validation_features(&[vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION]);
        let mut info =
            vk::InstanceCreateInfo::default().application_info(&application).enabled_extension_names(&names);
        if validation {
            info = info.enabled_layer_names(&layers).push_next(&mut validation_features);
        }
        // SAFETY: a loaded entry and names that live through the call.
        let raw =
            unsafe { entry.create_instance(&info, None) }.map_err(GpuError::vulkan("vkCreateInstance"))?;
        let mut instance = Self { entry, raw, debug_utils, messenger: None };
        if validation {
            instance.messenger = Some(Messenger::new(&instance.entry, &instance.raw)?);
        }
        Ok(instance)
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        drop(self.messenger.take());
        // SAFETY: `OpenDevice` destroys its device before its instance is dropped.
        unsafe { self.raw.destroy_instance(None) };
    }
}

fn has_layer(entry: &ash::Entry) -> Result<bool, GpuError> {
    // SAFETY: a loaded entry.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }
        .map_err(GpuError::vulkan("vkEnumerateInstanceLayerProperties"))?;
    Ok(layers.iter().any(|layer| layer.layer_name_as_c_str() == Ok(VALIDATION_LAYER)))
}

fn has_debug_utils(entry: &ash::Entry) -> Result<bool, GpuError> {
    // SAFETY: a loaded entry.
    let extensions = unsafe { entry.enumerate_instance_extension_properties(None) }
        .map_err(GpuError::vulkan("vkEnumerateInstanceExtensionProperties"))?;
    let name = ash::ext::debug_utils::NAME;
    Ok(extensions.iter().any(|extension| extension.extension_name_as_c_str() == Ok(name)))
}
