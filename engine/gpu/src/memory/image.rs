//! Images.

use super::Label;
use super::heap::Heap;
use crate::allocator::{Allocation, Location};
use crate::error::GpuError;
use crate::retire::Retired;
use crate::shared::{Shared, lock};
use airglow_graph::ImageDesc;
use ash::vk;
use std::sync::{Arc, Mutex};

/// Which part of an image is seen, and as what.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ViewDesc {
    /// Shape of the view.
    pub dimension: vk::ImageViewType,
    /// First mip level.
    pub base_mip: u32,
    /// Number of mip levels.
    pub mips: u32,
    /// First array layer.
    pub base_layer: u32,
    /// Number of array layers.
    pub layers: u32,
}

impl ViewDesc {
    /// One mip of one layer, as rendering and storage writes want it.
    pub fn single(mip: u32, layer: u32) -> Self {
        Self { dimension: vk::ImageViewType::TYPE_2D, base_mip: mip, mips: 1, base_layer: layer, layers: 1 }
    }
}

/// An image. Clones refer to the same image; the last one dropped retires it and its views.
#[derive(Clone)]
pub struct Image(pub(super) Arc<Inner>);

pub(super) struct Inner {
    pub(super) shared: Arc<Shared>,
    raw: vk::Image,
    name: String,
    desc: ImageDesc,
    /// Views made so far.
    pub(super) views: Mutex<Vec<(ViewDesc, vk::ImageView)>>,
    memory: Option<Allocation>,
    /// What it is placed in.
    heap: Option<Heap>,
    ledger: usize,
}

impl Image {
    pub(crate) fn new(shared: &Arc<Shared>, label: Label<'_>, desc: &ImageDesc) -> Result<Self, GpuError> {
        let info = create_info(desc);
        check(shared, label, desc, &info)?;
        let device = shared.device();
        // SAFETY: a live device and a checked description; on an error the image made so far is destroyed.
        let (raw, memory) = unsafe {
            let raw = device.create_image(&info, None).map_err(GpuError::vulkan("vkCreateImage"))?;
            let memory = shared
                .allocate(label.name, device.get_image_memory_requirements(raw), Location::Device, false)
                .inspect_err(|_| device.destroy_image(raw, None))?;
            if let Err(result) = device.bind_image_memory(raw, memory.memory, memory.offset) {
                device.destroy_image(raw, None);
                shared.free(memory);
                return Err(GpuError::Vulkan { call: "vkBindImageMemory", result });
            }
            (raw, memory)
        };
        shared.name(raw, vk::ObjectType::IMAGE, label.name);
        let ledger = shared.ledger().add(label.owner, memory.size);
        Ok(Self::from_parts(shared, raw, label, desc, (Some(memory), None), ledger))
    }

    /// An image that was bound to a place in `heap`.
    pub(crate) fn placed(
        shared: &Arc<Shared>,
        raw: vk::Image,
        label: Label<'_>,
        desc: &ImageDesc,
        heap: &Heap,
    ) -> Self {
        shared.name(raw, vk::ObjectType::IMAGE, label.name);
        let ledger = shared.ledger().add(label.owner, 0);
        Self::from_parts(shared, raw, label, desc, (None, Some(heap.clone())), ledger)
    }

    /// An image whose memory is the host's.
    pub(crate) fn imported(shared: &Arc<Shared>, raw: vk::Image, label: Label<'_>, desc: &ImageDesc) -> Self {
        let ledger = shared.ledger().add(label.owner, 0);
        Self::from_parts(shared, raw, label, desc, (None, None), ledger)
    }

    fn from_parts(
        shared: &Arc<Shared>,
        raw: vk::Image,
        label: Label<'_>,
        desc: &ImageDesc,
        (memory, heap): (Option<Allocation>, Option<Heap>),
        ledger: usize,
    ) -> Self {
        Self(Arc::new(Inner {
            shared: Arc::clone(shared),
            raw,
            name: label.name.to_owned(),
            desc: *desc,
            views: Mutex::default(),
            memory,
            heap,
            ledger,
        }))
    }

    /// The Vulkan handle, for the host's own commands. It dies with the last clone, frames later.
    pub fn raw(&self) -> vk::Image {
        self.0.raw
    }

    /// The name it was made with.
    pub fn name(&self) -> &str {
        &self.0.name
    }

    /// What it is: extent, format, mips, layers, usage. The same description imports it into a graph.
    pub fn desc(&self) -> &ImageDesc {
        &self.0.desc
    }

    /// Width, height and depth in texels of mip `mip`.
    pub fn extent(&self, mip: u32) -> [u32; 3] {
        self.0.desc.extent.map(|size| size.checked_shr(mip).unwrap_or(0).max(1))
    }

    pub(crate) fn belongs_to(&self, shared: &Arc<Shared>) -> bool {
        Arc::ptr_eq(&self.0.shared, shared)
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        let views = std::mem::take(&mut *lock(&self.views)).into_iter().map(|(_, view)| view).collect();
        let memory = self.memory.take();
        if memory.is_none() && self.heap.is_none() {
            self.shared.ledger().remove(self.ledger, 0);
            return self.shared.retire(Retired::Views(views));
        }
        self.shared.retire(Retired::Image { raw: self.raw, views, memory, ledger: self.ledger });
    }
}

/// The description as Vulkan takes it.
pub(crate) fn create_info<'a>(desc: &ImageDesc) -> vk::ImageCreateInfo<'a> {
    let three = desc.extent[2] > 1;
    vk::ImageCreateInfo::default()
        .flags(if desc.cube { vk::ImageCreateFlags::CUBE_COMPATIBLE } else { Default::default() })
        .image_type(if three { vk::ImageType::TYPE_3D } else { vk::ImageType::TYPE_2D })
        .format(desc.format)
        .extent(vk::Extent3D { width: desc.extent[0], height: desc.extent[1], depth: desc.extent[2] })
        .mip_levels(desc.mips)
        .array_layers(desc.layers)
        .samples(desc.samples)
        .usage(desc.usage)
}

/// Asks the device whether it can make such an image at all, and how large.
pub(crate) fn check(
    shared: &Shared,
    label: Label<'_>,
    desc: &ImageDesc,
    info: &vk::ImageCreateInfo<'_>,
) -> Result<(), GpuError> {
    // SAFETY: a live physical device of this instance.
    let most = unsafe {
        shared.functions.instance.get_physical_device_image_format_properties(
            shared.facts.physical_device,
            info.format,
            info.image_type,
            info.tiling,
            info.usage,
            info.flags,
        )
    }
    .map_err(|_| {
        GpuError::misuse(label.name, format!("the device has no {:?} for {:?}", desc.format, desc.usage))
    })?;
    let [width, height, depth] = desc.extent;
    let limit = most.max_extent;
    let largest = width.max(height).max(depth);
    let problem = if width == 0 || height == 0 || depth == 0 || desc.layers == 0 || desc.mips == 0 {
        "every side needs at least one texel, and an image at least one layer and mip".to_owned()
    } else if width > limit.width || height > limit.height || depth > limit.depth {
        let most = format!("{} x {} x {}", limit.width, limit.height, limit.depth);
        format!("{width} x {height} x {depth} texels; the device allows {most}: make it smaller or split it")
    } else if desc.layers > most.max_array_layers {
        format!("{} layers; the device allows {}", desc.layers, most.max_array_layers)
    } else if !most.sample_counts.contains(desc.samples) || desc.samples.as_raw().count_ones() != 1 {
        format!("{:?} samples; the device allows {:?}", desc.samples, most.sample_counts)
    } else if desc.mips > 32 - largest.leading_zeros() {
        format!("{} mips; the largest side has {}", desc.mips, 32 - largest.leading_zeros())
    } else if desc.cube && (!desc.layers.is_multiple_of(6) || width != height) {
        "a cube needs square faces and six layers for each".to_owned()
    } else {
        return Ok(());
    };
    Err(GpuError::misuse(label.name, problem))
}
