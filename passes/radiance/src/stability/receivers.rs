//! Whole frames of extreme receivers and emitters, from samples to the light of vertices.

use std::ops::ControlFlow;

use airglow_math::sh::zonal::{clamped_cosine, rotate_to_direction};
use airglow_math::statistics::relative_l2;
use glam::DVec3;

use super::{BOUND, lit, room, square};
use crate::gpu::bench::Bench;
use crate::reference::{Cube, triangles};
use crate::{
    Hierarchy, Lights, Part, PassSettings, Radiance, RadianceError, Receiver, Reconstruction, Refined,
    Settings, Triangle, Weights,
};

const ORDER: usize = 3;
/// Half a side of the boxes about some vertices, metres.
const BOX: f64 = 0.45;

/// One extreme frame.
#[derive(Clone, Debug)]
pub struct FrameOutcome {
    /// What is tried.
    pub name: &'static str,
    /// Vertices, triangles and settings, in words.
    pub input: String,
    /// What the device made of it.
    pub result: String,
    /// What it should.
    pub truth: String,
    /// What `bound` is held to.
    pub error: f64,
    /// The largest error that passes.
    pub bound: f64,
}

impl FrameOutcome {
    /// Whether the error is within its bound; NaN is not.
    #[must_use]
    pub fn pass(&self) -> bool {
        self.error <= self.bound
    }
}

/// What a frame is held to.
#[derive(Clone, Copy)]
enum Demand {
    /// Samples and colours of f64, from samples at the same places.
    Reference,
    /// No light at vertices within the box.
    Inside,
    /// Light on the dark side, x above 0, as a part of all light: at most so much.
    Leak(f64),
    /// No light anywhere.
    Dark,
    /// So many samples, within the limit.
    Samples(usize),
    /// The limit is met, and said to be.
    Limited,
    /// The pass is left out.
    LeftOut,
}

struct Frame {
    name: &'static str,
    positions: Vec<[f32; 3]>,
    /// Whether vertices reflect light.
    white: bool,
    emitters: Vec<Triangle>,
    refinement: Settings,
    demand: Demand,
}

/// Runs the extreme frames, or the one called `only`; those of two million vertices, which take a gigabyte, only if `large`.
///
/// # Errors
/// [`RadianceError::Gpu`] when the device fails; a wrong result is an outcome that does not pass.
pub fn frames(
    bench: &Bench<'_>,
    only: Option<&str>,
    large: bool,
) -> Result<Vec<FrameOutcome>, RadianceError> {
    let chosen = |name: &str| only.is_none_or(|only| only == name);
    let mut outcomes = Vec::new();
    for frame in all_frames().into_iter().filter(|frame| chosen(frame.name)) {
        outcomes.push(frame.run(bench)?);
    }
    if large && chosen(TWO_MILLION) {
        outcomes.push(two_million().run(bench)?);
    }
    Ok(outcomes)
}

const TWO_MILLION: &str = "receiver: two million vertices";

/// A level floor of side 2 about the origin, its vertices a grid.
fn floor(side: usize) -> Vec<[f32; 3]> {
    let at = |i: usize| (2.0 * i as f32 / (side - 1) as f32) - 1.0;
    (0..side * side).map(|i| [at(i % side), 0.0, at(i / side)]).collect()
}

/// A level square.
fn lamp(centre: DVec3, half: f64, radiance: f64) -> Vec<Triangle> {
    lit(square(centre, half * DVec3::X, half * DVec3::Z), radiance)
}

fn two_million() -> Frame {
    let refinement = Settings { bound: 1e-3, limit: 256, ..Settings::default() };
    Frame {
        name: TWO_MILLION,
        positions: floor(1448),
        white: true,
        emitters: lamp(DVec3::new(0.3, 0.4, 0.1), 0.1, 5.0),
        refinement,
        demand: Demand::Reference,
    }
}

fn all_frames() -> Vec<Frame> {
    let mut frames = Vec::new();
    let settings = |bound, limit| Settings { bound, limit, ..Settings::default() };
    let corner = DVec3::new(1.0, 0.0, 1.0);
    let near = || lamp(DVec3::new(0.1, 0.3, 0.2), 0.15, 3.0);
    let mut add = |name, positions: &[[f32; 3]], emitters: Vec<Triangle>, refinement, demand| {
        let positions = positions.to_vec();
        frames.push(Frame { name, positions, white: true, emitters, refinement, demand });
    };
    let grid = floor(16);
    let touching = square(corner + 0.1 * DVec3::Y, 0.1 * DVec3::X, 0.1 * DVec3::Y);
    let some = settings(1e-3, 200);
    for (name, emitters) in [
        ("emitter: touching a vertex", touching),
        ("emitter: inside the hull", lamp(DVec3::new(0.1, 1e-3, 0.2), 0.05, 5.0)),
        ("emitter: larger than the scene", lamp(DVec3::Y, 1e6, 1.0)),
        ("emitter: of no area", lamp(DVec3::Y, 0.0, 1.0)),
        ("emitter: of radiance 1e6", lamp(0.5 * DVec3::Y, 0.1, 1e6)),
        ("emitter: a speck of radiance 1e6", lamp(DVec3::new(0.3, 0.1, 0.3), 5e-10, 1e6)),
    ] {
        add(name, &grid, emitters, some, Demand::Reference);
    }
    let hidden = [lamp(DVec3::Y, 0.3, 5.0), lamp(0.5 * DVec3::Y, 50.0, 0.0)].concat();
    add("emitter: all hidden", &grid, hidden, some, Demand::Dark);
    let beside = lamp(DVec3::new(0.76, 0.4, 0.71), 0.1, 3.0);
    let boxed = [beside, lit(room(BOX), 0.0)].concat();
    add(
        "point inside geometry: a black box about some vertices",
        &grid,
        boxed,
        settings(0.0, 4096),
        Demand::Inside,
    );
    add(
        "point inside geometry: a glowing box about some vertices",
        &grid,
        room(BOX),
        settings(0.0, 4096),
        Demand::Reference,
    );
    let wall = || {
        let wall = square(DVec3::ZERO, 9.0 * DVec3::Y, 9.0 * DVec3::Z);
        [lamp(DVec3::new(-0.5, 0.6, 0.0), 0.2, 3.0), lit(wall, 0.0)].concat()
    };
    let fine = floor(24);
    for (name, bound, leak) in [
        ("thin wall: bound 0.03", 0.03, 0.1),
        ("thin wall: bound 0.003", 0.003, 0.05),
        ("thin wall: bound 0", 0.0, 1e-6),
    ] {
        add(name, &fine, wall(), settings(bound, 4096), Demand::Leak(leak));
    }
    add(
        "receiver: coincident vertices",
        &[[0.5, 0.0, 0.5]; 300],
        near(),
        settings(0.0, 4096),
        Demand::Samples(1),
    );
    let triangle = [[0.0; 3], [0.1, 0.0, 0.0], [0.0, 0.0, 0.1]];
    add("receiver: one triangle", &triangle, near(), settings(0.0, 4096), Demand::Reference);
    add("receiver: one vertex", &triangle[..1], near(), settings(0.0, 4096), Demand::Samples(1));
    add("bound: 0, stopped by the limit", &grid, near(), settings(0.0, 100), Demand::Limited);
    add("bound: infinite", &grid, near(), settings(f64::INFINITY, 4096), Demand::Samples(1));
    let far = lamp(DVec3::new(0.0, 1e5, 0.0), 1e4, 1.0);
    add("emitter: far, one sample", &grid, far, some, Demand::Samples(1));
    add("emitter: none", &grid, Vec::new(), some, Demand::LeftOut);
    frames.push(Frame {
        name: "receiver: black",
        positions: grid,
        white: false,
        emitters: near(),
        refinement: some,
        demand: Demand::LeftOut,
    });
    // Single precision holds them: what is compared is the same.
    let triangles = frames.iter_mut().flat_map(|frame| &mut frame.emitters);
    for corner in triangles.flat_map(|triangle| &mut triangle.corners) {
        *corner = corner.as_vec3().as_dvec3();
    }
    frames
}

/// What the device left.
struct Found {
    refined: Refined,
    /// Which samples are closed forms.
    exact: Vec<bool>,
    /// Of all vertices, one channel.
    colours: Vec<f64>,
}

impl Frame {
    fn run(&self, bench: &Bench<'_>) -> Result<FrameOutcome, RadianceError> {
        let transfer = self.transfer()?;
        let tree = Hierarchy::build(&self.positions, &transfer, &mut |_, _| ControlFlow::Continue(()))?;
        let settings = PassSettings {
            order: ORDER,
            face: 8,
            rays: 2,
            refinement: self.refinement,
            ..PassSettings::default()
        };
        let found = self.found(bench, &tree, &transfer, settings)?;
        let (result, truth, error, bound) = self.judge(found.as_ref(), &transfer, &settings)?;
        let Settings { bound: asked, limit, .. } = self.refinement;
        let (vertices, triangles) = (self.positions.len(), self.emitters.len());
        let input = format!("{vertices} vertices, {triangles} triangles, bound {asked:e}, limit {limit}");
        Ok(FrameOutcome { name: self.name, input, result, truth, error, bound })
    }

    /// Upwards, of what nothing shadows.
    fn transfer(&self) -> Result<Vec<f32>, RadianceError> {
        let factors: Vec<f64> = clamped_cosine(ORDER)?.iter().map(|a| a / std::f64::consts::PI).collect();
        let mut vector = [0.0; ORDER * ORDER];
        rotate_to_direction(&factors, DVec3::Y, &mut vector)?;
        let shade = if self.white { 1.0 } else { 0.0 };
        Ok(self.positions.iter().flat_map(|_| vector.map(|t| (shade * t) as f32)).collect())
    }

    /// A frame on the device; `None` when the pass is left out.
    fn found(
        &self,
        bench: &Bench<'_>,
        tree: &Hierarchy,
        transfer: &[f32],
        settings: PassSettings,
    ) -> Result<Option<Found>, RadianceError> {
        let part = Part { vertices: 0..self.positions.len() as u32, turn: None };
        let receiver = Receiver::new(bench.context, settings, tree, &self.positions, &[part])?;
        let radiance = Radiance::new(bench.context, settings)?;
        let lights = Lights { emitters: &self.emitters, ..Lights::default() };
        let prepared = radiance.prepare(&receiver, &lights)?;
        if prepared.left_out.is_some() {
            return Ok(None);
        }
        let buffers = bench.light_buffers(&prepared)?;
        bench.frame(&prepared, &buffers)?;
        let light = bench.light::<[f32; 3]>(&buffers)?.concat();
        let vertex = |(t, l): (&[f32], &[[f32; 3]])| -> f64 {
            t.iter().zip(l).map(|(t, l)| f64::from(*t) * f64::from(l[0])).sum()
        };
        let size = ORDER * ORDER;
        let colours = transfer.chunks_exact(size).zip(light.chunks_exact(size)).map(vertex).collect();
        let (refined, _) = bench.refined(&receiver, tree)?;
        let records: Vec<[f32; 4]> = bench.read(&receiver.samples().lights)?;
        let shape = receiver.shape();
        let exact = |i: usize| records[i * shape.stride() + shape.coefficients()][2] == 1.0;
        let exact = (0..refined.samples.len()).map(exact).collect();
        Ok(Some(Found { refined, exact, colours }))
    }

    /// Result and truth in words, error and bound.
    fn judge(
        &self,
        found: Option<&Found>,
        transfer: &[f32],
        settings: &PassSettings,
    ) -> Result<(String, String, f64, f64), RadianceError> {
        let Some(found) = found else {
            let due = matches!(self.demand, Demand::LeftOut);
            let error = if due { 0.0 } else { f64::INFINITY };
            return Ok(("left out".to_owned(), "left out".to_owned(), error, 0.0));
        };
        let Found { refined, colours, .. } = found;
        let (count, limited) = (refined.samples.len(), refined.limited);
        let samples = format!("{count} samples{}", if limited { ", stopped by the limit" } else { "" });
        let norm = |colours: &mut dyn Iterator<Item = f64>| colours.map(|c| c * c).sum::<f64>().sqrt();
        let whole = norm(&mut colours.iter().copied());
        let part = |chosen: &dyn Fn(&[f32; 3]) -> bool| {
            let chosen = colours.iter().zip(&self.positions).filter(|(_, position)| chosen(position));
            norm(&mut chosen.map(|(colour, _)| *colour)) / whole
        };
        let fails = |holds: bool| if holds { 0.0 } else { f64::INFINITY };
        Ok(match self.demand {
            Demand::Reference => {
                let (truth, worst) = self.reference(found, transfer, settings)?;
                let expected = norm(&mut truth.iter().copied());
                let error = if expected > 0.0 { relative_l2(colours, &truth)? } else { whole };
                let error = if whole.is_finite() { error.max(worst) } else { f64::INFINITY };
                (format!("|c| {whole:.8e}, {samples}"), format!("|c| {expected:.8e}"), error, BOUND)
            }
            Demand::Leak(most) => {
                let leak = part(&|[x, ..]| *x > 0.0);
                (format!("{leak:.4} of the light on the dark side, {samples}"), "0".to_owned(), leak, most)
            }
            Demand::Inside => {
                let inside = part(&|[x, _, z]| x.abs() < BOX as f32 && z.abs() < BOX as f32);
                (format!("{inside:.4} of the light in the box, {samples}"), "0".to_owned(), inside, 1e-6)
            }
            Demand::Dark => (format!("|c| {whole:e}, {samples}"), "0".to_owned(), whole, 0.0),
            Demand::Samples(due) => (samples, format!("{due}"), fails(count == due && !limited), 0.0),
            Demand::Limited => {
                let most = self.refinement.limit;
                (samples, format!("at most {most}, and said"), fails(limited && count <= most), 0.0)
            }
            Demand::LeftOut => (samples, "left out".to_owned(), f64::INFINITY, 0.0),
        })
    }

    /// Colours of the same samples in f64, and the largest error of a sample that is a closed form, over the brightest
    /// sample.
    fn reference(
        &self,
        found: &Found,
        transfer: &[f32],
        settings: &PassSettings,
    ) -> Result<(Vec<f64>, f64), RadianceError> {
        let cube =
            Cube::new(ORDER, settings.face as usize)?.with_rays(settings.rays as usize)?.with_gradients();
        let (mut refined, mut worst) = (found.refined.clone(), 0.0_f64);
        let brightest =
            refined.samples.iter().map(|sample| sample.light.norm()).fold(f64::MIN_POSITIVE, f64::max);
        for (sample, exact) in refined.samples.iter_mut().zip(&found.exact) {
            if !exact {
                sample.light = cube.sample(sample.point, &self.emitters)?;
                continue;
            }
            let truth = triangles(ORDER, sample.point, &self.emitters)?.coefficients;
            let pairs = sample.light.coefficients.iter().zip(&truth);
            let difference = pairs.map(|(l, t)| l.distance_squared(*t)).sum::<f64>().sqrt();
            worst = worst.max(difference / brightest);
        }
        let reconstruction = Reconstruction::new(&refined, Weights::Compact, settings.gradients);
        let mut light = vec![DVec3::ZERO; ORDER * ORDER];
        let vertices = self.positions.iter().zip(transfer.chunks_exact(ORDER * ORDER));
        let colours = vertices.map(|(position, t)| {
            reconstruction.light(DVec3::from(position.map(f64::from)), &mut light)?;
            Ok(t.iter().zip(&light).map(|(t, l)| f64::from(*t) * l.x).sum())
        });
        Ok((colours.collect::<Result<_, RadianceError>>()?, worst))
    }
}
