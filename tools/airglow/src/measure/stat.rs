//! What drawing a picture took: times, counts and memory, as JSON and as text.

use serde::Serialize;

use super::health::Count;
#[cfg(feature = "fog")]
use super::lights::LightStat;
#[cfg(feature = "radiance")]
use super::near::NearStat;
use super::pass::{PassStat, counted};
use super::profiler::ProfilerCost;
#[cfg(feature = "shadow")]
use super::shadow::ShadowStat;
use crate::host::device::Device;
use crate::host::machine::Machine;
use crate::host::picture::{Picture, WARM_UP};
use crate::host::settings::Settings;

/// What `--stat` writes.
#[derive(Serialize)]
pub struct Stat {
    machine: Machine,
    width: u32,
    height: u32,
    frames: usize,
    exposure: f32,
    passes: Vec<PassStat>,
    /// From the first pass's start to the last one's end, milliseconds.
    span_ms: Option<f64>,
    /// All passes added up, milliseconds.
    sum_ms: Option<f64>,
    /// Median of the sum over the span of its frame.
    coverage: Option<f64>,
    /// Median CPU time of recording a frame, milliseconds.
    record_ms: f64,
    /// What measuring adds to a frame; with --stat alone.
    profiler: Option<ProfilerCost>,
    /// Which lights the fog pass evaluates in each view.
    #[cfg(feature = "fog")]
    lights: Vec<LightStat>,
    /// What the radiance pass sampled, where there is one.
    #[cfg(feature = "radiance")]
    pub near: Option<NearStat>,
    /// What the shadow pass found near its receivers, where there is one.
    #[cfg(feature = "shadow")]
    pub shadow: Option<ShadowStat>,
    /// What the passes counted; with --health, where they have anything to count.
    pub health: Vec<Count>,
    /// Device memory by owner.
    memory: Vec<MemoryStat>,
}

/// What an owner holds.
#[derive(Serialize)]
struct MemoryStat {
    owner: String,
    bytes: u64,
    objects: u64,
}

impl Stat {
    /// Of a picture that was drawn with those settings, before anything is counted.
    pub fn new(
        device: &Device<'_>,
        settings: &Settings,
        picture: &Picture,
        profiler: Option<ProfilerCost>,
    ) -> Self {
        let mut cpu = picture.cpu_milliseconds.clone();
        cpu.sort_by(f64::total_cmp);
        let timing = picture.timing.as_ref();
        Self {
            machine: device.machine(),
            width: settings.picture_size()[0],
            height: settings.picture_size()[1],
            frames: timing.map_or(0, |timing| timing.frames),
            exposure: settings.exposure,
            passes: counted(&picture.passes, timing),
            span_ms: timing.map(|timing| 1e3 * timing.span),
            sum_ms: timing.map(|timing| 1e3 * timing.sum),
            coverage: timing.map(|timing| timing.coverage),
            record_ms: cpu.get(cpu.len() / 2).copied().unwrap_or(0.0),
            profiler,
            #[cfg(feature = "fog")]
            lights: picture.lights.iter().copied().map(LightStat::from).collect(),
            #[cfg(feature = "radiance")]
            near: None,
            #[cfg(feature = "shadow")]
            shadow: None,
            health: Vec::new(),
            memory: device
                .context()
                .memory_report()
                .into_iter()
                .map(|owner| MemoryStat { owner: owner.owner, bytes: owner.bytes, objects: owner.objects })
                .collect(),
        }
    }

    /// The same for people.
    pub fn text(&self) -> String {
        let mut text = format!("{} ({})\n", self.machine.device, self.machine.driver);
        text.extend(self.passes.iter().map(PassStat::line));
        match (self.span_ms, self.sum_ms, self.coverage) {
            (Some(span), Some(sum), Some(coverage)) => {
                text.push_str(&format!(
                "  span {span:.3} ms, sum {sum:.3} ms, coverage {:.1} %; medians of {} frames (5th to 95th percentile)\n",
                100.0 * coverage,
                self.frames
            ));
            }
            _ => text.push_str(&format!("  no times: more than {WARM_UP} frames are needed\n")),
        }
        text.push_str(&self.profiler.as_ref().map_or(String::new(), ProfilerCost::text));
        #[cfg(feature = "fog")]
        text.extend(self.lights.iter().map(LightStat::line));
        #[cfg(feature = "radiance")]
        text.extend(self.near.iter().map(NearStat::line));
        #[cfg(feature = "shadow")]
        text.extend(self.shadow.iter().map(ShadowStat::line));
        text.extend(self.health.iter().map(Count::line));
        for owner in &self.memory {
            text.push_str(&format!("  {:32} {}\n", owner.owner, crate::text::bytes(owner.bytes)));
        }
        text
    }
}
