//! Times the colour kernel against its rivals, interleaved: `cargo run --release --example kernels -- [FRAMES]`.
//!
//! Every frame runs every rival once at order 4 and 100 000 vertices; the table has the medians and minima.

use std::error::Error;

use airglow_gpu::open::{FrameLoop, FrameSemaphores, OpenDevice, OpenOptions};
use airglow_gpu::{Context, Execution, Imports, Timing};
use airglow_graph::{Graph, Limits};
use airglow_relight::rivals::{self, Task};
use airglow_relight::{Relight, Settings};

const VERTICES: u32 = 100_000;
/// Frames that are thrown away: drivers compile at first use.
const WARM_UP: usize = 2;

fn main() -> Result<(), Box<dyn Error>> {
    let frames = std::env::args().nth(1).map_or(Ok(24), |text| text.parse())?;
    let requirements = Relight::requirements(&Settings::default());
    let device = OpenDevice::open(&OpenOptions::new(&requirements))?;
    println!("{}\n{VERTICES} vertices, order {}, {frames} frames\n", device.line(), rivals::ORDER);
    // SAFETY: the context dies at the end of `measure`'s caller, before the device, which is idle by then.
    let context = unsafe { device.adopt(2) }?;
    let result = measure(&device, &context, frames);
    device.wait_idle()?;
    drop(context);
    result
}

fn measure(device: &OpenDevice, context: &Context, frames: usize) -> Result<(), Box<dyn Error>> {
    let rivals = rivals::all();
    let (mut graph, mut imports) = (Graph::new(), Imports::new());
    for rival in &rivals {
        rival.add(context, &mut graph, &mut imports, VERTICES)?;
    }
    let mut execution = Execution::prepare(context, graph.compile(&Limits::default())?)?;
    let mut timing = Timing::new(context, rivals.len() as u32, WARM_UP, frames)?;
    let mut host = FrameLoop::new(device, context)?;
    for _ in 0..WARM_UP + frames {
        host.frame(FrameSemaphores::default(), |commands| {
            // SAFETY: the loop's command buffer is recording and submitted once; no import has a pending state.
            unsafe { execution.record(context, commands, &imports, Some(&mut timing)) }
        })?;
    }
    host.finish()?;
    timing.collect()?;
    let mut rows = Vec::new();
    for rival in &rivals {
        let name = rival.name();
        let Some(index) = timing.passes().iter().position(|pass| *pass == name) else { continue };
        let mut times: Vec<f64> = timing.frames().map(|frame| frame.passes[index]).collect();
        times.sort_by(f64::total_cmp);
        rows.push((times[times.len() / 2], times[0], rival));
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    println!("median ms  min ms  GB/s  rival (vertices of an invocation x invocations of a workgroup)");
    for (median, least, rival) in &rows {
        let rate = rival.bytes(VERTICES) as f64 / median / 1e9;
        let mark = if rival.is_default() { "  <- the pass" } else { "" };
        println!("{:9.3}  {:6.3}  {rate:4.1}  {}{mark}", median * 1e3, least * 1e3, rival.name());
    }
    for storage in [airglow_relight::Storage::F32, airglow_relight::Storage::F16] {
        let best = |task| rows.iter().find(|row| row.2.storage == storage && row.2.task == task);
        let own = rows.iter().find(|row| row.2.storage == storage && row.2.is_default());
        if let (Some(own), Some(moved), Some(copied)) = (own, best(Task::Move), best(Task::Copy)) {
            let (to_move, to_copy) = (own.0 / moved.0, copied.0 / own.0);
            println!(
                "{storage:?}: {to_move:.2} x the fastest move, {:.0} % of copy bandwidth",
                100.0 * to_copy
            );
        }
    }
    Ok(())
}
