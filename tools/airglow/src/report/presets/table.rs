//! The presets' errors, times and bytes as they were measured, kept with the source.

use std::sync::OnceLock;

use airglow_math::Preset;
use airglow_scene::Presets;
use serde::Serialize;

use crate::report::model::Errors;
use crate::scene_options::ROOMS;
use crate::text::bytes;

/// One file for each device, each the `report.csv` of `airglow report presets`.
const KEPT: [&str; 1] = [include_str!("../../../../../docs/measured/presets-llvmpipe.csv")];

/// What a preset of a room took on a device.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// As the driver states it.
    pub device: String,
    /// Day of the run, ISO 8601.
    pub date: String,
    /// relight, fog, radiance, normals or shadow.
    pub room: String,
    /// The preset, by its name.
    pub preset: String,
    /// Against f64, against the converged setting, against the model's truth.
    pub error: Errors,
    /// Median.
    pub milliseconds: f64,
    /// Memory held.
    pub bytes: u64,
    /// How errors are measured.
    pub norm: String,
    /// What was timed, and on what.
    pub timed: String,
}

impl Row {
    /// One line: errors, time, memory, device.
    pub fn words(&self) -> String {
        let error = |name: &str, value: Option<f64>| value.map(|value| format!("{name} {value:.1e}"));
        let Errors { arithmetic, setting, model, .. } = self.error;
        let errors = [("arithmetic", arithmetic), ("setting", setting), ("model", model)];
        let errors: Vec<String> = errors.into_iter().filter_map(|(name, value)| error(name, value)).collect();
        format!(
            "{} {}: error {}; {:.2} ms, {} ({})",
            self.room,
            self.preset,
            errors.join(", "),
            self.milliseconds,
            bytes(self.bytes),
            self.device
        )
    }
}

/// All rows kept.
pub fn rows() -> &'static [Row] {
    static ROWS: OnceLock<Vec<Row>> = OnceLock::new();
    ROWS.get_or_init(|| KEPT.iter().flat_map(|text| read(text)).collect())
}

/// What a preset of a room took on a device of that name; where that was never measured, on any other.
pub fn find(room: &str, preset: Preset, device: &str) -> Option<&'static Row> {
    let of_room = || rows().iter().filter(|row| row.room == room && row.preset == preset.name());
    of_room().find(|row| row.device == device).or_else(|| of_room().next())
}

/// What a scene's presets took, room by room; empty where it asks for none.
pub fn asked(presets: &Presets, device: &str) -> Vec<&'static Row> {
    ROOMS.into_iter().filter_map(|room| find(room, presets.of(room)?, device)).collect()
}

/// The same as lines; no text where there is none.
pub fn text(rows: &[&Row]) -> String {
    let lines: String = rows.iter().map(|row| format!("  {}\n", row.words())).collect();
    if lines.is_empty() {
        lines
    } else {
        format!("presets, each measured on the scene that shows its pass\n{lines}")
    }
}

/// The rows of a table; what cannot be read is not there.
fn read(text: &str) -> Vec<Row> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let Ok(header) = reader.headers().cloned() else { return Vec::new() };
    let row = |record: csv::StringRecord| {
        let cell = |name: &str| record.get(header.iter().position(|column| column == name)?);
        let text = |name: &str| Some(cell(name)?.to_owned());
        let number = |name: &str| cell(name)?.parse().ok();
        Some(Row {
            device: text("device")?,
            date: text("date")?,
            room: text("knob")?,
            preset: text("setting")?,
            error: Errors {
                arithmetic: number("error_arithmetic"),
                setting: number("error_setting"),
                model: number("error_model"),
                model_p95: number("error_model_p95"),
            },
            milliseconds: number("median_ms")?,
            bytes: cell("memory_held_bytes")?.parse().ok()?,
            norm: text("norm")?,
            timed: text("timed")?,
        })
    };
    reader.records().flatten().filter_map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_of_every_room_is_kept_and_a_finer_one_errs_less() {
        for room in ROOMS {
            let of = |preset| find(room, preset, "llvmpipe").unwrap_or_else(|| panic!("{room} {preset}"));
            let kept = Preset::ALL.map(of);
            let error =
                kept.map(|row| row.error.setting.filter(|_| room == "fog").or(row.error.model).unwrap());
            // Where two presets see a map alike, only rounding is left between them.
            assert!(error.is_sorted_by(|a, b| 1.01 * a >= *b), "{room}: {error:?}");
            assert!(kept.is_sorted_by(|a, b| a.bytes <= b.bytes), "{room}");
            assert!(
                kept.iter().all(|row| row.milliseconds > 0.0 && row.words().contains(&row.device)),
                "{room}"
            );
        }
    }

    #[test]
    fn a_broken_table_has_no_rows() {
        assert!(read("knob,setting\nfog,low\n").is_empty() && read("").is_empty());
    }
}
