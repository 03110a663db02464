//! What the shared presets of each room take on a device: measured, and as it was kept.

#[cfg(feature = "relight")]
pub mod measure;
pub mod table;

use airglow::math::Preset;

use super::model::Choice;

/// The preset that holds where nobody asks for another.
pub fn choice() -> Choice {
    Choice { setting: Preset::default().to_string(), reason: "it is the default of all settings".to_owned() }
}
