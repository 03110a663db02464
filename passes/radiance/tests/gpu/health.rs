//! Counts that a host asks for, by both roads, and the budget that it sets.

use airglow_gpu::open::{FrameLoop, FrameSemaphores};
use airglow_gpu::{AdoptInfo, Context, Execution, Health, Imports, Label, Location, Options, Tally};
use airglow_graph::{Access, BufferDesc, Graph};
use airglow_radiance::{
    Bindings, HEALTH, Lights, PassSettings, Radiance, RadianceError, Receiver, Settings, Triangle,
};
use airglow_tests::device::{Fixture, fixture_with, open};
use airglow_tests::plan::compile;
use glam::DVec3;

use crate::receivers::Mesh;
use crate::scenes::block;

fn settings(limit: usize) -> PassSettings {
    let refinement = Settings { limit, bound: 1e-3, ..Settings::default() };
    PassSettings { order: 3, gradients: false, face: 8, rays: 1, refinement, ..PassSettings::default() }
}

/// The newest counts, once nothing is in flight.
fn counts(fixture: &Fixture, health: &Health) -> Vec<u32> {
    let context = fixture.context();
    let mut frames = FrameLoop::new(fixture.device(), context).unwrap();
    for _ in 0..context.frames_in_flight() {
        frames.frame(FrameSemaphores::default(), |_| Ok(())).unwrap();
    }
    frames.finish().unwrap();
    health.latest(context).unwrap().unwrap().counts.into_iter().map(|(_, count)| count).collect()
}

/// The counts of a frame by each road, and how many vertices have light that is not finite.
fn frame(limit: usize, emitters: &[Triangle]) -> ([Vec<u32>; 2], u32) {
    let settings = settings(limit);
    let fixture = fixture_with(&Radiance::requirements(&settings).and(&Tally::requirements()));
    let (device, context) = (fixture.device(), fixture.context());
    let (mesh, lights) = (Mesh::ball(12, 3, false), Lights { emitters, ..Lights::default() });
    let radiance = Radiance::new(context, settings).unwrap();
    let make = || Receiver::new(context, settings, &mesh.tree, &mesh.positions, &mesh.whole()).unwrap();
    let mut health = Health::new(context, &HEALTH).unwrap();
    let tally = Tally::new(context, &health).unwrap();

    let (mut graph, mut imports) = (Graph::new(), Imports::new());
    let lit = radiance.add(&mut graph, &mut imports, &make(), &lights).unwrap();
    tally.add(&mut graph, &mut imports, "radiance health", lit.looks);
    let plan = compile(graph, &context.graph_limits());
    assert!(plan.text().contains("radiance health"), "{}", plan.text());
    let mut execution = Execution::prepare(context, plan).unwrap();
    let run = device.run(context, |recorder| {
        health.clear(recorder)?;
        // SAFETY: a recording command buffer of this frame; imports are in their entry states.
        unsafe { execution.record(context, recorder.command_buffer(), &imports, None)? };
        health.collect(recorder)
    });
    run.unwrap();
    let by_graph = counts(&fixture, &health);

    let prepared = radiance.prepare(&make(), &lights).unwrap();
    let usage = Access::ComputeStorageWrite.buffer_usage() | Access::TransferSource.buffer_usage();
    let desc = BufferDesc { size: prepared.light_bytes[0], usage };
    let light = context.create_buffer(Label::new("host", "light"), &desc, Location::Device).unwrap();
    let bindings: Bindings = [(0, (&light).into())].into();
    let copy = device.run(context, |recorder| {
        health.clear(recorder)?;
        prepared.record(recorder, &bindings)?;
        recorder.memory_barrier(Access::ComputeStorageReadWrite, Access::ComputeStorageRead)?;
        recorder.memory_barrier(Access::ComputeStorageWrite, Access::TransferSource)?;
        tally.record(recorder, &prepared.looks(&bindings))?;
        health.collect(recorder)?;
        recorder.read_back_buffer(&light)
    });
    let values = copy.unwrap().read::<f32>().unwrap();
    let broken = values.chunks(27).filter(|vertex| vertex.iter().any(|value| !value.is_finite())).count();
    ([by_graph, counts(&fixture, &health)], broken as u32)
}

#[test]
fn light_past_floats_and_limits_are_counted() {
    let lamp = block(DVec3::new(0.0, 0.0, -1.5), 0.3, DVec3::ONE);
    let (found, broken) = frame(1000, &lamp);
    assert_eq!((found, broken), ([vec![0, 0], vec![0, 0]], 0));
    let (found, _) = frame(8, &lamp);
    assert_eq!(found, [vec![0, 1], vec![0, 1]]);
    // Finite for a host, and infinite in single precision.
    let blinding = block(DVec3::new(0.0, 0.0, -1.5), 0.3, DVec3::splat(1e39));
    let (found, broken) = frame(1000, &blinding);
    assert!(broken > 10, "{broken}");
    assert_eq!([found[0][0], found[1][0]], [broken; 2]);
}

#[test]
fn a_receiver_past_the_budget_names_the_limit_that_fits() {
    let settings = settings(1000);
    let device = open(&Radiance::requirements(&settings));
    let mut extensions = Vec::new();
    let options = Options { memory_budget: Some(120_000), ..Options::default() };
    let info = AdoptInfo { options, ..device.adopt_info(&mut extensions, 1) };
    // SAFETY: nothing is submitted; everything is dropped before the device.
    let context = &unsafe { Context::adopt(info) }.unwrap();
    let mesh = Mesh::ball(16, 3, false);
    let make =
        |settings| Receiver::new(context, settings, &mesh.tree, &mesh.positions, &mesh.whole()).map(drop);
    let refused = make(settings).unwrap_err();
    let RadianceError::Budget { size, left, mend } = &refused else { panic!("{refused}") };
    assert!(*size > 120_000 && *left == 120_000, "{refused}");
    let nodes = mesh.tree.nodes().len();
    let beside = size - settings.sample_bytes(nodes);
    let next = settings.next_that_fits(nodes, left - beside).unwrap();
    assert!(next.refinement.limit >= 64 && !next.gradients, "{next:?}");
    assert_eq!(*mend, format!("a limit of {} samples would fit", next.refinement.limit));
    make(next).unwrap();
}
