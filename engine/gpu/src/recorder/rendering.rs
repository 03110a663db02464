//! Dynamic rendering: attachments, viewport and scissor.

use super::Recorder;
use super::draw::Attachments;
use crate::error::GpuError;
use crate::memory::ImageView;
use crate::pipeline::MAX_COLORS;
use airglow_graph::Access;
use ash::vk;

/// What an attachment starts from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load<T> {
    /// What it holds.
    Keep,
    /// A value.
    Clear(T),
    /// Anything: every texel will be overwritten.
    Discard,
}

/// A colour attachment, in the layout of [`Access::ColorAttachmentWrite`].
#[derive(Clone, Copy)]
pub struct ColorAttachment<'a> {
    /// One mip of one layer.
    pub view: &'a ImageView,
    /// What it starts from: linear RGBA.
    pub load: Load<[f32; 4]>,
}

/// A depth attachment, in the layout of [`Access::DepthAttachmentWrite`], or of [`Access::DepthAttachmentRead`].
#[derive(Clone, Copy)]
pub struct DepthAttachment<'a> {
    /// One mip of one layer.
    pub view: &'a ImageView,
    /// What it starts from, in [0, 1].
    pub load: Load<f32>,
    /// False if it is only tested; then the pipelines must not write it.
    pub write: bool,
}

/// The attachments of draws. All have one size, which is rendered whole.
#[derive(Clone, Copy)]
pub struct Rendering<'a> {
    /// Colour attachments by location.
    pub colors: &'a [ColorAttachment<'a>],
    /// Depth attachment.
    pub depth: Option<DepthAttachment<'a>>,
}

impl Recorder<'_> {
    /// Begins rendering and sets viewport and scissor to the whole of it.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if rendering has begun, there is no attachment, or one has another size, more than one
    /// layer, mip or sample, or not the usage it needs.
    pub fn begin_rendering(&mut self, rendering: &Rendering<'_>) -> Result<(), GpuError> {
        self.outside_rendering("begin_rendering")?;
        let extent = self.check_rendering(rendering)?;
        let mut colors = [vk::RenderingAttachmentInfo::default(); MAX_COLORS];
        let mut formats = [vk::Format::UNDEFINED; MAX_COLORS];
        for (i, color) in rendering.colors.iter().enumerate() {
            let value =
                vk::ClearValue { color: vk::ClearColorValue { float32: clear_value(color.load, [0.0; 4]) } };
            colors[i] =
                attachment(color.view, Access::ColorAttachmentWrite, load_op(color.load), true, value);
            formats[i] = color.view.image().desc().format;
        }
        let depth = rendering.depth.map_or_else(Default::default, |depth| {
            let access = if depth.write { Access::DepthAttachmentWrite } else { Access::DepthAttachmentRead };
            let value = vk::ClearDepthStencilValue { depth: clear_value(depth.load, 0.0), stencil: 0 };
            let value = vk::ClearValue { depth_stencil: value };
            attachment(depth.view, access, load_op(depth.load), depth.write, value)
        });
        let count = rendering.colors.len();
        let area =
            vk::Rect2D { extent: vk::Extent2D { width: extent[0], height: extent[1] }, ..Default::default() };
        let mut info =
            vk::RenderingInfo::default().render_area(area).layer_count(1).color_attachments(&colors[..count]);
        if rendering.depth.is_some() {
            info = info.depth_attachment(&depth);
        }
        // SAFETY: outside rendering, with live views of this device that were checked to fit.
        unsafe { self.device().cmd_begin_rendering(self.command_buffer, &info) };
        let views =
            rendering.colors.iter().map(|color| color.view).chain(rendering.depth.map(|depth| depth.view));
        self.counts.bound_bytes += views.map(ImageView::bytes).sum::<u64>();
        let depth = rendering.depth.map(|depth| (depth.view.image().desc().format, depth.write));
        self.draw.rendering = Some(Attachments { colors: formats, count, depth });
        self.set_viewport([0.0, 0.0, extent[0] as f32, extent[1] as f32], [0.0, 1.0])?;
        self.set_scissor([0, 0], extent)
    }

    /// Ends rendering.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if it has not begun.
    pub fn end_rendering(&mut self) -> Result<(), GpuError> {
        if self.draw.rendering.take().is_none() {
            return Err(GpuError::misuse("end_rendering", "rendering has not begun"));
        }
        // SAFETY: rendering was begun by this recorder.
        unsafe { self.device().cmd_end_rendering(self.command_buffer) };
        Ok(())
    }

    fn check_rendering(&self, rendering: &Rendering<'_>) -> Result<[u32; 2], GpuError> {
        let color = rendering.colors.iter().map(|color| (color.view, vk::ImageUsageFlags::COLOR_ATTACHMENT));
        let depth = rendering.depth.iter().map(|d| (d.view, vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT));
        let Some((first, _)) = color.clone().chain(depth.clone()).next() else {
            return Err(GpuError::misuse("begin_rendering", "there is no attachment"));
        };
        if rendering.colors.len() > MAX_COLORS {
            return Err(GpuError::misuse(
                "begin_rendering",
                format!("at most {MAX_COLORS} colours are allowed"),
            ));
        }
        let most = self.context.limits();
        let extent = first.extent();
        for (view, usage) in color.chain(depth) {
            let (desc, image) = (view.desc(), view.image());
            let problem = if !image.belongs_to(&self.context.shared) {
                "the image was made by another context".to_owned()
            } else if !image.desc().usage.contains(usage) {
                format!("the image was made without {usage:?}")
            } else if desc.mips != 1
                || desc.layers != 1
                || image.desc().samples != vk::SampleCountFlags::TYPE_1
            {
                "an attachment is one mip of one layer with one sample".to_owned()
            } else if view.extent() != extent {
                format!("{:?} texels beside an attachment of {extent:?}", view.extent())
            } else if extent[0] > most.max_framebuffer_width || extent[1] > most.max_framebuffer_height {
                format!("{extent:?} texels; maxFramebufferWidth and Height are smaller")
            } else {
                continue;
            };
            return Err(GpuError::misuse(image.name(), problem));
        }
        let clears_unwritten = |depth: &DepthAttachment<'_>| !depth.write && depth.load != Load::Keep;
        if rendering.depth.as_ref().is_some_and(clears_unwritten) {
            return Err(GpuError::misuse(
                "begin_rendering",
                "depth that is not written is kept, not cleared",
            ));
        }
        Ok(extent)
    }

    /// Sets the viewport: x, y, width and height in pixels (a negative height turns y up), and the range of depth.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for values that Vulkan does not allow.
    pub fn set_viewport(&mut self, [x, y, width, height]: [f32; 4], depth: [f32; 2]) -> Result<(), GpuError> {
        let limits = self.context.limits();
        let [low, high] = limits.viewport_bounds_range;
        let [most_wide, most_high] = limits.max_viewport_dimensions.map(|side| side as f32);
        let inside = |value: f32| (low..=high).contains(&value);
        let allowed = width > 0.0
            && width <= most_wide
            && height.abs() <= most_high
            && [x, y, x + width, y + height].into_iter().all(inside)
            && depth.iter().all(|depth| (0.0..=1.0).contains(depth));
        if !allowed {
            return Err(GpuError::misuse(
                "set_viewport",
                format!("[{x}, {y}, {width}, {height}] {depth:?} is not allowed"),
            ));
        }
        let viewport = vk::Viewport { x, y, width, height, min_depth: depth[0], max_depth: depth[1] };
        // SAFETY: values checked against the limits.
        unsafe { self.device().cmd_set_viewport(self.command_buffer, 0, &[viewport]) };
        Ok(())
    }

    /// Limits drawing to `extent` pixels from `offset` on.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if the rectangle leaves the range of `i32`.
    pub fn set_scissor(&mut self, offset: [u32; 2], extent: [u32; 2]) -> Result<(), GpuError> {
        let end = |i: usize| offset[i].checked_add(extent[i]).and_then(|end| i32::try_from(end).ok());
        if end(0).is_none() || end(1).is_none() {
            return Err(GpuError::misuse("set_scissor", format!("{offset:?} + {extent:?} is too large")));
        }
        let scissor = vk::Rect2D {
            offset: vk::Offset2D { x: offset[0] as i32, y: offset[1] as i32 },
            extent: vk::Extent2D { width: extent[0], height: extent[1] },
        };
        // SAFETY: the rectangle was checked.
        unsafe { self.device().cmd_set_scissor(self.command_buffer, 0, &[scissor]) };
        Ok(())
    }
}

fn load_op<T>(load: Load<T>) -> vk::AttachmentLoadOp {
    match load {
        Load::Keep => vk::AttachmentLoadOp::LOAD,
        Load::Clear(_) => vk::AttachmentLoadOp::CLEAR,
        Load::Discard => vk::AttachmentLoadOp::DONT_CARE,
    }
}

fn clear_value<T>(load: Load<T>, otherwise: T) -> T {
    match load {
        Load::Clear(value) => value,
        Load::Keep | Load::Discard => otherwise,
    }
}

fn attachment(
    view: &ImageView,
    access: Access,
    load: vk::AttachmentLoadOp,
    store: bool,
    clear: vk::ClearValue,
) -> vk::RenderingAttachmentInfo<'static> {
    vk::RenderingAttachmentInfo::default()
        .image_view(view.raw())
        .image_layout(access.layout())
        .load_op(load)
        // Attachments are stored even when only read: what others see must not depend on how a driver discards.
        .store_op(if store { vk::AttachmentStoreOp::STORE } else { vk::AttachmentStoreOp::NONE })
        .clear_value(clear)
}
