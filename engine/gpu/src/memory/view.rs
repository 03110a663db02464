//! Views of an image's mips and layers.

use super::image::{Image, ViewDesc};
use crate::error::GpuError;
use crate::shared::lock;
use airglow_graph::ImageDesc;
use ash::vk;

/// Usages that need a Vulkan view; an image that is only copied has none.
const VIEWED: vk::ImageUsageFlags = vk::ImageUsageFlags::from_raw(
    vk::ImageUsageFlags::SAMPLED.as_raw()
        | vk::ImageUsageFlags::STORAGE.as_raw()
        | vk::ImageUsageFlags::COLOR_ATTACHMENT.as_raw()
        | vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT.as_raw()
        | vk::ImageUsageFlags::INPUT_ATTACHMENT.as_raw(),
);

/// A view of an image; keeps the image.
#[derive(Clone)]
pub struct ImageView {
    image: Image,
    raw: vk::ImageView,
    desc: ViewDesc,
}

impl Image {
    /// The view of the whole image: 2D, 2D array (more than one layer) or 3D. Cube views are asked for by [`Image::view`].
    ///
    /// # Errors
    /// As [`Image::view`].
    pub fn full_view(&self) -> Result<ImageView, GpuError> {
        let dimension = match (self.desc().extent[2] > 1, self.desc().layers > 1) {
            (true, _) => vk::ImageViewType::TYPE_3D,
            (false, true) => vk::ImageViewType::TYPE_2D_ARRAY,
            (false, false) => vk::ImageViewType::TYPE_2D,
        };
        self.view(ViewDesc {
            dimension,
            base_mip: 0,
            mips: self.desc().mips,
            base_layer: 0,
            layers: self.desc().layers,
        })
    }

    /// A view, made on first asking and kept with the image.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if the mips or layers leave the image or do not fit the shape.
    pub fn view(&self, desc: ViewDesc) -> Result<ImageView, GpuError> {
        let mut views = lock(&self.0.views);
        if let Some(&(_, raw)) = views.iter().find(|(known, _)| *known == desc) {
            return Ok(ImageView { image: self.clone(), raw, desc });
        }
        self.check_view(&desc)?;
        if !self.desc().usage.intersects(VIEWED) {
            return Ok(ImageView { image: self.clone(), raw: vk::ImageView::null(), desc });
        }
        let info = vk::ImageViewCreateInfo::default()
            .image(self.raw())
            .view_type(desc.dimension)
            .format(self.desc().format)
            .subresource_range(vk::ImageSubresourceRange {
                aspect_mask: seen_aspect(self.desc()),
                base_mip_level: desc.base_mip,
                level_count: desc.mips,
                base_array_layer: desc.base_layer,
                layer_count: desc.layers,
            });
        let device = self.0.shared.device();
        // SAFETY: a live image of this device and a range checked against it.
        let raw = unsafe { device.create_image_view(&info, None) }
            .map_err(GpuError::vulkan("vkCreateImageView"))?;
        self.0.shared.name(raw, vk::ObjectType::IMAGE_VIEW, self.name());
        views.push((desc, raw));
        Ok(ImageView { image: self.clone(), raw, desc })
    }

    fn check_view(&self, desc: &ViewDesc) -> Result<(), GpuError> {
        let within = |base: u32, count: u32, all: u32| {
            count > 0 && base.checked_add(count).is_some_and(|end| end <= all)
        };
        let shape = match desc.dimension {
            vk::ImageViewType::TYPE_2D => desc.layers == 1 && self.desc().extent[2] == 1,
            vk::ImageViewType::TYPE_2D_ARRAY => self.desc().extent[2] == 1,
            vk::ImageViewType::TYPE_3D => desc.layers == 1 && self.desc().extent[2] > 1,
            vk::ImageViewType::CUBE => desc.layers == 6 && self.desc().cube,
            _ => false,
        };
        let fits = within(desc.base_mip, desc.mips, self.desc().mips)
            && within(desc.base_layer, desc.layers, self.desc().layers);
        if shape && fits {
            return Ok(());
        }
        let (mips, layers) = (self.desc().mips, self.desc().layers);
        Err(GpuError::misuse(
            self.name(),
            format!("no {desc:?} of an image with {mips} mips and {layers} layers"),
        ))
    }
}

impl ImageView {
    /// The Vulkan handle; null for an image that can only be copied.
    pub fn raw(&self) -> vk::ImageView {
        self.raw
    }

    /// The image.
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// What is seen.
    pub fn desc(&self) -> ViewDesc {
        self.desc
    }

    /// The one aspect seen: depth, where there is stencil too.
    pub(crate) fn aspect(&self) -> vk::ImageAspectFlags {
        seen_aspect(self.image.desc())
    }

    /// Bytes of the texels seen; 0 for a format whose size is not known.
    pub(crate) fn bytes(&self) -> u64 {
        let (image, desc) = (self.image.desc(), self.desc);
        let extent = self.image.extent(desc.base_mip);
        let seen = ImageDesc { extent, mips: desc.mips, layers: desc.layers, ..*image };
        seen.bytes().unwrap_or(0)
    }

    /// Width and height in texels of the view's first mip.
    pub fn extent(&self) -> [u32; 2] {
        let [width, height, _] = self.image.extent(self.desc.base_mip);
        [width, height]
    }
}

/// The one aspect a view shows: depth, where there is stencil too.
fn seen_aspect(desc: &ImageDesc) -> vk::ImageAspectFlags {
    let all = desc.aspects();
    if all.contains(vk::ImageAspectFlags::DEPTH) { vk::ImageAspectFlags::DEPTH } else { all }
}
