//! Writing breadcrumbs, each between two full barriers.

use super::Recorder;
use crate::breadcrumbs::Breadcrumbs;
use crate::error::GpuError;
use ash::vk;

impl Recorder<'_> {
    /// Writes the number of a new step called `name`; the result is the number to write after it.
    pub(super) fn begin_crumb(&mut self, name: &str) -> Result<Option<u32>, GpuError> {
        let Some(crumbs) = &self.context().breadcrumbs else { return Ok(None) };
        if self.outside_rendering("a breadcrumb").is_err() {
            return Ok(None);
        }
        let number = crumbs.next(self.context().frame(), name);
        self.write_crumb(crumbs, number)?;
        Ok(Some(number + 1))
    }

    /// Writes the number that [`Recorder::begin_crumb`] returned.
    pub(super) fn end_crumb(&mut self, number: Option<u32>) -> Result<(), GpuError> {
        match (&self.context().breadcrumbs, number) {
            (Some(crumbs), Some(number)) if self.outside_rendering("a breadcrumb").is_ok() => {
                self.write_crumb(crumbs, number)
            }
            _ => Ok(()),
        }
    }

    fn write_crumb(&mut self, crumbs: &Breadcrumbs, number: u32) -> Result<(), GpuError> {
        self.full_barrier();
        self.fill(&crumbs.word(self.context().frame())?, number)?;
        self.full_barrier();
        Ok(())
    }

    /// Everything before is done, and visible to everything after and to the CPU.
    fn full_barrier(&mut self) {
        let barriers = [vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS | vk::PipelineStageFlags2::HOST)
            .dst_access_mask(
                vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE | vk::AccessFlags2::HOST_READ,
            )];
        let info = vk::DependencyInfo::default().memory_barriers(&barriers);
        // SAFETY: a recording command buffer outside rendering.
        unsafe { self.context().device().cmd_pipeline_barrier2(self.command_buffer(), &info) };
    }
}
