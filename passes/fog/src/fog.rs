//! The pass: its pipelines, kept from frame to frame.

use std::slice::from_ref;

use airglow_gpu::Binding;
use airglow_gpu::ash::vk;
use airglow_gpu::requirements::FormatNeed;
use airglow_gpu::{
    ColorAttachment, Context, GpuError, GraphicsPipeline, ImageView, Load, Recorder, Rendering, Requirements,
};
use airglow_graph::{Access, LeftOut};

use crate::FogError;
use crate::control::Control;
use crate::envelope::Pipelines;
use crate::frame::Frame;
use crate::kernels;
use crate::settings::Settings;
use crate::tiles::KINDS;

/// What the pass does with the images of a frame, in the order of [`Bindings`]: for a host with a frame graph of its own.
pub const ACCESSES: [(&str, Access); 3] = [
    ("surface", Access::FragmentSampled),
    ("depth", Access::FragmentSampledDepth),
    ("target", Access::ColorAttachmentWrite),
];

/// The images of a frame, in the order of [`ACCESSES`].
#[derive(Clone)]
pub struct Bindings {
    /// Radiance of the surfaces.
    pub surface: ImageView,
    /// Their depth.
    pub depth: ImageView,
    /// The picture through the medium; all of it is written.
    pub target: ImageView,
}

/// Single scattering from lights inside a medium. Made once for a device and [`Settings`]; holds no frame.
#[derive(Clone)]
pub struct Fog {
    settings: Settings,
    pipelines: [GraphicsPipeline; KINDS.len()],
    pipeline_count: usize,
}

/// A frame as the road without a graph records it.
#[derive(Clone)]
pub enum Prepared {
    /// The pass has something to do.
    Pass(Pass),
    /// It has not: the surface is the picture.
    LeftOut(LeftOut),
}

/// A prepared pass.
#[derive(Clone)]
pub struct Pass {
    /// Changes the view before it is recorded again.
    pub control: Control,
    pipelines: [GraphicsPipeline; KINDS.len()],
}

impl Fog {
    /// What a device must offer for these settings, to be joined to those of other passes before it is made.
    #[must_use]
    pub fn requirements(settings: &Settings) -> Requirements {
        let mut requirements = Requirements::engine().with_descriptors(&kernels::BINDINGS);
        requirements.formats.push(FormatNeed {
            format: settings.format,
            usage: vk::FormatFeatureFlags::COLOR_ATTACHMENT,
            why: "the picture through the medium",
        });
        requirements
    }

    /// Makes the kernels that `settings` need on a device.
    ///
    /// # Errors
    /// [`FogError::Range`] for settings out of range, [`FogError::Gpu`] when the device refuses.
    pub fn new(context: &Context, settings: Settings) -> Result<Self, FogError> {
        settings.check()?;
        Self::with_pipelines(settings, &Pipelines::prepare(context, (&settings).into())?)
    }

    /// The same with pipelines that were made before, on whatever thread: none is made here or while recording.
    ///
    /// # Errors
    /// [`FogError::Envelope`] where the envelope has not got it; else as [`Fog::new`].
    pub fn with_pipelines(settings: Settings, pipelines: &Pipelines) -> Result<Self, FogError> {
        settings.check()?;
        pipelines.envelope().check(&settings)?;
        let pipeline = |kind| pipelines.graphics(&kernels::airlight(&settings, kind));
        let [dark, points, all] = KINDS;
        let pipeline_count = pipelines.count();
        Ok(Self { settings, pipelines: [pipeline(dark)?, pipeline(points)?, pipeline(all)?], pipeline_count })
    }

    /// Pipelines that it and its like hold ready.
    pub(crate) fn pipeline_count(&self) -> usize {
        self.pipeline_count
    }

    /// The settings it was made for.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Prepares a frame for the road without a graph: the host makes the barriers of [`ACCESSES`] around
    /// [`Pass::record`], which has none of its own.
    ///
    /// # Errors
    /// [`FogError::Range`], [`FogError::TooManyLights`], [`FogError::Kernel`].
    pub fn prepare<I>(&self, frame: &Frame<I>) -> Result<Prepared, FogError> {
        let control = Control::new(self.settings, frame.size, &frame.view)?;
        if frame.view.medium.is_clear() {
            return Ok(Prepared::LeftOut(LeftOut {
                what: "fog".to_owned(),
                why: "the medium has no extinction".to_owned(),
                bytes: 0,
                time: None,
                would_return: "a medium with extinction".to_owned(),
            }));
        }
        Ok(Prepared::Pass(Pass { control, pipelines: self.pipelines.clone() }))
    }
}

impl Pass {
    /// Records the pass without barriers. Command-buffer state changed: as [`Recorder`] says.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for views that do not fit.
    pub fn record(&self, recorder: &mut Recorder<'_>, bindings: &Bindings) -> Result<(), GpuError> {
        let state = self.control.lock();
        let frame = recorder.upload(from_ref(&state.constants))?;
        let tiles = recorder.upload(state.tiles.rows())?;
        let colors = [ColorAttachment { view: &bindings.target, load: Load::Discard }];
        recorder.begin_rendering(&Rendering { colors: &colors, depth: None })?;
        let bound = [
            Binding::uniform(0, &frame),
            Binding::sampled(1, bindings.surface.clone()),
            Binding::sampled(2, bindings.depth.clone()),
        ];
        recorder.bind_vertex_buffer(0, &tiles)?;
        for (pipeline, kind) in self.pipelines.iter().zip(KINDS) {
            let rows = state.tiles.of(kind);
            if !rows.is_empty() {
                recorder.bind_graphics(pipeline, &bound)?;
                recorder.draw(0..6, rows)?;
            }
        }
        recorder.end_rendering()
    }
}
