//! Graphics pipelines for dynamic rendering; viewport and scissor are dynamic.

use super::layout::{BindingDesc, Interface, PipelineCore};
use super::spirv::Module;
use crate::context::Context;
use crate::error::GpuError;
use ash::vk;
use std::sync::Arc;

/// One attribute of a vertex buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VertexAttribute {
    /// `layout(location = …)` in the vertex shader.
    pub location: u32,
    /// Format of the attribute.
    pub format: vk::Format,
    /// Bytes from the start of the vertex.
    pub offset: u32,
}

/// One vertex buffer; its slot is its position in [`GraphicsPipelineDesc::vertex_buffers`].
#[derive(Clone, Copy, Debug)]
pub struct VertexBufferLayout<'a> {
    /// Bytes from one vertex (or instance) to the next.
    pub stride: u32,
    /// Per vertex or per instance.
    pub rate: vk::VertexInputRate,
    /// What is in it.
    pub attributes: &'a [VertexAttribute],
}

/// Depth test and write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthState {
    /// Format of the depth attachment.
    pub format: vk::Format,
    /// Which fragments pass.
    pub compare: vk::CompareOp,
    /// Whether they write their depth.
    pub write: bool,
}

/// How fragments meet what is there; the same for every colour attachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blend {
    /// Replace.
    None,
    /// Add, alpha too.
    Add,
    /// Source over destination, with colour already multiplied by alpha.
    PremultipliedOver,
}

/// What a graphics pipeline is to be: triangles, one sample, no stencil.
#[derive(Clone, Copy, Debug)]
pub struct GraphicsPipelineDesc<'a> {
    /// Name, shown by captures, validation and errors.
    pub name: &'a str,
    /// A valid SPIR-V module with a vertex entry point `main`.
    pub vertex: &'a [u32],
    /// The same for the fragment stage; `None` writes depth only.
    pub fragment: Option<&'a [u32]>,
    /// Every binding of descriptor set 0 that the modules use.
    pub bindings: &'a [BindingDesc],
    /// Bytes of push constants, seen by both stages; a multiple of 4.
    pub push_constant_size: u32,
    /// Vertex buffers by slot.
    pub vertex_buffers: &'a [VertexBufferLayout<'a>],
    /// How vertices make primitives.
    pub topology: vk::PrimitiveTopology,
    /// Which faces are dropped.
    pub cull: vk::CullModeFlags,
    /// Which winding faces the front, seen with y down.
    pub front_face: vk::FrontFace,
    /// Depth test; `None` when there is no depth attachment.
    pub depth: Option<DepthState>,
    /// Formats of the colour attachments.
    pub colors: &'a [vk::Format],
    /// How colours meet what is there.
    pub blend: Blend,
}

/// A graphics pipeline. Clones refer to the same one; the last one dropped retires it.
#[derive(Clone)]
pub struct GraphicsPipeline(pub(crate) Arc<Graphics>);

pub(crate) struct Graphics {
    pub core: PipelineCore,
    /// Stride and rate by slot.
    pub vertex_buffers: Vec<(u32, vk::VertexInputRate)>,
    pub colors: Vec<vk::Format>,
    pub depth: Option<DepthState>,
}

/// Most vertex buffers of one pipeline.
pub(crate) const MAX_VERTEX_BUFFERS: usize = 8;
/// Most colour attachments; the least that Vulkan guarantees.
pub(crate) const MAX_COLORS: usize = 4;

impl GraphicsPipeline {
    /// The name it was made with.
    pub fn name(&self) -> &str {
        &self.0.core.name
    }
}

impl Context {
    /// Makes a graphics pipeline.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for SPIR-V that is cut short or lacks its `main`, or a description over the limits;
    /// [`GpuError::Vulkan`] if the driver refuses.
    pub fn create_graphics_pipeline(
        &self,
        desc: &GraphicsPipelineDesc<'_>,
    ) -> Result<GraphicsPipeline, GpuError> {
        if desc.vertex_buffers.len() > MAX_VERTEX_BUFFERS || desc.colors.len() > MAX_COLORS {
            let problem =
                format!("at most {MAX_VERTEX_BUFFERS} vertex buffers and {MAX_COLORS} colours are allowed");
            return Err(GpuError::misuse(desc.name, problem));
        }
        let vertex = Module::new(&self.shared, desc.name, desc.vertex, vk::ShaderStageFlags::VERTEX)?;
        let fragment = match desc.fragment {
            Some(words) => Some(Module::new(&self.shared, desc.name, words, vk::ShaderStageFlags::FRAGMENT)?),
            None => None,
        };
        let interface = Interface {
            bindings: desc.bindings.to_vec(),
            push_constant_size: desc.push_constant_size,
            stages: vk::ShaderStageFlags::VERTEX | vk::ShaderStageFlags::FRAGMENT,
        };
        let mut core = PipelineCore::new(&self.shared, desc.name, interface)?;
        let stages: Vec<_> =
            [Some(&vertex), fragment.as_ref()].into_iter().flatten().map(Module::stage).collect();
        core.pipeline = self.build(desc, &stages, core.layout)?;
        self.shared.pipelines_made.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        self.shared.name(core.pipeline, vk::ObjectType::PIPELINE, desc.name);
        let vertex_buffers = desc.vertex_buffers.iter().map(|buffer| (buffer.stride, buffer.rate)).collect();
        let colors = desc.colors.to_vec();
        Ok(GraphicsPipeline(Arc::new(Graphics { core, vertex_buffers, colors, depth: desc.depth })))
    }

    fn build(
        &self,
        desc: &GraphicsPipelineDesc<'_>,
        stages: &[vk::PipelineShaderStageCreateInfo<'_>],
        layout: vk::PipelineLayout,
    ) -> Result<vk::Pipeline, GpuError> {
        let (buffers, attributes) = vertex_input(desc);
        let vertex_input = vk::PipelineVertexInputStateCreateInfo::default()
            .vertex_binding_descriptions(&buffers)
            .vertex_attribute_descriptions(&attributes);
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(desc.topology);
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let raster = vk::PipelineRasterizationStateCreateInfo::default()
            .cull_mode(desc.cull)
            .front_face(desc.front_face)
            .line_width(1.0);
        let samples = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let depth = desc.depth.map_or_else(Default::default, |depth| {
            vk::PipelineDepthStencilStateCreateInfo::default()
                .depth_test_enable(true)
                .depth_write_enable(depth.write)
                .depth_compare_op(depth.compare)
        });
        let attachments = vec![blend(desc.blend); desc.colors.len()];
        let color = vk::PipelineColorBlendStateCreateInfo::default().attachments(&attachments);
        let dynamic = vk::PipelineDynamicStateCreateInfo::default()
            .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
        let mut rendering = vk::PipelineRenderingCreateInfo::default()
            .color_attachment_formats(desc.colors)
            .depth_attachment_format(desc.depth.map_or(vk::Format::UNDEFINED, |depth| depth.format));
        let info = vk::GraphicsPipelineCreateInfo::default()
            .stages(stages)
            .vertex_input_state(&vertex_input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .depth_stencil_state(&depth)
            .color_blend_state(&color)
            .dynamic_state(&dynamic)
            .layout(layout)
            .push_next(&mut rendering);
        let cache = self.shared.facts.pipeline_cache;
        // SAFETY: everything the description points at is alive here; the host vouches for the cache.
        match unsafe { self.shared.device().create_graphics_pipelines(cache, &[info], None) } {
            Ok(pipelines) => Ok(pipelines.into_iter().next().unwrap_or_default()),
            Err((_, result)) => Err(GpuError::Vulkan { call: "vkCreateGraphicsPipelines", result }),
        }
    }
}

type VertexInput = (Vec<vk::VertexInputBindingDescription>, Vec<vk::VertexInputAttributeDescription>);

fn vertex_input(desc: &GraphicsPipelineDesc<'_>) -> VertexInput {
    let slots = || desc.vertex_buffers.iter().zip(0u32..);
    let buffers = slots()
        .map(|(buffer, binding)| vk::VertexInputBindingDescription {
            binding,
            stride: buffer.stride,
            input_rate: buffer.rate,
        })
        .collect();
    let attributes = slots()
        .flat_map(|(buffer, binding)| {
            buffer.attributes.iter().map(move |attribute| vk::VertexInputAttributeDescription {
                location: attribute.location,
                binding,
                format: attribute.format,
                offset: attribute.offset,
            })
        })
        .collect();
    (buffers, attributes)
}

fn blend(blend: Blend) -> vk::PipelineColorBlendAttachmentState {
    let state =
        vk::PipelineColorBlendAttachmentState::default().color_write_mask(vk::ColorComponentFlags::RGBA);
    let destination = match blend {
        Blend::None => return state,
        Blend::Add => vk::BlendFactor::ONE,
        Blend::PremultipliedOver => vk::BlendFactor::ONE_MINUS_SRC_ALPHA,
    };
    state
        .blend_enable(true)
        .src_color_blend_factor(vk::BlendFactor::ONE)
        .dst_color_blend_factor(destination)
        .src_alpha_blend_factor(vk::BlendFactor::ONE)
        .dst_alpha_blend_factor(destination)
}
