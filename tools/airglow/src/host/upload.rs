//! From the host's arrays to buffers and images of the device, through staging memory.

use airglow_gpu::ash::vk;
use airglow_gpu::{Buffer, Context, GpuError, Image, ImageView, Label, Location, Recorder, ViewDesc};
use airglow_graph::{Access, BufferDesc, ImageDesc, State};
use bytemuck::Pod;

/// Whom the host's own resources are charged to.
pub const OWNER: &str = "host";

/// A buffer with `data` in it. `first_use` is what will read it.
pub fn buffer<T: Pod>(
    recorder: &mut Recorder<'_>,
    name: &str,
    data: &[T],
    first_use: Access,
) -> Result<Buffer, GpuError> {
    let context = recorder.context();
    let size = (size_of_val(data) as u64).max(4);
    let usage = first_use.buffer_usage() | vk::BufferUsageFlags::TRANSFER_DST;
    let buffer =
        context.create_buffer(Label::new(OWNER, name), &BufferDesc { size, usage }, Location::Device)?;
    if !data.is_empty() {
        let staging = staging(context, name, data)?;
        recorder.copy_buffer(&staging, &buffer)?;
        recorder.memory_barrier(Access::TransferDestination, first_use)?;
    }
    Ok(buffer)
}

/// A sampled 2D image from the texels of each mip level, `(width, height, texels)`, ready for `first_use`.
pub fn image<T: Pod>(
    recorder: &mut Recorder<'_>,
    name: &str,
    format: vk::Format,
    levels: &[(u32, u32, Vec<T>)],
    first_use: Access,
) -> Result<ImageView, GpuError> {
    array(recorder, name, format, levels, first_use)?.full_view()
}

/// The same with as many array layers as the texels of a level fill, layer by layer.
pub fn array<T: Pod>(
    recorder: &mut Recorder<'_>,
    name: &str,
    format: vk::Format,
    levels: &[(u32, u32, Vec<T>)],
    first_use: Access,
) -> Result<Image, GpuError> {
    let context = recorder.context();
    let (width, height) = levels.first().map_or((0, 0), |(width, height, _)| (*width, *height));
    let texels = levels.first().map_or(0, |(.., texels)| texels.len() as u32);
    let layers = texels / (width * height).max(1);
    let desc = ImageDesc {
        mips: levels.len() as u32,
        layers,
        usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
        ..ImageDesc::new_2d(width, height, format)
    };
    let image = context.create_image(Label::new(OWNER, name), &desc)?;
    recorder.transition(&image, State::UNDEFINED, Access::TransferDestination)?;
    let dimension = if layers > 1 { vk::ImageViewType::TYPE_2D_ARRAY } else { vk::ImageViewType::TYPE_2D };
    for (level, (_, _, texels)) in levels.iter().enumerate() {
        let staging = staging(context, name, texels)?;
        let whole = ViewDesc { dimension, base_mip: level as u32, mips: 1, base_layer: 0, layers };
        recorder.copy_buffer_to_image(&staging, &image.view(whole)?)?;
    }
    recorder.transition(&image, Access::TransferDestination, first_use)?;
    Ok(image)
}

fn staging<T: Pod>(context: &Context, name: &str, data: &[T]) -> Result<Buffer, GpuError> {
    let desc = BufferDesc { size: size_of_val(data) as u64, usage: vk::BufferUsageFlags::TRANSFER_SRC };
    let staging = context.create_buffer(Label::new(OWNER, name), &desc, Location::Upload)?;
    staging.write(0, data)?;
    Ok(staging)
}
