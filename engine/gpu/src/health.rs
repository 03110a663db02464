//! Counts that shaders make while they work (values that are not finite, clamped, dropped), readable frames later.
//!
//! Off unless a host makes a [`Health`]: a pass that can count takes its buffer as one more binding, or is built without
//! it. Counts are sums of integers, so their order does not matter and the same frame gives the same counts.

use crate::allocator::Location;
use crate::context::Context;
use crate::error::GpuError;
use crate::memory::{Buffer, Label};
use crate::recorder::Recorder;
use airglow_graph::{Access, BufferDesc};
use ash::vk;

/// A set of named counters on the device and a ring of copies on the CPU.
pub struct Health {
    names: Vec<String>,
    counters: Buffer,
    /// One more than frames in flight: the oldest is always done when it is taken again.
    copies: Vec<Copy>,
    current: usize,
}

struct Copy {
    buffer: Buffer,
    /// The frame that was copied; `None` before the first.
    frame: Option<u64>,
}

/// Counts of one frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HealthCounts {
    /// The context's frame they belong to.
    pub frame: u64,
    /// Name and count of each counter, in the order they were named.
    pub counts: Vec<(String, u32)>,
}

impl Health {
    /// Counters called `names`, charged to owner `health`.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for no names, and those of making a buffer.
    pub fn new(context: &Context, names: &[&str]) -> Result<Self, GpuError> {
        if names.is_empty() {
            return Err(GpuError::misuse("health", "name at least one counter"));
        }
        let size = 4 * names.len() as u64;
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::TRANSFER_SRC
            | vk::BufferUsageFlags::TRANSFER_DST;
        let label = Label::new("health", "health counters");
        let counters = context.create_buffer(label, &BufferDesc { size, usage }, Location::Device)?;
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let copy = |_| {
            let buffer = context.create_buffer(label, &BufferDesc { size, usage }, Location::Readback)?;
            Ok(Copy { buffer, frame: None })
        };
        let copies = (0..=context.frames_in_flight()).map(copy).collect::<Result<_, GpuError>>()?;
        Ok(Self { names: names.iter().map(|&name| name.to_owned()).collect(), counters, copies, current: 0 })
    }

    /// The counters: a storage buffer of one `uint` each, to be bound by passes that add to them. Between
    /// [`Health::clear`] and [`Health::collect`] it is in use [`Access::ComputeStorageReadWrite`] and
    /// [`Access::FragmentStorageReadWrite`].
    pub fn buffer(&self) -> &Buffer {
        &self.counters
    }

    /// Sets the counters to 0, before the passes of a frame.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] within rendering or for another context's recorder.
    pub fn clear(&mut self, recorder: &mut Recorder<'_>) -> Result<(), GpuError> {
        recorder.memory_barrier(Access::TransferSource, Access::TransferDestination)?;
        recorder.fill(&self.counters, 0)?;
        recorder.memory_barrier(Access::TransferDestination, Access::ComputeStorageReadWrite)?;
        recorder.memory_barrier(Access::TransferDestination, Access::FragmentStorageReadWrite)
    }

    /// Copies the counters for the CPU, after the passes of a frame.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for a second call in one frame, within rendering or for another context's recorder.
    pub fn collect(&mut self, recorder: &mut Recorder<'_>) -> Result<(), GpuError> {
        let frame = recorder.context().frame();
        if self.copies[self.current].frame == Some(frame) {
            return Err(GpuError::misuse("health", "it is collected once a frame"));
        }
        let next = (self.current + 1) % self.copies.len();
        recorder.memory_barrier(Access::ComputeStorageReadWrite, Access::TransferSource)?;
        recorder.memory_barrier(Access::FragmentStorageReadWrite, Access::TransferSource)?;
        // The copy before this one in the same slot was read by the CPU only, frames ago.
        recorder.copy_buffer(&self.counters, &self.copies[next].buffer)?;
        recorder.memory_barrier(Access::TransferDestination, Access::HostRead)?;
        self.copies[next].frame = Some(frame);
        self.current = next;
        Ok(())
    }

    /// The counts of the newest frame that is done, without waiting; `None` before there is one.
    ///
    /// A frame counts as done when the frame `frames_in_flight` later has begun.
    ///
    /// # Errors
    /// None in practice: the copies are mapped.
    pub fn latest(&self, context: &Context) -> Result<Option<HealthCounts>, GpuError> {
        let done = |frame: u64| frame + u64::from(context.frames_in_flight()) <= context.frame();
        let finished = self.copies.iter().filter_map(|copy| Some((copy.frame.filter(|&f| done(f))?, copy)));
        let Some((frame, copy)) = finished.max_by_key(|(frame, _)| *frame) else { return Ok(None) };
        let values = copy.buffer.read::<u32>(0, self.names.len())?;
        Ok(Some(HealthCounts { frame, counts: self.names.iter().cloned().zip(values).collect() }))
    }
}
