//! Copies and fills. Images are in the layouts of [`airglow_graph::Access::TransferSource`] and its sibling.

use super::Recorder;
use crate::error::GpuError;
use crate::memory::{Buffer, BufferSlice, ImageView};
use airglow_graph::ImageDesc;
use ash::vk;

impl Recorder<'_> {
    /// Copies `from` to `to`, ranges of the same size that do not overlap.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if they differ in size, overlap, lack `TRANSFER_SRC` or `TRANSFER_DST`, or within rendering.
    pub fn copy_buffer(
        &mut self,
        from: impl Into<BufferSlice>,
        to: impl Into<BufferSlice>,
    ) -> Result<(), GpuError> {
        let (from, to) = (from.into(), to.into());
        self.outside_rendering("copy_buffer")?;
        self.check_buffer(&from, vk::BufferUsageFlags::TRANSFER_SRC)?;
        self.check_buffer(&to, vk::BufferUsageFlags::TRANSFER_DST)?;
        if from.size != to.size {
            let problem =
                format!("copying {} bytes to {} bytes; give ranges of one size", from.size, to.size);
            return Err(GpuError::misuse(to.buffer.name(), problem));
        }
        let same = from.buffer.raw() == to.buffer.raw();
        if same && from.offset < to.offset + to.size && to.offset < from.offset + from.size {
            return Err(GpuError::misuse(to.buffer.name(), "source and destination of the copy overlap"));
        }
        let region = vk::BufferCopy { src_offset: from.offset, dst_offset: to.offset, size: from.size };
        // SAFETY: live buffers with the right usages and ranges within them.
        unsafe {
            self.device().cmd_copy_buffer(self.command_buffer, from.buffer.raw(), to.buffer.raw(), &[region]);
        }
        self.counts.copied(to.size);
        Ok(())
    }

    /// Fills `to` with copies of `value`.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if the range is not made of whole aligned words, lacks `TRANSFER_DST`, or within rendering.
    pub fn fill(&mut self, to: impl Into<BufferSlice>, value: u32) -> Result<(), GpuError> {
        let to = to.into();
        self.outside_rendering("fill")?;
        self.check_buffer(&to, vk::BufferUsageFlags::TRANSFER_DST)?;
        if !to.offset.is_multiple_of(4) || !to.size.is_multiple_of(4) {
            return Err(GpuError::misuse(to.buffer.name(), "a fill covers whole words of 4 bytes"));
        }
        // SAFETY: a live buffer with the right usage and an aligned range within it.
        unsafe {
            self.device().cmd_fill_buffer(self.command_buffer, to.buffer.raw(), to.offset, to.size, value);
        }
        self.counts.copied(to.size);
        Ok(())
    }

    /// Copies texels of a view's first mip to `to`, tightly packed, row by row, layer by layer.
    ///
    /// From one layer as many texels are copied as `to` holds: `to` may end within a row, so that a packed rectangle
    /// fills an array of any length. From several layers all are copied.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if `to` is not made of whole texels, holds more than the view, or usages are lacking.
    pub fn copy_image_to_buffer(
        &mut self,
        from: &ImageView,
        to: impl Into<BufferSlice>,
    ) -> Result<(), GpuError> {
        let to = to.into();
        self.check_image_copy(
            from,
            &to,
            vk::ImageUsageFlags::TRANSFER_SRC,
            vk::BufferUsageFlags::TRANSFER_DST,
        )?;
        let texel = texel_bytes(from)?;
        let [width, height, depth] = from.image().extent(from.desc().base_mip);
        let texels = to.size / texel;
        let layer = u64::from(width) * u64::from(height) * u64::from(depth);
        let all = layer * u64::from(from.desc().layers);
        let partial_allowed = from.desc().layers == 1 && depth == 1;
        if texels > all || (texels < all && !partial_allowed) || !to.size.is_multiple_of(texel) {
            let problem = format!("{} bytes do not hold a copy of {all} texels of {texel} bytes", to.size);
            return Err(GpuError::misuse(to.buffer.name(), problem));
        }
        self.counts.copied(to.size);
        let whole = region(from, to.offset);
        if texels == all {
            self.copy_regions(from, &to.buffer, &[whole]);
            return Ok(());
        }
        let (rows, rest) = ((texels / u64::from(width)) as u32, (texels % u64::from(width)) as u32);
        let extent = |width, height| vk::Extent3D { width, height, depth: 1 };
        let rows_region = vk::BufferImageCopy { image_extent: extent(width, rows), ..whole };
        let rest_region = vk::BufferImageCopy {
            buffer_offset: to.offset + u64::from(rows) * u64::from(width) * texel,
            image_offset: vk::Offset3D { x: 0, y: rows as i32, z: 0 },
            image_extent: extent(rest, 1),
            ..whole
        };
        match (rows, rest) {
            (0, _) => self.copy_regions(from, &to.buffer, &[rest_region]),
            (_, 0) => self.copy_regions(from, &to.buffer, &[rows_region]),
            _ => self.copy_regions(from, &to.buffer, &[rows_region, rest_region]),
        }
        Ok(())
    }

    fn copy_regions(&self, from: &ImageView, to: &Buffer, regions: &[vk::BufferImageCopy]) {
        let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        // SAFETY: a live image and buffer with the right usages; regions within both.
        unsafe {
            self.device().cmd_copy_image_to_buffer(
                self.command_buffer,
                from.image().raw(),
                layout,
                to.raw(),
                regions,
            );
        }
    }

    /// Copies `from`, tightly packed texels, to the whole first mip of a view.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if `from` is not exactly as large as the view's texels, or usages are lacking.
    pub fn copy_buffer_to_image(
        &mut self,
        from: impl Into<BufferSlice>,
        to: &ImageView,
    ) -> Result<(), GpuError> {
        let from = from.into();
        self.check_image_copy(
            to,
            &from,
            vk::ImageUsageFlags::TRANSFER_DST,
            vk::BufferUsageFlags::TRANSFER_SRC,
        )?;
        let extent = to.image().extent(to.desc().base_mip);
        let texels = extent.iter().fold(u64::from(to.desc().layers), |all, &side| all * u64::from(side));
        let size = texels * texel_bytes(to)?;
        if from.size != size {
            let problem = format!("{} bytes copied to an image of {size} bytes", from.size);
            return Err(GpuError::misuse(to.image().name(), problem));
        }
        let layout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        // SAFETY: a live image and buffer with the right usages; the region was checked against both.
        unsafe {
            self.device().cmd_copy_buffer_to_image(
                self.command_buffer,
                from.buffer.raw(),
                to.image().raw(),
                layout,
                &[region(to, from.offset)],
            );
        }
        self.counts.copied(size);
        Ok(())
    }

    fn check_image_copy(
        &self,
        view: &ImageView,
        slice: &BufferSlice,
        image_usage: vk::ImageUsageFlags,
        buffer_usage: vk::BufferUsageFlags,
    ) -> Result<(), GpuError> {
        self.outside_rendering("copy between image and buffer")?;
        self.check_buffer(slice, buffer_usage)?;
        let image = view.image();
        if !image.belongs_to(&self.context.shared) {
            return Err(GpuError::misuse(image.name(), "the image was made by another context"));
        }
        if !image.desc().usage.contains(image_usage) || image.desc().samples != vk::SampleCountFlags::TYPE_1 {
            let problem = format!("copying needs an image of one sample made with {image_usage:?}");
            return Err(GpuError::misuse(image.name(), problem));
        }
        let texel = texel_bytes(view)?;
        if !slice.offset.is_multiple_of(texel) || !slice.offset.is_multiple_of(4) {
            let problem = format!("byte {} is no multiple of 4 and of a texel's {texel} bytes", slice.offset);
            return Err(GpuError::misuse(slice.buffer.name(), problem));
        }
        Ok(())
    }
}

/// All of the view's first mip.
fn region(view: &ImageView, buffer_offset: u64) -> vk::BufferImageCopy {
    let desc = view.desc();
    let [width, height, depth] = view.image().extent(desc.base_mip);
    vk::BufferImageCopy {
        buffer_offset,
        image_subresource: vk::ImageSubresourceLayers {
            aspect_mask: view.aspect(),
            mip_level: desc.base_mip,
            base_array_layer: desc.base_layer,
            layer_count: desc.layers,
        },
        image_extent: vk::Extent3D { width, height, depth },
        ..Default::default()
    }
}

/// Bytes of a texel as copies pack it.
fn texel_bytes(view: &ImageView) -> Result<u64, GpuError> {
    let desc = view.image().desc();
    if desc.aspects().contains(vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL) {
        return Err(GpuError::misuse(view.image().name(), "formats with depth and stencil are not copied"));
    }
    ImageDesc::new_2d(1, 1, desc.format).bytes().ok_or_else(|| {
        GpuError::misuse(view.image().name(), format!("{:?} has no known texel size", desc.format))
    })
}
