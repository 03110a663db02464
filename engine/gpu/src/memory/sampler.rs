//! Samplers.

use crate::error::GpuError;
use crate::retire::Retired;
use crate::shared::Shared;
use ash::vk;
use std::sync::Arc;

/// How an image is sampled.
#[derive(Clone, Copy, Debug)]
pub struct SamplerDesc<'a> {
    /// Name, shown by captures and validation.
    pub name: &'a str,
    /// Filter within a mip.
    pub filter: vk::Filter,
    /// Filter between mips.
    pub mipmap_mode: vk::SamplerMipmapMode,
    /// Addressing in u, v and w.
    pub address: [vk::SamplerAddressMode; 3],
    /// The comparison of a shadow sampler.
    pub compare: Option<vk::CompareOp>,
}

impl<'a> SamplerDesc<'a> {
    /// Linear filtering within and between mips, clamped at the edges.
    pub fn linear(name: &'a str) -> Self {
        Self {
            name,
            filter: vk::Filter::LINEAR,
            mipmap_mode: vk::SamplerMipmapMode::LINEAR,
            address: [vk::SamplerAddressMode::CLAMP_TO_EDGE; 3],
            compare: None,
        }
    }
}

/// A sampler. Clones refer to the same one; the last one dropped retires it.
#[derive(Clone)]
pub struct Sampler(Arc<Inner>);

struct Inner {
    shared: Arc<Shared>,
    raw: vk::Sampler,
}

impl Sampler {
    pub(crate) fn new(shared: &Arc<Shared>, desc: &SamplerDesc<'_>) -> Result<Self, GpuError> {
        let info = vk::SamplerCreateInfo::default()
            .mag_filter(desc.filter)
            .min_filter(desc.filter)
            .mipmap_mode(desc.mipmap_mode)
            .address_mode_u(desc.address[0])
            .address_mode_v(desc.address[1])
            .address_mode_w(desc.address[2])
            .compare_enable(desc.compare.is_some())
            .compare_op(desc.compare.unwrap_or_default())
            .max_lod(vk::LOD_CLAMP_NONE);
        // SAFETY: a live device and a complete description without extensions.
        let raw = unsafe { shared.device().create_sampler(&info, None) }
            .map_err(GpuError::vulkan("vkCreateSampler"))?;
        shared.name(raw, vk::ObjectType::SAMPLER, desc.name);
        Ok(Self(Arc::new(Inner { shared: Arc::clone(shared), raw })))
    }

    /// The Vulkan handle.
    pub fn raw(&self) -> vk::Sampler {
        self.0.raw
    }

    pub(crate) fn belongs_to(&self, shared: &Arc<Shared>) -> bool {
        Arc::ptr_eq(&self.0.shared, shared)
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        self.shared.retire(Retired::Sampler(self.raw));
    }
}
