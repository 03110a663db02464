//! A small kernel and a buffer for it: what tests of the device layer record when it does not matter what.

use airglow_gpu::ash::vk;
use airglow_gpu::{Binding, Buffer, ComputePipeline, Context, GpuError, Label, Location, Recorder};
use airglow_graph::BufferDesc;

use crate::workload;

/// Colours the kernel writes.
pub const COUNT: u32 = 256;

/// Bytes of them, four f32 each.
pub const BYTES: u64 = COUNT as u64 * 16;

/// How the buffer is used.
pub const STORAGE: vk::BufferUsageFlags = vk::BufferUsageFlags::from_raw(
    vk::BufferUsageFlags::STORAGE_BUFFER.as_raw()
        | vk::BufferUsageFlags::TRANSFER_SRC.as_raw()
        | vk::BufferUsageFlags::TRANSFER_DST.as_raw(),
);

/// The kernel of `test/colours_compute`.
///
/// # Panics
/// When the device refuses the pipeline: the test that asks for it has failed.
pub fn pipeline(context: &Context) -> ComputePipeline {
    workload::colours(context).expect("the pipeline is sound")
}

/// A storage buffer of `size` bytes.
///
/// # Panics
/// When there is no memory for it: the test that asks for it has failed.
pub fn storage(context: &Context, owner: &str, size: u64) -> Buffer {
    let desc = BufferDesc { size, usage: STORAGE };
    context
        .create_buffer(Label::new(owner, "colours"), &desc, Location::Device)
        .expect("memory for a small buffer")
}

/// Records the kernel: every colour is `tint`.
///
/// # Errors
/// Those of the recorder.
pub fn record(
    recorder: &mut Recorder<'_>,
    pipeline: &ComputePipeline,
    buffer: &Buffer,
    tint: f32,
) -> Result<(), GpuError> {
    let tint = recorder.upload(&[[tint; 4]])?;
    recorder.bind_compute(pipeline, &[Binding::storage(0, buffer), Binding::uniform(1, &tint)])?;
    recorder.push_constants(&COUNT)?;
    recorder.dispatch([COUNT.div_ceil(64), 1, 1])
}
