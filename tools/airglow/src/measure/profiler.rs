//! What measuring costs: frames with and without it in turn, and the difference of each pair.

use airglow_gpu::open::FrameSemaphores;
use airglow_math::MathError;
use airglow_math::statistics::bootstrap_interval;
use serde::Serialize;
use std::time::Instant;

use crate::failure::{Failure, Outcome};
use crate::host::picture::Compiled;
use crate::host::renderer::Renderer;
use crate::host::settings::Settings;

/// Pairs of frames whose times are dropped.
const WARM_UP: usize = 2;
/// Most pairs of frames that are timed.
pub const MOST_PAIRS: usize = 24;

/// What timestamps, and statistics where asked for, add to a frame.
#[derive(Debug, Serialize)]
pub struct ProfilerCost {
    /// Pairs of frames, one of them measured.
    pub pairs: usize,
    /// CPU time of recording, milliseconds.
    pub record_ms: Difference,
    /// From the begin of recording until the device is done, frame by frame, milliseconds.
    pub frame_ms: Difference,
}

/// With less without, and the 95 % bootstrap interval of the median.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// Median of the differences.
    pub median: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Difference {
    /// The median of `with - without` over pairs.
    fn of(pairs: &[[f64; 2]]) -> Result<Self, MathError> {
        let differences: Vec<f64> = pairs.iter().map(|[without, with]| with - without).collect();
        let interval = bootstrap_interval(&differences, 0.95, 2000, 1)?;
        Ok(Self { median: interval.estimate, low: interval.low, high: interval.high })
    }
}

impl ProfilerCost {
    /// Draws pairs of frames, each waited for; every second pair begins with the frame that is measured.
    ///
    /// `None` on a queue without timestamps.
    pub fn measure(
        renderer: &mut Renderer<'_>,
        settings: &Settings,
        statistics: bool,
        pairs: usize,
    ) -> Outcome<Option<Self>> {
        let device = renderer.device();
        let Compiled { mut execution, imports, mut timing, .. } =
            renderer.compile(settings, pairs.max(1), statistics)?;
        if timing.is_none() {
            return Ok(None);
        }
        let mut frames = device.frame_loop()?;
        let (mut record, mut whole) = (Vec::new(), Vec::new());
        for pair in 0..WARM_UP + pairs.clamp(1, MOST_PAIRS) {
            let (mut recorded, mut done) = ([0.0; 2], [0.0; 2]);
            for step in 0..2 {
                let with = (pair + step) % 2;
                let timing = timing.as_mut().filter(|_| with == 1);
                let start = Instant::now();
                let semaphores = FrameSemaphores::default();
                let took = device.frame(&mut frames, semaphores, &mut execution, &imports, timing)?;
                frames.finish().map_err(Failure::work)?;
                done[with] = 1e3 * start.elapsed().as_secs_f64();
                recorded[with] = 1e3 * took.cpu.as_secs_f64();
            }
            if pair >= WARM_UP {
                record.push(recorded);
                whole.push(done);
            }
        }
        Ok(Some(Self {
            pairs: whole.len(),
            record_ms: Difference::of(&record).map_err(Failure::work)?,
            frame_ms: Difference::of(&whole).map_err(Failure::work)?,
        }))
    }

    /// Two lines of text.
    pub fn text(&self) -> String {
        let line = |what: &str, Difference { median, low, high }: Difference| {
            format!("  measuring adds {median:+.4} ms to {what} (95 % interval {low:+.4} to {high:+.4}, ")
        };
        let pairs = format!("{} pairs of frames)\n", self.pairs);
        line("recording", self.record_ms) + &pairs + &line("a frame waited for", self.frame_ms) + &pairs
    }
}

#[cfg(test)]
mod tests {
    use super::Difference;

    #[test]
    fn a_load_that_drifts_cancels_in_pairs() {
        let pairs: Vec<[f64; 2]> = (0..9).map(|i| [f64::from(i), f64::from(i) + 0.5]).collect();
        let found = Difference::of(&pairs).unwrap();
        assert_eq!(found, Difference { median: 0.5, low: 0.5, high: 0.5 });
    }
}
