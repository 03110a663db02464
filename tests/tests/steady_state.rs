//! A frame after the first ones allocates nothing on the heap: recording a plan reuses what earlier frames made.

use airglow_gpu::ash::vk;
use airglow_gpu::open::{FrameLoop, FrameSemaphores};
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, ComputePipelineDesc, Execution, Imports, Record, Timing,
};
use airglow_graph::{Access, BufferDesc, Graph, PassKind};
use airglow_tests::device::fixture;
use airglow_tests::plan::compile;
use airglow_tests::spirv::words;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::time::Duration;

thread_local! {
    /// Allocations of this thread.
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

/// The system's allocator, counting.
struct Counting;

// SAFETY: every call is the system allocator's; counting touches a thread-local that allocates nothing.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // A thread that is ending has no count any more.
        let _ = COUNT.try_with(|count| count.set(count.get() + 1));
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }
}

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
    let mut allocations = [0, 0];
    let mut fastest = Duration::MAX;
    for frame in 0..warm_up + measured {
        let recorded = frames.frame(FrameSemaphores::default(), |command_buffer: vk::CommandBuffer| {
            let before = COUNT.get();
            // SAFETY: the loop's command buffer is recording; the plan imports nothing.
            let recorded = unsafe { execution.record(context, command_buffer, &imports, Some(&mut timing)) };
            allocations[usize::from(frame >= warm_up)] += COUNT.get() - before;
            recorded
        });
        fastest = fastest.min(recorded.unwrap().cpu);
    }
    frames.finish().unwrap();
    println!("{PASSES} passes recorded in {fastest:?} at best, under validation");
    assert!(timing.summary().is_some());
    let [warming_up, after] = allocations;
    assert!(warming_up > 0, "the counter is dead: the first frames make pools and buffers");
    assert_eq!(after, 0, "heap allocations in {measured} frames of {PASSES} passes");
}
