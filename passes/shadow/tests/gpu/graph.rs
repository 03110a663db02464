//! The road of the graph: the same bits as without, and a pass that is left out where nothing blocks.

use std::sync::{Arc, Mutex};

use airglow_gpu::{Buffer, Execution, GpuError, Imports, Label, Location, Recorder};
use airglow_graph::{Access, BufferDesc, Graph, PassKind};
use airglow_shadow::bench::{Scene, SphereKernel};
use airglow_shadow::{Bench, Blockers, Settings, Shadow, Sphere};
use airglow_tests::compare::assert_same_bits;
use airglow_tests::device::{Fixture, fixture_with};
use glam::{DMat4, DVec3};

pub(crate) const SPHERES: [Sphere; 2] = [
    Sphere { center: DVec3::new(3.0, 1.0, 2.0), radius: 0.7 },
    Sphere { center: DVec3::new(5.0, 2.0, 6.0), radius: 1.2 },
];

/// A square of ground, and its normals.
pub(crate) fn ground() -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    ((0..300).map(|i| [(i % 20) as f32, 0.0, (i / 20) as f32]).collect(), vec![[0.0, 1.0, 0.0]; 300])
}

fn upload(fixture: &Fixture, name: &str, values: &[[f32; 3]]) -> Buffer {
    let desc =
        BufferDesc { size: size_of_val(values) as u64, usage: Access::ComputeStorageRead.buffer_usage() };
    let buffer = fixture.context().create_buffer(Label::new("host", name), &desc, Location::Upload).unwrap();
    buffer.write(0, values).unwrap();
    buffer
}

/// The visibility by a plan, and what the plan says was left out.
fn with_graph(fixture: &Fixture, settings: Settings, spheres: &[Sphere]) -> (Option<Vec<f32>>, String) {
    let context = fixture.context();
    let (positions, normals) = ground();
    let shadow = Shadow::new(context, settings).unwrap();
    let receivers = shadow.receivers(context, "ground", &positions).unwrap();
    let blockers = Blockers::default();
    blockers.set(spheres, DMat4::IDENTITY).unwrap();
    let (positions, normals) =
        (upload(fixture, "positions", &positions), upload(fixture, "normals", &normals));
    let mut graph = Graph::new();
    let entry = Access::HostWrite;
    let places = graph.import_buffer("positions", *positions.desc(), entry, Access::ComputeStorageRead);
    let axes = graph.import_buffer("normals", *normals.desc(), entry, Access::ComputeStorageRead);
    let mut imports = Imports::new();
    imports.buffer(&places, &positions);
    imports.buffer(&axes, &normals);
    let shadowed = shadow.add(&mut graph, &receivers, &blockers, places, settings.normals.then_some(axes));
    let slot = Arc::new(Mutex::new(None));
    if let Some(visibility) = shadowed.visibility {
        let filled = Arc::clone(&slot);
        let mut read = graph.pass("read back", PassKind::Transfer);
        read.read(&visibility, Access::TransferSource).side_effect();
        read.record(Box::new(move |recorder, resources| {
            *filled.lock().unwrap() = Some(recorder.read_back_buffer(resources.buffer(&visibility)?)?);
            Ok(())
        }));
    }
    let plan = airglow_tests::plan::compile(graph, &context.graph_limits());
    let text = plan.text();
    let mut execution = Execution::prepare(context, plan).unwrap();
    let record = |recorder: &mut Recorder<'_>| -> Result<(), GpuError> {
        // SAFETY: a recording command buffer of this frame; the imports are in their entry state.
        unsafe { execution.record(context, recorder.command_buffer(), &imports, None) }.map(|_| ())
    };
    fixture.device().run(context, record).unwrap();
    let readback = slot.lock().unwrap().take();
    (readback.map(|readback| readback.read().unwrap()), text)
}

#[test]
fn both_roads_give_the_same_bits() {
    let fixture = fixture_with(&Shadow::requirements());
    let settings = Settings { normals: true, ..Default::default() };
    let (found, _) = with_graph(&fixture, settings, &SPHERES);
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    let bench = Bench { context: fixture.context(), run: &run };
    let (positions, normals) = ground();
    let scene = Scene { positions: &positions, normals: Some(&normals), spheres: &SPHERES };
    let frame = bench.spheres(settings, SphereKernel::Pass, &scene, 1).unwrap();
    assert_same_bits("visibility", &found.unwrap(), &frame.values);
}

#[test]
fn a_pass_without_blockers_is_left_out_with_the_reason() {
    let fixture = fixture_with(&Shadow::requirements());
    for spheres in [&[][..], &[Sphere { center: DVec3::ONE, radius: 0.0 }]] {
        let (visibility, text) = with_graph(&fixture, Settings::default(), spheres);
        assert!(visibility.is_none() && text.contains("nothing that moves blocks"), "{text}");
    }
}

#[test]
fn what_has_no_kernel_or_is_out_of_range_is_refused() {
    use airglow_shadow::Exponential;
    let fixture = fixture_with(&Shadow::requirements());
    let default = Settings::default();
    for (settings, word) in [
        (Settings { order: 2, ..default }, "3 to 6"),
        (Settings { exponential: Exponential::Operator, ..default }, "Operator"),
        (Settings { exponential: Exponential::OptimalLinear, normals: true, ..default }, "normals"),
        (Settings { reach: f64::NAN, ..default }, "reach"),
        (Settings { window: -1.0, ..default }, "window"),
        (Settings { clip: 0.0, ..default }, "clip"),
    ] {
        let error = Shadow::new(fixture.context(), settings).err().unwrap().to_string();
        assert!(error.contains(word), "{error}");
    }
    let shadow = Shadow::new(fixture.context(), default).unwrap();
    assert!(shadow.receivers(fixture.context(), "nobody", &[]).is_err());
}
