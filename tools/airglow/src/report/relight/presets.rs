//! The shared presets of the pass, measured.

use airglow::math::Preset;
use airglow::relight::Settings;

use super::curves::Measurement;
use crate::failure::Outcome;
use crate::report::model::Curve;
use crate::report::presets::choice;

impl Measurement<'_> {
    /// Error, time and memory of each preset.
    pub fn presets(&self) -> Outcome<Curve> {
        let settings = Preset::ALL.map(|preset| (preset.to_string(), Settings::from(preset)));
        let points = self.frame_points("relight presets", settings.into())?;
        self.curve("relight", "What do the presets of relighting take?", points, Some(choice()))
    }
}
