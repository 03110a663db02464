//! The pipelines of the forward draw: what they bind, and what a vertex brings.

use airglow_gpu::ash::vk;
use airglow_gpu::{
    BindingDesc, BindingKind, Blend, Context, DepthState, GpuError, GraphicsPipeline, GraphicsPipelineDesc,
    VertexAttribute, VertexBufferLayout,
};

use super::formats::DEPTH;
use super::scene::MaterialConstants;
use super::shaders;

/// The fourth is for the lights, where there are any, the last for their tables in fog.
pub const DRAW_BINDINGS: [BindingDesc; 5] = [
    BindingDesc::new(0, BindingKind::UniformBuffer),
    BindingDesc::new(1, BindingKind::SampledImage),
    BindingDesc::new(2, BindingKind::Sampler),
    BindingDesc::new(3, BindingKind::UniformBuffer),
    BindingDesc::new(4, BindingKind::StorageBuffer),
];

/// What the vertex stage hands on of a surface.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Inputs {
    /// Texture coordinates and the light of the vertex.
    Unlit,
    /// Place and normal as well: the scene has lights.
    Lit,
    /// What lamps shine on the vertex, through a medium.
    #[cfg(feature = "fog")]
    LitVertices,
    /// Tangent as well: the surface has a normal map.
    Mapped,
    /// And so many bytes of coefficients of the radiance that meets the vertex.
    Incident(u32),
}

impl Inputs {
    /// Bytes of the coefficients.
    fn incident(self) -> Option<u32> {
        match self {
            Self::Incident(bytes) => Some(bytes),
            _ => None,
        }
    }
}

/// The pipeline of a forward draw.
pub fn scene_pipeline(
    context: &Context,
    hdr: vk::Format,
    relight: bool,
    inputs: Inputs,
    fragment: &[u32],
    bindings: &[BindingDesc],
) -> Result<GraphicsPipeline, GpuError> {
    let attribute = |location, format| VertexAttribute { location, format, offset: 0 };
    let position = [attribute(0, vk::Format::R32G32B32_SFLOAT)];
    let texture_coordinates = [attribute(1, vk::Format::R32G32_SFLOAT)];
    let colour = [attribute(2, vk::Format::R32G32B32A32_SFLOAT)];
    let layout =
        |stride, attributes| VertexBufferLayout { stride, rate: vk::VertexInputRate::VERTEX, attributes };
    let normal = [attribute(3, vk::Format::R32G32B32_SFLOAT)];
    let mut buffers = vec![layout(12, &position[..]), layout(8, &texture_coordinates[..])];
    buffers.extend(relight.then(|| layout(16, &colour[..])));
    let tangent = [attribute(4, vk::Format::R32G32B32A32_SFLOAT)];
    buffers.extend((inputs != Inputs::Unlit).then(|| layout(12, &normal[..])));
    let incident = inputs.incident();
    buffers.extend((incident.is_some() || inputs == Inputs::Mapped).then(|| layout(16, &tangent[..])));
    let coefficients: [VertexAttribute; 9] = std::array::from_fn(|i| VertexAttribute {
        offset: 12 * i as u32,
        ..attribute(5 + i as u32, vk::Format::R32G32B32_SFLOAT)
    });
    buffers.extend(incident.map(|bytes| layout(bytes, &coefficients[..])));
    let vertex = match inputs {
        #[cfg(feature = "normals")]
        Inputs::Mapped => shaders::mapped_vertex(relight),
        #[cfg(feature = "normals")]
        Inputs::Incident(_) => shaders::incident_vertex(),
        #[cfg(feature = "fog")]
        Inputs::LitVertices => shaders::complete_vertex(relight),
        _ => shaders::scene_vertex(relight, inputs != Inputs::Unlit),
    };
    context.create_graphics_pipeline(&GraphicsPipelineDesc {
        name: if relight { "scene, relit" } else { "scene, ambient" },
        vertex: &vertex,
        fragment: Some(fragment),
        bindings,
        push_constant_size: size_of::<MaterialConstants>() as u32,
        vertex_buffers: &buffers,
        topology: vk::PrimitiveTopology::TRIANGLE_LIST,
        cull: vk::CullModeFlags::NONE,
        front_face: vk::FrontFace::COUNTER_CLOCKWISE,
        depth: Some(DepthState { format: DEPTH, compare: vk::CompareOp::LESS_OR_EQUAL, write: true }),
        colors: &[hdr],
        blend: Blend::None,
    })
}
