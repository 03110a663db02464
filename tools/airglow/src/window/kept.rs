//! What values of knobs erred and took where they were measured: reports that are kept with the source.

use std::sync::OnceLock;

/// The `report.csv` of `airglow report ROOM`, one for each room and device.
const KEPT: [(&str, &str); 4] = [
    ("relight", include_str!("../../../../docs/measured/relight-llvmpipe.csv")),
    ("fog", include_str!("../../../../docs/measured/fog-llvmpipe.csv")),
    ("radiance", include_str!("../../../../docs/measured/radiance-llvmpipe.csv")),
    ("shadow", include_str!("../../../../docs/measured/shadow-llvmpipe.csv")),
];

/// A value of a knob, and what was found at it.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    room: &'static str,
    knob: String,
    /// The value.
    pub value: f64,
    /// Against the model's truth, or where that was not measured against the converged setting.
    pub error: Option<f64>,
    /// Median device time of what was timed.
    pub milliseconds: Option<f64>,
    /// As the driver states it.
    pub device: String,
    /// How the error is measured, and what was timed.
    pub how: String,
}

/// The values of a knob that were measured, in rising order.
pub fn values(room: &str, knob: &str) -> Vec<&'static Measured> {
    static ROWS: OnceLock<Vec<Measured>> = OnceLock::new();
    let rows = ROWS.get_or_init(|| KEPT.iter().flat_map(|(room, text)| read(room, text)).collect());
    let mut found: Vec<_> = rows.iter().filter(|row| row.room == room && row.knob == knob).collect();
    found.sort_by(|a, b| a.value.total_cmp(&b.value));
    found.dedup_by(|a, b| a.value == b.value);
    found
}

/// The rows of a table whose settings are numbers.
fn read(room: &'static str, text: &str) -> Vec<Measured> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let Ok(header) = reader.headers().cloned() else { return Vec::new() };
    let row = |record: csv::StringRecord| {
        let cell = |name: &str| record.get(header.iter().position(|column| column == name)?);
        let number = |name: &str| cell(name)?.parse::<f64>().ok();
        let setting = cell("setting")?;
        Some(Measured {
            room,
            knob: cell("knob")?.to_owned(),
            value: setting.split_whitespace().next()?.parse().ok()?,
            error: number("error_model").or(number("error_setting")),
            milliseconds: number("median_ms"),
            device: cell("device")?.to_owned(),
            how: ["norm", "timed"]
                .into_iter()
                .filter_map(cell)
                .fold(setting.to_owned(), |all, text| all + "\n" + text),
        })
    };
    reader.records().flatten().filter_map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::window::wish::KNOBS;

    #[test]
    fn every_knob_has_values_that_were_measured() {
        for knob in KNOBS {
            let values = values(knob.room, knob.name);
            assert!(values.len() >= 4, "{} {}: {values:?}", knob.room, knob.name);
            assert!(values.is_sorted_by(|a, b| a.value < b.value));
            assert!(values.iter().all(|row| row.error.is_some_and(f64::is_finite)), "{}", knob.name);
        }
        assert!(values("fog", "no such knob").is_empty());
    }
}
