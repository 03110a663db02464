//! What a host may choose when it hands over its device, beyond the device itself.

use crate::feature::FeatureSet;
use crate::requirements::{Limit, Requirements};
use ash::vk;

/// Choices of a host; the default is none of them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Most bytes of device memory that everything made from the context may hold at once; `None` for no bound.
    /// Counted is what buffers and images occupy, padding included, not what an allocator keeps beside it. What would
    /// exceed it is refused with [`GpuError::Budget`](crate::GpuError::Budget) before anything is allocated.
    pub memory_budget: Option<u64>,
    /// Whether every labelled step first writes its number where the host can read it after a loss
    /// ([`Context::last_pass_reached`](crate::Context::last_pass_reached)). Costs a full barrier and a fill of 4 bytes
    /// before each step, so that passes no longer overlap: for hunting a loss, not for shipping.
    pub breadcrumbs: bool,
    /// Pretends a lesser device.
    pub mask: DeviceMask,
}

/// A lesser device than the one there is, so that paths for it can be tested on any machine.
///
/// The mask applies after the device was found to meet the requirements: limits below them are for tests of chunking.
/// Memory that the CPU cannot map needs no mask: device memory is never mapped, what goes there goes by a copy. The
/// conformance kit tells a device's memory so (`stage_on`), and holds rooms to the same bits.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DeviceMask {
    /// Limits and what they are lowered to; values above the device's own change nothing.
    pub limits: Vec<(Limit, u64)>,
    /// Whether optional features count as not enabled.
    pub without_optional_features: bool,
}

impl DeviceMask {
    /// The limits behind the mask.
    pub(crate) fn limits(&self, mut limits: vk::PhysicalDeviceLimits) -> vk::PhysicalDeviceLimits {
        self.limits.iter().for_each(|&(limit, most)| limit.lower(&mut limits, most));
        limits
    }

    /// The features behind the mask.
    pub(crate) fn features(&self, features: FeatureSet, requirements: &Requirements) -> FeatureSet {
        match self.without_optional_features {
            true => features.intersection(requirements.features_to_enable(FeatureSet::default())),
            false => features,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feature::Feature;

    #[test]
    fn a_mask_lowers_and_never_raises() {
        let limits = vk::PhysicalDeviceLimits { max_storage_buffer_range: 1 << 30, ..Default::default() };
        let masked = |most| {
            let limit = Limit::StorageBufferRange;
            DeviceMask { limits: vec![(limit, most)], ..Default::default() }
                .limits(limits)
                .max_storage_buffer_range
        };
        assert_eq!((masked(1 << 16), masked(u64::MAX)), (1 << 16, 1 << 30));
        let all: FeatureSet = Feature::ALL.iter().copied().collect();
        let engine = Requirements::engine();
        assert_eq!(DeviceMask::default().features(all, &engine), all);
        let mask = DeviceMask { without_optional_features: true, ..Default::default() };
        let required = [Feature::Synchronization2, Feature::DynamicRendering].into_iter().collect();
        assert_eq!(mask.features(all, &engine), required);
    }
}
