//! Time by the number of emitters.

use std::ops::ControlFlow;

use airglow::math::sequence::{hammersley, uniform_hemisphere};
use airglow::radiance::{Hierarchy, Lights, Part, PassSettings, Radiance, Receiver, Settings, Triangle};
use airglow_gpu::Imports;
use airglow_graph::{Access, Graph};
use glam::{DVec3, Vec3Swizzles};

use crate::failure::{Failure, Outcome};
use crate::host::device::Device;
use crate::output::Output;
use crate::report::interleave::{self, Rounds};
use crate::report::model::{Errors, Point};
use crate::report::timed_plan::TimedPlan;

/// Samples of each frame.
pub const SAMPLES: usize = 64;
/// Vertices lit: a square of ground.
pub const VERTICES: usize = SIDE * SIDE;
const SIDE: usize = 32;

/// Points of so many emitters each: squares on a dome of 3 m, all of the same size.
pub fn emitters(
    device: &Device<'_>,
    counts: &[usize],
    rounds: Rounds,
    output: &Output,
) -> Outcome<Vec<(f64, Point)>> {
    let mut racers = counts.iter().map(|&count| racer(device, count)).collect::<Outcome<Vec<_>>>()?;
    let bar =
        output.progress("emitters", ((rounds.warm_up + rounds.measured) * racers.len()) as u64, "frames");
    let times = interleave::measure(rounds, racers.len(), |place| {
        bar.inc(1);
        let (plan, receiver) = &mut racers[place];
        receiver.forget_samples();
        plan.run(device)
    })?;
    bar.finish_and_clear();
    let point = |((&count, milliseconds), (plan, receiver)): ((&usize, Vec<f64>), &(TimedPlan, Receiver))| {
        let (memory, counts) = (receiver.bytes(), plan.counts(0));
        let (setting, error) = (format!("{count} emitters"), Errors::default());
        (count as f64, Point { setting, milliseconds, memory, counts, error, distribution: None })
    };
    Ok(counts.iter().zip(times).zip(&racers).map(point).collect())
}

fn racer(device: &Device<'_>, count: usize) -> Outcome<(TimedPlan, Receiver)> {
    // The limit stops refinement, so that every frame takes as many samples.
    let refinement = Settings { bound: 0.0, limit: SAMPLES, ..Settings::default() };
    let settings = PassSettings { keep: 0.0, refinement, ..PassSettings::default() };
    let place = |at: usize| [at % SIDE, at / SIDE].map(|at| at as f32 / SIDE as f32 - 0.5);
    let positions: Vec<[f32; 3]> = (0..VERTICES).map(place).map(|[x, z]| [x, 0.0, z]).collect();
    let tree =
        Hierarchy::build(&positions, &[], &mut |_, _| ControlFlow::Continue(())).map_err(Failure::work)?;
    let part = Part { vertices: 0..VERTICES as u32, turn: None };
    let context = device.context();
    let receiver = Receiver::new(context, settings, &tree, &positions, &[part]).map_err(Failure::work)?;
    let radiance = Radiance::new(context, settings).map_err(Failure::work)?;
    let emitters: Vec<Triangle> = (0..count as u32).flat_map(|at| square(at, count as u32)).collect();
    let lights = Lights { emitters: &emitters, ..Lights::default() };
    let (mut graph, mut imports) = (Graph::new(), Imports::new());
    let added = radiance.add(&mut graph, &mut imports, &receiver, &lights).map_err(Failure::work)?;
    for light in added.light {
        graph.export(light, Access::ComputeStorageRead);
    }
    Ok((TimedPlan::new(device, format!("{count} emitters"), graph, imports)?, receiver))
}

/// An emitter of two triangles that faces the origin.
fn square(at: u32, count: u32) -> [Triangle; 2] {
    let towards = uniform_hemisphere(hammersley(at, count));
    let (right, up) = towards.any_orthonormal_pair();
    let corner =
        |x: f64, y: f64| (3.0 * towards.xzy() + 0.02 * (x * right + y * up).xzy()).as_vec3().as_dvec3();
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    [[a, b, c], [a, c, d]].map(|corners| Triangle { corners, radiance: DVec3::ONE })
}
