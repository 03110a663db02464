//! Switching features on in a host's own `pNext` chain, before it makes its device.
//!
//! A feature of a later core version stands in that version's structure or in the structure of the extension it came
//! from; a chain may hold one of the two, never both (Vulkan 1.3, `VkDeviceCreateInfo`, "Valid Usage").

#[cfg(test)]
mod tests;

use crate::error::GpuError;
use crate::feature::{Feature, FeatureSet, FeatureStructs, Group};
use ash::vk;
use ash::vk::StructureType as S;
use std::ffi::c_void;
use std::mem::offset_of;

/// Room for every structure that [`patch_features`] may have to append.
#[derive(Default)]
pub struct FeatureStorage {
    core: vk::PhysicalDeviceFeatures2<'static>,
    v11: vk::PhysicalDeviceVulkan11Features<'static>,
    v12: vk::PhysicalDeviceVulkan12Features<'static>,
    v13: vk::PhysicalDeviceVulkan13Features<'static>,
    synchronization2: vk::PhysicalDeviceSynchronization2Features<'static>,
    dynamic_rendering: vk::PhysicalDeviceDynamicRenderingFeatures<'static>,
    host_query_reset: vk::PhysicalDeviceHostQueryResetFeatures<'static>,
    timeline_semaphore: vk::PhysicalDeviceTimelineSemaphoreFeatures<'static>,
    float16: vk::PhysicalDeviceShaderFloat16Int8Features<'static>,
    storage16: vk::PhysicalDevice16BitStorageFeatures<'static>,
}

/// The structure of a group, the version that has it, and the structures it stands for.
fn whole(group: Group) -> (S, u32, &'static [S]) {
    match group {
        Group::Core => (S::PHYSICAL_DEVICE_FEATURES_2, vk::API_VERSION_1_1, &[]),
        Group::V11 => (S::PHYSICAL_DEVICE_VULKAN_1_1_FEATURES, vk::API_VERSION_1_2, PARTS_11),
        Group::V12 => (S::PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, vk::API_VERSION_1_2, PARTS_12),
        Group::V13 => (S::PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, vk::API_VERSION_1_3, PARTS_13),
    }
}

const PARTS_11: &[S] = &[
    S::PHYSICAL_DEVICE_16BIT_STORAGE_FEATURES,
    S::PHYSICAL_DEVICE_MULTIVIEW_FEATURES,
    S::PHYSICAL_DEVICE_VARIABLE_POINTERS_FEATURES,
    S::PHYSICAL_DEVICE_PROTECTED_MEMORY_FEATURES,
    S::PHYSICAL_DEVICE_SAMPLER_YCBCR_CONVERSION_FEATURES,
    S::PHYSICAL_DEVICE_SHADER_DRAW_PARAMETERS_FEATURES,
];
const PARTS_12: &[S] = &[
    S::PHYSICAL_DEVICE_8BIT_STORAGE_FEATURES,
    S::PHYSICAL_DEVICE_SHADER_ATOMIC_INT64_FEATURES,
    S::PHYSICAL_DEVICE_SHADER_FLOAT16_INT8_FEATURES,
    S::PHYSICAL_DEVICE_DESCRIPTOR_INDEXING_FEATURES,
    S::PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES,
    S::PHYSICAL_DEVICE_IMAGELESS_FRAMEBUFFER_FEATURES,
    S::PHYSICAL_DEVICE_UNIFORM_BUFFER_STANDARD_LAYOUT_FEATURES,
    S::PHYSICAL_DEVICE_SHADER_SUBGROUP_EXTENDED_TYPES_FEATURES,
    S::PHYSICAL_DEVICE_SEPARATE_DEPTH_STENCIL_LAYOUTS_FEATURES,
    S::PHYSICAL_DEVICE_HOST_QUERY_RESET_FEATURES,
    S::PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES,
    S::PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES,
    S::PHYSICAL_DEVICE_VULKAN_MEMORY_MODEL_FEATURES,
];
const PARTS_13: &[S] = &[
    S::PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES,
    S::PHYSICAL_DEVICE_IMAGE_ROBUSTNESS_FEATURES,
    S::PHYSICAL_DEVICE_INLINE_UNIFORM_BLOCK_FEATURES,
    S::PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES,
    S::PHYSICAL_DEVICE_PIPELINE_CREATION_CACHE_CONTROL_FEATURES,
    S::PHYSICAL_DEVICE_PRIVATE_DATA_FEATURES,
    S::PHYSICAL_DEVICE_SHADER_DEMOTE_TO_HELPER_INVOCATION_FEATURES,
    S::PHYSICAL_DEVICE_SHADER_INTEGER_DOT_PRODUCT_FEATURES,
    S::PHYSICAL_DEVICE_SHADER_TERMINATE_INVOCATION_FEATURES,
    S::PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES,
    S::PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES,
    S::PHYSICAL_DEVICE_TEXTURE_COMPRESSION_ASTC_HDR_FEATURES,
    S::PHYSICAL_DEVICE_ZERO_INITIALIZE_WORKGROUP_MEMORY_FEATURES,
];

/// The extension's structure that has a feature too, and the feature's byte in it.
fn part(feature: Feature) -> Option<(S, usize)> {
    macro_rules! member {
        ($structure:ident . $field:ident, $kind:ident) => {
            Some((S::$kind, offset_of!(vk::$structure<'static>, $field)))
        };
    }
    match feature {
        Feature::Synchronization2 => member!(
            PhysicalDeviceSynchronization2Features.synchronization2,
            PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES
        ),
        Feature::DynamicRendering => member!(
            PhysicalDeviceDynamicRenderingFeatures.dynamic_rendering,
            PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES
        ),
        Feature::HostQueryReset => member!(
            PhysicalDeviceHostQueryResetFeatures.host_query_reset,
            PHYSICAL_DEVICE_HOST_QUERY_RESET_FEATURES
        ),
        Feature::TimelineSemaphore => member!(
            PhysicalDeviceTimelineSemaphoreFeatures.timeline_semaphore,
            PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES
        ),
        Feature::ShaderFloat16 => member!(
            PhysicalDeviceShaderFloat16Int8Features.shader_float16,
            PHYSICAL_DEVICE_SHADER_FLOAT16_INT8_FEATURES
        ),
        Feature::StorageBuffer16BitAccess => member!(
            PhysicalDevice16BitStorageFeatures.storage_buffer16_bit_access,
            PHYSICAL_DEVICE_16BIT_STORAGE_FEATURES
        ),
        _ => None,
    }
}

impl FeatureStorage {
    /// The structure of that kind, clean. Every kind asked for is here.
    fn take(&mut self, kind: S) -> *mut vk::BaseOutStructure<'static> {
        macro_rules! clean {
            ($field:ident) => {{
                self.$field = Default::default();
                (&raw mut self.$field).cast()
            }};
        }
        match kind {
            S::PHYSICAL_DEVICE_VULKAN_1_1_FEATURES => clean!(v11),
            S::PHYSICAL_DEVICE_VULKAN_1_2_FEATURES => clean!(v12),
            S::PHYSICAL_DEVICE_VULKAN_1_3_FEATURES => clean!(v13),
            S::PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES => clean!(synchronization2),
            S::PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES => clean!(dynamic_rendering),
            S::PHYSICAL_DEVICE_HOST_QUERY_RESET_FEATURES => clean!(host_query_reset),
            S::PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES => clean!(timeline_semaphore),
            S::PHYSICAL_DEVICE_SHADER_FLOAT16_INT8_FEATURES => clean!(float16),
            S::PHYSICAL_DEVICE_16BIT_STORAGE_FEATURES => clean!(storage16),
            _ => clean!(core),
        }
    }
}

/// The structure of `kind` in a chain, or null.
///
/// # Safety
/// `chain` is null or a valid chain.
unsafe fn find(mut chain: *const c_void, kind: S) -> *mut vk::BaseOutStructure<'static> {
    while !chain.is_null() {
        let structure = chain.cast::<vk::BaseInStructure<'static>>();
        // SAFETY: every structure of a chain starts with its kind and the next one.
        unsafe {
            if (*structure).s_type == kind {
                return structure.cast_mut().cast();
            }
            chain = (*structure).p_next.cast();
        }
    }
    std::ptr::null_mut()
}

/// Where a feature is switched: the structure's kind and the byte in it; `None` if this chain cannot hold it.
///
/// # Safety
/// As [`find`].
unsafe fn target(chain: *const c_void, feature: Feature, api_version: u32) -> Option<(S, usize)> {
    let (group, byte) = feature.place();
    let (kind, version, parts) = whole(group);
    // SAFETY: the caller vouches for the chain.
    let (has_whole, has_parts) =
        unsafe { (!find(chain, kind).is_null(), parts.iter().any(|&part| !find(chain, part).is_null())) };
    match has_whole || (!has_parts && api_version >= version) {
        true => Some((kind, header(group) + byte)),
        false => part(feature),
    }
}

/// Switches `wanted` on in the chain of a `VkDeviceCreateInfo` whose device will have API version `api_version`.
///
/// Members of structures that are there are set; other members and unknown structures stay as they are; structures
/// that are missing are appended from `storage`; none is there twice. Features of Vulkan 1.0 go to `enabled`, the
/// structure behind `pEnabledFeatures`, where it is given and the chain has no `VkPhysicalDeviceFeatures2`.
///
/// # Errors
/// [`GpuError::Misuse`] for a feature that only the structure of a core version has, when the chain has structures which
/// that one excludes; nothing is changed then.
///
/// # Safety
/// `p_next` points at null or at a valid chain that may be written. The chain is not used after `storage` is moved or
/// dropped, and `storage` is in no other chain.
pub unsafe fn patch_features(
    p_next: *mut *mut c_void,
    mut enabled: Option<&mut vk::PhysicalDeviceFeatures>,
    wanted: FeatureSet,
    api_version: u32,
    storage: &mut FeatureStorage,
) -> Result<(), GpuError> {
    // SAFETY: the caller vouches for the chain.
    let unplaced = wanted.iter().find(|&feature| unsafe { target(*p_next, feature, api_version).is_none() });
    if let Some(feature) = unplaced {
        let problem =
            "the chain has structures of extensions that exclude the one of the core version; use that one";
        return Err(GpuError::misuse(feature.name(), problem));
    }
    for feature in wanted.iter() {
        let (group, byte) = feature.place();
        // SAFETY: the caller vouches for the chain; a structure found or appended is of the kind whose byte is written.
        unsafe {
            let alone = group == Group::Core && find(*p_next, S::PHYSICAL_DEVICE_FEATURES_2).is_null();
            if let Some(enabled) = enabled.as_deref_mut().filter(|_| alone) {
                (&raw mut *enabled).cast::<u8>().add(byte).cast::<vk::Bool32>().write(vk::TRUE);
            } else if let Some((kind, byte)) = target(*p_next, feature, api_version) {
                let mut structure = find(*p_next, kind);
                if structure.is_null() {
                    structure = storage.take(kind);
                    append(p_next, structure);
                }
                structure.cast::<u8>().add(byte).cast::<vk::Bool32>().write(vk::TRUE);
            }
        }
    }
    Ok(())
}

impl FeatureSet {
    /// The features that are switched on in a `VkDeviceCreateInfo`'s chain or in `enabled`, what its `pEnabledFeatures`
    /// points at: what a host enabled, read from its own structures.
    ///
    /// # Safety
    /// `p_next` is null or a valid chain.
    pub unsafe fn of_chain(p_next: *const c_void, enabled: Option<&vk::PhysicalDeviceFeatures>) -> Self {
        let is_on = |kind, byte| {
            // SAFETY: the caller vouches for the chain; a structure found is of the kind whose byte is read.
            unsafe {
                let structure = find(p_next, kind).cast::<u8>();
                !structure.is_null() && structure.add(byte).cast::<vk::Bool32>().read() == vk::TRUE
            }
        };
        let in_chain = |&feature: &Feature| {
            let (group, byte) = feature.place();
            let in_part = part(feature).is_some_and(|(kind, byte)| is_on(kind, byte));
            in_part || is_on(whole(group).0, header(group) + byte)
        };
        let core = enabled.map_or_else(Self::default, |core| {
            Self::of(&FeatureStructs { core: *core, ..Default::default() })
        });
        Feature::ALL.iter().copied().filter(|feature| core.contains(*feature) || in_chain(feature)).collect()
    }
}

/// Bytes before the members that a group counts from.
fn header(group: Group) -> usize {
    if group == Group::Core { offset_of!(vk::PhysicalDeviceFeatures2<'static>, features) } else { 0 }
}

/// Puts `structure` at the end of a chain.
///
/// # Safety
/// `p_next` points at null or at a valid chain, and `structure` ends a chain.
unsafe fn append(p_next: *mut *mut c_void, structure: *mut vk::BaseOutStructure<'static>) {
    let mut last = p_next.cast::<*mut vk::BaseOutStructure<'static>>();
    // SAFETY: the caller vouches for the chain.
    unsafe {
        while !(*last).is_null() {
            last = &raw mut (**last).p_next;
        }
        last.write(structure);
    }
}
