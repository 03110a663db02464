//! What the pass is measured against: a sample at each vertex, and even samples that all vertices take all of.

use airglow::radiance::gpu::bench::Bench;
use airglow::radiance::gpu::{Global, GlobalWork, LightShape, TexelBuffers, TexelSettings, Texels};
use airglow::radiance::rivals::places;
use airglow::radiance::{PassSettings, Settings};
use airglow_gpu::{GpuError, Imports, Record, Recorder};
use airglow_graph::{Access, Graph, PassKind};
use glam::DVec3;

use super::Measurement;
use super::curves::default_settings;
use super::race::{Runner, Setting};
use crate::failure::{Failure, Outcome};
use crate::report::interleave;
use crate::report::model::{Choice, Curve, Errors, Point};
use crate::report::timed_plan::TimedPlan;

/// What a rival records.
pub type Work = Box<dyn Fn(&mut Recorder<'_>) -> Result<(), GpuError> + Send + Sync>;

impl Measurement<'_> {
    /// The pass among its rivals, at as many samples each.
    pub fn methods(&self) -> Outcome<Curve> {
        let mut runners = Vec::new();
        let mut chosen = String::new();
        for bound in [0.03, default_settings().refinement.bound, 0.003] {
            let pass = default_settings();
            let refinement = Settings { bound, ..pass.refinement };
            let ours = self
                .runner(Setting::new(format!("ours, bound {bound}"), PassSettings { refinement, ..pass }))?;
            for power in [1, 2, 4] {
                runners.push(self.even(ours.samples, power)?);
            }
            if bound == pass.refinement.bound {
                chosen = ours.point.setting.clone();
            }
            runners.push(ours);
        }
        runners.push(self.every_vertex()?);
        let points = self.race("methods", runners)?;
        Ok(Curve {
            knob: "method".to_owned(),
            question: "Samples where the oracle wants them, continued by gradients and weighed in their domains; as \
                       many spread evenly (Linde, Buzo, Gray), all of which every vertex weighs with 1/d^b (Sloan et al. \
                       2002); or one at each vertex?"
                .to_owned(),
            norm: self.norm(),
            timed: "sampling anew and light of all vertices, device time of a frame".to_owned(),
            comparisons: interleave::compare(&points, &chosen).map_err(Failure::work)?,
            chosen: Some(Choice { setting: chosen, reason: "the default bound".to_owned() }),
            points,
        })
    }

    /// Light of the vertices alone, from about 500 samples.
    pub fn reconstruction(&self) -> Outcome<Curve> {
        let pass = default_settings();
        let mut runners = Vec::new();
        let refinement = Settings { bound: 0.0, limit: 500, ..pass.refinement };
        for gradients in [true, false] {
            let name = if gradients { "domains, gradients" } else { "domains" };
            let setting = Setting::new(name, PassSettings { refinement, gradients, ..pass });
            runners.push(Runner { receiver: None, ..self.runner(setting)? });
        }
        let samples = runners[0].samples;
        runners.push(self.interpolation(samples)?);
        let points = self.race("reconstruction", runners)?;
        let chosen = points[0].setting.clone();
        Ok(Curve {
            knob: "reconstruction".to_owned(),
            question: "What does the light of all vertices take, once samples are there?".to_owned(),
            norm: self.norm(),
            timed: "light of all vertices from samples that stay, device time of a frame".to_owned(),
            comparisons: interleave::compare(&points, &chosen).map_err(Failure::work)?,
            chosen: Some(Choice { setting: chosen, reason: "the pass's own".to_owned() }),
            points,
        })
    }

    fn buffers(&self, bench: &Bench<'_>, points: &[DVec3]) -> Outcome<TexelBuffers> {
        bench.buffers(Self::shape(), &self.workload.emitters, points).map_err(Failure::work)
    }

    /// Samples of the default order without gradients.
    pub fn shape() -> LightShape {
        LightShape { order: default_settings().order, gradients: false }
    }

    fn texels(&self) -> Outcome<Texels> {
        let PassSettings { face, rays, .. } = default_settings();
        let settings = TexelSettings { shape: Self::shape(), size: face, rays };
        Texels::new(self.device.context(), settings).map_err(Failure::work)
    }

    /// A sample at each vertex: the ground truth of the thesis.
    fn every_vertex(&self) -> Outcome<Runner> {
        let run = self.device.bench();
        let bench = Bench { context: self.device.context(), run: &run };
        let texels = self.texels()?;
        let points: Vec<DVec3> = (0..self.workload.positions.len()).map(|v| self.workload.point(v)).collect();
        let lights = bench.texels(&texels, &self.workload.emitters, &points).map_err(Failure::work)?;
        let light: Vec<[f32; 3]> =
            lights.iter().flat_map(|l| &l.coefficients).map(|l| l.as_vec3().to_array()).collect();
        let order = default_settings().order;
        let error = self.workload.errors(order, &self.workload.colours(order, &light), false)?;
        let buffers = self.buffers(&bench, &points)?;
        let bytes = Self::shape().light_bytes(points.len());
        let work: Work = Box::new(move |recorder| texels.record(recorder, &buffers));
        self.rival("a sample at each vertex".to_owned(), points.len(), bytes, error, work)
    }

    /// Even samples and their interpolation.
    fn even(&self, samples: usize, power: u32) -> Outcome<Runner> {
        let run = self.device.bench();
        let bench = Bench { context: self.device.context(), run: &run };
        let texels = self.texels()?;
        let places = places(&self.workload.positions, samples);
        let buffers = self.buffers(&bench, &places)?;
        let (global, work) = self.global(&bench, &buffers, power)?;
        let record: Work = {
            let (global, work) = (global.clone(), work.clone());
            Box::new(move |recorder| {
                texels.record(recorder, &buffers)?;
                recorder.memory_barrier(Access::ComputeStorageWrite, Access::ComputeStorageRead)?;
                global.record(recorder, &work)
            })
        };
        (bench.run)(&mut |recorder| record(recorder)).map_err(Failure::work)?;
        let light: Vec<[f32; 3]> = bench.read(&work.light).map_err(Failure::work)?;
        let order = default_settings().order;
        let error = self.workload.errors(order, &self.workload.colours(order, &light), false)?;
        let count = places.len();
        let name = format!("even, 1/d^{power} ({count} samples)");
        self.rival(name, count, Self::shape().light_bytes(count) + work.light.size(), error, record)
    }

    /// The interpolation alone.
    fn interpolation(&self, samples: usize) -> Outcome<Runner> {
        let run = self.device.bench();
        let bench = Bench { context: self.device.context(), run: &run };
        let places = places(&self.workload.positions, samples);
        let buffers = self.buffers(&bench, &places)?;
        let (global, work) = self.global(&bench, &buffers, 2)?;
        let bytes = Self::shape().light_bytes(places.len()) + work.light.size();
        let record: Work = Box::new(move |recorder| global.record(recorder, &work));
        let name = format!("all samples at each vertex ({} samples)", places.len());
        self.rival(name, places.len(), bytes, Errors::default(), record)
    }

    fn global(&self, bench: &Bench<'_>, buffers: &TexelBuffers, power: u32) -> Outcome<(Global, GlobalWork)> {
        let positions: Vec<[f32; 4]> =
            self.workload.positions.iter().map(|[x, y, z]| [*x, *y, *z, 0.0]).collect();
        let bytes = default_settings().light_bytes() * positions.len() as u64;
        let work = GlobalWork {
            points: buffers.points.clone(),
            lights: buffers.lights.clone(),
            samples: (buffers.points.size() / 16) as u32,
            positions: bench.upload("positions", &positions).map_err(Failure::work)?,
            vertices: positions.len() as u32,
            light: bench.scratch("light", bytes).map_err(Failure::work)?,
            power,
        };
        Ok((Global::new(bench.context, Self::shape()).map_err(Failure::work)?, work))
    }

    /// A plan of one pass.
    pub fn rival(
        &self,
        setting: String,
        samples: usize,
        bytes: u64,
        error: Errors,
        work: Work,
    ) -> Outcome<Runner> {
        let mut graph: Graph<Record> = Graph::new();
        let mut pass = graph.pass("rival", PassKind::Compute);
        pass.side_effect();
        pass.record(Box::new(move |recorder, _| work(recorder)));
        let plan = TimedPlan::new(self.device, setting.clone(), graph, Imports::new())?;
        let (milliseconds, counts) = (Vec::new(), Default::default());
        let mut point = Point { setting, milliseconds, memory: bytes, counts, error, distribution: None };
        point.counts.bytes = 2 * bytes;
        Ok(Runner { point, plan, receiver: None, samples })
    }
}
