//! Draws, and what they depend on.

use super::{Bound, Recorder};
use crate::error::GpuError;
use crate::feature::Feature;
use crate::memory::BufferSlice;
use crate::pipeline::{GraphicsPipeline, MAX_COLORS, MAX_VERTEX_BUFFERS};
use ash::vk;
use std::ops::Range;

/// What draws depend on.
#[derive(Default)]
pub(super) struct DrawState {
    pub(super) rendering: Option<Attachments>,
    /// Bytes bound by slot.
    vertex_bytes: [Option<u64>; MAX_VERTEX_BUFFERS],
    /// Indices bound.
    indices: Option<u64>,
}

/// Formats of the attachments rendered to.
pub(super) struct Attachments {
    pub colors: [vk::Format; MAX_COLORS],
    pub count: usize,
    /// Format, and whether it is written.
    pub depth: Option<(vk::Format, bool)>,
}

impl DrawState {
    pub(super) fn is_rendering(&self) -> bool {
        self.rendering.is_some()
    }
}

impl Recorder<'_> {
    /// Binds a vertex buffer to a slot.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for a slot out of range or a buffer without `VERTEX_BUFFER`.
    pub fn bind_vertex_buffer(&mut self, slot: u32, buffer: impl Into<BufferSlice>) -> Result<(), GpuError> {
        let slice = buffer.into();
        self.check_buffer(&slice, vk::BufferUsageFlags::VERTEX_BUFFER)?;
        let Some(bytes) = self.draw.vertex_bytes.get_mut(slot as usize) else {
            return Err(GpuError::misuse(
                slice.buffer.name(),
                format!("there are {MAX_VERTEX_BUFFERS} slots"),
            ));
        };
        *bytes = Some(slice.size);
        // SAFETY: a live buffer with the right usage, an offset within it.
        unsafe {
            let (buffers, offsets) = ([slice.buffer.raw()], [slice.offset]);
            self.device().cmd_bind_vertex_buffers(self.command_buffer, slot, &buffers, &offsets);
        }
        self.counts.bound_bytes += slice.size;
        Ok(())
    }

    /// Binds 32-bit indices.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for a buffer without `INDEX_BUFFER` or an offset that is no multiple of 4.
    pub fn bind_index_buffer(&mut self, buffer: impl Into<BufferSlice>) -> Result<(), GpuError> {
        let slice = buffer.into();
        self.check_buffer(&slice, vk::BufferUsageFlags::INDEX_BUFFER)?;
        if !slice.offset.is_multiple_of(4) {
            return Err(GpuError::misuse(slice.buffer.name(), "indices start at a multiple of 4 bytes"));
        }
        self.draw.indices = Some(slice.size / 4);
        let kind = vk::IndexType::UINT32;
        // SAFETY: a live buffer with the right usage, an aligned offset within it.
        unsafe {
            self.device().cmd_bind_index_buffer(self.command_buffer, slice.buffer.raw(), slice.offset, kind);
        }
        self.counts.bound_bytes += slice.size;
        Ok(())
    }

    /// Draws vertices in order.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if no graphics pipeline is bound and complete, its attachments are not those rendered to,
    /// or a vertex buffer is missing or too small.
    pub fn draw(&mut self, vertices: Range<u32>, instances: Range<u32>) -> Result<(), GpuError> {
        self.ready_to_draw("draw", Some(vertices.end), Some(instances.end))?;
        let (count, instance_count) = (vertices.len() as u32, instances.len() as u32);
        // SAFETY: everything the draw reads is bound and large enough.
        unsafe {
            self.device().cmd_draw(
                self.command_buffer,
                count,
                instance_count,
                vertices.start,
                instances.start,
            );
        }
        self.count_draw(count, instance_count);
        Ok(())
    }

    /// Draws vertices by index. The indices themselves are not checked.
    ///
    /// # Errors
    /// As [`Recorder::draw`], and if the index buffer is missing or too small.
    pub fn draw_indexed(
        &mut self,
        indices: Range<u32>,
        vertex_offset: i32,
        instances: Range<u32>,
    ) -> Result<(), GpuError> {
        self.ready_to_draw("draw_indexed", None, Some(instances.end))?;
        self.check_indices(u64::from(indices.end))?;
        let (count, instance_count) = (indices.len() as u32, instances.len() as u32);
        let (first, instance) = (indices.start, instances.start);
        // SAFETY: as for `draw`; what the indices point at is the caller's, as the module says.
        unsafe {
            self.device().cmd_draw_indexed(
                self.command_buffer,
                count,
                instance_count,
                first,
                vertex_offset,
                instance,
            );
        }
        self.count_draw(count, instance_count);
        Ok(())
    }

    /// Draws `count` times with the `VkDrawIndirectCommand`s packed in `arguments`, which nobody checks.
    ///
    /// # Errors
    /// As [`Recorder::draw`], and if the arguments do not fit; more than one needs `multiDrawIndirect`.
    pub fn draw_indirect(&mut self, arguments: impl Into<BufferSlice>, count: u32) -> Result<(), GpuError> {
        const STRIDE: u32 = size_of::<vk::DrawIndirectCommand>() as u32;
        let slice = arguments.into();
        self.ready_to_draw("draw_indirect", None, None)?;
        self.check_draw_arguments(&slice, count, STRIDE)?;
        let (buffer, offset) = (slice.buffer.raw(), slice.offset);
        // SAFETY: the arguments lie in a live buffer; what they say is the caller's, as the module says.
        unsafe { self.device().cmd_draw_indirect(self.command_buffer, buffer, offset, count, STRIDE) };
        self.counts.draws += u64::from(count);
        Ok(())
    }

    /// Draws `count` times with the `VkDrawIndexedIndirectCommand`s packed in `arguments`, which nobody checks.
    ///
    /// # Errors
    /// As [`Recorder::draw_indexed`], and if the arguments do not fit; more than one needs `multiDrawIndirect`.
    pub fn draw_indexed_indirect(
        &mut self,
        arguments: impl Into<BufferSlice>,
        count: u32,
    ) -> Result<(), GpuError> {
        const STRIDE: u32 = size_of::<vk::DrawIndexedIndirectCommand>() as u32;
        let slice = arguments.into();
        self.ready_to_draw("draw_indexed_indirect", None, None)?;
        self.check_indices(0)?;
        self.check_draw_arguments(&slice, count, STRIDE)?;
        let (buffer, offset) = (slice.buffer.raw(), slice.offset);
        // SAFETY: as for `draw_indirect`.
        unsafe {
            self.device().cmd_draw_indexed_indirect(self.command_buffer, buffer, offset, count, STRIDE)
        };
        self.counts.draws += u64::from(count);
        Ok(())
    }

    fn count_draw(&mut self, vertices: u32, instances: u32) {
        self.counts.draws += 1;
        self.counts.vertices += u64::from(vertices) * u64::from(instances);
    }

    fn check_indices(&self, end: u64) -> Result<(), GpuError> {
        match self.draw.indices {
            Some(bound) if end <= bound => Ok(()),
            Some(bound) => Err(GpuError::misuse("draw_indexed", format!("index {end} of {bound} bound"))),
            None => Err(GpuError::misuse("draw_indexed", "bind an index buffer first")),
        }
    }

    fn check_draw_arguments(&self, slice: &BufferSlice, count: u32, stride: u32) -> Result<(), GpuError> {
        self.check_arguments(slice, u64::from(count) * u64::from(stride))?;
        let most = match self.context.features().contains(Feature::MultiDrawIndirect) {
            true => self.context.limits().max_draw_indirect_count,
            false => 1,
        };
        if count > most {
            return Err(GpuError::misuse(
                slice.buffer.name(),
                format!("{count} draws in one call; {most} are allowed"),
            ));
        }
        Ok(())
    }

    /// Checks pipeline, attachments and vertex buffers for vertices and instances below the given ends.
    fn ready_to_draw(
        &self,
        call: &'static str,
        vertices: Option<u32>,
        instances: Option<u32>,
    ) -> Result<(), GpuError> {
        let Bound::Graphics(pipeline) = self.ready(call)? else {
            return Err(GpuError::misuse(call, "bind a graphics pipeline, not a compute pipeline"));
        };
        let Some(attachments) = &self.draw.rendering else {
            return Err(GpuError::misuse(call, "begin rendering first"));
        };
        attachments.check(pipeline)?;
        for (slot, &(stride, rate)) in pipeline.0.vertex_buffers.iter().enumerate() {
            let Some(bytes) = self.draw.vertex_bytes[slot] else {
                return Err(GpuError::misuse(pipeline.name(), format!("vertex buffer {slot} is not bound")));
            };
            let end = if rate == vk::VertexInputRate::VERTEX { vertices } else { instances };
            if end.is_some_and(|end| u64::from(end) * u64::from(stride) > bytes) {
                let problem =
                    format!("vertex buffer {slot} has {bytes} bytes, too few for {end:?} of {stride}");
                return Err(GpuError::misuse(pipeline.name(), problem));
            }
        }
        Ok(())
    }
}

impl Attachments {
    /// The pipeline was made for these attachments.
    fn check(&self, pipeline: &GraphicsPipeline) -> Result<(), GpuError> {
        let colors = &self.colors[..self.count];
        let stated = &pipeline.0;
        let depth = self.depth.map(|(format, _)| format);
        if stated.colors != colors || stated.depth.map(|depth| depth.format) != depth {
            let made = (&stated.colors, stated.depth.map(|depth| depth.format));
            let problem = format!("made for {made:?}, but rendering to {:?}", (colors, depth));
            return Err(GpuError::misuse(pipeline.name(), problem));
        }
        let writes = stated.depth.is_some_and(|depth| depth.write);
        if writes && self.depth.is_some_and(|(_, write)| !write) {
            return Err(GpuError::misuse(pipeline.name(), "writes depth, but the attachment is read only"));
        }
        Ok(())
    }
}
