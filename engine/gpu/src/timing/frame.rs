//! What a ring of queries found: times of one frame, and medians over many.

use super::statistics::PassStatistics;
use crate::clock::{median, quantile};
use std::collections::VecDeque;
use std::time::Instant;

/// Device times of one frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameTimes {
    /// The context's frame they belong to.
    pub frame: u64,
    /// Seconds of each pass, in the plan's order.
    pub passes: Vec<f64>,
    /// Seconds from the start of the first pass to the start of each.
    pub begins: Vec<f64>,
    /// The device's clock when the first pass began, in ticks of `timestampPeriod` nanoseconds.
    pub start: u64,
    /// Seconds from the start of the first pass to the end of the last to finish.
    pub span: f64,
    /// Seconds of all passes added up.
    pub sum: f64,
    /// When the CPU began and ended to record each pass.
    pub recorded: Vec<[Instant; 2]>,
    /// Statistics of each pass; empty unless asked for ([`Timing::with_pipeline_statistics`](super::Timing)).
    pub statistics: Vec<PassStatistics>,
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
    /// Pipeline statistics of the newest frame kept; `None` unless asked for.
    pub statistics: Option<PassStatistics>,
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
    /// Median of the sum over the span of its frame: below 1 the device idled between passes, above 1 passes overlapped.
    pub coverage: f64,
}

impl TimingSummary {
    pub(super) fn of(names: &[String], history: &VecDeque<FrameTimes>) -> Option<Self> {
        let newest = history.back()?;
        let pass = |(i, name): (usize, &String)| {
            let at = |share| quantile(history.iter().map(|frame| frame.passes[i]), share);
            let statistics = newest.statistics.get(i).copied();
            Some(PassTime { name: name.clone(), median: at(0.5)?, p5: at(0.05)?, p95: at(0.95)?, statistics })
        };
        let covered = history.iter().filter(|frame| frame.span > 0.0).map(|frame| frame.sum / frame.span);
        Some(Self {
            frames: history.len(),
            span: median(history.iter().map(|frame| frame.span))?,
            sum: median(history.iter().map(|frame| frame.sum))?,
            coverage: median(covered).unwrap_or(0.0),
            passes: names.iter().enumerate().map(pass).collect::<Option<_>>()?,
        })
    }
}
