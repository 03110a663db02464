//! What a pipeline takes: bindings of descriptor set 0 and push constants.

use crate::error::GpuError;
use crate::requirements::{Limit, LimitNeed, Requirements};
use crate::retire::Retired;
use crate::shared::Shared;
use ash::vk;
use std::sync::Arc;

/// Most bindings of one pipeline; the least that Vulkan guarantees for all kinds together is larger.
pub const MAX_BINDINGS: usize = 16;

/// What a binding holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BindingKind {
    /// A storage buffer.
    StorageBuffer,
    /// A uniform buffer.
    UniformBuffer,
    /// A sampled image (GLSL `texture2D` and its like), without sampler.
    SampledImage,
    /// A storage image, in layout `GENERAL`.
    StorageImage,
    /// A sampler.
    Sampler,
}

impl BindingKind {
    /// Vulkan's name for it.
    pub fn descriptor_type(self) -> vk::DescriptorType {
        match self {
            Self::StorageBuffer => vk::DescriptorType::STORAGE_BUFFER,
            Self::UniformBuffer => vk::DescriptorType::UNIFORM_BUFFER,
            Self::SampledImage => vk::DescriptorType::SAMPLED_IMAGE,
            Self::StorageImage => vk::DescriptorType::STORAGE_IMAGE,
            Self::Sampler => vk::DescriptorType::SAMPLER,
        }
    }
}

/// One binding of descriptor set 0, seen by every stage of its pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BindingDesc {
    /// `layout(binding = …)` in the shader.
    pub binding: u32,
    /// What it holds.
    pub kind: BindingKind,
}

impl BindingDesc {
    /// Binding `binding` holding a `kind`.
    pub const fn new(binding: u32, kind: BindingKind) -> Self {
        Self { binding, kind }
    }
}

impl Requirements {
    /// Asks for room for the descriptors of a pipeline with `bindings`, all of them seen by one stage.
    #[must_use]
    pub fn with_descriptors(self, bindings: &[BindingDesc]) -> Self {
        let count = |kind| bindings.iter().filter(|binding| binding.kind == kind).count() as u64;
        let floor = |(kind, limit)| match count(kind) {
            0 => None,
            at_least => Some(LimitNeed { limit, at_least, why: "descriptors of one pipeline" }),
        };
        let kinds = [
            (BindingKind::StorageBuffer, Limit::PerStageStorageBuffers),
            (BindingKind::UniformBuffer, Limit::PerStageUniformBuffers),
            (BindingKind::SampledImage, Limit::PerStageSampledImages),
            (BindingKind::StorageImage, Limit::PerStageStorageImages),
            (BindingKind::Sampler, Limit::PerStageSamplers),
        ];
        let limits = kinds.into_iter().filter_map(floor).collect();
        let descriptors = Self { limits, ..Self::none() };
        self.and(&descriptors)
    }
}

/// The interface of a pipeline, in the order stated.
pub(crate) struct Interface {
    pub bindings: Vec<BindingDesc>,
    pub push_constant_size: u32,
    pub stages: vk::ShaderStageFlags,
}

/// What both kinds of pipeline are made of; the last clone of a pipeline retires it.
pub(crate) struct PipelineCore {
    pub shared: Arc<Shared>,
    pub name: String,
    pub interface: Interface,
    pub set_layout: vk::DescriptorSetLayout,
    pub layout: vk::PipelineLayout,
    pub pipeline: vk::Pipeline,
}

impl PipelineCore {
    /// Makes the layouts; the pipeline itself is still null and comes next.
    pub(crate) fn new(shared: &Arc<Shared>, name: &str, interface: Interface) -> Result<Self, GpuError> {
        check(shared, name, &interface)?;
        let mut core = Self {
            shared: Arc::clone(shared),
            name: name.to_owned(),
            interface,
            set_layout: vk::DescriptorSetLayout::null(),
            layout: vk::PipelineLayout::null(),
            pipeline: vk::Pipeline::null(),
        };
        let Interface { bindings, push_constant_size, stages } = &core.interface;
        let bindings: Vec<_> = bindings
            .iter()
            .map(|desc| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(desc.binding)
                    .descriptor_type(desc.kind.descriptor_type())
                    .descriptor_count(1)
                    .stage_flags(*stages)
            })
            .collect();
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        let device = shared.device();
        // SAFETY: a live device and a checked description.
        core.set_layout = unsafe { device.create_descriptor_set_layout(&info, None) }
            .map_err(GpuError::vulkan("vkCreateDescriptorSetLayout"))?;
        let set_layouts = [core.set_layout];
        let constants =
            [vk::PushConstantRange { stage_flags: *stages, offset: 0, size: *push_constant_size }];
        let constants = if *push_constant_size > 0 { &constants[..] } else { &[] };
        let info =
            vk::PipelineLayoutCreateInfo::default().set_layouts(&set_layouts).push_constant_ranges(constants);
        // SAFETY: as above; dropping `core` on an error destroys what was made.
        core.layout = unsafe { device.create_pipeline_layout(&info, None) }
            .map_err(GpuError::vulkan("vkCreatePipelineLayout"))?;
        Ok(core)
    }
}

impl Drop for PipelineCore {
    fn drop(&mut self) {
        let Self { pipeline, layout, set_layout, .. } = *self;
        self.shared.retire(Retired::Pipeline { pipeline, layout, set_layout });
    }
}

fn check(shared: &Shared, name: &str, interface: &Interface) -> Result<(), GpuError> {
    let limit = shared.facts.limits.max_push_constants_size;
    let size = interface.push_constant_size;
    if size > limit || !size.is_multiple_of(4) {
        let problem = format!("{size} bytes of push constants; a multiple of 4 up to {limit} is allowed");
        return Err(GpuError::misuse(name, problem));
    }
    if interface.bindings.len() > MAX_BINDINGS {
        let problem = format!("{} bindings; at most {MAX_BINDINGS} are allowed", interface.bindings.len());
        return Err(GpuError::misuse(name, problem));
    }
    let twice = |(i, desc): (usize, &BindingDesc)| {
        interface.bindings[..i].iter().any(|other| other.binding == desc.binding).then_some(desc.binding)
    };
    match interface.bindings.iter().enumerate().find_map(twice) {
        Some(binding) => Err(GpuError::misuse(name, format!("binding {binding} is stated twice"))),
        None => Ok(()),
    }
}
