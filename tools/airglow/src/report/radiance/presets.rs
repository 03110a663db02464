//! The shared presets of the pass, measured.

use airglow::math::Preset;

use super::Measurement;
use super::race::Setting;
use crate::failure::{Failure, Outcome};
use crate::report::interleave;
use crate::report::model::Curve;
use crate::report::presets::choice;

impl Measurement<'_> {
    /// Error, time and memory of each preset.
    pub fn presets(&self) -> Outcome<Curve> {
        let setting = |preset: Preset| Setting::new(preset.name(), preset.into());
        let mut points = self.settings("radiance presets", Preset::ALL.map(setting).into())?;
        let taken: Vec<String> = points.iter().map(|point| point.setting.clone()).collect();
        for (point, preset) in points.iter_mut().zip(Preset::ALL) {
            point.setting = preset.to_string();
        }
        let choice = choice();
        Ok(Curve {
            knob: "radiance".to_owned(),
            question: format!("What do the presets of near emitters take? {}.", taken.join(", ")),
            norm: self.norm(),
            timed: format!(
                "sampling anew and light of all vertices of {}, device time of a frame; memory held is the receiver's, with \
                 room for as many samples as the limit, and that of the light",
                self.workload.description
            ),
            comparisons: interleave::compare(&points, &choice.setting).map_err(Failure::work)?,
            points,
            chosen: Some(choice),
        })
    }
}
