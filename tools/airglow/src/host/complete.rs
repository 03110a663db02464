//! The complete model of surfaces in fog (Sun 2008, eq. 3.29) in the forward draw itself, without a pass after it: what
//! `fog/view.glsl` and `fog/surface.glsl` are for in a host's own shader.

use airglow::fog;
use airglow_gpu::ash::vk;
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, BufferSlice, Context, GpuError, GraphicsPipeline, Recorder,
};

use super::surface::{self, Inputs};
use super::{shaders, sky};

/// Where the model is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Road {
    /// At each pixel.
    Pixels,
    /// At each vertex of a surface, and at each pixel without one.
    Vertices,
}

/// The pipelines of a draw of the model.
#[derive(Clone)]
pub struct CompletePipelines {
    /// Lit by the vertices' colours.
    lit: GraphicsPipeline,
    /// Lit evenly.
    ambient: GraphicsPipeline,
    sky: GraphicsPipeline,
}

/// What such a draw takes.
#[derive(Clone)]
pub struct Complete {
    /// How it is drawn.
    pub pipelines: CompletePipelines,
    /// The view through the medium.
    pub control: fog::Control,
}

/// The view through the medium.
const VIEW: BindingDesc = BindingDesc::new(9, BindingKind::UniformBuffer);

impl CompletePipelines {
    /// For targets of a float format.
    pub fn new(context: &Context, hdr: vk::Format, road: Road) -> Result<Self, GpuError> {
        let bindings = [&surface::DRAW_BINDINGS[..], &[VIEW]].concat();
        let (inputs, fragment) = match road {
            Road::Pixels => (Inputs::Lit, shaders::complete_fragment(false)),
            Road::Vertices => (Inputs::LitVertices, shaders::complete_fragment(true)),
        };
        let surface = |relight| surface::scene_pipeline(context, hdr, relight, inputs, &fragment, &bindings);
        let bindings = [BindingDesc::new(0, BindingKind::UniformBuffer), VIEW];
        let name = "airlight behind the surfaces";
        let sky = sky::behind(context, hdr, name, &shaders::complete_sky(), &bindings, 0)?;
        Ok(Self { lit: surface(true)?, ambient: surface(false)?, sky })
    }

    /// The pipeline of surfaces whose vertices have colours, or not.
    pub fn of(&self, colours: bool) -> &GraphicsPipeline {
        if colours { &self.lit } else { &self.ambient }
    }
}

impl Complete {
    /// What its pipelines bind beside those of clear air.
    pub fn binding(&self, recorder: &mut Recorder<'_>) -> Result<Binding, GpuError> {
        Ok(Binding::uniform(9, &recorder.upload(&[self.control.constants()])?))
    }

    /// Draws the airlight where no surface is, within rendering.
    pub fn record_sky(
        &self,
        recorder: &mut Recorder<'_>,
        view: &BufferSlice,
        through: &Binding,
    ) -> Result<(), GpuError> {
        recorder.bind_graphics(&self.pipelines.sky, &[Binding::uniform(0, view), through.clone()])?;
        recorder.draw(0..3, 0..1)
    }
}
