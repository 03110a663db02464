//! Work whose amount only the device knows: what enters or leaves the frame changes arguments, and nothing else.

#![expect(clippy::unwrap_used, reason = "helpers fail the test they are called from")]

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use airglow_gpu::ash::vk;
use airglow_gpu::open::{FrameLoop, FrameSemaphores};
use airglow_gpu::{
    Binding, Context, Counts, Execution, GpuError, ImageView, Imports, Label, Location, PassStatistics,
    Record, Timing,
};
use airglow_graph::{Access, BufferDesc, Graph, ImageDesc, PassKind, State};
use airglow_tests::colours::storage;
use airglow_tests::device::fixture;
use airglow_tests::heap::allocations;
use airglow_tests::plan::compile;
use airglow_tests::workload::{COUNT, HEIGHT, WIDTH, begin_points, colours, points};

/// Arguments of a dispatch, a draw and an indexed draw of `count` points, as a kernel that culls would leave them.
fn arguments(count: u32) -> [u32; 12] {
    [count.div_ceil(64), 1, 1, count, 1, 0, 0, count, 1, 0, 0, 0]
}

const DRAW: u64 = 12;
const DRAW_INDEXED: u64 = 28;

/// Points by arguments in a buffer, of as many as `count` says when it is recorded.
fn declare(context: &Context, count: &Arc<AtomicU32>, target: &ImageView) -> (Graph<Record>, Imports) {
    let (mut graph, mut imports) = (Graph::<Record>::new(), Imports::new());
    let picture =
        graph.import_image("picture", *target.image().desc(), State::UNDEFINED, Access::TransferSource);
    imports.image(&picture, target.image());
    let mut pass = graph.pass("arguments", PassKind::Transfer);
    let given = pass.create_buffer("arguments", BufferDesc::new(48), Access::TransferDestination);
    let count = Arc::clone(count);
    pass.record(Box::new(move |recorder, resources| {
        let arguments = recorder.upload(&arguments(count.load(Ordering::Relaxed)))?;
        recorder.copy_buffer(&arguments.buffer().slice(arguments.offset(), 48)?, resources.buffer(&given)?)
    }));
    let mut pass = graph.pass("colours", PassKind::Compute);
    pass.read(&given, Access::IndirectBuffer);
    let size = 16 * u64::from(COUNT);
    let made = pass.create_buffer("colours", BufferDesc::new(size), Access::ComputeStorageWrite);
    let pipeline = colours(context).unwrap();
    pass.record(Box::new(move |recorder, resources| {
        let tint = recorder.upload(&[[2.0f32, 0.5, 1.0, 1.0]])?;
        let bindings = [Binding::storage(0, resources.buffer(&made)?), Binding::uniform(1, &tint)];
        recorder.bind_compute(&pipeline, &bindings)?;
        recorder.push_constants(&COUNT)?;
        recorder.dispatch_indirect(resources.buffer(&given)?)
    }));
    let mut pass = graph.pass("draw", PassKind::Graphics);
    pass.read(&given, Access::IndirectBuffer).read(&made, Access::VertexBuffer);
    let drawn = pass.write(picture, Access::ColorAttachmentWrite);
    let pipeline = points(context).unwrap();
    let desc = BufferDesc { size: 4 * u64::from(COUNT), usage: vk::BufferUsageFlags::INDEX_BUFFER };
    let indices = context.create_buffer(Label::new("test", "indices"), &desc, Location::Upload).unwrap();
    indices.write(0, &(0..COUNT).collect::<Vec<u32>>()).unwrap();
    pass.record(Box::new(move |recorder, resources| {
        let given = resources.buffer(&given)?;
        begin_points(recorder, &pipeline, &resources.view(&drawn)?, resources.buffer(&made)?)?;
        recorder.draw_indirect(given.slice(DRAW, 16)?, 1)?;
        recorder.bind_index_buffer(&indices)?;
        recorder.draw_indexed_indirect(given.slice(DRAW_INDEXED, 20)?, 1)?;
        recorder.end_rendering()
    }));
    (graph, imports)
}

#[test]
fn what_enters_changes_arguments_alone_and_none_of_it_does_nothing() {
    let fixture = fixture();
    let context = fixture.context();
    let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
    let desc = ImageDesc { usage, ..ImageDesc::new_2d(WIDTH, HEIGHT, vk::Format::R32G32B32A32_SFLOAT) };
    let picture = context.create_image(Label::new("test", "picture"), &desc).unwrap();
    let view = picture.full_view().unwrap();
    let count = Arc::new(AtomicU32::new(0));
    let (graph, imports) = declare(context, &count, &view);
    let mut execution = Execution::prepare(context, compile(graph, &context.graph_limits())).unwrap();
    let timing = Timing::new(context, 3, 0, 4).unwrap();
    let mut timing = timing.with_pipeline_statistics().unwrap();
    let made = context.pipelines_made();
    let mut recorded = Vec::new();
    for (round, present) in [64, COUNT, 0, 128, 0].into_iter().enumerate() {
        let mut frames = FrameLoop::new(fixture.device(), context).unwrap();
        for frame in 0..4 {
            let allocated = frames.frame(FrameSemaphores::default(), |commands| {
                let before = allocations();
                count.store(present, Ordering::Relaxed);
                // SAFETY: the loop's command buffer is recording; the picture's contents do not matter on entry.
                unsafe { execution.record(context, commands, &imports, Some(&mut timing))? };
                Ok::<_, GpuError>(allocations() - before)
            });
            let allocated = allocated.unwrap();
            assert!(round == 0 || allocated == 0, "{present} points, frame {frame}: {allocated} allocations");
        }
        frames.finish().unwrap();
        timing.collect().unwrap();
        let newest = timing.frames().last().unwrap().clone();
        let [_, compute, draw] = newest.statistics[..] else { panic!("{newest:?}") };
        let did = |statistics: PassStatistics| {
            [statistics.compute_invocations, statistics.vertex_invocations, statistics.fragment_invocations]
        };
        let present = u64::from(present);
        println!("{present} points: {compute:?} {draw:?}");
        assert_eq!(did(compute), [present, 0, 0]);
        assert_eq!(did(draw)[..2], [0, 2 * present]);
        assert!(did(draw)[2] >= present && (present > 0 || did(draw)[2] == 0), "{draw:?}");
        let commands = execution.counts().iter().copied().reduce(Counts::and).unwrap();
        recorded.push((commands.dispatches, commands.draws, commands.barriers));
    }
    assert_eq!(recorded, [(1, 2, recorded[0].2); 5], "the same commands whatever they amount to");
    assert_eq!(context.pipelines_made(), made, "a pipeline was made");
    let copy = fixture.device().run(context, |recorder| recorder.read_back_image(&view)).unwrap();
    assert!(copy.texels().unwrap().iter().all(|texel| *texel == [-1.0; 4]), "nothing was drawn");
}

#[test]
fn arguments_that_cannot_be_read_are_refused() {
    let fixture = fixture();
    let context = fixture.context();
    let colours = colours(context).unwrap();
    let values = storage(context, "values", 1024);
    let desc = BufferDesc { size: 64, usage: vk::BufferUsageFlags::INDIRECT_BUFFER };
    let arguments = context.create_buffer(Label::new("test", "arguments"), &desc, Location::Device).unwrap();
    let refused = |problem: &str, buffer: &airglow_gpu::Buffer, offset: u64, size: u64| {
        let told = fixture.device().run(context, |recorder| {
            let tint = recorder.upload(&[[1.0f32; 4]])?;
            recorder.bind_compute(&colours, &[Binding::storage(0, &values), Binding::uniform(1, &tint)])?;
            recorder.push_constants(&1u32)?;
            recorder.dispatch_indirect(buffer.slice(offset, size)?)
        });
        let told = told.unwrap_err().to_string();
        assert!(told.contains(problem), "expected `{problem}`, got `{told}`");
    };
    refused("made without INDIRECT_BUFFER", &values, 0, 12);
    refused("12 bytes of arguments", &arguments, 0, 8);
    refused("at a multiple of 4", &arguments, 2, 12);
}
