//! Resources that remember one frame: each frame reads what the frame before wrote, by one plan, while frames overlap.

use airglow_gpu::ash::vk;
use airglow_gpu::open::FrameLoop;
use airglow_gpu::{Execution, Histories, Imports, Label, Location, Record};
use airglow_graph::{Access, BufferDesc, Graph, ImageDesc, PassKind, State};
use airglow_tests::device::fixture;
use airglow_tests::plan::compile;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

/// Frames that are remembered: each pushes its number to the end and drops the first.
const WORDS: u64 = 6;

#[test]
fn each_frame_reads_what_the_frame_before_wrote() {
    let fixture = fixture();
    let context = fixture.context();
    let frame_number = Arc::new(AtomicU32::new(0));
    let (graph, result) = remembering(&frame_number);
    let desc = BufferDesc { size: 4 * WORDS, usage: vk::BufferUsageFlags::TRANSFER_DST };
    let buffer = context.create_buffer(Label::new("test", "result"), &desc, Location::Readback).unwrap();

    let mut execution = Execution::prepare(context, compile(graph, &context.graph_limits())).unwrap();
    let mut histories = Histories::prepare(context, execution.plan()).unwrap();
    let mut imports = Imports::new();
    imports.buffer(&result, &buffer);
    let mut frames = FrameLoop::new(fixture.device(), context).unwrap();
    for frame in 1..=4 {
        frame_number.store(frame, Ordering::Relaxed);
        histories.turn(&mut imports);
        let recorded = frames.frame(Default::default(), |commands| {
            if frame == 1 {
                // SAFETY: the loop's command buffer is recording, and nothing has used the halves yet.
                unsafe { histories.clear(context, commands) };
            }
            // SAFETY: as above; the result is idle at first, and later frames take it as the one before left it.
            unsafe { execution.record(context, commands, &imports, None) }
        });
        recorded.unwrap();
    }
    frames.finish().unwrap();
    assert_eq!(buffer.read::<u32>(0, WORDS as usize).unwrap(), [0, 0, 1, 2, 3, 4]);
}

/// A row of words goes from frame to frame through a buffer's history, and each frame through an image's as well.
fn remembering(
    frame_number: &Arc<AtomicU32>,
) -> (Graph<Record>, airglow_graph::Handle<airglow_graph::Buffer>) {
    let mut graph: Graph<Record> = Graph::new();
    let row = graph.history_buffer("row", BufferDesc::new(4 * WORDS), Access::TransferSource);
    let texel = ImageDesc::new_2d(1, 1, vk::Format::R32_UINT);
    let newest = graph.history_image("newest", texel, Access::TransferSource);
    let desc = BufferDesc { size: 4 * WORDS, usage: vk::BufferUsageFlags::TRANSFER_DST };
    let left = State::of(Access::TransferDestination);
    let result = graph.import_buffer("result", desc, left, left);

    let mut pass = graph.pass("remember", PassKind::Transfer);
    pass.read(&row.previous, Access::TransferSource);
    pass.read(&newest.previous, Access::TransferSource);
    let staged = pass.create_buffer("staged", BufferDesc::new(4 * WORDS), Access::TransferDestination);
    let number = Arc::clone(frame_number);
    pass.record(Box::new(move |recorder, resources| {
        let staged = resources.buffer(&staged)?;
        let kept = 4 * (WORDS - 2);
        recorder.copy_buffer(resources.buffer(&row.previous)?.slice(4, kept)?, staged.slice(0, kept)?)?;
        let before = resources.view(&newest.previous)?;
        recorder.copy_image_to_buffer(&before, staged.slice(kept, 4)?)?;
        recorder.fill(staged.slice(4 * (WORDS - 1), 4)?, number.load(Ordering::Relaxed))
    }));

    let mut pass = graph.pass("keep", PassKind::Transfer);
    pass.read(&staged, Access::TransferSource);
    let kept = pass.write(row.current, Access::TransferDestination);
    let shown = pass.write(newest.current, Access::TransferDestination);
    let copied = pass.write(result, Access::TransferDestination);
    pass.record(Box::new(move |recorder, resources| {
        let staged = resources.buffer(&staged)?;
        recorder.copy_buffer(staged, resources.buffer(&kept)?)?;
        recorder.copy_buffer(staged, resources.buffer(&copied)?)?;
        recorder.copy_buffer_to_image(staged.slice(4 * (WORDS - 1), 4)?, &resources.view(&shown)?)
    }));
    (graph, result)
}
