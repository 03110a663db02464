//! A pass with its times, and with the counts that do not depend on the machine.

use std::collections::BTreeMap;

use airglow_gpu::{PassTime, TimingSummary};
use serde::Serialize;

use crate::host::work::PassWork;
use crate::text::bytes;

/// A pass as `--stat` writes it.
#[derive(Debug, Serialize)]
pub struct PassStat {
    name: String,
    #[serde(flatten)]
    time: Option<Time>,
    /// The same on every machine.
    #[serde(skip_serializing_if = "Option::is_none")]
    counts: Option<BTreeMap<&'static str, u64>>,
    /// Counted by the device.
    #[serde(skip_serializing_if = "Option::is_none")]
    pipeline_statistics: Option<BTreeMap<&'static str, u64>>,
}

/// Device time of a pass: median, 5th and 95th percentile of the frames.
#[derive(Debug, Serialize)]
struct Time {
    median_ms: f64,
    p5_ms: f64,
    p95_ms: f64,
}

/// The passes of some frames by their times alone; none with too few frames.
#[cfg(feature = "view")]
pub fn timed(timing: Option<&TimingSummary>) -> Vec<PassStat> {
    timing.map_or(Vec::new(), |timing| timing.passes.iter().map(PassStat::timed).collect())
}

/// The passes of a frame by what they do, with times where there were enough frames.
pub fn counted(work: &[PassWork], timing: Option<&TimingSummary>) -> Vec<PassStat> {
    let pass = |(place, work): (usize, &PassWork)| {
        let time = timing.and_then(|timing| timing.passes.get(place));
        let stat = time.map_or_else(|| PassStat::untimed(&work.name), PassStat::timed);
        PassStat { counts: Some(work.counts.named().into()), ..stat }
    };
    work.iter().enumerate().map(pass).collect()
}

impl PassStat {
    fn untimed(name: &str) -> Self {
        Self { name: name.to_owned(), time: None, counts: None, pipeline_statistics: None }
    }

    fn timed(pass: &PassTime) -> Self {
        let [median_ms, p5_ms, p95_ms] = [pass.median, pass.p5, pass.p95].map(|seconds| 1e3 * seconds);
        Self {
            time: Some(Time { median_ms, p5_ms, p95_ms }),
            pipeline_statistics: pass.statistics.map(|counted| counted.named().into()),
            ..Self::untimed(&pass.name)
        }
    }

    /// The pass as a line of text, and what was counted of it below.
    pub fn line(&self) -> String {
        let mut line = match &self.time {
            Some(Time { median_ms, p5_ms, p95_ms }) => {
                format!("  {:32} {median_ms:9.3} ms  ({p5_ms:.3} to {p95_ms:.3})\n", self.name)
            }
            None => format!("  {}\n", self.name),
        };
        let counted = [("", &self.counts), ("by the device: ", &self.pipeline_statistics)];
        for (by, counts) in counted.into_iter().filter_map(|(by, counts)| Some((by, counts.as_ref()?))) {
            let some = counts.iter().filter(|(_, count)| **count > 0);
            let text: Vec<_> = some.map(|(name, count)| count_text(name, *count)).collect();
            line.push_str(&format!("    {by}{}\n", text.join(", ")));
        }
        line
    }
}

fn count_text(name: &str, count: u64) -> String {
    match name.strip_suffix("_bytes") {
        Some(what) => format!("{what} {}", bytes(count)),
        None => format!("{} {count}", name.replace('_', " ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use airglow_gpu::Counts;

    #[test]
    fn counts_stand_beside_times_or_alone() {
        let counts = Counts { dispatches: 1, invocations: 64, bound_bytes: 2048, ..Counts::default() };
        let work = [PassWork { name: "relight".to_owned(), counts }];
        let alone = counted(&work, None);
        assert_eq!(alone[0].line(), "  relight\n    bound 2.0 KiB, dispatches 1, invocations 64\n");
        let json = serde_json::to_value(&alone[0]).unwrap();
        assert_eq!((&json["counts"]["invocations"], json.get("median_ms")), (&64.into(), None));
        let pass =
            PassTime { name: "relight".to_owned(), median: 1e-3, p5: 5e-4, p95: 2e-3, statistics: None };
        let timing = TimingSummary { frames: 9, passes: vec![pass], span: 2e-3, sum: 1e-3, coverage: 0.5 };
        let json = serde_json::to_value(&counted(&work, Some(&timing))[0]).unwrap();
        assert_eq!((&json["median_ms"], &json["counts"]["draws"]), (&1.0.into(), &0.into()));
        assert!(json.get("pipeline_statistics").is_none(), "{json}");
    }
}
