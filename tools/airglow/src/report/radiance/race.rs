//! Settings of the pass against one another: each drawn once for its errors, and all in turn for their times.

use airglow::radiance::gpu::bench::Bench;
use airglow::radiance::reference::Cube;
use airglow::radiance::{
    Lights, Part, PassSettings, Radiance, Receiver, Reconstruction, Refined, Triangle, Weights,
};
use airglow_gpu::Imports;
use airglow_graph::{Access, Graph};
use airglow_math::statistics::relative_l2;
use glam::DVec3;

use super::workload::Workload;
use super::{Measurement, parallel};
use crate::failure::{Failure, Outcome};
use crate::measure::near;
use crate::report::interleave::{self, Rounds};
use crate::report::model::{Errors, Point};
use crate::report::relight::truth::flat;
use crate::report::timed_plan::TimedPlan;

/// One way to light the workload.
pub struct Setting {
    /// Its name, to which the number of its samples is added.
    pub name: String,
    /// The pass.
    pub pass: PassSettings,
    /// Other emitters than the workload's.
    pub emitters: Option<Vec<Triangle>>,
    /// Whether its converged setting is a sample at each vertex of its own faces: what more samples lead to.
    pub same_rays: bool,
}

/// A plan on the starting line.
pub struct Runner {
    /// The point that its times go to.
    pub point: Point,
    /// What is timed.
    pub plan: TimedPlan,
    /// Whose samples are forgotten before each frame; `None` where nothing is taken anew.
    pub receiver: Option<Receiver>,
    /// Samples that it takes.
    pub samples: usize,
}

impl Setting {
    /// Settings of the workload's own emitters.
    pub fn new(name: impl Into<String>, pass: PassSettings) -> Self {
        Self { name: name.into(), pass, emitters: None, same_rays: false }
    }

    /// The same, whose converged setting is a sample at each vertex of its own faces.
    pub fn of_same_rays(self) -> Self {
        Self { same_rays: true, ..self }
    }
}

impl Measurement<'_> {
    /// The points of some settings.
    pub fn settings(&self, what: &str, settings: Vec<Setting>) -> Outcome<Vec<Point>> {
        let runners = settings.into_iter().map(|setting| self.runner(setting));
        self.race(what, runners.collect::<Outcome<_>>()?)
    }

    /// Times runners in turn.
    pub fn race(&self, what: &str, mut runners: Vec<Runner>) -> Outcome<Vec<Point>> {
        let Rounds { warm_up, measured } = self.effort.rounds;
        let bar = self.output.progress(what, ((warm_up + measured) * runners.len()) as u64, "frames");
        let times = interleave::measure(self.effort.rounds, runners.len(), |place| {
            bar.inc(1);
            let runner = &mut runners[place];
            runner.receiver.iter().for_each(Receiver::forget_samples);
            runner.plan.run(self.device)
        })?;
        bar.finish_and_clear();
        let timed = |(Runner { point, plan, .. }, milliseconds): (Runner, Vec<f64>)| {
            let counts = plan.counts(point.counts.bytes);
            Point { milliseconds, counts, ..point }
        };
        Ok(runners.into_iter().zip(times).map(timed).collect())
    }

    /// A setting with its errors.
    pub fn runner(&self, setting: Setting) -> Outcome<Runner> {
        let (device, workload) = (self.device, self.workload);
        let run = device.bench();
        let bench = Bench { context: device.context(), run: &run };
        let Setting { name, pass, emitters, same_rays } = setting;
        let emitters = emitters.as_deref().unwrap_or(&workload.emitters);
        let tree = workload.tree(pass.order)?;
        let part = Part { vertices: 0..workload.positions.len() as u32, turn: None };
        let receiver = Receiver::new(bench.context, pass, &tree, &workload.positions, &[part]);
        let receiver = receiver.map_err(Failure::work)?;
        let radiance = Radiance::new(bench.context, pass).map_err(Failure::work)?;
        let lights = Lights { emitters, ..Lights::default() };
        let prepared = radiance.prepare(&receiver, &lights).map_err(Failure::work)?;
        let buffers = bench.light_buffers(&prepared).map_err(Failure::work)?;
        bench.frame(&prepared, &buffers).map_err(Failure::work)?;
        let light = bench.light::<[f32; 3]>(&buffers).map_err(Failure::work)?.concat();
        let (refined, _) = bench.refined(&receiver, &tree).map_err(Failure::work)?;
        let colours = workload.colours(pass.order, &light);
        let samples = refined.samples.len();
        let records: Vec<[f32; 4]> = bench.read(&receiver.samples().lights).map_err(Failure::work)?;
        let exact = near::closed_forms(&records, receiver.shape()).take(samples).collect();
        let limited = if refined.limited { ", at the limit" } else { "" };
        let shape = receiver.shape();
        let taken = shape.light_bytes(samples) + shape.gradient_bytes(samples);
        let lit = pass.light_bytes() * workload.positions.len() as u64;
        let mut point = Point {
            setting: format!("{name} ({samples} samples{limited})"),
            milliseconds: Vec::new(),
            memory: receiver.bytes() + lit,
            counts: Default::default(),
            error: Errors {
                arithmetic: Some(arithmetic(workload, &pass, (refined, exact), emitters, &colours)?),
                ..workload.errors(pass.order, &colours, same_rays)?
            },
            distribution: None,
        };
        point.counts.bytes = 2 * taken + lit + 16 * workload.positions.len() as u64;
        let (mut graph, mut imports) = (Graph::new(), Imports::new());
        let added = radiance.add(&mut graph, &mut imports, &receiver, &lights).map_err(Failure::work)?;
        for light in added.light {
            graph.export(light, Access::ComputeStorageRead);
        }
        let plan = TimedPlan::new(device, name, graph, imports)?;
        Ok(Runner { point, plan, receiver: Some(receiver), samples })
    }
}

impl Workload {
    /// Errors against a sample at each vertex of the same order, of the finest rays or of [`FINE`](super::workload::FINE) ones; and against the
    /// ray-traced truth.
    pub fn errors(&self, order: usize, colours: &[[f32; 3]], same_rays: bool) -> Outcome<Errors> {
        let converged = if same_rays { self.fine(order) } else { self.finest(order) };
        let setting = relative_l2(&flat(colours), &flat(&converged)).map_err(Failure::work)?;
        Ok(Errors {
            arithmetic: None,
            setting: Some(setting),
            model: Some(self.truth.error(colours)?),
            model_p95: Some(self.truth.error_p95(colours)?),
        })
    }
}

/// Relative root mean square difference of the colours from those of the same rays and interpolation in f64; samples that are
/// `exact`, closed forms, are taken as they are.
fn arithmetic(
    workload: &Workload,
    pass: &PassSettings,
    (mut refined, exact): (Refined, Vec<bool>),
    emitters: &[Triangle],
    colours: &[[f32; 3]],
) -> Outcome<f64> {
    let cube = Cube::new(pass.order, pass.face as usize).and_then(|cube| cube.with_rays(pass.rays as usize));
    let mut cube = cube.map_err(Failure::work)?;
    if pass.gradients {
        cube = cube.with_gradients();
    }
    let points: Vec<DVec3> = refined.samples.iter().map(|sample| sample.point).collect();
    let lights = parallel(points.len(), |place| cube.sample(points[place], emitters));
    for ((sample, light), exact) in refined.samples.iter_mut().zip(lights).zip(exact) {
        if !exact {
            sample.light = light.map_err(Failure::work)?;
        }
    }
    let reconstruction = Reconstruction::new(&refined, Weights::Compact, pass.gradients);
    let mut light = Vec::with_capacity(pass.order * pass.order * workload.positions.len());
    let mut vector = vec![DVec3::ZERO; pass.order * pass.order];
    for vertex in 0..workload.positions.len() {
        reconstruction.light(workload.point(vertex), &mut vector).map_err(Failure::work)?;
        light.extend(vector.iter().map(|l| l.as_vec3().to_array()));
    }
    let expected = workload.colours(pass.order, &light);
    relative_l2(&flat(colours), &flat(&expected)).map_err(Failure::work)
}
