//! One receiver on a device: the pass and its rival, their errors and their times.

use std::time::Instant;

use airglow_gpu::{Buffer, GpuError, Recorder};
use airglow_graph::Access;
use airglow_math::statistics::{Interval, median, paired_ratio_interval};
use airglow_radiance::gpu::bench::Bench;
use airglow_radiance::gpu::{Global, GlobalWork, LightShape, TexelBuffers, TexelSettings, Texels};
use airglow_radiance::{
    Lights, Part, PassSettings, Prepared, Radiance, RadianceError, Receiver, Reconstruction, Refined,
    Settings, Triangle, Weights, rivals,
};
use glam::DVec3;

use super::scene::{Failure, Placed};

/// Rays along a side of a texel: the pass's default.
pub const RAYS: u32 = 4;
/// Samples of a dispatch where every vertex is sampled.
const BATCH: usize = 4096;
/// Frames timed, after one that is not.
const ROUNDS: usize = 5;
/// Pairs of a race, after one that is not timed.
const PAIRS: usize = 11;

/// The receiver with its true colours, and the pass without and with gradients.
pub struct Lab<'a> {
    pub bench: &'a Bench<'a>,
    pub placed: &'a Placed,
    /// Texels along a side of a face, of truth and samples alike.
    pub face: u32,
    truth: Vec<DVec3>,
    radiance: [Radiance; 2],
}

/// A receiver's frame, ready to be drawn.
struct Frame {
    receiver: Receiver,
    prepared: Prepared,
    light: Vec<Buffer>,
}

/// What a method took and left.
pub struct Outcome {
    pub samples: usize,
    pub limited: bool,
    pub error: f64,
    /// Seconds.
    pub sampling: f64,
    pub reconstruction: f64,
}

/// The rival's samples on the device.
pub struct Even {
    count: usize,
    buffers: TexelBuffers,
    texels: Texels,
    global: Global,
    work: GlobalWork,
}

impl<'a> Lab<'a> {
    /// Samples light at every vertex, for the truth; also the seconds that this takes.
    pub fn new(bench: &'a Bench<'a>, placed: &'a Placed, face: u32) -> Result<(Self, f64), Failure> {
        let shape = LightShape { order: placed.order, gradients: false };
        let texels = Texels::new(bench.context, TexelSettings { shape, size: face, rays: RAYS })?;
        let settings = |gradients| PassSettings {
            order: placed.order,
            gradients,
            face,
            rays: RAYS,
            ..PassSettings::default()
        };
        let pass = |gradients| Radiance::new(bench.context, settings(gradients));
        let (mut truth, mut seconds) = (Vec::new(), 0.0);
        let points = placed.points();
        // The first dispatch compiles.
        bench.texels(&texels, &placed.emitters, &points[..1])?;
        for (batch, points) in points.chunks(BATCH).enumerate() {
            let buffers = bench.buffers(shape, &placed.emitters, points)?;
            seconds += timed(bench, &mut |recorder| texels.record(recorder, &buffers))?;
            let lights =
                bench.incidents(shape, points.len(), buffers.lights.buffer(), buffers.gradients.buffer())?;
            truth.extend(
                (batch * BATCH..).zip(lights).map(|(v, light)| placed.colour(v, &light.coefficients)),
            );
        }
        Ok((Self { bench, placed, face, truth, radiance: [pass(false)?, pass(true)?] }, seconds))
    }

    fn lights(&self) -> Lights<'_> {
        Lights { emitters: &self.placed.emitters, ..Lights::default() }
    }

    fn frame(&self, refinement: Settings, gradients: bool, lit: bool) -> Result<Frame, RadianceError> {
        let radiance = &self.radiance[usize::from(gradients)];
        let settings = PassSettings { refinement, ..*radiance.settings() };
        let vertices = if lit { self.placed.positions.len() as u32 } else { 1 };
        let parts = [Part { vertices: 0..vertices, turn: None }];
        let (tree, positions) = (&self.placed.tree, &self.placed.positions);
        let receiver = Receiver::new(self.bench.context, settings, tree, positions, &parts)?;
        let prepared = radiance.prepare(&receiver, &self.lights())?;
        let light = self.bench.light_buffers(&prepared)?;
        self.bench.frame(&prepared, &light)?;
        Ok(Frame { receiver, prepared, light })
    }

    /// Samples of these settings, read back.
    pub fn refined(&self, refinement: Settings, gradients: bool) -> Result<Refined, Failure> {
        let frame = self.frame(refinement, gradients, false)?;
        Ok(self.bench.refined(&frame.receiver, &self.placed.tree)?.0)
    }

    /// The settings whose bound takes as near to `count` samples as there is and no more, by bisection.
    pub fn settings_for(&self, count: usize, settings: Settings) -> Result<Settings, Failure> {
        let (mut low, mut high) = (1e-5_f64, 1e2_f64);
        for _ in 0..11 {
            let middle = (low * high).sqrt();
            let tried = Settings { bound: middle, limit: 2 * count, ..settings };
            if self.refined(tried, false)?.samples.len() > count { low = middle } else { high = middle }
        }
        Ok(Settings { bound: high, limit: 2 * count, ..settings })
    }

    /// The pass's frame: with the time of sampling anew, and of vertices alone, which is a frame in which nothing moved.
    pub fn pass(&self, refinement: Settings, gradients: bool) -> Result<Outcome, Failure> {
        let frame = self.frame(refinement, gradients, true)?;
        let (mut whole, mut kept) = (Vec::new(), Vec::new());
        for _ in 0..ROUNDS {
            frame.receiver.forget_samples();
            whole.push(self.frame_seconds(&frame)?);
            kept.push(self.frame_seconds(&frame)?);
        }
        let (refined, _) = self.bench.refined(&frame.receiver, &self.placed.tree)?;
        let light = self.bench.light::<[f32; 3]>(&frame.light)?.concat();
        let reconstruction = median(&kept)?;
        Ok(Outcome {
            samples: refined.samples.len(),
            limited: refined.limited,
            error: self.error(&light),
            sampling: median(&whole)? - reconstruction,
            reconstruction,
        })
    }

    fn frame_seconds(&self, frame: &Frame) -> Result<f64, RadianceError> {
        let begin = Instant::now();
        self.bench.frame(&frame.prepared, &frame.light)?;
        Ok(begin.elapsed().as_secs_f64())
    }

    /// The thesis's own interpolation of samples, on the CPU: its error.
    pub fn inverse(&self, refined: &Refined) -> Result<f64, Failure> {
        let reconstruction = Reconstruction::new(refined, Weights::Inverse, false);
        let mut vector = vec![DVec3::ZERO; self.placed.order * self.placed.order];
        let mut light = Vec::with_capacity(self.truth.len() * vector.len());
        for vertex in 0..self.truth.len() {
            reconstruction.light(self.placed.point(vertex), &mut vector)?;
            light.extend(vector.iter().map(|l| l.as_vec3().to_array()));
        }
        Ok(self.error(&light))
    }

    /// As many even samples on the device.
    pub fn even(&self, count: usize) -> Result<Even, Failure> {
        let (bench, placed) = (self.bench, self.placed);
        let shape = LightShape { order: placed.order, gradients: false };
        let texels = Texels::new(bench.context, TexelSettings { shape, size: self.face, rays: RAYS })?;
        let places = rivals::places(&placed.positions, count);
        let buffers = bench.buffers(shape, &placed.emitters, &places)?;
        let points: Vec<[f32; 4]> = placed.positions.iter().map(|[x, y, z]| [*x, *y, *z, 0.0]).collect();
        let bytes = (12 * shape.coefficients() * points.len()) as u64;
        let work = GlobalWork {
            points: buffers.points.clone(),
            lights: buffers.lights.clone(),
            samples: places.len() as u32,
            positions: bench.upload("positions", &points)?,
            vertices: points.len() as u32,
            light: bench.scratch("light", bytes)?,
            power: 2,
        };
        let global = Global::new(bench.context, shape)?;
        Ok(Even { count: places.len(), buffers, texels, global, work })
    }

    /// The rival's error and times with a power of the distance.
    pub fn rival(&self, even: &Even, power: u32) -> Result<Outcome, Failure> {
        let work = GlobalWork { power, ..even.work.clone() };
        let (mut sampling, mut interpolation) = (Vec::new(), Vec::new());
        for _ in 0..=ROUNDS {
            sampling.push(timed(self.bench, &mut |recorder| even.texels.record(recorder, &even.buffers))?);
            interpolation.push(timed(self.bench, &mut |recorder| {
                recorder.memory_barrier(Access::ComputeStorageWrite, Access::ComputeStorageRead)?;
                even.global.record(recorder, &work)
            })?);
        }
        let light: Vec<[f32; 3]> = self.bench.read(&work.light)?;
        Ok(Outcome {
            samples: even.count,
            limited: false,
            error: self.error(&light),
            sampling: median(&sampling[1..])?,
            reconstruction: median(&interpolation[1..])?,
        })
    }

    /// The rival's time for the light of all vertices over the pass's from about as many samples, each run in turn: the median of
    /// the pairs' ratios, with an interval of confidence 0.95.
    pub fn race(&self, refinement: Settings, gradients: bool, even: &Even) -> Result<Interval, Failure> {
        let frame = self.frame(refinement, gradients, true)?;
        let (mut ours, mut rivals) = (Vec::new(), Vec::new());
        for round in 0..=PAIRS {
            let all = timed(self.bench, &mut |recorder| even.global.record(recorder, &even.work))?;
            let kept = self.frame_seconds(&frame)?;
            if round > 0 {
                ours.push(kept);
                rivals.push(all);
            }
        }
        Ok(paired_ratio_interval(&rivals, &ours, 0.95, 2000, 1)?)
    }

    /// Root mean square of the colours' difference from the truth, over the root mean square of the truth.
    fn error(&self, light: &[[f32; 3]]) -> f64 {
        let count = self.placed.order * self.placed.order;
        let (mut difference, mut whole) = (0.0, 0.0);
        for (vertex, (truth, light)) in self.truth.iter().zip(light.chunks_exact(count)).enumerate() {
            let light: Vec<DVec3> = light.iter().map(|l| DVec3::from(l.map(f64::from))).collect();
            difference += self.placed.colour(vertex, &light).distance_squared(*truth);
            whole += truth.length_squared();
        }
        (difference / whole).sqrt()
    }

    /// Samples taken for other emitters.
    pub fn samples_for(&self, emitters: &[Triangle], refinement: Settings) -> Result<usize, Failure> {
        let frame = self.frame(refinement, true, false)?;
        let control = frame.prepared.control.as_ref().ok_or("the pass was left out")?;
        control.set(&Lights { emitters, ..Lights::default() })?;
        self.bench.frame(&frame.prepared, &frame.light)?;
        Ok(self.bench.refined(&frame.receiver, &self.placed.tree)?.0.samples.len())
    }
}

/// Seconds of one submission.
fn timed(
    bench: &Bench<'_>,
    record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>,
) -> Result<f64, GpuError> {
    let begin = Instant::now();
    (bench.run)(record)?;
    Ok(begin.elapsed().as_secs_f64())
}
