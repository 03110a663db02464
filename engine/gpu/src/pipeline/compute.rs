//! Compute pipelines.

use super::layout::{BindingDesc, Interface, PipelineCore};
use super::spirv::{Module, workgroup_invocations};
use crate::context::Context;
use crate::error::GpuError;
use ash::vk;
use std::sync::Arc;

/// What a compute pipeline is to be.
#[derive(Clone, Copy, Debug)]
pub struct ComputePipelineDesc<'a> {
    /// Name, shown by captures, validation and errors.
    pub name: &'a str,
    /// A valid SPIR-V module with a compute entry point `main`.
    pub spirv: &'a [u32],
    /// Every binding of descriptor set 0 that the module uses.
    pub bindings: &'a [BindingDesc],
    /// Bytes of push constants; a multiple of 4.
    pub push_constant_size: u32,
}

/// A compute pipeline. Clones refer to the same one; the last one dropped retires it.
#[derive(Clone)]
pub struct ComputePipeline {
    pub(crate) core: Arc<PipelineCore>,
    workgroup: u64,
}

impl ComputePipeline {
    /// The name it was made with.
    pub fn name(&self) -> &str {
        &self.core.name
    }

    /// Invocations of a workgroup, as the module states them.
    pub fn workgroup_invocations(&self) -> u64 {
        self.workgroup
    }
}

impl Context {
    /// Makes a compute pipeline.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for SPIR-V that is cut short or has no compute `main`, or bindings over the limits;
    /// [`GpuError::Vulkan`] if the driver refuses.
    pub fn create_compute_pipeline(
        &self,
        desc: &ComputePipelineDesc<'_>,
    ) -> Result<ComputePipeline, GpuError> {
        let stages = vk::ShaderStageFlags::COMPUTE;
        let module = Module::new(&self.shared, desc.name, desc.spirv, stages)?;
        let interface = Interface {
            bindings: desc.bindings.to_vec(),
            push_constant_size: desc.push_constant_size,
            stages,
        };
        let mut core = PipelineCore::new(&self.shared, desc.name, interface)?;
        let info = vk::ComputePipelineCreateInfo::default().stage(module.stage()).layout(core.layout);
        let cache = self.shared.facts.pipeline_cache;
        // SAFETY: module and layout are alive; the host vouches for the cache.
        let made = unsafe { self.shared.device().create_compute_pipelines(cache, &[info], None) };
        core.pipeline = match made {
            Ok(pipelines) => pipelines.into_iter().next().unwrap_or_default(),
            Err((_, result)) => return Err(GpuError::Vulkan { call: "vkCreateComputePipelines", result }),
        };
        self.shared.pipelines_made.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        self.shared.name(core.pipeline, vk::ObjectType::PIPELINE, desc.name);
        Ok(ComputePipeline { core: Arc::new(core), workgroup: workgroup_invocations(desc.spirv) })
    }
}
