//! The shared presets of the pass, measured.

use airglow::fog::Settings;
use airglow::math::Preset;

use super::against_all_orders;
use super::evaluators::Measurement;
use super::orders::Orders;
use super::pass::NORM;
use super::picture::{Picture, SIDE};
use crate::failure::{Failure, Outcome};
use crate::report::interleave;
use crate::report::model::Curve;
use crate::report::presets::choice;

impl Measurement<'_> {
    /// Error, time and memory of each preset.
    pub(super) fn presets_of(&self, picture: &Picture, orders: &Orders) -> Outcome<Curve> {
        let settings = Preset::ALL.map(|preset| (preset.to_string(), Settings::from(preset)));
        let mut points = self.pass_points("fog presets", picture, &settings)?;
        for (point, (_, settings)) in points.iter_mut().zip(&settings) {
            point.memory = settings.picture_bytes([SIDE; 2]).unwrap_or(0);
        }
        let choice = choice();
        let mut curve = Curve {
            knob: "fog".to_owned(),
            question: "What do the presets of fog take?".to_owned(),
            norm: NORM.to_owned(),
            timed: format!("the pass on {}, device time; memory held is its picture", picture.words()),
            comparisons: interleave::compare(&points, &choice.setting).map_err(Failure::work)?,
            points,
            chosen: Some(choice),
        };
        against_all_orders(&mut curve, orders.over_peak(picture.nearest())?);
        Ok(curve)
    }
}
