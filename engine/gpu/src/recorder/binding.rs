//! Resources bound to a pipeline, checked against what it states, written to a descriptor set of the frame.

use crate::context::Context;
use crate::error::GpuError;
use crate::memory::{BufferSlice, ImageView, Sampler};
use crate::pipeline::{BindingKind, MAX_BINDINGS, PipelineCore};
use airglow_graph::Access;
use ash::vk;

/// A resource for one binding of descriptor set 0.
#[derive(Clone)]
pub struct Binding {
    binding: u32,
    resource: Bindable,
}

#[derive(Clone)]
enum Bindable {
    Storage(BufferSlice),
    Uniform(BufferSlice),
    Sampled(ImageView),
    StorageImage(ImageView),
    Sampler(Sampler),
}

impl Binding {
    /// A storage buffer: a whole [`Buffer`](crate::Buffer) or a slice of one.
    pub fn storage(binding: u32, buffer: impl Into<BufferSlice>) -> Self {
        Self { binding, resource: Bindable::Storage(buffer.into()) }
    }

    /// A uniform buffer, often what [`Recorder::upload`](super::Recorder::upload) returned.
    pub fn uniform(binding: u32, buffer: impl Into<BufferSlice>) -> Self {
        Self { binding, resource: Bindable::Uniform(buffer.into()) }
    }

    /// A sampled image, in the layout of [`Access::FragmentSampled`], or of its depth sibling for a depth format.
    pub fn sampled(binding: u32, view: ImageView) -> Self {
        Self { binding, resource: Bindable::Sampled(view) }
    }

    /// A storage image, in layout `GENERAL`.
    pub fn storage_image(binding: u32, view: ImageView) -> Self {
        Self { binding, resource: Bindable::StorageImage(view) }
    }

    /// A sampler.
    pub fn sampler(binding: u32, sampler: &Sampler) -> Self {
        Self { binding, resource: Bindable::Sampler(sampler.clone()) }
    }

    /// Bytes of the range bound.
    pub(super) fn bytes(&self) -> u64 {
        match &self.resource {
            Bindable::Storage(slice) | Bindable::Uniform(slice) => slice.size,
            Bindable::Sampled(view) | Bindable::StorageImage(view) => view.bytes(),
            Bindable::Sampler(_) => 0,
        }
    }

    fn kind(&self) -> BindingKind {
        match self.resource {
            Bindable::Storage(_) => BindingKind::StorageBuffer,
            Bindable::Uniform(_) => BindingKind::UniformBuffer,
            Bindable::Sampled(_) => BindingKind::SampledImage,
            Bindable::StorageImage(_) => BindingKind::StorageImage,
            Bindable::Sampler(_) => BindingKind::Sampler,
        }
    }
}

/// A set with `bindings` in it, or `None` for a pipeline that takes none.
pub(super) fn descriptor_set(
    context: &Context,
    core: &PipelineCore,
    bindings: &[Binding],
) -> Result<Option<vk::DescriptorSet>, GpuError> {
    check_interface(core, bindings)?;
    if bindings.is_empty() {
        return Ok(None);
    }
    let mut buffers = [vk::DescriptorBufferInfo::default(); MAX_BINDINGS];
    let mut images = [vk::DescriptorImageInfo::default(); MAX_BINDINGS];
    for (i, binding) in bindings.iter().enumerate() {
        match &binding.resource {
            Bindable::Storage(slice) | Bindable::Uniform(slice) => {
                buffers[i] = buffer_info(context, core, binding, slice)?;
            }
            Bindable::Sampled(view) | Bindable::StorageImage(view) => {
                images[i] = image_info(context, core, binding, view)?;
            }
            Bindable::Sampler(sampler) if sampler.belongs_to(&context.shared) => {
                images[i].sampler = sampler.raw()
            }
            Bindable::Sampler(_) => return Err(foreign(core, binding)),
        }
    }
    let set = context.slot().descriptor_set(core.set_layout)?;
    let mut writes = [vk::WriteDescriptorSet::default(); MAX_BINDINGS];
    for (i, binding) in bindings.iter().enumerate() {
        let write = vk::WriteDescriptorSet::default()
            .dst_set(set)
            .dst_binding(binding.binding)
            .descriptor_type(binding.kind().descriptor_type());
        writes[i] = match binding.kind() {
            BindingKind::StorageBuffer | BindingKind::UniformBuffer => write.buffer_info(&buffers[i..=i]),
            _ => write.image_info(&images[i..=i]),
        };
    }
    // SAFETY: set, buffers, views and samplers are live objects of this device and of the kinds the layout states.
    unsafe { context.shared.device().update_descriptor_sets(&writes[..bindings.len()], &[]) };
    Ok(Some(set))
}

/// The same numbers and kinds on both sides, each once.
fn check_interface(core: &PipelineCore, bindings: &[Binding]) -> Result<(), GpuError> {
    let stated = &core.interface.bindings;
    for desc in stated {
        let mut given = bindings.iter().filter(|binding| binding.binding == desc.binding);
        let problem = match (given.next(), given.next()) {
            (None, _) => format!("binding {} ({:?}) is not given", desc.binding, desc.kind),
            (_, Some(_)) => format!("binding {} is given twice", desc.binding),
            (Some(binding), None) if binding.kind() != desc.kind => {
                format!("binding {} is {:?}, given {:?}", desc.binding, desc.kind, binding.kind())
            }
            _ => continue,
        };
        return Err(GpuError::misuse(&*core.name, problem));
    }
    match bindings.iter().find(|binding| !stated.iter().any(|desc| desc.binding == binding.binding)) {
        Some(extra) => {
            Err(GpuError::misuse(&*core.name, format!("binding {} is not its own", extra.binding)))
        }
        None => Ok(()),
    }
}

fn buffer_info(
    context: &Context,
    core: &PipelineCore,
    binding: &Binding,
    slice: &BufferSlice,
) -> Result<vk::DescriptorBufferInfo, GpuError> {
    if !slice.buffer.belongs_to(&context.shared) {
        return Err(foreign(core, binding));
    }
    let limits = context.limits();
    let (usage, alignment, range, limit) = match binding.kind() {
        BindingKind::UniformBuffer => (
            vk::BufferUsageFlags::UNIFORM_BUFFER,
            limits.min_uniform_buffer_offset_alignment,
            limits.max_uniform_buffer_range,
            "maxUniformBufferRange",
        ),
        _ => (
            vk::BufferUsageFlags::STORAGE_BUFFER,
            limits.min_storage_buffer_offset_alignment,
            limits.max_storage_buffer_range,
            "maxStorageBufferRange",
        ),
    };
    let what = || format!("{}, binding {} ({})", core.name, binding.binding, slice.buffer.name());
    if !slice.buffer.desc().usage.contains(usage) {
        return Err(GpuError::misuse(what(), format!("the buffer was made without {usage:?}")));
    }
    if !slice.offset.is_multiple_of(alignment.max(1)) {
        return Err(GpuError::misuse(what(), format!("byte {} is no multiple of {alignment}", slice.offset)));
    }
    if slice.size > u64::from(range) {
        return Err(GpuError::TooLarge { what: what(), size: slice.size, limit, allowed: u64::from(range) });
    }
    Ok(vk::DescriptorBufferInfo { buffer: slice.buffer.raw(), offset: slice.offset, range: slice.size })
}

fn image_info(
    context: &Context,
    core: &PipelineCore,
    binding: &Binding,
    view: &ImageView,
) -> Result<vk::DescriptorImageInfo, GpuError> {
    if !view.image().belongs_to(&context.shared) {
        return Err(foreign(core, binding));
    }
    let desc = view.image().desc();
    let depth = desc.aspects().contains(vk::ImageAspectFlags::DEPTH);
    let access = match (binding.kind(), depth) {
        (BindingKind::StorageImage, _) => Access::ComputeStorageReadWrite,
        (_, true) => Access::FragmentSampledDepth,
        (_, false) => Access::FragmentSampled,
    };
    let what = || format!("{}, binding {} ({})", core.name, binding.binding, view.image().name());
    if !desc.usage.contains(access.image_usage()) {
        return Err(GpuError::misuse(
            what(),
            format!("the image was made without {:?}", access.image_usage()),
        ));
    }
    if binding.kind() == BindingKind::StorageImage && view.desc().mips != 1 {
        return Err(GpuError::misuse(what(), "a storage image is viewed one mip at a time"));
    }
    Ok(vk::DescriptorImageInfo {
        sampler: vk::Sampler::null(),
        image_view: view.raw(),
        image_layout: access.layout(),
    })
}

fn foreign(core: &PipelineCore, binding: &Binding) -> GpuError {
    GpuError::misuse(
        format!("{}, binding {}", core.name, binding.binding),
        "the resource was made by another context",
    )
}
