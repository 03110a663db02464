//! A report on disk: `report.html`, `report.json` (raw samples in it) and `report.csv` in one folder.

use std::path::{Path, PathBuf};

use super::model::Report;
use super::{html, table};
use crate::failure::{Failure, Outcome};
use crate::files;

/// Writes the three files of one report, or of several overlaid, and returns their paths.
pub fn write(folder: &Path, reports: &[Report]) -> Outcome<Vec<PathBuf>> {
    let json = serde_json::to_vec_pretty(reports)
        .map_err(|error| Failure::work(format!("could not write the report as JSON: {error}")))?;
    let contents = [
        ("report.html", html::page(reports)?.into_bytes()),
        ("report.json", json),
        ("report.csv", table::csv(reports)?),
    ];
    let mut paths = Vec::new();
    for (name, bytes) in contents {
        let path = folder.join(name);
        files::write(&path, &bytes)?;
        paths.push(path);
    }
    Ok(paths)
}

/// The reports in a `report.json`.
pub fn read(path: &Path) -> Outcome<Vec<Report>> {
    let text = files::read_text(path)?;
    serde_json::from_str(&text)
        .map_err(|error| Failure::input(format!("{}: not a report of this command: {error}", path.display())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::model::testing;

    #[test]
    fn a_report_survives_the_round_trip_through_json() {
        let folder = tempfile::tempdir().unwrap();
        let reports = [testing::report("a"), testing::report("b")];
        write(folder.path(), &reports).unwrap();
        let read = read(&folder.path().join("report.json")).unwrap();
        assert_eq!(read[1].curves[0].points[1].milliseconds, reports[1].curves[0].points[1].milliseconds);
        let csv = std::fs::read_to_string(folder.path().join("report.csv")).unwrap();
        assert_eq!(csv.lines().count(), 1 + 4);
    }
}
