//! Time by the number of lights.

use airglow_scene::Scene;

use super::evaluators::Measurement;
use super::picture::Picture;
use crate::failure::Outcome;
use crate::report::model::Point;

impl Measurement<'_> {
    /// Points of so many lights each, all of which reach every pixel.
    pub fn lights_of(&self, scene: &Scene) -> Outcome<Vec<(f64, Point)>> {
        let curve = self.lights(&Picture::new(self.device, scene)?)?;
        // The frame without extinction has no pass.
        let lit = curve.points.into_iter().filter(|point| !point.setting.contains(','));
        let count = |point: &Point| point.setting.split(' ').next()?.parse().ok();
        Ok(lit.filter_map(|point| Some((count(&point)?, point))).collect())
    }
}
