//! What a ring of queries found: times of one frame, and medians over many.

use super::statistics::PassStatistics;
use crate::clock::{Clock, median, quantile};
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

impl FrameTimes {
    /// Turns begin and end of each pass, as `clock` counts, into times.
    pub(super) fn fill(&mut self, clock: &Clock, results: &[[u64; 2]]) {
        let pairs = || results.chunks_exact(2).map(|pair| (pair[0][0], pair[1][0]));
        let start = results.first().map_or(0, |first| first[0] & clock.mask);
        self.start = start;
        self.passes.clear();
        self.passes.extend(pairs().map(|(begin, end)| clock.seconds(begin, end)));
        self.begins.clear();
        self.begins.extend(pairs().map(|(begin, _)| clock.seconds(start, begin)));
        self.sum = self.passes.iter().sum();
        self.span = pairs().map(|(_, end)| clock.seconds(start, end)).fold(0.0, f64::max);
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::mask;

    #[test]
    fn wrapped_counters_and_overlap_give_true_times() {
        let clock = Clock { mask: mask(36), period: 1e-9 };
        let near_end = (1 << 36) - 100;
        let results = [[near_end, 1], [900, 1], [400, 1], [1400, 1]];
        let mut times = FrameTimes::default();
        times.fill(&clock, &results);
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-15, "{a} against {b}");
        near(times.passes[0], 1000e-9);
        near(times.passes[1], 1000e-9);
        near(times.begins[1], 500e-9);
        assert_eq!((times.start, times.begins[0]), (near_end, 0.0));
        near(times.sum, 2000e-9);
        near(times.span, 1500e-9);
        near(clock.seconds(500, 499), 0.0);
        assert_eq!((mask(64), mask(0), mask(1)), (u64::MAX, 0, 1));
    }
}
