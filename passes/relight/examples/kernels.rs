//! Times the colour kernel against its rivals, interleaved, then every setting of the curve:
//! `cargo run --release -p airglow-relight --example kernels -- [FRAMES]`.
//!
//! Every frame runs every rival once at order 4 and 100 000 vertices; the table has the medians and minima.

use std::error::Error;

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::open::{FrameLoop, FrameSemaphores, OpenDevice, OpenOptions};
use airglow_gpu::{Context, Execution, FrameTimes, Imports, Label, Location, Record, Timing};
use airglow_graph::{Access, BufferDesc, Graph, Limits};
use airglow_relight::rivals::{self, Task};
use airglow_relight::{GraphFrame, Instance, Light, Relight, Settings, curve};
use glam::DQuat;

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
    let result = race(&device, &context, frames).and_then(|()| settings(&device, &context, frames));
    device.wait_idle()?;
    drop(context);
    result
}

/// Runs a graph for some frames and returns the times of its passes.
fn time(
    device: &OpenDevice,
    context: &Context,
    graph: Graph<Record>,
    imports: &Imports,
    frames: usize,
) -> Result<Timing, Box<dyn Error>> {
    let mut execution = Execution::prepare(context, graph.compile(&Limits::default())?)?;
    let mut timing = Timing::new(context, execution.plan().steps().len() as u32, WARM_UP, frames)?;
    let mut host = FrameLoop::new(device, context)?;
    for _ in 0..WARM_UP + frames {
        host.frame(FrameSemaphores::default(), |commands| {
            // SAFETY: the loop's command buffer is recording and submitted once; no import has a pending state.
            unsafe { execution.record(context, commands, imports, Some(&mut timing)) }
        })?;
    }
    host.finish()?;
    timing.collect()?;
    Ok(timing)
}

/// Every rival once a frame.
fn race(device: &OpenDevice, context: &Context, frames: usize) -> Result<(), Box<dyn Error>> {
    let rivals = rivals::all();
    let (mut graph, mut imports) = (Graph::new(), Imports::new());
    for rival in &rivals {
        rival.add(context, &mut graph, &mut imports, VERTICES)?;
    }
    let timing = time(device, context, graph, &imports, frames)?;
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

/// Every setting of the curve: the median of the passes over vertices.
fn settings(device: &OpenDevice, context: &Context, frames: usize) -> Result<(), Box<dyn Error>> {
    println!("\norder  storage  method    median ms  bytes read and written");
    for settings in curve::sweep() {
        let mut relight = Relight::new(context, settings)?;
        let vectors = vec![0.25; VERTICES as usize * settings.coefficients()];
        let mesh = relight.add_mesh(context, "mesh", VERTICES, Some(&vectors))?;
        let usage = BufferUsageFlags::STORAGE_BUFFER;
        let desc = BufferDesc { size: 16 * settings.coefficients() as u64, usage };
        let light = context.create_buffer(Label::new("host", "light"), &desc, Location::Upload)?;
        light.write(0, &vec![[1.0f32; 4]; settings.coefficients()])?;
        let (mut graph, mut imports) = (Graph::new(), Imports::new());
        let read = Access::ComputeStorageRead;
        let coefficients = graph.import_buffer("light", *light.desc(), read, read);
        imports.buffer(&coefficients, &light);
        let light = Light::Uniform { coefficients, rotation: DQuat::IDENTITY };
        let frame = GraphFrame { light, instances: vec![Instance::new(mesh)], target: None };
        let relit = relight.add(context, &mut graph, &mut imports, &frame)?;
        graph.export(relit.results.ok_or("nothing was relit")?, Access::VertexBuffer);
        let timing = time(device, context, graph, &imports, frames)?;
        let over_vertices = ["relight colours", "relight rectangle", "relight copy"];
        let places: Vec<usize> =
            (0..timing.passes().len()).filter(|i| over_vertices.contains(&&*timing.passes()[*i])).collect();
        let sum = |frame: &FrameTimes| places.iter().map(|i| frame.passes[*i]).sum();
        let mut times: Vec<f64> = timing.frames().map(sum).collect();
        times.sort_by(f64::total_cmp);
        let counts = curve::counts(&settings, VERTICES);
        let (storage, method) = (format!("{:?}", settings.storage), format!("{:?}", settings.method));
        let median = times[times.len() / 2] * 1e3;
        println!(
            "{:5}  {storage:7}  {method:8}  {median:9.3}  {}",
            settings.order,
            counts.read + counts.written
        );
    }
    Ok(())
}
