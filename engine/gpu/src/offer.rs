//! What a device offers, and what it lacks of what is required.

use crate::feature::{Feature, FeatureSet};
use crate::requirements::{FormatNeed, Limit, LimitNeed, Requirements};
use ash::vk;
use std::collections::BTreeMap;
use std::fmt;

/// What a device offers: plain data, so that checks can be tested on invented devices.
#[derive(Clone, Debug, Default)]
pub struct Offer {
    /// API version of the device (or of the instance, if that is lower).
    pub api_version: u32,
    /// Extensions of instance and device.
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

impl Requirements {
    /// Everything `offer` lacks; empty when it suffices. Optional features are never listed.
    pub fn check(&self, offer: &Offer) -> Vec<Missing> {
        let mut missing = Vec::new();
        if offer.api_version < self.api_version {
            missing.push(Missing::ApiVersion { needed: self.api_version, offered: offer.api_version });
        }
        if !offer.queue.contains(self.queue) {
            missing.push(Missing::Queue { needed: self.queue, offered: offer.queue });
        }
        let features_below_1_3 = self.features.iter().filter(|need| need.required).filter_map(|need| {
            let core = offer.api_version >= vk::API_VERSION_1_3;
            need.feature.extension_before_1_3().filter(|_| !core)
        });
        let instance = self.instance_extensions.iter().filter(|need| need.required).map(|need| need.name);
        let extensions = instance.chain(self.extensions.iter().copied()).chain(features_below_1_3);
        let lacking = extensions.filter(|&name| !offer.extensions.iter().any(|have| have == name));
        missing.extend(lacking.map(|name| Missing::Extension { name }));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirements::FeatureNeed;

    /// An invented device that just suffices for the engine.
    fn plain() -> Offer {
        Offer {
            api_version: vk::API_VERSION_1_3,
            features: FeatureSet::default().with(Feature::Synchronization2).with(Feature::DynamicRendering),
            limits: [(Limit::PushConstantsSize, 128), (Limit::StorageBufferRange, 1 << 27)].into(),
            queue: vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE | vk::QueueFlags::TRANSFER,
            ..Offer::default()
        }
    }

    #[test]
    fn a_device_that_suffices_lacks_nothing() {
        assert_eq!(Requirements::engine().check(&plain()), []);
    }

    #[test]
    fn below_1_3_the_extensions_stand_in_for_the_core() {
        let older = Offer { api_version: vk::API_VERSION_1_2, ..plain() };
        let names = ["VK_KHR_synchronization2", "VK_KHR_dynamic_rendering"];
        let missing = names.map(|name| Missing::Extension { name });
        assert_eq!(Requirements::engine().check(&older), missing);
        let extended = Offer { extensions: names.map(str::to_owned).to_vec(), ..older };
        assert_eq!(Requirements::engine().check(&extended), []);
    }

    #[test]
    fn everything_missing_is_named() {
        let missing = Requirements::engine().check(&Offer::default());
        let text: Vec<_> = missing.iter().map(ToString::to_string).collect();
        let expected = [
            "Vulkan 1.2 (this is 0.0)",
            "a queue family with GRAPHICS | COMPUTE (this has )",
            "extension VK_KHR_synchronization2, not enabled",
            "extension VK_KHR_dynamic_rendering, not enabled",
            "feature synchronization2, not enabled (the plan's barriers)",
            "feature dynamicRendering, not enabled (rendering into a host's images)",
            "maxPushConstantsSize of 128 (this is 0; settings of a pass)",
            "maxStorageBufferRange of 134217728 (this is 0; large arrays are chunked at 128 MiB)",
        ];
        assert_eq!(text, expected);
    }

    #[test]
    fn the_stricter_of_two_requirements_wins() {
        let format = |usage| FormatNeed { format: vk::Format::R32_SFLOAT, usage, why: "shadows" };
        let room = Requirements {
            extensions: vec!["VK_KHR_x"],
            features: vec![FeatureNeed { feature: Feature::HostQueryReset, required: true, buys: "x" }],
            limits: vec![LimitNeed { limit: Limit::PushConstantsSize, at_least: 64, why: "less" }],
            formats: vec![format(vk::FormatFeatureFlags::SAMPLED_IMAGE)],
            ..Requirements::engine()
        };
        let other =
            Requirements { formats: vec![format(vk::FormatFeatureFlags::STORAGE_IMAGE)], ..room.clone() };
        let both = Requirements::engine().and(&room).and(&other).and(&room);
        assert_eq!(both.extensions, ["VK_KHR_x"]);
        assert_eq!(both.features.len(), Requirements::engine().features.len());
        let missing = both.check(&plain());
        assert_eq!(missing.len(), 3, "{missing:?}");
        assert!(missing.contains(&Missing::Extension { name: "VK_KHR_x" }));
        assert!(missing.contains(&Missing::Feature { feature: Feature::HostQueryReset, buys: "x" }));
        let lacking = vk::FormatFeatureFlags::SAMPLED_IMAGE | vk::FormatFeatureFlags::STORAGE_IMAGE;
        assert!(missing.contains(&Missing::Format {
            format: vk::Format::R32_SFLOAT,
            lacking,
            why: "shadows"
        }));
        let supported = FeatureSet::default().with(Feature::RobustBufferAccess).with(Feature::ShaderInt64);
        let enabled = both.features_to_enable(supported);
        assert!(enabled.contains(Feature::RobustBufferAccess) && !enabled.contains(Feature::ShaderInt64));
    }
}
