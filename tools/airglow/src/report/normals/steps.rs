//! What the steps of a fit are worth: error against the time of a build.

use std::time::Instant;

use airglow::math::statistics::{median, relative_l2};
use airglow::normals::bench::Row;
use airglow::normals::{Bench, Brdf, Directions, FitSettings, NormalMap, Settings, reference};
use glam::DVec3;

use super::Measurement;
use super::workload::Map;
use crate::failure::{Failure, Outcome};
use crate::report::interleave;
use crate::report::model::{Choice, Curve, Errors, Number, Point};

/// Numbers of steps, and lobes of each fit.
const STEPS: [usize; 6] = [0, 4, 8, 12, 20, 32];
const LOBES: usize = 4;
/// What errors are taken at.
pub(super) const BRDF: Brdf = Brdf::BlinnPhong { exponent: 50.0 };
/// Where builds are timed: the goal is for a map of this size.
const GOAL: usize = 1024;

impl Measurement<'_> {
    /// The curve of the steps, and the numbers of a build.
    pub fn steps(&self, map: &Map) -> Outcome<(Curve, Vec<Number>)> {
        let normals = map.repeated(self.effort.side)?;
        let run = self.device.bench();
        let bench = Bench { context: self.device.context(), run: &run };
        let rounds = self.effort.build_rounds();
        let bar =
            self.output.progress("builds", (STEPS.len() * (rounds.warm_up + rounds.measured)) as u64, "maps");
        let times = interleave::measure(rounds, STEPS.len(), |at| {
            bar.inc(1);
            let begin = Instant::now();
            bench.texture(&normals, &settings(STEPS[at])).map_err(Failure::work)?;
            Ok::<_, Failure>(1e3 * begin.elapsed().as_secs_f64())
        })?;
        bar.finish_and_clear();
        let memory =
            settings(0).storage.lobe_bytes() * LOBES as u64 * (self.effort.side * self.effort.side) as u64
                / 3;
        let mut points = Vec::new();
        for (steps, milliseconds) in STEPS.into_iter().zip(times) {
            let error =
                Errors { model: Some(error(&bench, &map.normals, &settings(steps))?), ..Errors::default() };
            let counts = Default::default();
            let setting = format!("{steps} steps");
            points.push(Point { setting, milliseconds, memory, counts, error, distribution: None });
        }
        let numbers = self.build_numbers(&points)?;
        let setting = format!("{} steps", FitSettings::default().iterations);
        let reason =
            "the default: further steps change the error by less than the map's own texels do".to_owned();
        let comparisons = interleave::compare(&points, &setting).map_err(Failure::work)?;
        let curve = Curve {
            knob: "steps of the fit".to_owned(),
            question: "How many steps of expectation and maximisation are worth their time?".to_owned(),
            norm: format!("relative L2 of the radiance at exponent 50, over all levels of {}", map.name),
            timed: format!(
                "wall clock of building {0} x {0} texels with {LOBES} lobes, texture included",
                self.effort.side
            ),
            points,
            chosen: Some(Choice { setting, reason }),
            comparisons,
        };
        Ok((curve, numbers))
    }

    /// Time of a build, by texel and by step.
    fn build_numbers(&self, points: &[Point]) -> Outcome<Vec<Number>> {
        let default = FitSettings::default().iterations;
        let seconds = |steps: usize| -> Outcome<f64> {
            let at = STEPS.iter().position(|&of| of == steps).unwrap_or(0);
            Ok(1e-3 * median(&points[at].milliseconds).map_err(Failure::work)?)
        };
        let texels = (self.effort.side * self.effort.side) as f64;
        let (built, none, most) = (seconds(default)?, seconds(0)?, seconds(STEPS[STEPS.len() - 1])?);
        let of_step = (most - none) / STEPS[STEPS.len() - 1] as f64 / texels;
        let whole = built / texels * (GOAL * GOAL) as f64;
        Ok(vec![Number {
            what: format!("building {GOAL} x {GOAL} with {LOBES} lobes and {default} steps"),
            asked: "under 10 s on a software driver with 2 cores".to_owned(),
            measured: format!(
                "{whole:.1} s (measured at {0} x {0}): {1:.2} us a texel, of which a step takes {2:.0} ns",
                self.effort.side,
                1e6 * built / texels,
                1e9 * of_step
            ),
            holds: whole < 10.0,
        }])
    }
}

fn settings(iterations: usize) -> Settings {
    let fit = FitSettings { lobes: LOBES, iterations, ..FitSettings::default() };
    Settings { fit, budget: Some(u64::MAX), ..Settings::default() }
}

/// The error of a chain over a few texels of each level, at the highlights of its own lobes.
pub(super) fn error(bench: &Bench<'_>, normals: &NormalMap, settings: &Settings) -> Outcome<f64> {
    let levels = bench.build(normals, settings).map_err(Failure::work)?;
    let count = settings.fit.lobes;
    let (mut rows, mut truths) = (Vec::new(), Vec::new());
    for (finer, level) in levels.iter().enumerate().skip(1) {
        for at in 0..16 {
            let texels = level.size[0] * level.size[1];
            let texel = at * texels / 16;
            let (x, y) = (texel % level.size[0], texel / level.size[0]);
            let footprint = normals.footprint(finer + 1, x, y).map_err(Failure::work)?;
            let half = footprint[at * footprint.len() / 16].mean;
            let light = (half + DVec3::new(0.3, -0.2, 0.1)).normalize();
            let view = 2.0 * light.dot(half) * half - light;
            let directions = Directions::new(light, view).map_err(Failure::work)?;
            truths.push(reference::radiance(&footprint, BRDF, directions));
            let lobes = level.lobes[texel * count..][..count].iter().map(|&lobe| lobe.into()).collect();
            rows.push(Row { lobes, brdf: BRDF, directions });
        }
    }
    let values: Vec<f64> = bench.radiance(&rows).map_err(Failure::work)?.into_iter().map(f64::from).collect();
    relative_l2(&values, &truths).map_err(Failure::work)
}
