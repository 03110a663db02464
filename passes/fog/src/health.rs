//! Counts what is wrong with the images that a host gives, frame by frame, without a stall.

use airglow_gpu::{
    Binding, ComputePipeline, Context, GpuError, Health, ImageView, Imports, Record, Recorder, Requirements,
};
use airglow_graph::{Access, Graph, Handle, Image, PassKind};

use crate::envelope::{Part, Pipelines};
use crate::kernels::{HEALTH_BINDINGS, SizeConstants};
use crate::{FogError, kernels};

/// What is counted: pixels whose surface has a component that is not finite; others with a negative one; pixels whose
/// depth is not between 0 and 1.
pub const COUNTED: [&str; 3] = ["surface not finite", "surface negative", "depth not in 0 to 1"];

/// Counters of a host's bad pixels. A host that does not make it pays nothing: no kernel, no pass, no memory. The
/// airlight pass keeps a bad pixel where it is, with or without it.
pub struct InputHealth {
    pipeline: ComputePipeline,
    counters: Health,
}

impl InputHealth {
    /// What a device must offer for it.
    #[must_use]
    pub fn requirements() -> Requirements {
        Requirements::engine().with_descriptors(&HEALTH_BINDINGS)
    }

    /// Makes the kernel and the counters.
    ///
    /// # Errors
    /// [`FogError::Gpu`] when the device refuses.
    pub fn new(context: &Context) -> Result<Self, FogError> {
        Self::with_pipeline(context, kernels::health().compute_pipeline(context)?)
    }

    /// The same with pipelines that were made before, on whatever thread: none is made here or while recording.
    ///
    /// # Errors
    /// [`FogError::Envelope`] where the envelope has not got it; else as [`InputHealth::new`].
    pub fn with_pipelines(context: &Context, pipelines: &Pipelines) -> Result<Self, FogError> {
        pipelines.envelope().check_part(Part::Health)?;
        Self::with_pipeline(context, pipelines.compute(&kernels::health())?)
    }

    fn with_pipeline(context: &Context, pipeline: ComputePipeline) -> Result<Self, FogError> {
        Ok(Self { pipeline, counters: Health::new(context, &COUNTED)? })
    }

    /// The counters: cleared before the passes of a frame and collected after them by the host, read when the frame is
    /// done ([`Health::latest`]).
    pub fn counters(&mut self) -> &mut Health {
        &mut self.counters
    }

    /// Adds the pass `fog health` to a graph, which counts in surface and depth of each view, of that many pixels.
    pub fn add(
        &self,
        graph: &mut Graph<Record>,
        imports: &mut Imports,
        size: [u32; 2],
        views: Vec<[Handle<Image>; 2]>,
    ) {
        let access = Access::ComputeStorageReadWrite;
        let buffer = self.counters.buffer().clone();
        let counters = graph.import_buffer("fog health", *buffer.desc(), access, access);
        imports.buffer(&counters, &buffer);
        let mut pass = graph.pass("fog health", PassKind::Compute);
        for [surface, depth] in &views {
            pass.read(surface, Access::ComputeSampled).read(depth, Access::ComputeSampledDepth);
        }
        pass.write(counters, access);
        let pipeline = self.pipeline.clone();
        pass.record(Box::new(move |recorder, resources| {
            for (index, [surface, depth]) in views.iter().enumerate() {
                if index > 0 {
                    recorder.memory_barrier(access, access)?;
                }
                let bound = [
                    Binding::sampled(0, resources.view(surface)?),
                    Binding::sampled(1, resources.view(depth)?),
                    Binding::storage(2, &buffer),
                ];
                count(recorder, &pipeline, &bound, size)?;
            }
            Ok(())
        }));
    }

    /// Records the same without a graph and without barriers: both images are to be readable by compute shaders
    /// ([`Access::ComputeSampled`], [`Access::ComputeSampledDepth`]).
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for views that do not fit.
    pub fn record(
        &self,
        recorder: &mut Recorder<'_>,
        size: [u32; 2],
        surface: &ImageView,
        depth: &ImageView,
    ) -> Result<(), GpuError> {
        let bound = [
            Binding::sampled(0, surface.clone()),
            Binding::sampled(1, depth.clone()),
            Binding::storage(2, self.counters.buffer()),
        ];
        count(recorder, &self.pipeline, &bound, size)
    }
}

fn count(
    recorder: &mut Recorder<'_>,
    pipeline: &ComputePipeline,
    bound: &[Binding],
    size: [u32; 2],
) -> Result<(), GpuError> {
    recorder.bind_compute(pipeline, bound)?;
    recorder.push_constants(&SizeConstants { size })?;
    let [width, height] = size.map(|side| side.div_ceil(8));
    recorder.dispatch([width, height, 1])
}
