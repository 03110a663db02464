//! A chain of small passes, each behind a barrier, as long as the frame of an engine's lighting.

use airglow_gpu::{
    Binding, BindingDesc, BindingKind, ComputePipeline, ComputePipelineDesc, Context, GpuError, Record,
};
use airglow_graph::{Access, BufferDesc, Graph, PassKind};

use crate::spirv::words;

/// Passes of the chain.
pub const PASSES: usize = 20;
const VERTICES: u32 = 64;

/// The pipeline of every pass.
///
/// # Errors
/// What the device refuses.
pub fn pipeline(context: &Context) -> Result<ComputePipeline, GpuError> {
    let bindings =
        [BindingDesc::new(0, BindingKind::StorageBuffer), BindingDesc::new(1, BindingKind::UniformBuffer)];
    let spirv = words("test/colours_compute");
    let desc =
        ComputePipelineDesc { name: "colours", spirv: &spirv, bindings: &bindings, push_constant_size: 4 };
    context.create_compute_pipeline(&desc)
}

/// Declares the chain: each pass uploads a uniform, binds two buffers, pushes constants, dispatches.
pub fn declare(pipeline: &ComputePipeline) -> Graph<Record> {
    let mut graph: Graph<Record> = Graph::new();
    let mut colours = graph.create_buffer("colours", BufferDesc::new(16 * u64::from(VERTICES)));
    for index in 0..PASSES {
        let mut pass = graph.pass(&format!("pass {index}"), PassKind::Compute);
        colours = pass.write(colours, Access::ComputeStorageWrite);
        pass.side_effect();
        let (pipeline, target) = (pipeline.clone(), colours);
        pass.record(Box::new(move |recorder, resources| {
            let tint = recorder.upload(&[[1.0f32; 4]])?;
            let buffer = resources.buffer(&target)?;
            recorder.bind_compute(&pipeline, &[Binding::storage(0, buffer), Binding::uniform(1, &tint)])?;
            recorder.push_constants(&VERTICES)?;
            recorder.dispatch([1, 1, 1])
        }));
    }
    graph
}
