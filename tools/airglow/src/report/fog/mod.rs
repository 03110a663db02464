//! The report on fog: its evaluator among its rivals, the knobs, and the numbers it is held to.

mod choice;
mod evaluators;
mod numbers;
mod orders;
mod pass;
mod picture;
mod presets;
mod random;
mod scaling;
mod table_sizes;

use airglow_scene::Scene;

pub use evaluators::{Effort, Measurement};
use orders::Orders;
use picture::Picture;
use random::Range;

use crate::failure::Outcome;
use crate::report::model::{Curve, Number};

/// What a report is made of.
pub struct Measured {
    /// What was measured on.
    pub workload: String,
    /// What a reader must know.
    pub remarks: Vec<String>,
    /// The curves.
    pub curves: Vec<Curve>,
    /// What the pass is held to.
    pub numbers: Vec<Number>,
}

impl Measurement<'_> {
    /// Everything.
    pub fn all(&self, scene: &Scene) -> Outcome<Measured> {
        let picture = Picture::new(self.device, scene)?;
        let orders = Orders::new();
        let whole = self.evaluators("evaluator", &Range::WHOLE)?;
        let of_table = self.evaluators("evaluator, in the table's domain", &Range::OF_TABLE)?;
        let seen = self.seen(&picture)?;
        let knobs = self.knobs(&picture, &orders)?;
        let lights = self.lights(&picture)?;
        let mut numbers = self.precision()?;
        numbers.extend(numbers::times(&whole, &of_table)?);
        numbers.extend(numbers::seen(&knobs[0]));
        numbers.extend(numbers::lights(&lights));
        let sizes = table_sizes::curve(&of_table)?;
        let mut curves = vec![whole, of_table, sizes, seen];
        curves.extend(knobs);
        curves.push(lights);
        curves.extend(orders.curves(picture.nearest())?);
        Ok(Measured { workload: picture.words(), remarks: self.remarks(), curves, numbers })
    }

    /// A scene's knobs alone: what was measured on, and the curves.
    pub fn explain(&self, scene: &Scene) -> Outcome<(String, Vec<Curve>)> {
        let picture = Picture::new(self.device, scene)?;
        let mut curves = self.knobs(&picture, &Orders::new())?;
        curves.insert(0, self.seen(&picture)?);
        Ok((picture.words(), curves))
    }

    /// The shared presets on a scene.
    pub fn presets(&self, scene: &Scene) -> Outcome<Curve> {
        self.presets_of(&Picture::new(self.device, scene)?, &Orders::new())
    }

    /// The knobs of the pass on a picture, each error of its own.
    fn knobs(&self, picture: &Picture, orders: &Orders) -> Outcome<Vec<Curve>> {
        let model = orders.over_peak(picture.nearest())?;
        let mut curves = vec![self.preset(picture)?, self.bound(picture)?];
        curves.iter_mut().for_each(|curve| against_all_orders(curve, model));
        Ok(curves)
    }

    fn remarks(&self) -> Vec<String> {
        vec![
            format!(
                "Evaluators are timed with {} lights for each ray that is read, the next a little farther off the ray \
                 than the last, and times are given for one; {} rounds of all in turn after {} of warm-up.",
                evaluators::REPEATS,
                self.effort.rounds.measured,
                self.effort.rounds.warm_up
            ),
            "On random rays neighbouring pixels have nothing in common, which is the worst case for an evaluator with \
             branches; on the picture they are alike."
                .to_owned(),
        ]
    }
}

/// Gives every point of a curve the error of the model, which no knob changes.
fn against_all_orders(curve: &mut Curve, model: f64) {
    curve.norm.push_str(
        ". model: single scattering against all orders, root mean square over the glow's peak, at the optical distance of \
         the nearest lamp; no knob changes it",
    );
    curve.points.iter_mut().for_each(|point| point.error.model = Some(model));
}
