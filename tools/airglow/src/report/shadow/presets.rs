//! The shared presets of the pass, measured.

use airglow::math::Preset;
use airglow::shadow::Settings;
use airglow_scene::Scene;

use super::shading::Shading;
use super::{Measurement, knobs};
use crate::failure::Outcome;
use crate::report::model::Curve;
use crate::report::presets::choice;

impl Measurement<'_> {
    /// Error, time and memory of each preset on a scene.
    pub fn presets(&self, scene: &Scene) -> Outcome<Curve> {
        let shading = Shading::new(self, scene)?;
        let settings =
            |preset: Preset| (preset.to_string(), Settings { normals: true, ..Settings::from(preset) });
        let choice = choice();
        let settings = Preset::ALL.map(settings).into();
        let question = "What do the presets of shadows take?";
        let curve = knobs::curve(self, &shading, "shadow", question, settings, &choice.setting)?;
        let timed = format!("{}: {}", curve.timed, shading.words());
        Ok(Curve { chosen: Some(choice), timed, ..curve })
    }
}
