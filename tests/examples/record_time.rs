//! How long the CPU takes to record a compiled frame of 20 passes, with and without timestamps; and that a frame that
//! has warmed up allocates nothing and compiles nothing.
//!
//! `cargo run --release -p airglow-tests --example record_time`

use airglow_gpu::open::{FrameLoop, FrameSemaphores, OpenDevice, OpenOptions};
use airglow_gpu::{Execution, Imports, Requirements, Timing};
use airglow_tests::chain::{PASSES, declare, pipeline};
use airglow_tests::heap::{Counting, allocations as counted};
use std::error::Error;
use std::time::{Duration, Instant};

const WARM_UP: usize = 50;
const FRAMES: usize = 2000;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

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
            let before = counted();
            // SAFETY: the loop's command buffer is recording; the plan imports nothing.
            let recorded = unsafe { execution.record(&context, command_buffer, &imports, timing) };
            if frame >= WARM_UP {
                allocations += counted() - before;
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
