//! A frame after the first ones allocates nothing on the heap: recording a plan reuses what earlier frames made.

use airglow_gpu::ash::vk;
use airglow_gpu::open::{FrameLoop, FrameSemaphores};
use airglow_gpu::{Execution, Imports, Timing};
use airglow_tests::chain::{PASSES, declare, pipeline};
use airglow_tests::device::fixture;
use airglow_tests::heap::{Counting, allocations};
use airglow_tests::plan::compile;
use std::time::Duration;

mod indirect;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn a_frame_allocates_nothing_after_warm_up() {
    let fixture = fixture();
    let context = fixture.context();
    let graph = declare(&pipeline(context).unwrap());
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
