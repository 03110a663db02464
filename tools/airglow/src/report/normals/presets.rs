//! The shared presets of the room, measured.

use airglow::math::Preset;
use airglow::normals::{Bench, Method, Settings};

use super::steps::{self, BRDF};
use super::workload::Map;
use super::{Measurement, memory, shading, words};
use crate::failure::{Failure, Outcome};
use crate::report::interleave;
use crate::report::model::{Curve, Errors, Point};
use crate::report::presets::choice;

impl Measurement<'_> {
    /// Error, time and memory of each preset on a map.
    pub fn presets(&self, map: &Map) -> Outcome<Curve> {
        let run = self.device.bench();
        let bench = Bench { context: self.device.context(), run: &run };
        let settings = Preset::ALL.map(Settings::from);
        let methods = settings.map(|settings| Method::Lobes(settings.fit.lobes));
        let times = shading::times(self, map, BRDF, &methods)?;
        let mut points = Vec::new();
        for ((preset, settings), (method, (milliseconds, counts))) in
            Preset::ALL.into_iter().zip(settings).zip(methods.into_iter().zip(times))
        {
            let model = Some(steps::error(&bench, &map.normals, &settings)?);
            points.push(Point {
                setting: preset.to_string(),
                milliseconds,
                memory: memory(map, method),
                counts,
                error: Errors { model, ..Errors::default() },
                distribution: None,
            });
        }
        let choice = choice();
        Ok(Curve {
            knob: "normals".to_owned(),
            question: "What do the presets of normal maps take?".to_owned(),
            norm: "model: relative L2 of the radiance over all levels, against the mean of all texels"
                .to_owned(),
            timed: format!(
                "device time of looking up, bilinear in one level, and shading one light by {} at {1} x {1} pixels, of {2}",
                words(BRDF),
                shading::SIDE,
                map.words()
            ),
            comparisons: interleave::compare(&points, &choice.setting).map_err(Failure::work)?,
            points,
            chosen: Some(choice),
        })
    }
}
