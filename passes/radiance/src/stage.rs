//! A frame as data: the resources it touches and the stages that use them. Both roads are made from it.

use std::collections::BTreeMap;

use airglow_gpu::{Buffer, BufferSlice, GpuError, Recorder};
use airglow_graph::{Access, LeftOut, PassKind};

use crate::control::Control;
use crate::gpu::vertices::VertexWork;
use crate::gpu::{DeviceGlow, Keep, Refinement, TexelBuffers, Texels, VertexKernels};
use crate::receiver::Receiver;
use crate::resource::Resource;

/// One pass of a frame.
#[derive(Clone)]
pub struct Stage {
    /// Name, as the plan shows it.
    pub name: &'static str,
    /// What it records.
    pub kind: PassKind,
    /// What it uses, each resource once.
    pub uses: Vec<(Resource, Access)>,
    pub(crate) work: Work,
}

/// What a stage records.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Work {
    Uploads,
    Samples,
    Vertices,
}

/// A frame as data.
#[derive(Clone)]
pub struct Prepared {
    /// The stages in order; none when the pass is left out.
    pub stages: Vec<Stage>,
    /// This room's own buffers that the stages use, with the use before the frame and after it.
    pub ours: Vec<(Resource, Buffer, Access)>,
    /// Bytes of the light of each part.
    pub light_bytes: Vec<u64>,
    /// Why there is no stage.
    pub left_out: Option<LeftOut>,
    /// The lights, to be changed before the frame is recorded again; none when the pass is left out.
    pub control: Option<Control>,
    pub(crate) scene: Option<Scene>,
}

/// What stages record with.
#[derive(Clone)]
pub(crate) struct Scene {
    pub receiver: Receiver,
    pub refinement: Refinement,
    pub texels: Texels,
    pub keep: Keep,
    pub vertices: VertexKernels,
    pub control: Control,
}

/// The light of each part, by its index: buffers of the host's or of the graph's.
pub type Bindings = BTreeMap<u32, BufferSlice>;

impl Prepared {
    /// What the frame uses, for the barriers of a host's own frame graph: each resource with the accesses of all stages, in
    /// order.
    #[must_use]
    pub fn accesses(&self) -> Vec<(Resource, Vec<Access>)> {
        let mut accesses: BTreeMap<Resource, Vec<Access>> = BTreeMap::new();
        for (resource, access) in self.stages.iter().flat_map(|stage| &stage.uses) {
            accesses.entry(*resource).or_default().push(*access);
        }
        accesses.into_iter().collect()
    }

    /// Records all stages with the barriers between them and those of this room's own buffers; the light of the parts is
    /// written as [`Access::ComputeStorageWrite`], and its barriers are the host's. Command-buffer state changed: as
    /// [`Recorder`] says.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for light that is not bound or too small.
    pub fn record(&self, recorder: &mut Recorder<'_>, bindings: &Bindings) -> Result<(), GpuError> {
        let Some(scene) = &self.scene else { return Ok(()) };
        for stage in &self.stages {
            let [before, after] = match stage.work {
                Work::Uploads => [Access::ComputeStorageRead, Access::TransferDestination],
                Work::Samples => [Access::ComputeStorageReadWrite; 2],
                Work::Vertices => [Access::ComputeStorageReadWrite, Access::ComputeStorageRead],
            };
            recorder.memory_barrier(before, after)?;
            recorder.labelled(stage.name, |recorder| scene.record(recorder, stage.work, bindings))?;
            if stage.work == Work::Uploads {
                recorder.memory_barrier(Access::TransferDestination, Access::ComputeStorageRead)?;
            }
        }
        Ok(())
    }
}

impl Scene {
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder<'_>,
        work: Work,
        bindings: &Bindings,
    ) -> Result<(), GpuError> {
        match work {
            Work::Uploads => self.receiver.staged().try_for_each(|(_, staged)| staged.record(recorder)),
            Work::Samples => self.record_samples(recorder),
            Work::Vertices => self.record_vertices(recorder, bindings),
        }
    }

    /// Round by round: what the last round's samples ask for, sampled. A round that nothing asks for dispatches nothing.
    fn record_samples(&self, recorder: &mut Recorder<'_>) -> Result<(), GpuError> {
        let packed = self.control.lock();
        let mut sampled = self.receiver.sampled();
        let shows = sampled.surfaces == packed.surfaces;
        if shows && sampled.triangles == packed.triangles {
            return Ok(());
        }
        let (receiver, samples) = (&self.receiver, &self.receiver.samples);
        let settings = &receiver.settings.refinement;
        let triangles = recorder.upload(&packed.triangles)?;
        // How much a picture may have changed is not looked at.
        let same = shows && sampled.triangles.len() == packed.triangles.len();
        let old = receiver.old.as_ref().filter(|_| same);
        if let Some(old) = old {
            old.record_copy(recorder, samples)?;
        }
        let before = if old.is_some() { &sampled.triangles } else { &packed.triangles };
        let glows = recorder.upload(&DeviceGlow::of(&packed.triangles, before))?;
        let texels = TexelBuffers {
            batch: samples.state.slice(0, size_of::<crate::gpu::Batch>() as u64)?,
            points: (&samples.points).into(),
            triangles,
            triangle_count: packed.triangles.len() as u32,
            spheres: recorder.upload(&packed.spheres)?,
            sphere_count: packed.sphere_count,
            flat_count: packed.flat_count,
            surfaces: recorder.upload(&packed.surfaces.shown)?,
            shown_count: packed.surfaces.count,
            pictures: recorder.upload(&packed.surfaces.texels)?,
            extinction: packed.surfaces.extinction,
            kept: old.is_some(),
            lights: (&samples.lights).into(),
            gradients: (&samples.gradients).into(),
        };
        let refine = |recorder: &mut Recorder<'_>, seed| {
            self.refinement.record(recorder, &receiver.tree.buffer, samples, &glows, settings, seed)
        };
        refine(recorder, true)?;
        for _ in 0..receiver.rounds {
            recorder.memory_barrier(Access::ComputeStorageReadWrite, Access::ComputeStorageReadWrite)?;
            recorder.memory_barrier(Access::ComputeStorageWrite, Access::IndirectBuffer)?;
            if let Some(old) = old {
                let allowed = receiver.settings.keep * settings.bound;
                self.keep.record(recorder, &receiver.tree.buffer, samples, old, &glows, allowed)?;
                recorder.memory_barrier(Access::ComputeStorageReadWrite, Access::ComputeStorageReadWrite)?;
            }
            self.texels.record(recorder, &texels)?;
            recorder.memory_barrier(Access::ComputeStorageReadWrite, Access::ComputeStorageReadWrite)?;
            refine(recorder, false)?;
        }
        sampled.triangles.clone_from(&packed.triangles);
        sampled.surfaces.clone_from(&packed.surfaces);
        Ok(())
    }

    fn record_vertices(&self, recorder: &mut Recorder<'_>, bindings: &Bindings) -> Result<(), GpuError> {
        let receiver = &self.receiver;
        let distant = recorder.upload(&self.control.lock().distant)?;
        let bytes = receiver.settings.light_bytes();
        for chunk in &receiver.chunks {
            let part = chunk.part as u32;
            let missing = || GpuError::misuse("radiance", format!("the light of part {part} is not bound"));
            let whole = bindings.get(&part).ok_or_else(missing)?;
            let place = whole.offset() + bytes * u64::from(chunk.vertex);
            let light = whole.buffer().slice(place, bytes * u64::from(chunk.count))?;
            self.vertices.record(
                recorder,
                &VertexWork {
                    nodes: &receiver.tree.buffer,
                    samples: &receiver.samples,
                    vertices: &receiver.vertices.buffer,
                    groups: &receiver.groups.buffer,
                    first: chunk.first,
                    first_group: chunk.first_group,
                    count: chunk.count,
                    light: &light,
                    distant: &distant,
                    reach: receiver.reach,
                },
            )?;
            if let Some(rotation) = receiver.rotations.get(&part) {
                recorder.memory_barrier(Access::ComputeStorageReadWrite, Access::ComputeStorageReadWrite)?;
                self.vertices.record_turn(recorder, &rotation.buffer, &light, chunk.count)?;
            }
        }
        Ok(())
    }
}
