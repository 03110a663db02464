//! Device time of every pass, from timestamps in a ring that never stalls.
//!
//! A frame's timestamps are read once the host has begun the frame that makes it known to be done; nothing waits. A
//! pass is timed from when all that was recorded before it is done to when its own work is done, its barriers
//! included.

use crate::clock::{Clock, mask, median, quantile};
use crate::context::Context;
use crate::error::GpuError;
use crate::retire::Retired;
use crate::shared::Shared;
use ash::vk;
use std::collections::VecDeque;
use std::sync::Arc;

/// Device times of one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameTimes {
    /// The context's frame they belong to.
    pub frame: u64,
    /// Seconds of each pass, in the plan's order.
    pub passes: Vec<f64>,
    /// Seconds from the start of the first pass to the end of the last to finish.
    pub span: f64,
    /// Seconds of all passes added up.
    pub sum: f64,
}

/// Median device time of a pass.
#[derive(Clone, Debug, PartialEq)]
pub struct PassTime {
    /// The pass's name.
    pub name: String,
    /// Median over the frames kept, in seconds.
    pub median: f64,
    /// 5th percentile, in seconds.
    pub p5: f64,
    /// 95th percentile, in seconds.
    pub p95: f64,
}

/// Medians over the frames kept, in seconds.
#[derive(Clone, Debug, PartialEq)]
pub struct TimingSummary {
    /// How many frames were kept; warm-up is not among them.
    pub frames: usize,
    /// Each pass, in the plan's order.
    pub passes: Vec<PassTime>,
    /// Median span.
    pub span: f64,
    /// Median sum.
    pub sum: f64,
}

/// The ring of timestamps.
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
    /// Scratch: value and availability of each query.
    results: Vec<[u64; 2]>,
}

struct Slot {
    pool: vk::QueryPool,
    /// The frame whose timestamps are pending, and its number of passes.
    pending: Option<(u64, usize)>,
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
        };
        let info = vk::QueryPoolCreateInfo::default()
            .query_type(vk::QueryType::TIMESTAMP)
            .query_count(2 * most_passes.max(1));
        // One slot more than frames in flight: the oldest is always done when it is taken again.
        for _ in 0..=context.frames_in_flight() {
            // SAFETY: a live device and a complete description.
            let pool = unsafe { shared.device().create_query_pool(&info, None) }
                .map_err(GpuError::vulkan("vkCreateQueryPool"))?;
            timing.slots.push(Slot { pool, pending: None });
        }
        Ok(timing)
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
        if passes > 0 {
            // SAFETY: a recording command buffer outside rendering; the slot's last frame is done (see `new`).
            unsafe {
                self.shared.device().cmd_reset_query_pool(command_buffer, slot.pool, 0, 2 * passes as u32)
            };
        }
        Ok(())
    }

    /// Before the pass's barriers: what was recorded earlier is done when the device writes it.
    pub(crate) fn begin_pass(&self, command_buffer: vk::CommandBuffer, pass: usize) {
        self.write(command_buffer, vk::PipelineStageFlags2::ALL_COMMANDS, 2 * pass);
        // Depends on nothing, so a GPU does nothing. lavapipe keeps timestamps with its draws and runs dispatches at
        // once: without this it would write the begin of a dispatch after its end.
        let nothing = vk::DependencyInfo::default();
        // SAFETY: a recording command buffer outside rendering.
        unsafe { self.shared.device().cmd_pipeline_barrier2(command_buffer, &nothing) };
    }

    pub(crate) fn end_pass(&self, command_buffer: vk::CommandBuffer, pass: usize) {
        self.write(command_buffer, vk::PipelineStageFlags2::ALL_COMMANDS, 2 * pass + 1);
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
                self.keep_frame(frame, passes);
            }
        }
        Ok(self.history.back())
    }

    /// Reads a slot into `results`; false if some of it is not there yet.
    fn read(&mut self, slot: usize, passes: usize) -> Result<bool, GpuError> {
        let results = &mut self.results[..2 * passes];
        if results.is_empty() {
            return Ok(true);
        }
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WITH_AVAILABILITY;
        // SAFETY: the pool has that many queries, each result is two 64-bit words.
        match unsafe { self.shared.device().get_query_pool_results(self.slots[slot].pool, 0, results, flags) }
        {
            Ok(()) => Ok(results.iter().all(|[_, available]| *available != 0)),
            Err(vk::Result::NOT_READY) => Ok(false),
            Err(result) => Err(GpuError::Vulkan { call: "vkGetQueryPoolResults", result }),
        }
    }

    fn keep_frame(&mut self, frame: u64, passes: usize) {
        if self.warm_up > 0 {
            self.warm_up -= 1;
            return;
        }
        let reused = if self.history.len() == self.keep { self.history.pop_front() } else { None };
        let mut times = reused.unwrap_or(FrameTimes { frame, passes: Vec::new(), span: 0.0, sum: 0.0 });
        times.frame = frame;
        let clock = Clock {
            mask: mask(self.shared.facts.timestamp_valid_bits),
            period: f64::from(self.shared.facts.limits.timestamp_period) * 1e-9,
        };
        clock.fill(&self.results[..2 * passes], &mut times);
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
        let pass = |(i, name): (usize, &String)| {
            let at = |share| quantile(self.history.iter().map(|frame| frame.passes[i]), share);
            Some(PassTime { name: name.clone(), median: at(0.5)?, p5: at(0.05)?, p95: at(0.95)? })
        };
        Some(TimingSummary {
            frames: self.history.len(),
            span: median(self.history.iter().map(|frame| frame.span))?,
            sum: median(self.history.iter().map(|frame| frame.sum))?,
            passes: self.names.iter().enumerate().map(pass).collect::<Option<_>>()?,
        })
    }
}

impl Drop for Timing {
    fn drop(&mut self) {
        self.slots.iter().for_each(|slot| self.shared.retire(Retired::QueryPool(slot.pool)));
    }
}
