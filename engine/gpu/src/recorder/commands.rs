//! Dispatches, barriers within a pass, and labels.

use super::{Bound, Recorder};
use crate::error::GpuError;
use crate::functions::with_c_string;
use crate::memory::{BufferSlice, Image};
use airglow_graph::{Access, State};
use ash::vk;

/// Bytes of `VkDispatchIndirectCommand`.
const DISPATCH_ARGUMENTS: u64 = 12;

impl Recorder<'_> {
    /// Dispatches `groups` workgroups in x, y and z. Zero in any of them does nothing.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if no compute pipeline is bound and complete, within rendering, or over
    /// `maxComputeWorkGroupCount`.
    pub fn dispatch(&mut self, groups: [u32; 3]) -> Result<(), GpuError> {
        let size = self.ready_to_dispatch("dispatch")?;
        let most = self.context.limits().max_compute_work_group_count;
        if groups.iter().zip(most).any(|(&groups, most)| groups > most) {
            let problem = format!("{groups:?} workgroups; maxComputeWorkGroupCount is {most:?}");
            return Err(GpuError::misuse("dispatch", problem));
        }
        // SAFETY: a compute pipeline with its sets and constants is bound; the counts are within the limits.
        unsafe { self.device().cmd_dispatch(self.command_buffer, groups[0], groups[1], groups[2]) };
        self.counts.dispatches += 1;
        self.counts.invocations += groups.iter().fold(size, |all, &side| all * u64::from(side));
        Ok(())
    }

    /// Dispatches as many workgroups as the three `u32` at the start of `arguments` say.
    ///
    /// They must be within `maxComputeWorkGroupCount`; nobody checks.
    ///
    /// # Errors
    /// As [`Recorder::dispatch`], and if the arguments do not fit or the buffer lacks `INDIRECT_BUFFER`.
    pub fn dispatch_indirect(&mut self, arguments: impl Into<BufferSlice>) -> Result<(), GpuError> {
        let arguments = arguments.into();
        self.ready_to_dispatch("dispatch_indirect")?;
        self.check_arguments(&arguments, DISPATCH_ARGUMENTS)?;
        // SAFETY: as for `dispatch`; the arguments lie in a live buffer, aligned and of the right usage.
        unsafe {
            self.device().cmd_dispatch_indirect(
                self.command_buffer,
                arguments.buffer.raw(),
                arguments.offset,
            );
        }
        self.counts.dispatches += 1;
        Ok(())
    }

    /// Invocations of a workgroup of the pipeline bound.
    fn ready_to_dispatch(&self, call: &'static str) -> Result<u64, GpuError> {
        self.outside_rendering(call)?;
        match self.ready(call)? {
            Bound::Compute(pipeline) => Ok(pipeline.workgroup_invocations()),
            Bound::Graphics(_) => {
                Err(GpuError::misuse(call, "bind a compute pipeline, not a graphics pipeline"))
            }
        }
    }

    /// A buffer of this context that has `usage`.
    pub(super) fn check_buffer(
        &self,
        slice: &BufferSlice,
        usage: vk::BufferUsageFlags,
    ) -> Result<(), GpuError> {
        let buffer = &slice.buffer;
        if !buffer.belongs_to(&self.context.shared) {
            return Err(GpuError::misuse(buffer.name(), "the buffer was made by another context"));
        }
        if !buffer.desc().usage.contains(usage) {
            return Err(GpuError::misuse(buffer.name(), format!("the buffer was made without {usage:?}")));
        }
        Ok(())
    }

    /// Indirect arguments of `size` bytes.
    pub(super) fn check_arguments(&self, slice: &BufferSlice, size: u64) -> Result<(), GpuError> {
        self.check_buffer(slice, vk::BufferUsageFlags::INDIRECT_BUFFER)?;
        if slice.size < size || !slice.offset.is_multiple_of(4) {
            let problem =
                format!("{size} bytes of arguments at a multiple of 4 do not fit in {}", slice.size);
            return Err(GpuError::misuse(slice.buffer.name(), problem));
        }
        Ok(())
    }

    /// Makes every write of use `before` visible to use `after`, for all buffers: for steps within one pass.
    /// Between passes the plan does this.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] within rendering.
    pub fn memory_barrier(&mut self, before: Access, after: Access) -> Result<(), GpuError> {
        self.outside_rendering("memory_barrier")?;
        let barriers = [vk::MemoryBarrier2::default()
            .src_stage_mask(before.stage())
            .src_access_mask(before.access())
            .dst_stage_mask(after.stage())
            .dst_access_mask(after.access())];
        let info = vk::DependencyInfo::default().memory_barriers(&barriers);
        // SAFETY: a recording command buffer outside rendering.
        unsafe { self.device().cmd_pipeline_barrier2(self.command_buffer, &info) };
        self.counts.barriers += 1;
        Ok(())
    }

    /// Takes all of `image` from one state to the next: for images outside a plan, and steps within one pass.
    ///
    /// `before` must be true, or the contents are lost.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] within rendering or for an image of another context.
    pub fn transition(
        &mut self,
        image: &Image,
        before: impl Into<State>,
        after: impl Into<State>,
    ) -> Result<(), GpuError> {
        self.outside_rendering("transition")?;
        if !image.belongs_to(&self.context.shared) {
            return Err(GpuError::misuse(image.name(), "the image was made by another context"));
        }
        let (before, after) = (before.into(), after.into());
        let barriers = [vk::ImageMemoryBarrier2::default()
            .src_stage_mask(before.stage)
            .src_access_mask(before.access)
            .dst_stage_mask(after.stage)
            .dst_access_mask(after.access)
            .old_layout(before.layout)
            .new_layout(after.layout)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(image.raw())
            .subresource_range(vk::ImageSubresourceRange {
                aspect_mask: image.desc().aspects(),
                base_mip_level: 0,
                level_count: vk::REMAINING_MIP_LEVELS,
                base_array_layer: 0,
                layer_count: vk::REMAINING_ARRAY_LAYERS,
            })];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barriers);
        // SAFETY: a recording command buffer outside rendering and a live image of this device.
        unsafe { self.device().cmd_pipeline_barrier2(self.command_buffer, &info) };
        self.counts.barriers += 1;
        Ok(())
    }

    /// Records `commands` under a label that captures show, between breadcrumbs where the host asked for them; nothing
    /// but the commands without VK_EXT_debug_utils.
    ///
    /// # Errors
    /// Those of `commands`.
    pub fn labelled<R>(
        &mut self,
        name: &str,
        commands: impl FnOnce(&mut Self) -> Result<R, GpuError>,
    ) -> Result<R, GpuError> {
        let crumb = self.begin_crumb(name)?;
        self.begin_label(name);
        let result = commands(self);
        self.end_label();
        let result = result?;
        self.end_crumb(crumb)?;
        Ok(result)
    }

    fn begin_label(&self, name: &str) {
        let Some(debug) = &self.context.shared.functions.debug else { return };
        with_c_string(name, |text| {
            let label = vk::DebugUtilsLabelEXT { p_label_name: text, ..Default::default() };
            // SAFETY: the extension is enabled, its functions were probed, the text outlives the call.
            unsafe { (debug.cmd_begin_debug_utils_label_ext)(self.command_buffer, &label) };
        });
    }

    fn end_label(&self) {
        let Some(debug) = &self.context.shared.functions.debug else { return };
        // SAFETY: as in `begin_label`; one label was begun.
        unsafe { (debug.cmd_end_debug_utils_label_ext)(self.command_buffer) };
    }
}
