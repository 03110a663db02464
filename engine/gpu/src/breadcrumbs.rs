//! Which step the device was at when it was lost, without an extension of any vendor.
//!
//! Before and after each labelled step the device writes a number into memory the CPU can read. A full barrier stands
//! before each write, so that a step's number says that all steps before it are done.

use crate::allocator::Location;
use crate::error::GpuError;
use crate::memory::{Buffer, BufferSlice, Label};
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

    /// The number to write before the next step of `frame`, which is called `name`; the one after it is the next.
    pub(crate) fn next(&self, frame: u64, name: &str) -> u32 {
        let mut trail = lock(&self.trails[self.slot(frame)]);
        trail.names.push(name.to_owned());
        2 * trail.names.len() as u32 - 1
    }

    /// Where the numbers of `frame` are written.
    pub(crate) fn word(&self, frame: u64) -> Result<BufferSlice, GpuError> {
        self.words.slice(4 * self.slot(frame) as u64, 4)
    }

    /// The newest frame's number, as a name.
    pub(crate) fn last(&self) -> Result<Option<PassReached>, GpuError> {
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
