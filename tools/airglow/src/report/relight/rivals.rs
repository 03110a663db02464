//! Settings timed against one another: each a plan of its own, one frame of each in turn.

use airglow::relight::curve;
use airglow::relight::rivals::Rival as Contestant;
use airglow::relight::{Frame, Instance, Light, Method, Relight, Settings};
use airglow_gpu::{Execution, Imports, Record, Timing};
use airglow_graph::{Access, Graph};
use glam::DQuat;

use super::vectors::tile;
use crate::failure::{Failure, Outcome};
use crate::host::work;
use crate::host::{device::Device, upload};
use crate::output::Output;
use crate::report::interleave::{self, Rounds};
use crate::report::model::Counts;

/// The pass that copies what changed to the device: a frame that repeats has none.
const UPLOADS: &str = "relight uploads";

/// A plan that can be run and timed, and what it does each frame.
pub struct Rival {
    name: String,
    execution: Execution,
    imports: Imports,
    timing: Timing,
    /// Keeps meshes and kernels alive.
    _relight: Option<Relight>,
    /// Bytes that a frame must read and write.
    bytes: u64,
    /// Invocations of fragment shaders, which no recording shows.
    fragments: u64,
    memory: u64,
}

/// Where the transfer of vertices comes from; repeated for as many as are lit.
#[derive(Clone, Copy)]
pub enum Transfer<'a> {
    /// Baked vectors.
    Baked(&'a [f32]),
    /// Current normals, as of a skinned mesh: the vectors are made in the kernel.
    Normals(&'a [[f32; 3]]),
}

/// What was measured of a rival.
pub struct Timed {
    /// Its name.
    pub name: String,
    /// Device milliseconds of each round.
    pub milliseconds: Vec<f64>,
    /// Work of a frame.
    pub counts: Counts,
    /// Bytes of its buffers and images.
    pub memory: u64,
}

/// Relighting of `vertices` vertices under uniform light: the rotation of the light and the kernel over the vertices.
pub fn relight(
    device: &Device<'_>,
    name: impl Into<String>,
    settings: Settings,
    transfer: Transfer<'_>,
    light: &[[f64; 3]],
    vertices: usize,
) -> Outcome<Rival> {
    let context = device.context();
    let mut relight = Relight::new(context, settings).map_err(Failure::work)?;
    let tiled = match transfer {
        Transfer::Baked(vectors) => Some(tile(vectors, settings.order, vertices)),
        Transfer::Normals(_) => None,
    };
    let mesh =
        relight.add_mesh(context, "rival", vertices as u32, tiled.as_deref()).map_err(Failure::work)?;
    let padded: Vec<[f32; 4]> = light.iter().map(pad).collect();
    let light = device
        .run(|recorder| upload::buffer(recorder, "light", &padded, Access::ComputeStorageRead))
        .map_err(Failure::work)?;
    let (mut graph, mut imports) = (Graph::new(), Imports::new());
    let state = Access::ComputeStorageRead;
    let coefficients = graph.import_buffer("light", *light.desc(), state, state);
    imports.buffer(&coefficients, &light);
    let mut instance = Instance::new(mesh);
    if let Transfer::Normals(normals) = transfer {
        let tiled: Vec<[f32; 3]> = normals.iter().copied().cycle().take(vertices).collect();
        let normals = device
            .run(|recorder| upload::buffer(recorder, "normals", &tiled, state))
            .map_err(Failure::work)?;
        let handle = graph.import_buffer("normals", *normals.desc(), state, state);
        imports.buffer(&handle, &normals);
        instance.normals = Some(handle);
    }
    let frame = Frame {
        light: Light::Uniform { coefficients, rotation: DQuat::IDENTITY },
        instances: vec![instance],
        target: None,
    };
    let relit = relight.add(context, &mut graph, &mut imports, &frame).map_err(Failure::work)?;
    if let Some(results) = relit.results {
        graph.export(results, Access::VertexBuffer);
    }
    let work = curve::counts(&settings, vertices as u32);
    let read = match transfer {
        Transfer::Baked(_) => work.read,
        Transfer::Normals(_) => size_of::<[f32; 3]>() as u64 * vertices as u64,
    };
    let fragments = if settings.method == Method::Fragment { work.invocations } else { 0 };
    let (bytes, memory) = (read + work.written, read + work.memory);
    let (execution, timing) = prepare(device, graph)?;
    Ok(Rival {
        name: name.into(),
        execution,
        imports,
        timing,
        _relight: Some(relight),
        bytes,
        fragments,
        memory,
    })
}

/// One of the pass's own contestants for the kernel over the vertices: a shape of it, a kernel that only moves the
/// same bytes, or a copy of as many.
pub fn contestant(device: &Device<'_>, contestant: &Contestant, vertices: usize) -> Outcome<Rival> {
    let (mut graph, mut imports) = (Graph::new(), Imports::new());
    let count = vertices as u32;
    contestant.add(device.context(), &mut graph, &mut imports, count).map_err(Failure::work)?;
    let (execution, timing) = prepare(device, graph)?;
    let bytes = contestant.bytes(count);
    let (name, fragments, memory) = (contestant.name(), 0, bytes);
    Ok(Rival { name, execution, imports, timing, _relight: None, bytes, fragments, memory })
}

fn pad(&[r, g, b]: &[f64; 3]) -> [f32; 4] {
    [r as f32, g as f32, b as f32, 0.0]
}

fn prepare(device: &Device<'_>, graph: Graph<Record>) -> Outcome<(Execution, Timing)> {
    let context = device.context();
    let plan = graph.compile(&context.graph_limits()).map_err(Failure::work)?;
    let timing = Timing::new(context, plan.steps().len() as u32, 0, 1).map_err(Failure::device)?;
    Ok((Execution::prepare(context, plan).map_err(Failure::work)?, timing))
}

impl Rival {
    /// One frame; device milliseconds of its passes, without uploads.
    fn run(&mut self, device: &Device<'_>) -> Outcome<f64> {
        device.frames(&mut self.execution, &self.imports, Some(&mut self.timing), 1, |_| Ok(()))?;
        let Some(times) = self.timing.frames().last() else {
            return Err(Failure::work(format!("{}: the device gave no timestamps", self.name)));
        };
        let counted = self.timing.passes().iter().zip(&times.passes);
        let counted = counted.filter(|(name, _)| name.as_str() != UPLOADS);
        Ok(1e3 * counted.map(|(_, seconds)| seconds).sum::<f64>())
    }

    /// The work of the frame that was recorded last, without uploads.
    fn counts(&self) -> Counts {
        let passes = work::of_frame(&self.execution).into_iter().filter(|pass| pass.name != UPLOADS);
        let all =
            passes.map(|pass| pass.counts).fold(airglow_gpu::Counts::default(), airglow_gpu::Counts::and);
        Counts {
            bytes: self.bytes,
            invocations: all.invocations + self.fragments,
            dispatches: all.dispatches,
            draws: all.draws,
            copies: Some(all.copies),
            barriers: Some(all.barriers),
            bound: Some(all.bound_bytes),
        }
    }
}

/// Runs all rivals in turn, round after round.
pub fn measure(
    device: &Device<'_>,
    what: &str,
    mut rivals: Vec<Rival>,
    rounds: Rounds,
    output: &Output,
) -> Outcome<Vec<Timed>> {
    let frames = (rounds.warm_up + rounds.measured) * rivals.len();
    let bar = output.progress(what, frames as u64, "frames");
    let samples = interleave::measure(rounds, rivals.len(), |rival| {
        bar.inc(1);
        rivals[rival].run(device)
    })?;
    bar.finish_and_clear();
    let timed = rivals.into_iter().zip(samples);
    Ok(timed
        .map(|(rival, milliseconds)| Timed {
            counts: rival.counts(),
            name: rival.name,
            milliseconds,
            memory: rival.memory,
        })
        .collect())
}
