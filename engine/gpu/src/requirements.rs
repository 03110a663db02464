//! What rooms ask of a device, as data, and the check that names what is missing.
//!
//! A host reads [`Requirements`] before it makes its device, and [`Requirements::check`] compares them with an
//! [`Offer`](crate::Offer): what a physical device can do, or what the host has enabled on it. Neither makes a Vulkan call.

mod json;

use crate::feature::{Feature, FeatureSet};
use ash::vk;

/// Extensions that let a host read the device's clock, either of which serves, the newer first.
pub(crate) const CALIBRATED_TIMESTAMPS: [&str; 2] =
    ["VK_KHR_calibrated_timestamps", "VK_EXT_calibrated_timestamps"];

/// A feature some room needs or can use.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FeatureNeed {
    /// The feature.
    pub feature: Feature,
    /// Without it the room cannot run; otherwise it only buys something.
    pub required: bool,
    /// What it buys, in a few words.
    pub buys: &'static str,
}

/// An extension some room needs or can use.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExtensionNeed {
    /// Its name, such as `VK_EXT_debug_utils`.
    pub name: &'static str,
    /// Without it the room cannot run; otherwise it only buys something.
    pub required: bool,
    /// What it buys, in a few words.
    pub buys: &'static str,
}

macro_rules! limits {
    ($($variant:ident = $field:ident, $name:literal;)*) => {
        /// A device limit that rooms depend on. Values are in the limit's own unit (bytes or counts).
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Limit {
            $(#[doc = concat!("`", $name, "`.")] $variant,)*
        }

        impl Limit {
            /// Every limit known here.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)*];

            /// The field's name in the Vulkan specification.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            pub(crate) fn get(self, limits: &vk::PhysicalDeviceLimits) -> u64 {
                match self { $(Self::$variant => u64::from(limits.$field),)* }
            }

            /// Lowers the limit to `most`; never raises it.
            pub(crate) fn lower(self, limits: &mut vk::PhysicalDeviceLimits, most: u64) {
                let most = u32::try_from(most).unwrap_or(u32::MAX);
                match self { $(Self::$variant => limits.$field = limits.$field.min(most),)* }
            }
        }
    };
}

limits! {
    PushConstantsSize = max_push_constants_size, "maxPushConstantsSize";
    StorageBufferRange = max_storage_buffer_range, "maxStorageBufferRange";
    UniformBufferRange = max_uniform_buffer_range, "maxUniformBufferRange";
    ComputeSharedMemorySize = max_compute_shared_memory_size, "maxComputeSharedMemorySize";
    ComputeWorkGroupInvocations = max_compute_work_group_invocations, "maxComputeWorkGroupInvocations";
    PerStageStorageBuffers = max_per_stage_descriptor_storage_buffers, "maxPerStageDescriptorStorageBuffers";
    PerStageUniformBuffers = max_per_stage_descriptor_uniform_buffers, "maxPerStageDescriptorUniformBuffers";
    PerStageSampledImages = max_per_stage_descriptor_sampled_images, "maxPerStageDescriptorSampledImages";
    PerStageStorageImages = max_per_stage_descriptor_storage_images, "maxPerStageDescriptorStorageImages";
    PerStageSamplers = max_per_stage_descriptor_samplers, "maxPerStageDescriptorSamplers";
    ImageDimension2D = max_image_dimension2_d, "maxImageDimension2D";
    ImageDimension3D = max_image_dimension3_d, "maxImageDimension3D";
    ImageArrayLayers = max_image_array_layers, "maxImageArrayLayers";
}

/// A floor under a limit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LimitNeed {
    /// The limit.
    pub limit: Limit,
    /// Its least value, in the limit's own unit.
    pub at_least: u64,
    /// Why, in a few words.
    pub why: &'static str,
}

/// A format and what it must be able to do with optimal tiling.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FormatNeed {
    /// The format.
    pub format: vk::Format,
    /// Features asked of it: of images with optimal tiling, and of buffers for `VERTEX_BUFFER`.
    pub usage: vk::FormatFeatureFlags,
    /// Why, in a few words.
    pub why: &'static str,
}

/// What a device must offer. Plain data: rooms add to it, hosts read it before they make a device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Requirements {
    /// Least API version of instance and device, as `vk::make_api_version` packs it. Below 1.3, required features that
    /// are core in 1.3 need their extensions ([`Feature::extension_before_1_3`]).
    pub api_version: u32,
    /// Instance extensions.
    pub instance_extensions: Vec<ExtensionNeed>,
    /// Device extensions that must be enabled.
    pub extensions: Vec<&'static str>,
    /// Device extensions that buy something where they are enabled.
    pub optional_extensions: Vec<ExtensionNeed>,
    /// Features, required and optional.
    pub features: Vec<FeatureNeed>,
    /// Floors under limits.
    pub limits: Vec<LimitNeed>,
    /// Formats.
    pub formats: Vec<FormatNeed>,
    /// Capabilities of the queue family that commands are recorded for.
    pub queue: vk::QueueFlags,
}

impl Requirements {
    /// What the device layer itself needs: the floor under every room.
    pub fn engine() -> Self {
        let required = |feature, buys| FeatureNeed { feature, required: true, buys };
        let optional = |feature, buys| FeatureNeed { feature, required: false, buys };
        Self {
            api_version: vk::API_VERSION_1_2,
            instance_extensions: vec![ExtensionNeed {
                name: "VK_EXT_debug_utils",
                required: false,
                buys: "names of objects and labels of passes in captures and messages",
            }],
            extensions: Vec::new(),
            optional_extensions: CALIBRATED_TIMESTAMPS
                .map(|name| ExtensionNeed {
                    name,
                    required: false,
                    buys: "passes on the CPU's time line in traces; either of the two serves",
                })
                .into(),
            features: vec![
                required(Feature::Synchronization2, "the plan's barriers"),
                required(Feature::DynamicRendering, "rendering into a host's images"),
                optional(Feature::HostQueryReset, "timestamps reset outside the command buffer"),
                optional(Feature::PipelineStatisticsQuery, "counts of each pass made by the device itself"),
                optional(Feature::RobustBufferAccess, "defined results of out-of-range shader reads"),
            ],
            limits: vec![
                LimitNeed { limit: Limit::PushConstantsSize, at_least: 128, why: "settings of a pass" },
                LimitNeed {
                    limit: Limit::StorageBufferRange,
                    at_least: 1 << 27,
                    why: "large arrays are chunked at 128 MiB",
                },
            ],
            formats: Vec::new(),
            queue: vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE,
        }
    }

    /// The requirements of both: the stricter of each pair.
    #[must_use]
    pub fn and(mut self, other: &Self) -> Self {
        self.api_version = self.api_version.max(other.api_version);
        self.queue |= other.queue;
        for need in &other.instance_extensions {
            match self.instance_extensions.iter_mut().find(|mine| mine.name == need.name) {
                Some(mine) => mine.required |= need.required,
                None => self.instance_extensions.push(need.clone()),
            }
        }
        for &extension in &other.extensions {
            if !self.extensions.contains(&extension) {
                self.extensions.push(extension);
            }
        }
        for need in &other.optional_extensions {
            if !self.optional_extensions.iter().any(|mine| mine.name == need.name) {
                self.optional_extensions.push(need.clone());
            }
        }
        for need in &other.features {
            match self.features.iter_mut().find(|mine| mine.feature == need.feature) {
                Some(mine) if need.required && !mine.required => *mine = need.clone(),
                Some(_) => {}
                None => self.features.push(need.clone()),
            }
        }
        for need in &other.limits {
            match self.limits.iter_mut().find(|mine| mine.limit == need.limit) {
                Some(mine) if need.at_least > mine.at_least => *mine = need.clone(),
                Some(_) => {}
                None => self.limits.push(need.clone()),
            }
        }
        for need in &other.formats {
            match self.formats.iter_mut().find(|mine| mine.format == need.format) {
                Some(mine) => mine.usage |= need.usage,
                None => self.formats.push(need.clone()),
            }
        }
        self
    }

    /// Nothing at all, to build upon.
    pub(crate) fn none() -> Self {
        Self {
            api_version: 0,
            instance_extensions: Vec::new(),
            extensions: Vec::new(),
            optional_extensions: Vec::new(),
            features: Vec::new(),
            limits: Vec::new(),
            formats: Vec::new(),
            queue: vk::QueueFlags::empty(),
        }
    }

    /// The features a device should enable: all that are required, and the optional ones in `supported`.
    pub fn features_to_enable(&self, supported: FeatureSet) -> FeatureSet {
        let wanted = self.features.iter().filter(|need| need.required || supported.contains(need.feature));
        wanted.map(|need| need.feature).collect()
    }
}
