//! The pass: its kernels, kept from frame to frame.

use airglow_gpu::{Context, Kernel, Requirements};
use airglow_graph::{Access, LeftOut, PassKind};

use crate::RadianceError;
use crate::control::Control;
use crate::envelope::Pipelines;
use crate::gpu::keep::KEEP_BINDINGS;
use crate::gpu::refinement::REFINE_BINDINGS;
use crate::gpu::{Keep, Refinement, Texels, VertexKernels, keep, kernels, refinement, vertices};
use crate::lights::Lights;
use crate::pass_settings::PassSettings;
use crate::receiver::Receiver;
use crate::resource::Resource;
use crate::stage::{Prepared, Scene, Stage, Work};

/// Incident radiance of near emitters. Made once for a device and [`PassSettings`]; holds no frame.
#[derive(Clone)]
pub struct Radiance {
    settings: PassSettings,
    refinement: Refinement,
    texels: Texels,
    keep: Keep,
    vertices: VertexKernels,
    pipeline_count: usize,
}

impl Radiance {
    /// What a device must offer, to be joined to what other passes need before it is made.
    #[must_use]
    pub fn requirements(settings: &PassSettings) -> Requirements {
        Texels::requirements()
            .with_descriptors(&REFINE_BINDINGS)
            .with_descriptors(&KEEP_BINDINGS)
            .with_descriptors(&vertices::bindings(settings.shape()))
            .with_descriptors(&vertices::TURN_BINDINGS)
    }

    /// Makes the kernels that `settings` need.
    ///
    /// # Errors
    /// [`RadianceError::Setting`] for settings out of range, [`RadianceError::Gpu`] when the device refuses.
    pub fn new(context: &Context, settings: PassSettings) -> Result<Self, RadianceError> {
        settings.check()?;
        Self::with_pipelines(context, settings, &Pipelines::prepare(context, (&settings).into())?)
    }

    /// The same with pipelines that were made before, on whatever thread: none is made here or while recording.
    ///
    /// # Errors
    /// [`RadianceError::Envelope`] for settings outside the envelope they were prepared for; else as [`Radiance::new`].
    pub fn with_pipelines(
        context: &Context,
        settings: PassSettings,
        pipelines: &Pipelines,
    ) -> Result<Self, RadianceError> {
        settings.check()?;
        pipelines.envelope().check(&settings)?;
        let shape = settings.shape();
        let find = |kernel: &Kernel| pipelines.compute(kernel);
        let texels = Texels::with_kernel(context, settings.texels(), find)?;
        let texels = match settings.closed_forms {
            true => texels.with_analytic(find(&kernels::analytic(shape)?)?),
            false => texels,
        };
        Ok(Self {
            settings,
            refinement: Refinement::with_pipeline(find(&refinement::kernel())?, shape),
            texels,
            keep: Keep::with_pipeline(find(&keep::kernel())?, shape),
            vertices: VertexKernels::with_kernels(shape, find)?,
            pipeline_count: pipelines.count(),
        })
    }

    /// Pipelines that it and its like hold ready.
    pub(crate) fn pipeline_count(&self) -> usize {
        self.pipeline_count
    }

    /// The settings it was made for.
    #[must_use]
    pub fn settings(&self) -> &PassSettings {
        &self.settings
    }

    /// The frame as data, for a host without our graph: give the light of each part a storage buffer of
    /// [`Prepared::light_bytes`], then [`Prepared::record`]. It may be recorded again in later frames;
    /// [`Prepared::control`] changes the lights in between.
    ///
    /// # Errors
    /// As [`Control::set`], and [`RadianceError::Setting`] for a receiver whose samples have another shape; how far its
    /// tree is refined is its own.
    pub fn prepare(&self, receiver: &Receiver, lights: &Lights<'_>) -> Result<Prepared, RadianceError> {
        let settings = &receiver.settings;
        if (settings.shape(), settings.texels()) != (self.settings.shape(), self.settings.texels()) {
            let (name, value) = ("the receiver's shape of samples", "another than the pass's");
            return Err(RadianceError::setting(name, value, "order, gradients, face and rays of the pass"));
        }
        let control = Control::new(settings.shape().coefficients(), lights)?;
        if let Some(left_out) = self.left_out(receiver, lights) {
            return Ok(Prepared {
                stages: Vec::new(),
                ours: Vec::new(),
                light_bytes: Vec::new(),
                left_out: Some(left_out),
                control: None,
                scene: None,
            });
        }
        let scene = Scene {
            receiver: receiver.clone(),
            refinement: self.refinement.clone(),
            texels: self.texels.clone(),
            keep: self.keep.clone(),
            vertices: self.vertices.clone(),
            control: control.clone(),
        };
        Ok(Prepared {
            stages: stages(receiver),
            ours: ours(receiver),
            light_bytes: receiver.light_bytes.clone(),
            left_out: None,
            control: Some(control),
            scene: Some(scene),
        })
    }

    fn left_out(&self, receiver: &Receiver, lights: &Lights<'_>) -> Option<LeftOut> {
        let (why, would_return) = match lights.emit() {
            false => ("no emitter gives light", "an emitter whose radiance is above zero"),
            true if !receiver.reflects => ("no vertex reflects light", "a transfer vector that is not zero"),
            true => return None,
        };
        Some(LeftOut {
            what: "radiance".to_owned(),
            why: why.to_owned(),
            bytes: receiver.light_bytes.iter().sum(),
            time: None,
            would_return: would_return.to_owned(),
        })
    }
}

/// This room's own buffers.
fn ours(receiver: &Receiver) -> Vec<(Resource, airglow_gpu::Buffer, Access)> {
    let samples = &receiver.samples;
    let (read, kept) = (Access::ComputeStorageRead, Access::ComputeStorageReadWrite);
    let staged = receiver.staged().map(|(resource, staged)| (resource, staged.buffer.clone(), read));
    let mut ours: Vec<_> = staged.collect();
    for (resource, buffer) in [
        (Resource::Slots, &samples.slots),
        (Resource::Places, &samples.places),
        (Resource::Points, &samples.points),
        (Resource::Lights, &samples.lights),
        (Resource::Gradients, &samples.gradients),
        (Resource::State, &samples.state),
    ] {
        ours.push((resource, buffer.clone(), kept));
    }
    ours.extend(old(receiver).map(|(resource, buffer)| (resource, buffer.clone(), kept)));
    ours
}

/// Samples of the frame before, where there are any.
fn old(receiver: &Receiver) -> impl Iterator<Item = (Resource, &airglow_gpu::Buffer)> {
    receiver.old.iter().flat_map(|old| {
        [
            (Resource::OldPlaces, &old.places),
            (Resource::OldLights, &old.lights),
            (Resource::OldGradients, &old.gradients),
            (Resource::OldState, &old.state),
        ]
    })
}

fn stages(receiver: &Receiver) -> Vec<Stage> {
    use Access::{
        ComputeStorageRead as Read, ComputeStorageReadWrite as Update, ComputeStorageWrite as Write,
    };
    let mut stages = Vec::new();
    if receiver.tree.is_pending() {
        let uses = receiver.staged().map(|(resource, _)| (resource, Access::TransferDestination)).collect();
        stages.push(Stage { name: "radiance uploads", kind: PassKind::Transfer, uses, work: Work::Uploads });
    }
    let samples = [Resource::Slots, Resource::Places, Resource::Points, Resource::Lights];
    let samples = samples.into_iter().chain([Resource::Gradients, Resource::State]);
    let mut uses = vec![(Resource::Tree, Read)];
    uses.extend(samples.map(|resource| (resource, Update)));
    uses.extend(old(receiver).map(|(resource, _)| (resource, Update)));
    stages.push(Stage { name: "radiance samples", kind: PassKind::Compute, uses, work: Work::Samples });
    let read = [Resource::Slots, Resource::Places, Resource::Lights, Resource::Gradients, Resource::State];
    let read = receiver.staged().map(|(resource, _)| resource).chain(read);
    let mut uses: Vec<_> = read.map(|resource| (resource, Read)).collect();
    uses.extend((0..receiver.light_bytes.len() as u32).map(|part| (Resource::VertexLight(part), Write)));
    stages.push(Stage { name: "radiance vertices", kind: PassKind::Compute, uses, work: Work::Vertices });
    stages
}
