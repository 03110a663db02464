//! Device time of every pass, and on request what the device counted of it, from queries in a ring that never stalls.
//!
//! A frame's queries are read once the host has begun the frame that makes it known to be done; nothing waits. A
//! pass is timed from when all that was recorded before it is done to when its own work is done, its barriers
//! included.

mod frame;
mod statistics;

pub use frame::{FrameTimes, PassTime, TimingSummary};
pub use statistics::PassStatistics;

use crate::clock::{Clock, mask};
use crate::context::Context;
use crate::error::GpuError;
use crate::retire::Retired;
use crate::shared::Shared;
use ash::vk;
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Instant;

/// The ring of queries.
pub struct Timing {
    shared: Arc<Shared>,
    slots: Vec<Slot>,
    /// The slot being recorded.
    current: usize,
    most_passes: usize,
    names: Vec<String>,
    warm_up: usize,
    keep: usize,
    history: VecDeque<FrameTimes>,
    /// Scratch: value and availability of each timestamp.
    results: Vec<[u64; 2]>,
    /// Scratch: the statistics of each pass, where asked for.
    counted: Vec<statistics::Raw>,
}

struct Slot {
    pool: vk::QueryPool,
    /// Pipeline statistics, where asked for.
    statistics: Option<vk::QueryPool>,
    /// The frame whose queries are pending, and its number of passes.
    pending: Option<(u64, usize)>,
    /// When the CPU began and ended to record each pass.
    recorded: Vec<[Instant; 2]>,
}

impl Timing {
    /// A ring for plans of up to `most_passes` passes. The first `warm_up` frames are measured and thrown away
    /// (drivers compile at first use); of the rest the newest `keep` are kept.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if the queue family has no timestamps, [`GpuError::Vulkan`] if the device refuses.
    pub fn new(context: &Context, most_passes: u32, warm_up: usize, keep: usize) -> Result<Self, GpuError> {
        let shared = &context.shared;
        if shared.facts.timestamp_valid_bits == 0 {
            return Err(GpuError::misuse(
                "timing",
                "the queue family has no timestamps; record without timing",
            ));
        }
        let mut timing = Self {
            shared: Arc::clone(shared),
            slots: Vec::new(),
            current: 0,
            most_passes: most_passes as usize,
            names: Vec::new(),
            warm_up,
            keep: keep.max(1),
            history: VecDeque::new(),
            results: vec![[0; 2]; 2 * most_passes as usize],
            counted: Vec::new(),
        };
        let info = vk::QueryPoolCreateInfo::default()
            .query_type(vk::QueryType::TIMESTAMP)
            .query_count(2 * most_passes.max(1));
        // One slot more than frames in flight: the oldest is always done when it is taken again.
        for _ in 0..=context.frames_in_flight() {
            // SAFETY: a live device and a complete description.
            let pool = unsafe { shared.device().create_query_pool(&info, None) }
                .map_err(GpuError::vulkan("vkCreateQueryPool"))?;
            let recorded = Vec::with_capacity(most_passes as usize);
            timing.slots.push(Slot { pool, statistics: None, pending: None, recorded });
        }
        Ok(timing)
    }

    /// Has the device count what each pass makes it do, too. Its work may take longer for it.
    ///
    /// # Errors
    /// [`GpuError::Missing`] where the host did not enable `pipelineStatisticsQuery`, [`GpuError::Vulkan`] if the device
    /// refuses.
    pub fn with_pipeline_statistics(mut self) -> Result<Self, GpuError> {
        for slot in self.slots.iter_mut().filter(|slot| slot.statistics.is_none()) {
            slot.statistics = Some(statistics::pool(&self.shared, self.most_passes as u32)?);
        }
        self.counted = vec![Default::default(); self.most_passes];
        Ok(self)
    }

    /// Takes the next slot, reading what it holds first. `names` are the passes; other names than before start over.
    pub(crate) fn begin_frame<'n>(
        &mut self,
        context: &Context,
        command_buffer: vk::CommandBuffer,
        names: impl ExactSizeIterator<Item = &'n str> + Clone,
    ) -> Result<(), GpuError> {
        if !Arc::ptr_eq(&context.shared, &self.shared) {
            return Err(GpuError::misuse("timing", "it was made by another context"));
        }
        if names.len() > self.most_passes {
            let problem = format!("{} passes; it was made for {}", names.len(), self.most_passes);
            return Err(GpuError::misuse("timing", problem));
        }
        let frame = context.frame();
        if self.slots[self.current].pending.is_some_and(|(pending, _)| pending == frame) {
            return Err(GpuError::misuse(
                "timing",
                "it measures one recording per frame; use another for a second",
            ));
        }
        self.collect()?;
        let passes = names.len();
        if !self.names.iter().map(String::as_str).eq(names.clone()) {
            self.names = names.map(str::to_owned).collect();
            self.history.clear();
            self.slots.iter_mut().for_each(|slot| slot.pending = None);
        }
        self.current = (self.current + 1) % self.slots.len();
        let slot = &mut self.slots[self.current];
        slot.pending = Some((frame, passes));
        slot.recorded.clear();
        if passes > 0 {
            let device = self.shared.device();
            // SAFETY: a recording command buffer outside rendering; the slot's last frame is done (see `new`).
            unsafe {
                device.cmd_reset_query_pool(command_buffer, slot.pool, 0, 2 * passes as u32);
                if let Some(pool) = slot.statistics {
                    device.cmd_reset_query_pool(command_buffer, pool, 0, passes as u32);
                }
            }
        }
        Ok(())
    }

    /// Before the pass's barriers: what was recorded earlier is done when the device writes it.
    pub(crate) fn begin_pass(&mut self, command_buffer: vk::CommandBuffer, pass: usize) {
        let now = Instant::now();
        self.slots[self.current].recorded.push([now, now]);
        self.write(command_buffer, vk::PipelineStageFlags2::ALL_COMMANDS, 2 * pass);
        let device = self.shared.device();
        // Depends on nothing, so a GPU does nothing. lavapipe keeps timestamps with its draws and runs dispatches at
        // once: without this it would write the begin of a dispatch after its end.
        let nothing = vk::DependencyInfo::default();
        // SAFETY: a recording command buffer outside rendering.
        unsafe { device.cmd_pipeline_barrier2(command_buffer, &nothing) };
        if let Some(pool) = self.slots[self.current].statistics {
            let flags = vk::QueryControlFlags::empty();
            // SAFETY: as above; the query was reset in the same command buffer, and `end_pass` ends it outside rendering.
            unsafe { device.cmd_begin_query(command_buffer, pool, pass as u32, flags) };
        }
    }

    /// After the pass, outside rendering.
    pub(crate) fn end_pass(&mut self, command_buffer: vk::CommandBuffer, pass: usize) {
        if let Some(pool) = self.slots[self.current].statistics {
            // SAFETY: `begin_pass` began it, outside rendering too.
            unsafe { self.shared.device().cmd_end_query(command_buffer, pool, pass as u32) };
        }
        self.write(command_buffer, vk::PipelineStageFlags2::ALL_COMMANDS, 2 * pass + 1);
        if let Some([_, end]) = self.slots[self.current].recorded.last_mut() {
            *end = Instant::now();
        }
    }

    fn write(&self, command_buffer: vk::CommandBuffer, stage: vk::PipelineStageFlags2, query: usize) {
        let pool = self.slots[self.current].pool;
        // SAFETY: called by `Execution::record` only, after the query was reset in the same command buffer.
        unsafe { self.shared.device().cmd_write_timestamp2(command_buffer, stage, pool, query as u32) };
    }

    /// Reads every frame that is done, without waiting, and returns the newest one kept so far.
    ///
    /// A frame counts as done when the frame `frames_in_flight` later has begun. (Availability alone would not do: until
    /// the device reaches the reset, a query still offers what an older frame wrote.)
    ///
    /// # Errors
    /// [`GpuError::Vulkan`] when the device is lost.
    pub fn collect(&mut self) -> Result<Option<&FrameTimes>, GpuError> {
        // From the oldest slot to the newest.
        for i in 1..=self.slots.len() {
            let index = (self.current + i) % self.slots.len();
            let Some((frame, passes)) = self.slots[index].pending else { continue };
            if frame + self.shared.facts.frames_in_flight > self.shared.frame() {
                continue;
            }
            if self.read(index, passes)? {
                self.slots[index].pending = None;
                self.keep_frame(index, frame, passes);
            }
        }
        Ok(self.history.back())
    }

    /// Reads a slot into `results` and `counted`; false if some of it is not there yet.
    fn read(&mut self, slot: usize, passes: usize) -> Result<bool, GpuError> {
        let slot = &self.slots[slot];
        let times = &mut self.results[..2 * passes];
        if !read(&self.shared, slot.pool, times)? || times.iter().any(|[_, available]| *available == 0) {
            return Ok(false);
        }
        let Some(pool) = slot.statistics else { return Ok(true) };
        let counted = &mut self.counted[..passes];
        Ok(read(&self.shared, pool, counted)? && counted.iter().all(|[.., available]| *available != 0))
    }

    fn keep_frame(&mut self, slot: usize, frame: u64, passes: usize) {
        if self.warm_up > 0 {
            self.warm_up -= 1;
            return;
        }
        let reused = if self.history.len() == self.keep { self.history.pop_front() } else { None };
        let mut times = reused.unwrap_or_default();
        times.frame = frame;
        let clock = Clock {
            mask: mask(self.shared.facts.timestamp_valid_bits),
            period: f64::from(self.shared.facts.limits.timestamp_period) * 1e-9,
        };
        times.fill(&clock, &self.results[..2 * passes]);
        times.recorded.clear();
        times.recorded.extend_from_slice(&self.slots[slot].recorded);
        times.statistics.clear();
        let counted = self.counted.iter().take(passes);
        times.statistics.extend(counted.map(|raw| PassStatistics::of(*raw)));
        self.history.push_back(times);
    }

    /// The frames kept, oldest first.
    pub fn frames(&self) -> impl Iterator<Item = &FrameTimes> {
        self.history.iter()
    }

    /// Names of the passes, in the order of [`FrameTimes::passes`].
    pub fn passes(&self) -> &[String] {
        &self.names
    }

    /// Medians over the frames kept, or `None` when there are none yet.
    pub fn summary(&self) -> Option<TimingSummary> {
        TimingSummary::of(&self.names, &self.history)
    }
}

/// Reads queries from the first on, without waiting; false if none is there yet.
fn read<T>(shared: &Shared, pool: vk::QueryPool, results: &mut [T]) -> Result<bool, GpuError> {
    if results.is_empty() {
        return Ok(true);
    }
    let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WITH_AVAILABILITY;
    // SAFETY: the pool has that many queries, and each result is as many 64-bit words as its kind of query returns.
    match unsafe { shared.device().get_query_pool_results(pool, 0, results, flags) } {
        Ok(()) => Ok(true),
        Err(vk::Result::NOT_READY) => Ok(false),
        Err(result) => Err(GpuError::Vulkan { call: "vkGetQueryPoolResults", result }),
    }
}

impl Drop for Timing {
    fn drop(&mut self) {
        let pools = self.slots.iter().flat_map(|slot| slot.statistics.into_iter().chain([slot.pool]));
        pools.for_each(|pool| self.shared.retire(Retired::QueryPool(pool)));
    }
}
