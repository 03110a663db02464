//! Device features as data: a set that can be compared, printed, queried and enabled.

use ash::vk;
use std::fmt;
use std::mem::offset_of;

/// The four feature structures of core Vulkan 1.3, unchained.
#[derive(Clone, Copy, Default)]
pub struct FeatureStructs {
    /// Features of Vulkan 1.0.
    pub core: vk::PhysicalDeviceFeatures,
    /// Features of Vulkan 1.1.
    pub v11: vk::PhysicalDeviceVulkan11Features<'static>,
    /// Features of Vulkan 1.2.
    pub v12: vk::PhysicalDeviceVulkan12Features<'static>,
    /// Features of Vulkan 1.3.
    pub v13: vk::PhysicalDeviceVulkan13Features<'static>,
}

/// A structure of [`FeatureStructs`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Group {
    Core,
    V11,
    V12,
    V13,
}

macro_rules! group {
    (core) => {
        Group::Core
    };
    (v11) => {
        Group::V11
    };
    (v12) => {
        Group::V12
    };
    (v13) => {
        Group::V13
    };
}

macro_rules! features {
    ($($variant:ident = $group:ident . $field:ident, $name:literal, $what:literal;)*) => {
        /// A device feature that some room needs or can use.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Feature {
            $(#[doc = concat!("`", $name, "`: ", $what, ".")] $variant,)*
        }

        impl Feature {
            /// Every feature known here.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)*];

            /// The field's name in the Vulkan specification.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// The structure that has it, and its byte in there.
            pub(crate) fn place(self) -> (Group, usize) {
                match self {
                    $(Self::$variant => (
                        group!($group),
                        offset_of!(FeatureStructs, $group.$field) - offset_of!(FeatureStructs, $group),
                    ),)*
                }
            }

            fn get(self, structs: &FeatureStructs) -> bool {
                match self { $(Self::$variant => structs.$group.$field == vk::TRUE,)* }
            }

            fn set(self, structs: &mut FeatureStructs) {
                match self { $(Self::$variant => structs.$group.$field = vk::TRUE,)* }
            }
        }
    };
}

features! {
    Synchronization2 = v13.synchronization2, "synchronization2", "barriers with 64-bit stages";
    DynamicRendering = v13.dynamic_rendering, "dynamicRendering", "rendering without render pass objects";
    HostQueryReset = v12.host_query_reset, "hostQueryReset", "queries reset without a command";
    TimelineSemaphore = v12.timeline_semaphore, "timelineSemaphore", "one counter per queue";
    ShaderFloat16 = v12.shader_float16, "shaderFloat16", "half-precision arithmetic";
    StorageBuffer16BitAccess = v11.storage_buffer16_bit_access, "storageBuffer16BitAccess", "half-precision values in storage buffers";
    ShaderOutputLayer = v12.shader_output_layer, "shaderOutputLayer", "a vertex shader chooses the layer";
    VertexPipelineStoresAndAtomics = core.vertex_pipeline_stores_and_atomics, "vertexPipelineStoresAndAtomics", "vertex shaders write storage";
    FragmentStoresAndAtomics = core.fragment_stores_and_atomics, "fragmentStoresAndAtomics", "fragment shaders write storage";
    ShaderStorageImageWriteWithoutFormat = core.shader_storage_image_write_without_format, "shaderStorageImageWriteWithoutFormat", "one shader for storage images of any format";
    RobustBufferAccess = core.robust_buffer_access, "robustBufferAccess", "out-of-range reads return zero";
    IndependentBlend = core.independent_blend, "independentBlend", "each attachment blends its own way";
    ImageCubeArray = core.image_cube_array, "imageCubeArray", "arrays of cube maps";
    SamplerAnisotropy = core.sampler_anisotropy, "samplerAnisotropy", "anisotropic filtering";
    MultiDrawIndirect = core.multi_draw_indirect, "multiDrawIndirect", "more than one draw per indirect call";
    DrawIndirectFirstInstance = core.draw_indirect_first_instance, "drawIndirectFirstInstance", "instance offsets in indirect draws";
    ShaderClipDistance = core.shader_clip_distance, "shaderClipDistance", "vertex shaders place planes that clip";
    DepthClamp = core.depth_clamp, "depthClamp", "depth is clamped instead of clipped";
    PipelineStatisticsQuery = core.pipeline_statistics_query, "pipelineStatisticsQuery", "exact invocation counts";
    ShaderInt16 = core.shader_int16, "shaderInt16", "16-bit integers";
    ShaderInt64 = core.shader_int64, "shaderInt64", "64-bit integers";
    ShaderFloat64 = core.shader_float64, "shaderFloat64", "double precision";
}

impl Feature {
    /// The extension that brings it to a device below Vulkan 1.3; `None` where no extension is needed or does.
    pub fn extension_before_1_3(self) -> Option<&'static str> {
        match self {
            Self::Synchronization2 => Some("VK_KHR_synchronization2"),
            Self::DynamicRendering => Some("VK_KHR_dynamic_rendering"),
            _ => None,
        }
    }
}

/// A set of [`Feature`]s.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct FeatureSet(u64);

impl FeatureSet {
    /// True if `feature` is in the set.
    pub fn contains(self, feature: Feature) -> bool {
        self.0 & (1 << feature as u64) != 0
    }

    /// The set with `feature` in it.
    #[must_use]
    pub fn with(self, feature: Feature) -> Self {
        Self(self.0 | 1 << feature as u64)
    }

    /// The set with `feature` taken out.
    #[must_use]
    pub fn without(self, feature: Feature) -> Self {
        Self(self.0 & !(1 << feature as u64))
    }

    /// What is in both sets.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// The members, in the order of [`Feature::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Feature> {
        Feature::ALL.iter().copied().filter(move |&feature| self.contains(feature))
    }

    /// The features that are switched on in `structs`: what the host enabled, read from its own structures.
    pub fn of(structs: &FeatureStructs) -> Self {
        Feature::ALL.iter().copied().filter(|feature| feature.get(structs)).collect()
    }

    /// Structures with exactly the set's features switched on, for creating a device.
    pub fn structs(self) -> FeatureStructs {
        let mut structs = FeatureStructs::default();
        self.iter().for_each(|feature| feature.set(&mut structs));
        structs
    }

    /// The features that `physical_device` supports (not: has enabled).
    ///
    /// # Safety
    /// `physical_device` belongs to `instance`, both are alive, and the device's API version is 1.3 or newer.
    pub unsafe fn supported(instance: &ash::Instance, physical_device: vk::PhysicalDevice) -> Self {
        let mut structs = FeatureStructs::default();
        let mut features = vk::PhysicalDeviceFeatures2::default()
            .push_next(&mut structs.v11)
            .push_next(&mut structs.v12)
            .push_next(&mut structs.v13);
        // SAFETY: the caller vouches for the handles; every chained structure is core in 1.3.
        unsafe { instance.get_physical_device_features2(physical_device, &mut features) };
        structs.core = features.features;
        Self::of(&structs)
    }
}

impl FromIterator<Feature> for FeatureSet {
    fn from_iter<I: IntoIterator<Item = Feature>>(features: I) -> Self {
        features.into_iter().fold(Self::default(), Self::with)
    }
}

impl fmt::Debug for FeatureSet {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_set().entries(self.iter()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn structures_and_sets_are_inverse() {
        for &feature in Feature::ALL {
            let set = FeatureSet::default().with(feature);
            assert_eq!(FeatureSet::of(&set.structs()), set, "{feature:?}");
            assert_eq!(set.iter().collect::<Vec<_>>(), [feature]);
        }
        let all: FeatureSet = Feature::ALL.iter().copied().collect();
        assert_eq!(FeatureSet::of(&all.structs()), all);
        assert_eq!(all.without(Feature::ShaderFloat64).iter().count(), Feature::ALL.len() - 1);
    }
}
