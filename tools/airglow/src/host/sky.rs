//! The background of a view: the environment, as it is or seen through the scene's medium.

use airglow_gpu::ash::vk;
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, Blend, BufferSlice, Context, DepthState, GpuError, GraphicsPipeline,
    GraphicsPipelineDesc, ImageView, Recorder,
};
use airglow_graph::{Handle, Image};

use super::formats::DEPTH;
use super::scene::Sky;
use super::shaders;

/// The environment behind a view.
#[derive(Clone)]
pub struct Behind {
    /// Its map, as the frame imports it.
    pub environment: Handle<Image>,
    /// How it is seen through a medium.
    pub glow: Option<Glow>,
}

/// What a medium makes of an environment.
#[derive(Clone)]
pub struct Glow {
    /// Equirectangular, like the environment, ready to be sampled.
    pub map: ImageView,
    /// What is left of the environment itself; the last is unused.
    pub left: [f32; 4],
}

/// The pipelines of the background.
#[derive(Clone)]
pub struct SkyPipelines {
    clear: GraphicsPipeline,
    /// Where the scene has a medium.
    glowing: Option<GraphicsPipeline>,
}

/// The view, the map, its sampler, and the map of the glow where there is one.
const BINDINGS: [BindingDesc; 4] = [
    BindingDesc::new(0, BindingKind::UniformBuffer),
    BindingDesc::new(1, BindingKind::SampledImage),
    BindingDesc::new(2, BindingKind::Sampler),
    BindingDesc::new(3, BindingKind::SampledImage),
];

impl SkyPipelines {
    /// For targets of a float format.
    pub fn new(context: &Context, hdr: vk::Format) -> Result<Self, GpuError> {
        Ok(Self { clear: pipeline(context, hdr, false)?, glowing: None })
    }

    /// Makes what draws it through a medium.
    #[cfg(feature = "fog")]
    pub fn in_medium(&mut self, context: &Context, hdr: vk::Format) -> Result<(), GpuError> {
        self.glowing = Some(pipeline(context, hdr, true)?);
        Ok(())
    }

    /// Draws the background of a view where no surface is, within rendering.
    pub fn record(
        &self,
        recorder: &mut Recorder<'_>,
        view: &BufferSlice,
        sky: &Sky,
        glow: Option<&Glow>,
    ) -> Result<(), GpuError> {
        let mut bound = vec![
            Binding::uniform(0, view),
            Binding::sampled(1, sky.map.clone()),
            Binding::sampler(2, &sky.sampler),
        ];
        match (glow, &self.glowing) {
            (Some(glow), Some(glowing)) => {
                bound.push(Binding::sampled(3, glow.map.clone()));
                recorder.bind_graphics(glowing, &bound)?;
                recorder.push_constants(&glow.left)?;
            }
            _ => recorder.bind_graphics(&self.clear, &bound)?,
        }
        recorder.draw(0..3, 0..1)
    }
}

fn pipeline(context: &Context, hdr: vk::Format, glow: bool) -> Result<GraphicsPipeline, GpuError> {
    let name = if glow { "sky in a medium" } else { "sky" };
    let bindings = &BINDINGS[..if glow { 4 } else { 3 }];
    let push_constant_size = if glow { 16 } else { 0 };
    behind(context, hdr, name, &shaders::sky_fragment(glow), bindings, push_constant_size)
}

/// A pipeline of what is behind all surfaces.
pub(super) fn behind(
    context: &Context,
    hdr: vk::Format,
    name: &str,
    fragment: &[u32],
    bindings: &[BindingDesc],
    push_constant_size: u32,
) -> Result<GraphicsPipeline, GpuError> {
    context.create_graphics_pipeline(&GraphicsPipelineDesc {
        name,
        vertex: &shaders::sky_vertex(),
        fragment: Some(fragment),
        bindings,
        push_constant_size,
        vertex_buffers: &[],
        topology: vk::PrimitiveTopology::TRIANGLE_LIST,
        cull: vk::CullModeFlags::NONE,
        front_face: vk::FrontFace::COUNTER_CLOCKWISE,
        depth: Some(DepthState { format: DEPTH, compare: vk::CompareOp::LESS_OR_EQUAL, write: false }),
        colors: &[hdr],
        blend: Blend::None,
    })
}
