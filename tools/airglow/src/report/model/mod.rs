//! A report as plain data: what was measured, where, and every raw sample. JSON holds exactly this.

pub mod frame;
pub mod scaling;

use airglow_math::statistics;
use serde::{Deserialize, Serialize};

use crate::host::machine::Machine;
use frame::FrameReport;

/// One run of measurements of one pass on one device.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Report {
    /// The pass measured.
    pub pass: String,
    /// Where it was measured.
    pub machine: Machine,
    /// The command line that makes this report again.
    pub command: String,
    /// Day of the run, ISO 8601, UTC.
    pub date: String,
    /// What was lit, in a sentence: meshes, vertices, environment.
    pub workload: String,
    /// What a reader must know to read the numbers rightly.
    pub remarks: Vec<String>,
    /// One curve for each knob.
    pub curves: Vec<Curve>,
    /// What the pass is held to.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub numbers: Vec<Number>,
    /// A whole frame of all passes, where that was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<FrameReport>,
}

/// A number that a pass is held to.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Number {
    /// What was measured.
    pub what: String,
    /// What is asked for, in words.
    pub asked: String,
    /// What it is, in words.
    pub measured: String,
    /// Whether that is as asked.
    pub holds: bool,
}

/// What happens to error, time and memory as one knob turns.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Curve {
    /// The knob.
    pub knob: String,
    /// What the sweep answers, in a sentence.
    pub question: String,
    /// Norm of the errors.
    pub norm: String,
    /// What was timed.
    pub timed: String,
    /// The settings measured, in the knob's order.
    pub points: Vec<Point>,
    /// The setting that is the default on this device, and why.
    pub chosen: Option<Choice>,
    /// The chosen setting's time against each rival's.
    pub comparisons: Vec<Comparison>,
}

/// The setting picked from a curve.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Choice {
    /// Its name among the points.
    pub setting: String,
    /// The line of the curve that decided, in words.
    pub reason: String,
}

/// One setting of a knob.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Point {
    /// Name of the setting.
    pub setting: String,
    /// Milliseconds of each measured run, warm-up excluded; empty where only error was measured.
    pub milliseconds: Vec<f64>,
    /// Memory the setting holds, bytes: on the device, or as the curve's `timed` says.
    pub memory: u64,
    /// Counts that do not depend on the machine.
    pub counts: Counts,
    /// Errors against the three truths.
    pub error: Errors,
    /// Errors over many inputs, where they were taken.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distribution: Option<Distribution>,
}

/// Errors over many inputs; relative, unless the curve's norm says otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Distribution {
    /// Half of them are below.
    pub median: f64,
    /// 99 % of them are below.
    pub p99: f64,
    /// The largest.
    pub largest: f64,
    /// The largest absolute one where the truth is too small for a relative one.
    pub below: f64,
    /// Results that are not finite or negative; they are in none of the others.
    pub bad: u64,
}

/// Work of one run of the pass, the same on every machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Counts {
    /// Bytes that the method must read and write: its inputs once, its outputs as often as it writes them. Caches and
    /// padding apart.
    pub bytes: u64,
    /// Shader invocations; of a bake, its rays.
    pub invocations: u64,
    /// Compute dispatches.
    pub dispatches: u64,
    /// Draws.
    pub draws: u64,
    /// Copies and fills; `None` where it was not counted.
    #[serde(default)]
    pub copies: Option<u64>,
    /// Barriers; `None` where it was not counted.
    #[serde(default)]
    pub barriers: Option<u64>,
    /// Bytes of all ranges bound to shaders, as draws and attachments, a range bound twice counted twice; `None` where it
    /// was not counted.
    #[serde(default)]
    pub bound: Option<u64>,
}

/// Errors against the three truths; `None` where a truth does not apply.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// GPU against f64, same model.
    pub arithmetic: Option<f64>,
    /// Against the converged setting of the same knob.
    pub setting: Option<f64>,
    /// Against ray-traced truth.
    pub model: Option<f64>,
    /// 95th percentile over what is lit of the error against ray-traced truth, relative to the root mean square.
    #[serde(default)]
    pub model_p95: Option<f64>,
}

/// The paired ratio of two settings' times.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Comparison {
    /// Setting above the fraction line.
    pub setting: String,
    /// Setting below it.
    pub against: String,
    /// Median of the paired ratios.
    pub ratio: f64,
    /// Bootstrap 95 % interval of it.
    pub interval: [f64; 2],
}

impl Comparison {
    /// Two settings are called different only if the interval excludes 1.
    pub fn different(&self) -> bool {
        self.interval[0] > 1.0 || self.interval[1] < 1.0
    }

    /// The verdict in words.
    pub fn verdict(&self) -> &'static str {
        if !self.different() {
            "not different"
        } else if self.ratio < 1.0 {
            "faster"
        } else {
            "slower"
        }
    }
}

/// Median, 5th and 95th percentile and count of the samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Summary {
    pub median: f64,
    pub p5: f64,
    pub p95: f64,
    pub n: usize,
}

impl Summary {
    /// `None` without samples.
    pub fn of(samples: &[f64]) -> Option<Self> {
        let percentiles = statistics::percentiles(samples, &[5.0, 50.0, 95.0]).ok()?;
        Some(Self { p5: percentiles[0], median: percentiles[1], p95: percentiles[2], n: samples.len() })
    }
}

impl Point {
    /// Statistics of the times, if any were measured.
    pub fn time(&self) -> Option<Summary> {
        Summary::of(&self.milliseconds)
    }
}

/// One of the three errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    Model,
    Setting,
    Arithmetic,
}

impl Column {
    /// The first error, from the model's down, that differs by more than 2 % among `points`: what their knob changes.
    pub fn telling<'a>(points: impl Iterator<Item = &'a Point> + Clone) -> Self {
        let tells = |column: &Self| {
            let values = points.clone().filter_map(|point| column.of(&point.error));
            let (low, high) = values.fold((f64::MAX, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
            low > 0.0 && high > 1.02 * low
        };
        [Self::Model, Self::Setting, Self::Arithmetic].into_iter().find(tells).unwrap_or(Self::Model)
    }

    /// The error itself, where it is known.
    pub fn of(self, errors: &Errors) -> Option<f64> {
        match self {
            Self::Model => errors.model,
            Self::Setting => errors.setting,
            Self::Arithmetic => errors.arithmetic,
        }
    }

    /// For an axis.
    pub fn label(self) -> &'static str {
        match self {
            Self::Model => "model error (against ray-traced truth)",
            Self::Setting => "setting error (against the converged setting)",
            Self::Arithmetic => "arithmetic error (GPU against f64)",
        }
    }
}

impl Curve {
    /// Whether `point` is the chosen one.
    pub fn is_chosen(&self, point: &Point) -> bool {
        self.chosen.as_ref().is_some_and(|choice| choice.setting == point.setting)
    }
}

/// A small report for the tests of what is made from reports.
#[cfg(test)]
pub mod testing {
    use super::*;

    pub fn report(device: &str) -> Report {
        let point = |setting: &str, milliseconds: f64, error: f64| Point {
            setting: setting.to_owned(),
            milliseconds: vec![milliseconds, milliseconds * 1.1, milliseconds * 0.9],
            memory: (milliseconds * 1000.0) as u64,
            counts: Counts { bytes: 7, invocations: 5, dispatches: 1, ..Counts::default() },
            error: Errors { arithmetic: Some(1e-7), setting: Some(error), ..Errors::default() },
            distribution: None,
        };
        let curve = Curve {
            knob: "resolution".to_owned(),
            question: "Is fine worth its time? <yes>".to_owned(),
            norm: "relative L2".to_owned(),
            timed: "one frame".to_owned(),
            points: vec![point("coarse", 1.0, 0.1), point("fine", 4.0, 0.01)],
            chosen: Some(Choice { setting: "fine".to_owned(), reason: "it is fine".to_owned() }),
            comparisons: Vec::new(),
        };
        Report {
            pass: "test".to_owned(),
            machine: Machine {
                device: device.to_owned(),
                kind: "cpu".to_owned(),
                driver: "none".to_owned(),
                clocks: None,
                software: true,
            },
            command: "airglow report test".to_owned(),
            date: "2026-01-01".to_owned(),
            workload: "nothing".to_owned(),
            remarks: Vec::new(),
            curves: vec![curve],
            numbers: Vec::new(),
            frame: None,
        }
    }
}
