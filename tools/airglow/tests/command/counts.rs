//! What `--stat` counted, as text for golden files.

#![cfg(feature = "relight")]

use serde_json::Value;

/// The counts that are not 0 under a title, a line for each; nothing where all are.
pub fn lines(title: &str, counts: &Value) -> String {
    let some = counts.as_object().into_iter().flatten().filter(|(_, count)| **count != 0);
    let lines: String = some.map(|(name, count)| format!("    {name} {count}\n")).collect();
    if lines.is_empty() { lines } else { format!("  {title}\n{lines}") }
}

/// Counts of every pass and of every health counter under a title.
#[cfg(all(feature = "fog", any(feature = "shadow", all(feature = "radiance", feature = "normals"))))]
pub fn counts(title: &str, stat: &Value) -> String {
    let mut text = format!("{title}\n");
    for pass in stat["passes"].as_array().into_iter().flatten() {
        text += &format!("{}\n", pass["name"].as_str().unwrap_or_default());
        text += &lines("counts", &pass["counts"]);
        text += &lines("counted by the device", &pass["pipeline_statistics"]);
    }
    text += "health\n";
    for counter in stat["health"].as_array().into_iter().flatten() {
        text += &format!("    {} {}\n", counter["name"].as_str().unwrap_or_default(), counter["count"]);
    }
    text
}
