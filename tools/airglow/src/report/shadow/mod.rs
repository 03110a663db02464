//! The report on shadows: every exponential among chained products, the knobs against rays, and the numbers the pass is held
//! to.

mod knobs;
mod methods;
mod numbers;
mod presets;
mod scaling;
mod shading;

use airglow::shadow::bench::{Bench, SphereKernel};
use airglow::shadow::{Blockers, Settings, Shadow, ShadowError};
use airglow_scene::Scene;

use super::interleave::{self, Rounds};
use super::model::{Counts, Curve, Errors, Number, Point};
use crate::failure::{Failure, Outcome};
use crate::host::device::Device;
use crate::output::Output;

/// How much is measured.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    rounds: Rounds,
    /// Receivers along a side of the ground that is timed.
    side: usize,
    /// Receivers whose error is measured.
    probes: usize,
    /// Rays for each vertex of the truth of shading.
    rays: u32,
}

impl Effort {
    /// As in reports, or quickly.
    pub fn new(quick: bool) -> Self {
        match quick {
            true => Self { rounds: Rounds { warm_up: 1, measured: 5 }, side: 48, probes: 32, rays: 512 },
            false => Self { rounds: Rounds { warm_up: 2, measured: 9 }, side: 64, probes: 64, rays: 2048 },
        }
    }
}

/// Measures on a device.
pub struct Measurement<'a> {
    /// The device.
    pub device: &'a Device<'a>,
    /// How much.
    pub effort: Effort,
    /// Where remarks go.
    pub output: &'a Output,
}

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

/// A pass that is timed among others: its name, its settings, its kernel.
#[derive(Clone, Debug)]
struct Rival {
    name: String,
    settings: Settings,
    kernel: SphereKernel,
}

impl Measurement<'_> {
    /// Everything.
    pub fn all(&self, scene: &Scene) -> Outcome<Measured> {
        let shading = shading::Shading::new(self, scene)?;
        self.output.say("timing exponentials and chained products");
        let (methods, mut numbers) = methods::curves(self, &shading.spheres)?;
        self.output.say("turning knobs against rays");
        let mut curves = knobs::curves(self, &shading)?;
        curves.extend(methods);
        numbers.extend(numbers::products(self)?);
        numbers.push(numbers::fit(self)?);
        Ok(Measured { workload: shading.words(), remarks: remarks(&self.effort), curves, numbers })
    }

    /// A scene's knobs alone: what was measured on, and the curves.
    pub fn explain(&self, scene: &Scene) -> Outcome<(String, Vec<Curve>)> {
        let shading = shading::Shading::new(self, scene)?;
        Ok((shading.words(), knobs::curves(self, &shading)?))
    }

    /// Times rivals in turn over receivers, with their normals where they have them; each with the visibility and the counts
    /// of its last run, behind the blockers of each.
    fn interleaved(
        &self,
        rivals: &[Rival],
        positions: &[[f32; 3]],
        normals: Option<&[[f32; 3]]>,
        blockers: impl Fn(&Rival) -> Blockers,
    ) -> Outcome<Vec<(Point, Vec<f32>)>> {
        let run = self.device.bench();
        let bench = Bench { context: self.device.context(), run: &run };
        let made: Result<Vec<Shadow>, ShadowError> =
            rivals.iter().map(|rival| bench.shadow(rival.settings, rival.kernel)).collect();
        let made = made.map_err(Failure::work)?;
        let blockers: Vec<Blockers> = rivals.iter().map(blockers).collect();
        let mut last = vec![(Vec::new(), 0); rivals.len()];
        let times = interleave::measure(self.effort.rounds, rivals.len(), |rival| {
            let frame = bench.blocked(&made[rival], positions, normals, &blockers[rival], 1)?;
            last[rival] = (frame.values, frame.counts.spheres);
            Ok::<f64, ShadowError>(1e3 * frame.times.first().map_or(0.0, std::time::Duration::as_secs_f64))
        });
        let rows = times.map_err(Failure::work)?.into_iter().zip(last).zip(rivals);
        Ok(rows
            .map(|((milliseconds, (values, spheres)), rival)| {
                let count = positions.len() as u64;
                let order = rival.settings.order as u64;
                let point = Point {
                    setting: rival.name.clone(),
                    milliseconds,
                    memory: 4 * order * order * count,
                    counts: Counts {
                        bytes: (12 + 4 * order * order) * count + 16 * spheres,
                        invocations: count.next_multiple_of(64),
                        dispatches: 1,
                        ..Counts::default()
                    },
                    error: Errors::default(),
                    distribution: None,
                };
                (point, values)
            })
            .collect())
    }
}

fn remarks(effort: &Effort) -> Vec<String> {
    vec![
        format!(
            "Times are of one submission of the pass with its wait, over {0} x {0} receivers on the ground in methods and \
             over the receivers of the scene in knobs; {1} rounds of all rivals in turn after {2} of warm-up.",
            effort.side, effort.rounds.measured, effort.rounds.warm_up
        ),
        "The setting error of methods is the root mean square over the sphere of the difference from the projection of what \
         the spheres really leave open. The model error of knobs is of the colours of a white ground under the scene's \
         environment, over their root mean square, against rays to the figures' own triangles; static shadows are in \
         neither."
            .to_owned(),
        "First runs include the driver's compiler unless its disk cache holds the shader; MESA_SHADER_CACHE_DISABLE=1 \
         switches that of Mesa off."
            .to_owned(),
    ]
}
