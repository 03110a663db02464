//! Which step the device was at when it was lost, without an extension of any vendor.
//!
//! Before and after each labelled step the device writes a number into memory the CPU can read. A full barrier stands
//! before each write, so that a step's number says that all steps before it are done.

use crate::allocator::Location;
use crate::context::Context;
use crate::error::GpuError;
use crate::memory::{Buffer, Label};
use crate::recorder::Recorder;
use crate::shared::{Shared, lock};
use airglow_graph::BufferDesc;
use ash::vk;
use std::sync::{Arc, Mutex};

/// How far the device came.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PassReached {
    /// The context's frame.
    pub frame: u64,
    /// The last step that was begun; all before it are done.
    pub pass: String,
    /// Whether that step was done too.
    pub finished: bool,
}

/// One word and one list of names for each frame in flight.
pub(crate) struct Breadcrumbs {
    words: Buffer,
    trails: Vec<Mutex<Trail>>,
}

#[derive(Default)]
struct Trail {
    frame: u64,
    /// Names of the steps recorded, in order; word 2 i + 1 is written before step i, 2 i + 2 after it.
    names: Vec<String>,
}

impl Breadcrumbs {
    pub(crate) fn new(shared: &Arc<Shared>, slots: usize) -> Result<Self, GpuError> {
        let desc = BufferDesc { size: 4 * slots as u64, usage: vk::BufferUsageFlags::TRANSFER_DST };
        let label = Label::new("airglow", "breadcrumbs");
        let words = Buffer::new(shared, label, &desc, Location::Readback)?;
        words.write(0, &vec![0u32; slots])?;
        Ok(Self { words, trails: (0..slots).map(|_| Mutex::default()).collect() })
    }

    fn slot(&self, frame: u64) -> usize {
        (frame % self.trails.len() as u64) as usize
    }

    /// Gives `frame` its slot, and clears all slots whose frames are done.
    pub(crate) fn begin_frame(&self, frame: u64) -> Result<(), GpuError> {
        let next = self.slot(frame);
        for (slot, trail) in self.trails.iter().enumerate() {
            let mut trail = lock(trail);
            if trail.frame + self.trails.len() as u64 <= frame {
                trail.names.clear();
                self.words.write(4 * slot as u64, &[0u32])?;
            }
            if slot == next {
                trail.frame = frame;
            }
        }
        Ok(())
    }

    /// The newest frame's number, as a name.
    fn last(&self) -> Result<Option<PassReached>, GpuError> {
        let words = self.words.read::<u32>(0, self.trails.len())?;
        let reached = words.iter().zip(&self.trails).filter_map(|(&word, trail)| {
            let trail = lock(trail);
            let step = word.checked_sub(1)? as usize;
            let pass = trail.names.get(step / 2)?.clone();
            Some(PassReached { frame: trail.frame, pass, finished: step % 2 == 1 })
        });
        Ok(reached.max_by_key(|reached| reached.frame))
    }
}

impl Context {
    /// The last step the device reached, by the breadcrumbs it wrote: for after a loss. `None` without
    /// [`Options::breadcrumbs`](crate::Options::breadcrumbs), or when no step of the frames in flight was begun.
    ///
    /// # Errors
    /// None in practice: the breadcrumbs are mapped.
    pub fn last_pass_reached(&self) -> Result<Option<PassReached>, GpuError> {
        self.breadcrumbs.as_ref().map_or(Ok(None), Breadcrumbs::last)
    }
}

impl Recorder<'_> {
    /// Writes the number of a new step called `name`; the result is the number to write after it.
    pub(crate) fn begin_crumb(&mut self, name: &str) -> Result<Option<u32>, GpuError> {
        let Some(crumbs) = &self.context().breadcrumbs else { return Ok(None) };
        if self.outside_rendering("a breadcrumb").is_err() {
            return Ok(None);
        }
        let number = {
            let mut trail = lock(&crumbs.trails[crumbs.slot(self.context().frame())]);
            trail.names.push(name.to_owned());
            2 * trail.names.len() as u32 - 1
        };
        self.write_crumb(crumbs, number)?;
        Ok(Some(number + 1))
    }

    /// Writes the number that [`Recorder::begin_crumb`] returned.
    pub(crate) fn end_crumb(&mut self, number: Option<u32>) -> Result<(), GpuError> {
        match (&self.context().breadcrumbs, number) {
            (Some(crumbs), Some(number)) if self.outside_rendering("a breadcrumb").is_ok() => {
                self.write_crumb(crumbs, number)
            }
            _ => Ok(()),
        }
    }

    fn write_crumb(&mut self, crumbs: &Breadcrumbs, number: u32) -> Result<(), GpuError> {
        self.full_barrier();
        let slot = crumbs.slot(self.context().frame());
        self.fill(&crumbs.words.slice(4 * slot as u64, 4)?, number)?;
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
