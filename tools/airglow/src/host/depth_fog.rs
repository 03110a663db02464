//! Exponential depth fog: what most games draw, and what the fog pass is shown beside.

use airglow_gpu::ash::vk;
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, Blend, ColorAttachment, Context, GpuError, GraphicsPipeline,
    GraphicsPipelineDesc, Load, Record, Rendering,
};
use airglow_graph::{Access, Graph, ImageDesc, PassKind};
use bytemuck::{Pod, Zeroable};

use super::draw::Drawn;
use super::shaders;

/// `Fog` of `host/depth_fog.frag`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct DepthFogConstants {
    /// Coefficients of `common/depth.glsl`.
    pub depth: [f32; 4],
    /// 1/m; the last is the depth where there is no surface.
    pub extinction: [f32; 4],
    /// What far things turn to, W/sr/m2; the last is unused.
    pub colour: [f32; 4],
}

/// The pipeline of the pass.
#[derive(Clone)]
pub struct DepthFog {
    pipeline: GraphicsPipeline,
    hdr: vk::Format,
}

const BINDINGS: [BindingDesc; 2] =
    [BindingDesc::new(0, BindingKind::SampledImage), BindingDesc::new(1, BindingKind::SampledImage)];

impl DepthFog {
    /// For pictures of a float format.
    pub fn new(context: &Context, hdr: vk::Format) -> Result<Self, GpuError> {
        let pipeline = context.create_graphics_pipeline(&GraphicsPipelineDesc {
            name: "depth fog",
            vertex: &shaders::rectangle_vertex(),
            fragment: Some(&shaders::depth_fog_fragment()),
            bindings: &BINDINGS,
            push_constant_size: size_of::<DepthFogConstants>() as u32,
            vertex_buffers: &[],
            topology: vk::PrimitiveTopology::TRIANGLE_LIST,
            cull: vk::CullModeFlags::NONE,
            front_face: vk::FrontFace::COUNTER_CLOCKWISE,
            depth: None,
            colors: &[hdr],
            blend: Blend::None,
        })?;
        Ok(Self { pipeline, hdr })
    }

    /// Puts the fog before a view of `size` samples.
    pub fn add(
        &self,
        graph: &mut Graph<Record>,
        drawn: &mut Drawn,
        constants: DepthFogConstants,
        size: [u32; 2],
    ) {
        let (surface, depth) = (drawn.hdr, drawn.depth);
        let mut pass = graph.pass("depth fog", PassKind::Graphics);
        pass.read(&surface, Access::FragmentSampled).read(&depth, Access::FragmentSampledDepth);
        let desc = ImageDesc::new_2d(size[0], size[1], self.hdr);
        let target = pass.create_image("picture in depth fog", desc, Access::ColorAttachmentWrite);
        let pipeline = self.pipeline.clone();
        pass.record(Box::new(move |recorder, resources| {
            let colors = [ColorAttachment { view: &resources.view(&target)?, load: Load::Discard }];
            recorder.begin_rendering(&Rendering { colors: &colors, depth: None })?;
            let bound = [
                Binding::sampled(0, resources.view(&surface)?),
                Binding::sampled(1, resources.view(&depth)?),
            ];
            recorder.bind_graphics(&pipeline, &bound)?;
            recorder.push_constants(&constants)?;
            recorder.draw(0..3, 0..1)?;
            recorder.end_rendering()
        }));
        drawn.hdr = target;
    }
}
