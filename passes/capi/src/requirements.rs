//! What the library asks of a device, before there is one: as data, as JSON, and as a patcher of the host's own chain.

use std::ffi::{CString, c_char, c_void};

use airglow_gpu::ash::{self, vk, vk::Handle};
use airglow_gpu::{Feature, FeatureSet, FeatureStorage, Offer, Requirements, patch_features};
use serde_json::json;

use crate::input::Versioned;
use crate::input::{array, exclusive, shared, store, string, take, versioned};
use crate::status::{AirglowError, AirglowStatus, Failure, edge};
use crate::text::{AirglowText, write_array, write_text};

/// What passes ask of a device. Made empty, which is what the library itself needs; each pass adds its own
/// (`airglow_relight_require`). One thread at a time.
pub struct AirglowRequirements {
    pub(crate) asked: Requirements,
    /// Names and reasons that the host was given pointers to.
    texts: Vec<CString>,
    /// The structures that a host's chain was patched with.
    storage: Box<FeatureStorage>,
}

/// What an `AirglowNeed` is about.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowNeedKind {
    /// The API version of instance and device: `value` as `VK_MAKE_API_VERSION` packs it.
    ApiVersion = 0,
    /// An extension of the instance.
    InstanceExtension = 1,
    /// An extension of the device.
    DeviceExtension = 2,
    /// An extension of a device below Vulkan 1.3, where it stands for a feature that is core later.
    DeviceExtensionBelow13 = 3,
    /// A feature, by its field's name in the Vulkan specification.
    Feature = 4,
    /// A limit by its field's name; `value` is the least it may be, in its own unit.
    Limit = 5,
    /// A format: `value` is the `VkFormat`, `flags` the `VkFormatFeatureFlags` asked of images with optimal tiling, and
    /// of buffers for vertex input.
    Format = 6,
    /// The queue family that commands are submitted to: `flags` are its `VkQueueFlags`.
    Queue = 7,
}

/// One thing asked of a device. Texts live until the requirements change or are dropped.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowNeed {
    /// An `AirglowNeedKind`.
    pub kind: u32,
    /// 1: without it nothing runs. 0: it only buys something.
    pub required: u32,
    /// See `AirglowNeedKind`.
    pub value: u64,
    /// See `AirglowNeedKind`.
    pub flags: u64,
    /// The name of extension, feature or limit; empty for others.
    pub name: *const c_char,
    /// What it is for or what it buys.
    pub why: *const c_char,
}

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

/// Makes requirements: what the library itself needs. Drop them with `airglow_requirements_drop`.
///
/// # Safety
/// `requirements` may be written; `error` as everywhere.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_requirements_new(
    requirements: *mut *mut AirglowRequirements,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for both pointers.
    unsafe {
        edge(error, || {
            store(requirements, "requirements", || {
                let (asked, texts) = (Requirements::engine(), Vec::new());
                Ok(Box::into_raw(Box::new(AirglowRequirements { asked, texts, storage: Default::default() })))
            })
        })
    }
}

/// Drops requirements, and with them the texts of `airglow_requirements_list` and the structures that
/// `airglow_requirements_patch` put into a chain. Null is nothing.
///
/// # Safety
/// `requirements` is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_requirements_drop(requirements: *mut AirglowRequirements) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { edge(std::ptr::null_mut(), || take(requirements)) };
}

/// Lists everything asked for. `*count` holds the size of `needs` before and the number of needs after; with `needs`
/// null only the number is written.
///
/// # Safety
/// `needs` is null or has room for `*count` needs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_requirements_list(
    requirements: *mut AirglowRequirements,
    needs: *mut AirglowNeed,
    count: *mut usize,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe { edge(error, || write_array(needs, count, &exclusive(requirements, "requirements")?.list())) }
}

/// Everything asked for, as JSON: what `airglow requirements` prints.
///
/// # Safety
/// `text` as `AirglowText` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_requirements_json(
    requirements: *const AirglowRequirements,
    text: *mut AirglowText,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe { edge(error, || write_text(text, &shared(requirements, "requirements")?.asked.json())) }
}

/// Compares the requirements with what a physical device supports. Returns `AIRGLOW_STATUS_MISSING` where it does not
/// suffice; `missing`, which may be null, then gets a JSON array of texts, one for each thing that is lacking.
///
/// # Safety
/// The handles of `device` are alive and belong together; `missing` as `AirglowText` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_requirements_check(
    requirements: *const AirglowRequirements,
    device: *const AirglowPhysicalDevice,
    missing: *mut AirglowText,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers and handles.
    unsafe {
        edge(error, || {
            let asked = &shared(requirements, "requirements")?.asked;
            let device = Supported::ask(&versioned(device, "device")?)?;
            let lacking = asked.check(&device.offer(asked)?);
            let texts: Vec<_> = lacking.iter().map(ToString::to_string).collect();
            if !missing.is_null() {
                write_text(missing, &json!(texts).to_string())?;
            }
            if lacking.is_empty() { Ok(()) } else { Err(airglow_gpu::GpuError::Missing(lacking).into()) }
        })
    }
}

/// Switches the features asked for on in the `pNext` chain of a `VkDeviceCreateInfo`, before the device is made: those
/// required, and the optional ones that `device` supports (none, where `device` is null). Structures in the chain are
/// set and never duplicated, unknown ones stay, missing ones are appended. Features of Vulkan 1.0 go to
/// `enabled_features`, the `VkPhysicalDeviceFeatures` behind `pEnabledFeatures`, where it is given and the chain has no
/// `VkPhysicalDeviceFeatures2`. What was appended lives in the requirements: use the chain before they are dropped or
/// patch another.
///
/// # Safety
/// `p_next` points at null or at a valid chain that may be written, `enabled_features` at null or a
/// `VkPhysicalDeviceFeatures`; the handles of `device` are alive and belong together.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_requirements_patch(
    requirements: *mut AirglowRequirements,
    device: *const AirglowPhysicalDevice,
    api_version: u32,
    p_next: *mut *mut c_void,
    enabled_features: *mut c_void,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers and handles.
    unsafe {
        edge(error, || {
            let requirements = exclusive(requirements, "requirements")?;
            let supported = match device.is_null() {
                true => FeatureSet::default(),
                false => Supported::ask(&versioned(device, "device")?)?.features,
            };
            let wanted = requirements.asked.features_to_enable(supported);
            let p_next: *mut *mut c_void = exclusive(p_next, "p_next")?;
            let enabled = match enabled_features.is_null() {
                true => None,
                false => Some(exclusive(enabled_features.cast(), "enabled_features")?),
            };
            Ok(patch_features(p_next, enabled, wanted, api_version, &mut requirements.storage)?)
        })
    }
}

impl AirglowRequirements {
    /// Adds what a pass asks for.
    #[cfg(feature = "relight")]
    pub(crate) fn add(&mut self, more: &Requirements) {
        self.asked = self.asked.clone().and(more);
        self.texts.clear();
    }

    fn list(&mut self) -> Vec<AirglowNeed> {
        let rows = rows(&self.asked);
        if self.texts.is_empty() {
            let texts = rows.iter().flat_map(|row| [row.name, row.why]);
            // None of them has a nul within.
            self.texts = texts.map(|text| CString::new(text).unwrap_or_default()).collect();
        }
        let need = |(row, texts): (&Row, &[CString])| AirglowNeed {
            kind: row.kind as u32,
            required: u32::from(row.required),
            value: row.value,
            flags: row.flags,
            name: texts[0].as_ptr(),
            why: texts[1].as_ptr(),
        };
        rows.iter().zip(self.texts.chunks_exact(2)).map(need).collect()
    }
}

/// An [`AirglowNeed`] before its texts have a home.
struct Row {
    kind: AirglowNeedKind,
    required: bool,
    value: u64,
    flags: u64,
    name: &'static str,
    why: &'static str,
}

fn rows(asked: &Requirements) -> Vec<Row> {
    use AirglowNeedKind as Kind;
    let row = |kind, name, why| Row { kind, required: true, value: 0, flags: 0, name, why };
    let mut rows = vec![
        Row { value: asked.api_version.into(), ..row(Kind::ApiVersion, "", "the functions called") },
        Row { flags: asked.queue.as_raw().into(), ..row(Kind::Queue, "", "the commands recorded") },
    ];
    rows.extend(
        asked.instance_extensions.iter().map(|need| Row {
            required: need.required,
            ..row(Kind::InstanceExtension, need.name, need.buys)
        }),
    );
    rows.extend(asked.extensions.iter().map(|name| row(Kind::DeviceExtension, name, "")));
    rows.extend(asked.features.iter().filter_map(|need| {
        let name = need.feature.extension_before_1_3()?;
        Some(Row { required: need.required, ..row(Kind::DeviceExtensionBelow13, name, need.buys) })
    }));
    rows.extend(
        asked.features.iter().map(|need| Row {
            required: need.required,
            ..row(Kind::Feature, need.feature.name(), need.buys)
        }),
    );
    rows.extend(
        asked
            .limits
            .iter()
            .map(|need| Row { value: need.at_least, ..row(Kind::Limit, need.limit.name(), need.why) }),
    );
    rows.extend(asked.formats.iter().map(|need| Row {
        value: need.format.as_raw() as u64,
        flags: need.usage.as_raw().into(),
        ..row(Kind::Format, "", need.why)
    }));
    rows
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
struct Supported {
    instance: ash::Instance,
    device: vk::PhysicalDevice,
    queue_family: u32,
    features: FeatureSet,
}

impl Supported {
    /// # Safety
    /// The handles are alive and belong together.
    unsafe fn ask(device: &AirglowPhysicalDevice) -> Result<Self, Failure> {
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

    fn offer(&self, asked: &Requirements) -> Result<Offer, Failure> {
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
