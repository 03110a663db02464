//! The model's error: single scattering against all orders, by a Monte Carlo of a point light in an endless medium.

use std::f64::consts::FRAC_PI_2;

use airglow::fog::reference::multiple::LaterOrders;

use crate::failure::{Failure, Outcome};
use crate::report::model::{Curve, Errors, Point};

/// Walks of the Monte Carlo.
const WALKS: u32 = 20_000;

/// Optical distances of the light.
const DISTANCES: [f64; 6] = [0.1, 0.25, 0.5, 1.0, 2.0, 4.0];

/// Degrees between the directions of the root mean square.
const STEP: f64 = 1.0;

/// The share of the radiance that single scattering leaves out, at a right angle to the light and as root mean square
/// over the glow's peak.
pub struct Orders {
    later: LaterOrders,
}

impl Orders {
    /// Follows the walks.
    pub fn new() -> Self {
        Self { later: LaterOrders::simulate(WALKS) }
    }

    /// Left out at a right angle to the light, relative.
    pub fn pointwise(&self, optical: f64) -> Outcome<f64> {
        let orders = self.later.orders(optical, FRAC_PI_2).map_err(Failure::work)?;
        Ok(1.0 - orders.single / orders.all)
    }

    /// Root mean square over the peak.
    pub fn over_peak(&self, optical: f64) -> Outcome<f64> {
        self.later.rms_over_peak(optical, STEP).map_err(Failure::work)
    }

    /// Both measures by optical distance; the first is that of a scene.
    pub fn curves(&self, of_scene: f64) -> Outcome<[Curve; 2]> {
        let question = "How far is scattering once from all orders? An isotropic point light in an endless medium that \
                        scatters alike in all directions and absorbs nothing, by the optical distance of the light; \
                        the first is that of the scene's nearest lamp. No setting of the pass changes it.";
        let curve = |knob: &str, norm: String, error: &dyn Fn(f64) -> Outcome<f64>| {
            let points = std::iter::once(of_scene).chain(DISTANCES).map(|optical| {
                Ok(Point {
                    setting: format!("T {optical:.2}"),
                    milliseconds: Vec::new(),
                    memory: 0,
                    counts: Default::default(),
                    error: Errors { model: Some(error(optical)?), ..Errors::default() },
                    distribution: None,
                })
            });
            Ok(Curve {
                knob: knob.to_owned(),
                question: question.to_owned(),
                norm,
                timed: "nothing".to_owned(),
                points: points.collect::<Outcome<_>>()?,
                chosen: None,
                comparisons: Vec::new(),
            })
        };
        Ok([
            curve(
                "model, pointwise",
                "model: what is left out at 90 degrees from the light, relative to all orders".to_owned(),
                &|optical| self.pointwise(optical),
            )?,
            curve(
                "model, over the peak",
                format!(
                    "model: root mean square over directions each {STEP} degrees to 90, over the largest of them, at \
                     {STEP} degree: the thesis's measure, small because the glow's peak is high"
                ),
                &|optical| self.over_peak(optical),
            )?,
        ])
    }
}
