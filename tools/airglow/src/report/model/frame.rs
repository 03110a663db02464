//! A whole frame of all passes, as plain data.

use airglow_math::statistics;
use serde::{Deserialize, Serialize};

use super::scaling::Scaling;

/// A frame by preset, as plain data.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FrameReport {
    /// Pixels of the picture.
    pub size: [u32; 2],
    /// Coarsest first.
    pub presets: Vec<PresetFrame>,
    /// What the frame does without.
    pub left_out: Vec<Missing>,
    /// How time grows.
    pub scalings: Vec<Scaling>,
}

/// The frame of one preset for all passes.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PresetFrame {
    /// Its name.
    pub preset: String,
    /// In the order in which they run; those of one name as one.
    pub passes: Vec<PassSamples>,
    /// Bytes of the plan: of resources that are there before, and of the frame's own.
    pub imported: u64,
    /// Bytes of the frame's own.
    pub transient: u64,
    /// Bytes that the device holds for each owner.
    pub memory: Vec<(String, u64)>,
    /// Relative L2 of the scene-linear picture against that of the last preset; none of the last.
    pub error: Option<f64>,
}

/// A pass and its times.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PassSamples {
    /// As the plan has it.
    pub name: String,
    /// Device time of each measured frame.
    pub milliseconds: Vec<f64>,
    /// Compute dispatches, draws and barriers of a frame, the same on every machine.
    pub counts: [u64; 3],
}

/// Something a frame does without.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Missing {
    /// What.
    pub what: String,
    /// Why.
    pub why: String,
    /// Bytes that this saves.
    pub bytes: u64,
    /// What would bring it back.
    pub would_return: String,
}

impl PresetFrame {
    /// Milliseconds of each frame, all passes together.
    pub fn total(&self) -> Vec<f64> {
        let rounds = self.passes.iter().map(|pass| pass.milliseconds.len()).min().unwrap_or(0);
        (0..rounds).map(|round| self.passes.iter().map(|pass| pass.milliseconds[round]).sum()).collect()
    }
}

/// Median and its 95 % bootstrap interval; none without samples.
pub fn median_interval(samples: &[f64]) -> Option<[f64; 3]> {
    let interval = statistics::bootstrap_interval(samples, 0.95, 2000, 1).ok()?;
    Some([interval.estimate, interval.low, interval.high])
}
