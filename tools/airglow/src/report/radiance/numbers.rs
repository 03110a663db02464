//! The numbers that the pass is held to, each measured.

use airglow::radiance::gpu::bench::Bench;
use airglow::radiance::{Lights, Part, PassSettings, Radiance, Receiver, Settings, Triangle};
use glam::DVec3;

use super::Measurement;
use super::curves::default_settings;
use crate::failure::{Failure, Outcome};
use crate::report::interleave::paired;
use crate::report::model::{Curve, Number};

impl Measurement<'_> {
    /// All of them.
    pub fn numbers(&self, bound: &Curve, reconstruction: &Curve) -> Outcome<Vec<Number>> {
        let mut numbers = vec![falls(bound)];
        numbers.extend(speed(reconstruction)?);
        numbers.extend(self.contrast()?);
        Ok(numbers)
    }

    /// Samples that settings take.
    pub fn samples(&self, pass: &PassSettings) -> Outcome<usize> {
        self.samples_of(pass, &self.workload.emitters)
    }

    /// Samples of other emitters; 0 where the pass is left out.
    fn samples_of(&self, pass: &PassSettings, emitters: &[Triangle]) -> Outcome<usize> {
        let run = self.device.bench();
        let bench = Bench { context: self.device.context(), run: &run };
        let tree = self.workload.tree(pass.order)?;
        // One vertex is lit: only samples count.
        let one = [Part { vertices: 0..1, turn: None }];
        let receiver = Receiver::new(bench.context, *pass, &tree, &self.workload.positions, &one);
        let receiver = receiver.map_err(Failure::work)?;
        let radiance = Radiance::new(bench.context, *pass).map_err(Failure::work)?;
        let lights = Lights { emitters, ..Lights::default() };
        let prepared = radiance.prepare(&receiver, &lights).map_err(Failure::work)?;
        if prepared.left_out.is_some() {
            return Ok(0);
        }
        let light = bench.light_buffers(&prepared).map_err(Failure::work)?;
        bench.frame(&prepared, &light).map_err(Failure::work)?;
        Ok(bench.refined(&receiver, &tree).map_err(Failure::work)?.0.samples.len())
    }

    /// Table 4.3 of Sun 2005: one bound, emitters near and far.
    fn contrast(&self) -> Outcome<Vec<Number>> {
        let mut pass = default_settings();
        pass.refinement = Settings { bound: 1e-3, limit: 1 << 14, ..pass.refinement };
        let far = |triangle: &Triangle| Triangle {
            corners: triangle.corners.map(|corner| 1e3 * corner + 1e4 * DVec3::Y),
            ..*triangle
        };
        let far: Vec<Triangle> = self.workload.emitters.iter().map(far).collect();
        let [near, far] = [self.samples(&pass)?, self.samples_of(&pass, &far)?];
        let none = self.samples_of(&pass, &[])?;
        Ok(vec![Number {
            what:
                "samples at a bound of 1e-3: emitters near, the same a thousand times as large and far, none"
                    .to_owned(),
            asked: "hundreds, 1, 0".to_owned(),
            measured: format!("{near}, {far}, {none}"),
            holds: near >= 100 && far == 1 && none == 0,
        }])
    }
}

/// The error falls with each step of the bound.
fn falls(bound: &Curve) -> Number {
    let errors: Vec<f64> = bound.points.iter().filter_map(|point| point.error.setting).collect();
    let words: Vec<_> = errors.iter().map(|error| format!("{error:.4}")).collect();
    Number {
        what: "setting error at bounds from 0.3 to 0.001".to_owned(),
        asked: "falls with each".to_owned(),
        measured: words.join(", "),
        holds: errors.len() == bound.points.len() && errors.is_sorted_by(|a, b| a > b),
    }
}

/// The light of vertices against the rival's.
fn speed(reconstruction: &Curve) -> Outcome<Option<Number>> {
    let [with, without, .., all] = reconstruction.points.as_slice() else { return Ok(None) };
    let ratios = [with, without].map(|ours| paired(all, ours).map_err(Failure::work));
    let [with, without] = ratios;
    let (with, without) = (with?, without?);
    Ok(Some(Number {
        what: format!("time of {}, over that of domains with gradients", all.setting),
        asked: "at least 20".to_owned(),
        measured: format!(
            "{:.1} ({:.1} to {:.1}); over domains without gradients {:.1}",
            with.ratio, with.interval[0], with.interval[1], without.ratio
        ),
        holds: with.interval[0] >= 20.0,
    }))
}
