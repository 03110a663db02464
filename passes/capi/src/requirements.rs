//! What the library asks of a device, before there is one: as data, as JSON, and as a patcher of the host's own chain.

use std::ffi::{CString, c_void};

use airglow_gpu::{FeatureSet, FeatureStorage, GpuError, Requirements, patch_features};
use serde_json::json;

use crate::input::{exclusive, shared, store, take, versioned};
use crate::needs::{AirglowNeed, Row, rows};
use crate::physical::{AirglowPhysicalDevice, Supported};
use crate::status::{AirglowError, AirglowStatus, edge};
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
            if lacking.is_empty() { Ok(()) } else { Err(GpuError::Missing(lacking).into()) }
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
    pub fn add(&mut self, more: &Requirements) {
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
