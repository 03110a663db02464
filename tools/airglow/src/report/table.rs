//! A report's points as CSV, one row each: for spreadsheets and notebooks.

use super::model::{Point, Report};
use crate::failure::{Failure, Outcome};

const HEADER: [&str; 30] = [
    "pass",
    "device",
    "driver",
    "date",
    "knob",
    "setting",
    "chosen",
    "median_ms",
    "p5_ms",
    "p95_ms",
    "n",
    "memory_held_bytes",
    "read_written_bytes",
    "bound_bytes",
    "invocations",
    "dispatches",
    "draws",
    "copies",
    "barriers",
    "error_arithmetic",
    "error_setting",
    "error_model",
    "error_model_p95",
    "random_median",
    "random_p99",
    "random_largest",
    "random_below",
    "random_bad",
    "norm",
    "timed",
];

/// The rows of all reports under one header; a value that was not measured is an empty cell.
pub fn csv(reports: &[Report]) -> Outcome<Vec<u8>> {
    let broken = |error: csv::Error| Failure::work(format!("could not write CSV: {error}"));
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(HEADER).map_err(broken)?;
    for report in reports {
        for curve in &report.curves {
            for point in &curve.points {
                let mut row: Vec<String> = [
                    &report.pass,
                    &report.machine.device,
                    &report.machine.driver,
                    &report.date,
                    &curve.knob,
                    &point.setting,
                ]
                .map(Clone::clone)
                .into();
                row.push(curve.is_chosen(point).to_string());
                row.extend(numbers(point));
                row.extend([curve.norm.clone(), curve.timed.clone()]);
                writer.write_record(&row).map_err(broken)?;
            }
        }
    }
    writer.into_inner().map_err(|error| Failure::work(format!("could not write CSV: {error}")))
}

fn numbers(point: &Point) -> Vec<String> {
    let time = point.time();
    let real = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.6e}"));
    let count = |value: Option<u64>| value.map_or(String::new(), |value| value.to_string());
    vec![
        real(time.map(|t| t.median)),
        real(time.map(|t| t.p5)),
        real(time.map(|t| t.p95)),
        point.milliseconds.len().to_string(),
        point.memory.to_string(),
        point.counts.bytes.to_string(),
        count(point.counts.bound),
        point.counts.invocations.to_string(),
        point.counts.dispatches.to_string(),
        point.counts.draws.to_string(),
        count(point.counts.copies),
        count(point.counts.barriers),
        real(point.error.arithmetic),
        real(point.error.setting),
        real(point.error.model),
        real(point.error.model_p95),
        real(point.distribution.map(|d| d.median)),
        real(point.distribution.map(|d| d.p99)),
        real(point.distribution.map(|d| d.largest)),
        real(point.distribution.map(|d| d.below)),
        count(point.distribution.map(|d| d.bad)),
    ]
}
