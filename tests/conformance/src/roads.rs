//! What is recorded around a room and by it: the host's own commands, our plan, or the host's own frame graph.

use super::{Content, Declared, Given, HostResource, Named, Refusal, Room, layout_after};
use crate::plan::checked;
use crate::shim::{Call, Shim};
use airglow_gpu::ash::vk;
use airglow_gpu::{Context, Execution, GpuError, Imports, Readback, Record, Recorder};
use airglow_graph::{Access, Graph, ImageDesc, Options, Plan, State};

/// The host's own commands before the room: contents, then the state handed over.
pub(super) fn fill(
    recorder: &mut Recorder<'_>,
    resource: &HostResource,
    given: &Given,
    entry: State,
) -> Result<(), GpuError> {
    match (&resource.content, given) {
        (Content::Image(_, texels), Given::Image(image)) => {
            let source = recorder.upload(texels)?;
            recorder.transition(image, State::UNDEFINED, Access::TransferDestination)?;
            recorder.copy_buffer_to_image(&source, &image.full_view()?)?;
            hand_over(recorder, given, Access::TransferDestination.into(), entry)
        }
        (Content::Buffer(_, bytes), Given::Buffer(buffer)) if !bytes.is_empty() => {
            let source = recorder.upload(bytes)?;
            recorder.copy_buffer(&source, &buffer.slice(0, bytes.len() as u64)?)?;
            hand_over(recorder, given, Access::TransferDestination.into(), entry)
        }
        _ => Ok(()),
    }
}

/// The host's own barriers from one state of a resource to the next: it takes the resource from another family first, and
/// gives it to another last.
fn hand_over(recorder: &mut Recorder<'_>, given: &Given, from: State, to: State) -> Result<(), GpuError> {
    let own = recorder.context().graph_limits().queue_family;
    let (taken, left) = (foreign(from, own).then(|| idle(from)), foreign(to, own).then(|| idle(to)));
    if let Some(state) = taken {
        transfer(recorder, given, state.layout, (from.queue_family, own));
    }
    change(recorder, given, taken.unwrap_or(from), left.unwrap_or(to))?;
    if let Some(state) = left {
        transfer(recorder, given, state.layout, (own, to.queue_family));
    }
    Ok(())
}

/// Whether a family other than the host's own has the resource.
pub(super) fn foreign(state: State, own: u32) -> bool {
    ![vk::QUEUE_FAMILY_IGNORED, own].contains(&state.queue_family)
}

/// A state of the own family around a transfer, which waits for everything.
fn idle(State { layout, .. }: State) -> State {
    let access = vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE;
    State { stage: vk::PipelineStageFlags2::ALL_COMMANDS, access, layout, ..State::UNDEFINED }
}

/// The own half of a transfer between families, which leaves the layout as it is.
fn transfer(recorder: &Recorder<'_>, given: &Given, layout: vk::ImageLayout, (from, to): (u32, u32)) {
    let State { stage, access, .. } = idle(State::idle(layout));
    let (mut buffers, mut images) = (Vec::new(), Vec::new());
    match given {
        Given::Buffer(buffer) => buffers.push(
            vk::BufferMemoryBarrier2::default()
                .src_stage_mask(stage)
                .src_access_mask(access)
                .dst_stage_mask(stage)
                .dst_access_mask(access)
                .src_queue_family_index(from)
                .dst_queue_family_index(to)
                .buffer(buffer.raw())
                .size(vk::WHOLE_SIZE),
        ),
        Given::Image(image) => images.push(
            vk::ImageMemoryBarrier2::default()
                .src_stage_mask(stage)
                .src_access_mask(access)
                .dst_stage_mask(stage)
                .dst_access_mask(access)
                .old_layout(layout)
                .new_layout(layout)
                .src_queue_family_index(from)
                .dst_queue_family_index(to)
                .image(image.raw())
                .subresource_range(whole(image.desc())),
        ),
    }
    let info = vk::DependencyInfo::default().buffer_memory_barriers(&buffers).image_memory_barriers(&images);
    // SAFETY: a recording command buffer outside rendering, and live resources of its device.
    unsafe { recorder.context().device().cmd_pipeline_barrier2(recorder.command_buffer(), &info) };
}

/// All of an image.
fn whole(desc: &ImageDesc) -> vk::ImageSubresourceRange {
    let depth = Access::DepthAttachmentWrite.image_usage();
    let aspect = match desc.usage.intersects(depth) {
        true => vk::ImageAspectFlags::DEPTH,
        false => vk::ImageAspectFlags::COLOR,
    };
    vk::ImageSubresourceRange {
        aspect_mask: aspect,
        level_count: desc.mips,
        layer_count: desc.layers,
        ..Default::default()
    }
}

/// The host's own barrier within its family.
fn change(recorder: &mut Recorder<'_>, given: &Given, from: State, to: State) -> Result<(), GpuError> {
    let buffer = match given {
        Given::Image(image) => return recorder.transition(image, from, to),
        Given::Buffer(buffer) => buffer,
    };
    let barriers = [vk::BufferMemoryBarrier2::default()
        .src_stage_mask(from.stage)
        .src_access_mask(from.access)
        .dst_stage_mask(to.stage)
        .dst_access_mask(to.access)
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .buffer(buffer.raw())
        .size(vk::WHOLE_SIZE)];
    let info = vk::DependencyInfo::default().buffer_memory_barriers(&barriers);
    // SAFETY: a recording command buffer outside rendering, and a live buffer of its device.
    unsafe { recorder.context().device().cmd_pipeline_barrier2(recorder.command_buffer(), &info) };
    Ok(())
}

/// How a plan's transients are made.
pub(super) type Prepare = fn(&Context, Plan<Record>) -> Result<Execution, GpuError>;

/// One plan of all rooms, each with its resources of the host's; `prepare` makes its transients.
pub(super) fn by_graph<'r, R: Room + 'r>(
    rooms: impl IntoIterator<Item = (&'r mut R, &'r [HostResource], &'r [Given])>,
    recorder: &mut Recorder<'_>,
    options: &Options,
    prepare: Prepare,
) -> Result<Execution, Refusal> {
    let (mut graph, mut imports) = (Graph::<Record>::new(), Imports::new());
    let context = recorder.context();
    for (room, resources, given) in rooms {
        let name = |(resource, given): (&HostResource, &Given)| match given {
            Given::Buffer(buffer) => {
                let handle =
                    graph.import_buffer(resource.name, *buffer.desc(), resource.entry, resource.exit);
                imports.buffer(&handle, buffer);
                Named::Buffer(handle)
            }
            Given::Image(image) => {
                let handle = graph.import_image(resource.name, *image.desc(), resource.entry, resource.exit);
                imports.image(&handle, image);
                Named::Image(handle)
            }
        };
        let named: Vec<_> = resources.iter().zip(given).map(name).collect();
        room.add(&mut Declared { context, graph: &mut graph, imports: &mut imports, host: &named })?;
    }
    let plan = checked(graph, &context.graph_limits(), options)?;
    let mut execution = prepare(context, plan)?;
    // SAFETY: the recorder's command buffer is recording; the host brought every import to its entry state.
    let recorded = unsafe { execution.record(context, recorder.command_buffer(), &imports, None) };
    recorded?;
    Ok(execution)
}

/// The host's own frame graph: its barriers around the room come from the room's accesses.
pub(super) fn by_record(
    room: &mut impl Room,
    recorder: &mut Recorder<'_>,
    resources: &[HostResource],
    given: &[Given],
    shim: &Shim,
    calls: &mut Vec<Call>,
) -> Result<(), Refusal> {
    let accesses = room.accesses(recorder.context())?;
    let around = |before: bool, recorder: &mut Recorder<'_>| -> Result<(), Refusal> {
        for ((resource, given), used) in resources.iter().zip(given).zip(&accesses) {
            let Some((first, last)) = used else { continue };
            let [from, to] = match before {
                true => [resource.entry, State::of(*first)],
                false => [State::of(*last), resource.exit],
            };
            hand_over(recorder, given, from, to)?;
        }
        Ok(())
    };
    around(true, recorder)?;
    shim.take_calls();
    room.record(recorder, given)?;
    *calls = shim.take_calls();
    for ((resource, given), used) in resources.iter().zip(given).zip(&accesses) {
        let (Given::Image(image), Some((first, last))) = (given, used) else { continue };
        let layout = layout_after(calls, image.raw(), first.layout())?;
        if layout != last.layout() {
            let (name, said) = (resource.name, last.layout());
            return Err(format!("{name}: {layout:?} after the room, {said:?} said").into());
        }
    }
    around(false, recorder)
}

/// The host's own commands after the room.
pub(super) fn read_back(
    recorder: &mut Recorder<'_>,
    resources: &[HostResource],
    given: &[Given],
) -> Result<Vec<Readback>, GpuError> {
    let mut copies = Vec::new();
    for (resource, given) in resources.iter().zip(given) {
        match given {
            Given::Image(image) if !image.desc().usage.contains(vk::ImageUsageFlags::TRANSFER_SRC) => {}
            Given::Image(image) => {
                hand_over(recorder, given, resource.exit, Access::TransferSource.into())?;
                copies.push(recorder.read_back_image(&image.full_view()?)?);
            }
            Given::Buffer(buffer) => {
                hand_over(recorder, given, resource.exit, Access::TransferSource.into())?;
                copies.push(recorder.read_back_buffer(buffer)?);
            }
        }
    }
    Ok(copies)
}
