//! The depth of a view's surfaces before any is shaded, so that a costly draw shades of each pixel only what is seen.

use std::sync::Arc;

use airglow_gpu::ash::vk;
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, Blend, Context, DepthAttachment, DepthState, GpuError,
    GraphicsPipeline, GraphicsPipelineDesc, Load, Record, Rendering, VertexAttribute, VertexBufferLayout,
};
use airglow_graph::{Access, Graph, Handle, Image, ImageDesc, PassKind};

use super::scene::{DeviceScene, MaterialConstants};
use super::shaders;
use super::skin::Posed;
use super::view::SharedView;

/// Whether a scene is worth it: it has surfaces with normal maps, which cost most, and others that may lie before them.
pub fn is_worth(scene: &DeviceScene) -> bool {
    scene.draws.len() > 1 && scene.draws.iter().any(|draw| draw.mapped.is_some())
}

/// The pass: the same vertex stage as that of the draw, and no fragments.
pub struct DepthFirst {
    pipeline: GraphicsPipeline,
    format: vk::Format,
}

impl DepthFirst {
    /// Makes its pipeline, for depth of a format.
    pub fn new(context: &Context, format: vk::Format) -> Result<Self, GpuError> {
        let attribute = |location, format| [VertexAttribute { location, format, offset: 0 }];
        let position = attribute(0, vk::Format::R32G32B32_SFLOAT);
        let texture_coordinates = attribute(1, vk::Format::R32G32_SFLOAT);
        let rate = vk::VertexInputRate::VERTEX;
        let pipeline = context.create_graphics_pipeline(&GraphicsPipelineDesc {
            name: "depth first",
            vertex: &shaders::scene_vertex(false, false),
            fragment: None,
            bindings: &[BindingDesc::new(0, BindingKind::UniformBuffer)],
            push_constant_size: size_of::<MaterialConstants>() as u32,
            vertex_buffers: &[
                VertexBufferLayout { stride: 12, rate, attributes: &position },
                VertexBufferLayout { stride: 8, rate, attributes: &texture_coordinates },
            ],
            topology: vk::PrimitiveTopology::TRIANGLE_LIST,
            cull: vk::CullModeFlags::NONE,
            front_face: vk::FrontFace::COUNTER_CLOCKWISE,
            depth: Some(DepthState { format, compare: vk::CompareOp::LESS_OR_EQUAL, write: true }),
            colors: &[],
            blend: Blend::None,
        })?;
        Ok(Self { pipeline, format })
    }

    /// Adds the pass; surfaces with holes, which only their fragments know, are left to the draw.
    pub fn add(
        &self,
        graph: &mut Graph<Record>,
        scene: &Arc<DeviceScene>,
        view: &SharedView,
        posed: &[Posed],
        size: [u32; 2],
    ) -> Handle<Image> {
        let mut pass = graph.pass("scene depth", PassKind::Graphics);
        posed.iter().for_each(|posed| {
            pass.read(&posed.positions, Access::VertexBuffer);
        });
        let desc = ImageDesc::new_2d(size[0], size[1], self.format);
        let depth = pass.create_image("depth", desc, Access::DepthAttachmentWrite);
        let (pipeline, scene, view) = (self.pipeline.clone(), Arc::clone(scene), view.clone());
        pass.record(Box::new(move |recorder, resources| {
            let target = resources.view(&depth)?;
            recorder.begin_rendering(&Rendering {
                colors: &[],
                depth: Some(DepthAttachment { view: &target, load: Load::Clear(1.0), write: true }),
            })?;
            let view = recorder.upload(&[view.get()])?;
            recorder.bind_graphics(&pipeline, &[Binding::uniform(0, &view)])?;
            for draw in scene.draws.iter().filter(|draw| !draw.material.has_holes()) {
                recorder.push_constants(&draw.material)?;
                recorder.bind_vertex_buffer(0, &draw.mesh.positions)?;
                recorder.bind_vertex_buffer(1, &draw.mesh.texture_coordinates)?;
                recorder.bind_index_buffer(&draw.mesh.indices)?;
                recorder.draw_indexed(0..draw.mesh.index_count, 0, 0..1)?;
            }
            recorder.end_rendering()
        }));
        depth
    }
}
