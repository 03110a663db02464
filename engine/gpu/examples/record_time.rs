//! How long the CPU takes to record a compiled frame of 20 passes, with and without timestamps; and that a frame that
//! has warmed up allocates nothing and compiles nothing.
//!
//! `cargo run --release -p airglow-gpu --features open --example record_time`

use airglow_gpu::open::{FrameLoop, FrameSemaphores, OpenDevice, OpenOptions};
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, ComputePipeline, ComputePipelineDesc, Context, Execution, Imports,
    Record, Requirements, Timing,
};
use airglow_graph::{Access, BufferDesc, Graph, PassKind};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::error::Error;
use std::time::{Duration, Instant};

const PASSES: usize = 20;
const WARM_UP: usize = 50;
const FRAMES: usize = 2000;
const VERTICES: u32 = 64;

thread_local! {
    /// Heap allocations of this thread: drivers have threads of their own.
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

/// The system's allocator, counting.
struct Counting;

// SAFETY: every call is the system allocator's; counting touches a thread-local that allocates nothing.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // A thread that is ending has no count any more.
        let _ = ALLOCATIONS.try_with(|count| count.set(count.get() + 1));
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

/// A chain of passes, each behind a barrier: it uploads a uniform, binds two buffers, pushes constants, dispatches.
fn declare(pipeline: &ComputePipeline) -> Graph<Record> {
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

fn pipeline(context: &Context) -> Result<ComputePipeline, Box<dyn Error>> {
    let bytes = include_bytes!("../../../shaders/spirv/test/colours_compute.spv");
    let words: Vec<u32> = bytes.chunks_exact(4).map(bytemuck::pod_read_unaligned).collect();
    let bindings =
        [BindingDesc::new(0, BindingKind::StorageBuffer), BindingDesc::new(1, BindingKind::UniformBuffer)];
    let desc =
        ComputePipelineDesc { name: "colours", spirv: &words, bindings: &bindings, push_constant_size: 4 };
    Ok(context.create_compute_pipeline(&desc)?)
}

/// Median and 95th percentile, in microseconds.
fn summary(name: &str, mut times: Vec<Duration>) {
    times.sort_unstable();
    let at = |fraction: usize| times[times.len() * fraction / 100].as_secs_f64() * 1e6;
    println!("{name:<44} median {:8.2} us, p95 {:8.2} us, n {}", at(50), at(95), times.len());
}

fn main() -> Result<(), Box<dyn Error>> {
    let device = OpenDevice::open(&OpenOptions::new(&Requirements::engine()))?;
    println!("{}", device.line());
    // SAFETY: the context and all that is made from it are dropped before the device, after `finish` has waited.
    let context = unsafe { device.adopt(2)? };
    let pipeline = pipeline(&context)?;
    let graph = declare(&pipeline);
    let topology = graph.topology();
    let plan = graph.compile(&context.graph_limits())?;
    println!("{} passes, {} barriers", plan.steps().len(), plan.barrier_count());
    let mut execution = Execution::prepare(&context, plan)?;
    let imports = Imports::new();
    let mut timing = Timing::new(&context, PASSES as u32, 0, 4)?;
    let mut frames = FrameLoop::new(&device, &context)?;
    let [mut plain, mut timed, mut recognised] = [Vec::new(), Vec::new(), Vec::new()];
    let (mut allocations, mut compiled) = (0, 0);
    for frame in 0..WARM_UP + 2 * FRAMES {
        // A host that declares each frame anew keeps its plan while the key stays.
        let start = Instant::now();
        compiled += usize::from(declare(&pipeline).topology() != topology);
        recognised.push(start.elapsed());
        let recorded = frames.frame(FrameSemaphores::default(), |command_buffer| {
            let timing = (frame % 2 == 1).then_some(&mut timing);
            let before = ALLOCATIONS.get();
            // SAFETY: the loop's command buffer is recording; the plan imports nothing.
            let recorded = unsafe { execution.record(&context, command_buffer, &imports, timing) };
            if frame >= WARM_UP {
                allocations += ALLOCATIONS.get() - before;
            }
            recorded
        })?;
        if frame >= WARM_UP {
            let times = if frame % 2 == 1 { &mut timed } else { &mut plain };
            times.push(recorded.cpu);
        }
    }
    frames.finish()?;
    summary("record", plain);
    summary("record with timestamps", timed);
    summary("declare and recognise (instead of compiling)", recognised);
    println!(
        "{allocations} heap allocations while recording {} frames, {compiled} plans compiled",
        2 * FRAMES
    );
    Ok(())
}
