//! The patcher on invented chains.

use super::*;
use std::ptr::null_mut;

/// A structure no version of Vulkan has.
#[repr(C)]
struct Unknown {
    s_type: S,
    p_next: *mut c_void,
    content: [u32; 4],
}

fn unknown(p_next: *mut c_void) -> Unknown {
    Unknown { s_type: S::from_raw(0x7fff_0001), p_next, content: [7, 8, 9, 10] }
}

fn wanted() -> FeatureSet {
    use Feature::{
        DynamicRendering, RobustBufferAccess, ShaderFloat16, StorageBuffer16BitAccess, Synchronization2,
    };
    [Synchronization2, DynamicRendering, ShaderFloat16, StorageBuffer16BitAccess, RobustBufferAccess]
        .into_iter()
        .collect()
}

/// The kinds of a chain, in order.
fn kinds(mut chain: *const c_void) -> Vec<S> {
    let mut kinds = Vec::new();
    while !chain.is_null() {
        // SAFETY: the chains of these tests are valid.
        unsafe {
            let structure = &*chain.cast::<vk::BaseInStructure<'_>>();
            kinds.push(structure.s_type);
            chain = structure.p_next.cast();
        }
    }
    kinds
}

/// Patches, checks that every wanted feature is on and no kind is there twice, and returns the kinds.
fn patch(
    chain: &mut *mut c_void,
    mut enabled: Option<&mut vk::PhysicalDeviceFeatures>,
    api_version: u32,
    storage: &mut FeatureStorage,
) -> Vec<S> {
    for _ in 0..2 {
        // SAFETY: the chains of these tests are valid and outlived by the storage.
        unsafe { patch_features(chain, enabled.as_deref_mut(), wanted(), api_version, storage) }.unwrap();
    }
    // SAFETY: as above.
    let on = unsafe { FeatureSet::of_chain(*chain, enabled.as_deref()) };
    assert_eq!(on.intersection(wanted()), wanted());
    let kinds = kinds(*chain);
    for (index, kind) in kinds.iter().enumerate() {
        assert!(!kinds[..index].contains(kind), "{kind:?} is there twice: {kinds:?}");
    }
    kinds
}

#[test]
fn an_empty_chain_gets_one_structure_for_each_version() {
    let (mut chain, mut storage) = (null_mut(), FeatureStorage::default());
    let mut enabled = vk::PhysicalDeviceFeatures::default();
    let mut found = patch(&mut chain, Some(&mut enabled), vk::API_VERSION_1_3, &mut storage);
    found.sort();
    let (v11, v12) = (S::PHYSICAL_DEVICE_VULKAN_1_1_FEATURES, S::PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
    let mut expected = vec![v11, v12, S::PHYSICAL_DEVICE_VULKAN_1_3_FEATURES];
    expected.sort();
    assert_eq!(found, expected);
    assert_eq!((enabled.robust_buffer_access, enabled.geometry_shader), (vk::TRUE, vk::FALSE));
}

#[test]
fn without_enabled_features_the_core_ones_are_chained() {
    let (mut chain, mut storage) = (null_mut(), FeatureStorage::default());
    let found = patch(&mut chain, None, vk::API_VERSION_1_3, &mut storage);
    assert!(found.contains(&S::PHYSICAL_DEVICE_FEATURES_2) && found.len() == 4, "{found:?}");
    assert_eq!(storage.core.features.robust_buffer_access, vk::TRUE);
}

#[test]
fn the_hosts_own_structures_are_patched_and_unknown_ones_kept() {
    let mut features2 = vk::PhysicalDeviceFeatures2::default();
    features2.features.geometry_shader = vk::TRUE;
    let mut last = unknown(null_mut());
    features2.p_next = (&raw mut last).cast();
    let mut v13 = vk::PhysicalDeviceVulkan13Features { maintenance4: vk::TRUE, ..Default::default() };
    v13.p_next = (&raw mut features2).cast();
    let mut first = unknown((&raw mut v13).cast());
    first.s_type = S::from_raw(0x7fff_0002);
    let mut chain: *mut c_void = (&raw mut first).cast();
    let mut storage = FeatureStorage::default();
    let before = kinds(chain);
    let found = patch(&mut chain, None, vk::API_VERSION_1_3, &mut storage);
    assert_eq!(found[..4], before[..], "what was there stays in its order");
    assert_eq!(found.len(), 6, "only 1.1 and 1.2 are appended: {found:?}");
    assert_eq!(
        (v13.synchronization2, v13.dynamic_rendering, v13.maintenance4),
        (vk::TRUE, vk::TRUE, vk::TRUE)
    );
    assert_eq!(v13.inline_uniform_block, vk::FALSE);
    let core = features2.features;
    assert_eq!((core.robust_buffer_access, core.geometry_shader), (vk::TRUE, vk::TRUE));
    assert_eq!((first.content, last.content), ([7, 8, 9, 10], [7, 8, 9, 10]));
}

#[test]
fn structures_of_extensions_are_used_where_they_exclude_the_versions() {
    // Another member of 1.3, so that the structure of 1.3 may not be chained; one of 1.1 that is wanted itself.
    let mut maintenance4 = vk::PhysicalDeviceMaintenance4Features::default();
    let mut storage16 = vk::PhysicalDevice16BitStorageFeatures::default();
    maintenance4.p_next = (&raw mut storage16).cast();
    let mut chain: *mut c_void = (&raw mut maintenance4).cast();
    let mut storage = FeatureStorage::default();
    let found = patch(&mut chain, None, vk::API_VERSION_1_3, &mut storage);
    for excluded in [S::PHYSICAL_DEVICE_VULKAN_1_1_FEATURES, S::PHYSICAL_DEVICE_VULKAN_1_3_FEATURES] {
        assert!(!found.contains(&excluded), "{found:?}");
    }
    assert!(found.contains(&S::PHYSICAL_DEVICE_VULKAN_1_2_FEATURES), "nothing of 1.2 was there: {found:?}");
    assert_eq!(storage16.storage_buffer16_bit_access, vk::TRUE);
    assert_eq!(
        (storage.synchronization2.synchronization2, storage.dynamic_rendering.dynamic_rendering),
        (1, 1)
    );
}

#[test]
fn before_1_3_there_is_no_structure_of_1_3() {
    let (mut chain, mut storage) = (null_mut(), FeatureStorage::default());
    let found = patch(&mut chain, None, vk::API_VERSION_1_2, &mut storage);
    assert!(!found.contains(&S::PHYSICAL_DEVICE_VULKAN_1_3_FEATURES), "{found:?}");
    assert!(found.contains(&S::PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES), "{found:?}");
    assert!(found.contains(&S::PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES), "{found:?}");
}

#[test]
fn what_cannot_be_placed_is_named_and_nothing_is_changed() {
    let mut reset = vk::PhysicalDeviceHostQueryResetFeatures::default();
    let mut chain: *mut c_void = (&raw mut reset).cast();
    let mut storage = FeatureStorage::default();
    let wanted = wanted().with(Feature::ShaderOutputLayer).with(Feature::HostQueryReset);
    // SAFETY: a valid chain, outlived by the storage.
    let refused = unsafe { patch_features(&mut chain, None, wanted, vk::API_VERSION_1_3, &mut storage) };
    let message = refused.unwrap_err().to_string();
    assert!(message.starts_with("shaderOutputLayer: "), "{message}");
    assert_eq!((kinds(chain).len(), reset.host_query_reset), (1, vk::FALSE));
}
