//! A frame after the first ones allocates nothing on the heap: recording a plan reuses what earlier frames made.

use airglow_gpu::ash::vk;
use airglow_gpu::open::{FrameLoop, FrameSemaphores};
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, ComputePipelineDesc, Execution, Imports, Record, Timing,
};
use airglow_graph::{Access, BufferDesc, Graph, PassKind};
use airglow_tests::device::fixture;
use airglow_tests::heap::{Counting, allocations};
use airglow_tests::plan::compile;
use airglow_tests::spirv::words;
use std::time::Duration;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Passes of the plan.
const PASSES: usize = 20;
const VERTICES: u32 = 64;

#[test]
fn a_frame_allocates_nothing_after_warm_up() {
    let fixture = fixture();
    let context = fixture.context();
    let bindings =
        [BindingDesc::new(0, BindingKind::StorageBuffer), BindingDesc::new(1, BindingKind::UniformBuffer)];
    let spirv = words("test/colours_compute");
    let desc =
        ComputePipelineDesc { name: "colours", spirv: &spirv, bindings: &bindings, push_constant_size: 4 };
    let pipeline = context.create_compute_pipeline(&desc).unwrap();
    let mut graph: Graph<Record> = Graph::new();
    let size = u64::from(VERTICES) * 16;
    let mut colours = graph.create_buffer("colours", BufferDesc::new(size));
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
    let plan = compile(graph, &context.graph_limits());
    let mut execution = Execution::prepare(context, plan).unwrap();
    let imports = Imports::new();
    let timing = Timing::new(context, PASSES as u32, 0, 4).unwrap();
    let mut timing = timing.with_pipeline_statistics().unwrap();
    let mut frames = FrameLoop::new(fixture.device(), context).unwrap();
    let (warm_up, measured) = (10, 50);
    let mut counted = [0, 0];
    let mut fastest = Duration::MAX;
    for frame in 0..warm_up + measured {
        let recorded = frames.frame(FrameSemaphores::default(), |command_buffer: vk::CommandBuffer| {
            let before = allocations();
            // SAFETY: the loop's command buffer is recording; the plan imports nothing.
            let recorded = unsafe { execution.record(context, command_buffer, &imports, Some(&mut timing)) };
            counted[usize::from(frame >= warm_up)] += allocations() - before;
            recorded
        });
        fastest = fastest.min(recorded.unwrap().cpu);
    }
    frames.finish().unwrap();
    println!("{PASSES} passes recorded in {fastest:?} at best, under validation");
    assert!(timing.summary().is_some());
    let [warming_up, after] = counted;
    assert!(warming_up > 0, "the counter is dead: the first frames make pools and buffers");
    assert_eq!(after, 0, "heap allocations in {measured} frames of {PASSES} passes");
}
