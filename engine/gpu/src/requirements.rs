//! What rooms ask of a device, as data, and the check that names what is missing.
//!
//! A host reads [`Requirements`] before it makes its device, and [`Requirements::check`] compares them with an
//! [`Offer`]: what a physical device can do, or what the host has enabled on it. Neither makes a Vulkan call.

use crate::feature::{Feature, FeatureSet};
use ash::vk;
use std::collections::BTreeMap;
use std::fmt;

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

            fn get(self, limits: &vk::PhysicalDeviceLimits) -> u64 {
                match self { $(Self::$variant => u64::from(limits.$field),)* }
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
    /// Least API version of instance and device, as `vk::make_api_version` packs it.
    pub api_version: u32,
    /// Device extensions that must be enabled.
    pub extensions: Vec<&'static str>,
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
            api_version: vk::API_VERSION_1_3,
            extensions: Vec::new(),
            features: vec![
                required(Feature::Synchronization2, "the plan's barriers"),
                required(Feature::DynamicRendering, "rendering into a host's images"),
                optional(Feature::HostQueryReset, "timestamps reset outside the command buffer"),
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
        for &extension in &other.extensions {
            if !self.extensions.contains(&extension) {
                self.extensions.push(extension);
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

    /// The features a device should enable: all that are required, and the optional ones in `supported`.
    pub fn features_to_enable(&self, supported: FeatureSet) -> FeatureSet {
        let wanted = self.features.iter().filter(|need| need.required || supported.contains(need.feature));
        wanted.map(|need| need.feature).collect()
    }

    /// Everything `offer` lacks; empty when it suffices. Optional features are never listed.
    pub fn check(&self, offer: &Offer) -> Vec<Missing> {
        let mut missing = Vec::new();
        if offer.api_version < self.api_version {
            missing.push(Missing::ApiVersion { needed: self.api_version, offered: offer.api_version });
        }
        if !offer.queue.contains(self.queue) {
            missing.push(Missing::Queue { needed: self.queue, offered: offer.queue });
        }
        let extensions =
            self.extensions.iter().filter(|&&name| !offer.extensions.iter().any(|have| have == name));
        missing.extend(extensions.map(|&name| Missing::Extension { name }));
        let features =
            self.features.iter().filter(|need| need.required && !offer.features.contains(need.feature));
        missing.extend(features.map(|need| Missing::Feature { feature: need.feature, buys: need.buys }));
        for need in &self.limits {
            let offered = offer.limits.get(&need.limit).copied().unwrap_or(0);
            if offered < need.at_least {
                missing.push(Missing::Limit { need: need.clone(), offered });
            }
        }
        for need in &self.formats {
            let lacking = need.usage & !offer.formats.get(&need.format).copied().unwrap_or_default();
            if !lacking.is_empty() {
                missing.push(Missing::Format { format: need.format, lacking, why: need.why });
            }
        }
        missing
    }
}

/// What a device offers: plain data, so that checks can be tested on invented devices.
#[derive(Clone, Debug, Default)]
pub struct Offer {
    /// API version of the device (or of the instance, if that is lower).
    pub api_version: u32,
    /// Device extensions.
    pub extensions: Vec<String>,
    /// Features.
    pub features: FeatureSet,
    /// Limits.
    pub limits: BTreeMap<Limit, u64>,
    /// Format features: optimal tiling, with the buffer features added.
    pub formats: BTreeMap<vk::Format, vk::FormatFeatureFlags>,
    /// Capabilities of the queue family in question.
    pub queue: vk::QueueFlags,
}

impl Offer {
    /// Reads limits, formats (those that `requirements` ask about) and the queue family from a physical device.
    ///
    /// Features and extensions are the caller's to state: supported ones to judge a device, enabled ones to adopt it.
    ///
    /// # Safety
    /// `physical_device` belongs to `instance` and both are alive.
    pub unsafe fn read(
        instance: &ash::Instance,
        physical_device: vk::PhysicalDevice,
        queue_family: u32,
        requirements: &Requirements,
    ) -> Self {
        // SAFETY: the caller vouches for the handles.
        let (properties, queues) = unsafe {
            (
                instance.get_physical_device_properties(physical_device),
                instance.get_physical_device_queue_family_properties(physical_device),
            )
        };
        let format = |need: &FormatNeed| {
            // SAFETY: as above.
            let have =
                unsafe { instance.get_physical_device_format_properties(physical_device, need.format) };
            (need.format, have.optimal_tiling_features | have.buffer_features)
        };
        Self {
            api_version: properties.api_version,
            limits: Limit::ALL.iter().map(|&limit| (limit, limit.get(&properties.limits))).collect(),
            formats: requirements.formats.iter().map(format).collect(),
            queue: queues.get(queue_family as usize).map(|family| family.queue_flags).unwrap_or_default(),
            ..Self::default()
        }
    }
}

/// One thing a device lacks.
#[derive(Clone, Debug, PartialEq, Eq)]
#[expect(
    missing_docs,
    reason = "each variant and field is named after what it holds, and printed by Display"
)]
pub enum Missing {
    ApiVersion { needed: u32, offered: u32 },
    Extension { name: &'static str },
    Feature { feature: Feature, buys: &'static str },
    Limit { need: LimitNeed, offered: u64 },
    Format { format: vk::Format, lacking: vk::FormatFeatureFlags, why: &'static str },
    Queue { needed: vk::QueueFlags, offered: vk::QueueFlags },
}

impl fmt::Display for Missing {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let version = |v: u32| format!("{}.{}", vk::api_version_major(v), vk::api_version_minor(v));
        match self {
            Self::ApiVersion { needed, offered } => {
                write!(out, "Vulkan {} (this is {})", version(*needed), version(*offered))
            }
            Self::Extension { name } => write!(out, "extension {name}, not enabled"),
            Self::Feature { feature, buys } => {
                write!(out, "feature {}, not enabled ({buys})", feature.name())
            }
            Self::Limit { need, offered } => {
                write!(out, "{} of {} (this is {offered}; {})", need.limit.name(), need.at_least, need.why)
            }
            Self::Format { format, lacking, why } => write!(out, "{lacking:?} for {format:?} ({why})"),
            Self::Queue { needed, offered } => {
                write!(out, "a queue family with {needed:?} (this has {offered:?})")
            }
        }
    }
}
