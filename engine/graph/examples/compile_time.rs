//! How long a frame of 50 passes takes to declare, to compile, and to recognise as one declared before.
//!
//! `cargo run --release -p airglow-graph --example compile_time`

use airglow_graph::{
    Access, Buffer, BufferDesc, Graph, GraphError, Handle, Image, ImageDesc, Limits, PassKind,
};
use ash::vk;
use std::hint::black_box;
use std::time::{Duration, Instant};

const PASSES: usize = 50;
const ROUNDS: usize = 2000;

/// Groups of five passes as a lighting frame has them: project to SH, relight, draw with depth, blur down a mip
/// chain, compose.
fn declare() -> Graph<usize> {
    let mut graph = Graph::new();
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let transfer = BufferDesc { size: 64_000, usage };
    let read = Access::ComputeStorageRead;
    let transfer = graph.import_buffer("transfer", transfer, read, read);
    let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::SAMPLED;
    let hdr = ImageDesc { usage, ..ImageDesc::new_2d(1920, 1080, vk::Format::R16G16B16A16_SFLOAT) };
    let mut hdr = graph.import_image("hdr", hdr, Access::FragmentSampled, Access::FragmentSampled);
    for group in 0..PASSES / 5 {
        hdr = declare_group(&mut graph, transfer, hdr, group);
    }
    graph
}

fn declare_group(
    graph: &mut Graph<usize>,
    transfer: Handle<Buffer>,
    hdr: Handle<Image>,
    group: usize,
) -> Handle<Image> {
    let mut project = graph.pass("project", PassKind::Compute);
    let light = project.create_buffer("light", BufferDesc::new(1024), Access::ComputeStorageWrite);
    project.record(group);

    let mut relight = graph.pass("relight", PassKind::Compute);
    relight.read(&light, Access::ComputeUniform).read(&transfer, Access::ComputeStorageRead);
    let colours = relight.create_buffer("colours", BufferDesc::new(16_000), Access::ComputeStorageWrite);
    relight.record(group);

    let mut draw = graph.pass("draw", PassKind::Graphics);
    draw.read(&colours, Access::VertexBuffer);
    let depth = ImageDesc::new_2d(1920, 1080, vk::Format::D32_SFLOAT);
    let depth = draw.create_image("depth", depth, Access::DepthAttachmentWrite);
    let hdr = draw.write(hdr, Access::ColorAttachmentReadWrite);
    draw.record(group);

    let mut down = graph.pass("down", PassKind::Compute);
    let chain = ImageDesc { mips: 6, ..ImageDesc::new_2d(960, 540, vk::Format::R16G16B16A16_SFLOAT) };
    down.read(&hdr, Access::ComputeSampled).read(&depth, Access::ComputeSampledDepth);
    let chain = down.create_image("chain", chain, Access::ComputeStorageWrite);
    down.record(group);

    let mut compose = graph.pass("compose", PassKind::Graphics);
    compose.read(&chain, Access::FragmentSampled).read(&light, Access::FragmentUniform);
    let hdr = compose.write(hdr, Access::ColorAttachmentReadWrite);
    compose.record(group);
    hdr
}

/// Median and 95th percentile of a sorted row, in microseconds.
fn summary(name: &str, mut times: Vec<Duration>) {
    times.sort_unstable();
    let at = |fraction: usize| times[times.len() * fraction / 100].as_secs_f64() * 1e6;
    println!("{name:<34} median {:8.1} us, p95 {:8.1} us, n {}", at(50), at(95), times.len());
}

fn main() -> Result<(), GraphError> {
    let limits = Limits::default();
    let plan = declare().compile(&limits)?;
    let barriers: usize = plan.steps().iter().map(|step| step.barriers.len()).sum();
    println!(
        "{} passes, {} resources, {barriers} barriers before passes",
        plan.steps().len(),
        plan.resources().len()
    );
    let [mut declaring, mut compiling, mut recognising] = [Vec::new(), Vec::new(), Vec::new()];
    for _ in 0..ROUNDS {
        let start = Instant::now();
        let graph = black_box(declare());
        declaring.push(start.elapsed());

        let start = Instant::now();
        black_box(graph.topology());
        recognising.push(start.elapsed());

        let start = Instant::now();
        let plan = black_box(graph.compile(&limits)?);
        compiling.push(start.elapsed());
        drop(plan);
    }
    summary("declare", declaring);
    summary("compile", compiling);
    summary("topology (instead of compiling)", recognising);
    Ok(())
}
