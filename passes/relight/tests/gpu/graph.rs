//! The road of the graph: what a plan holds and leaves out, the same bits as without a graph, meshes between frames.

use std::path::Path;

use crate::host::{Numbers, fixture};
use airglow_gpu::ash::vk::{BufferUsageFlags, Format, ImageUsageFlags};
use airglow_gpu::open::{FrameLoop, FrameSemaphores};
use airglow_gpu::{Context, Execution, Image, Imports, Label, Location, Readback, Record};
use airglow_graph::{Access, BufferDesc, Graph, ImageDesc, Limits, Plan};
use airglow_relight::{
    Bench, Case, CaseLight, Environment, Frame, GraphFrame, Instance, Light, MeshId, Method, Relight,
    Settings, Texels,
};
use airglow_tests::device::Fixture;
use airglow_tests::golden::assert_text;
use glam::DQuat;

const WIDTH: u32 = 32;
const HEIGHT: u32 = 16;

/// An environment on the device, left as `ComputeSampled`.
fn sky(fixture: &Fixture, texels: &[[f32; 3]]) -> Image {
    let context = fixture.context();
    let usage = ImageUsageFlags::SAMPLED | ImageUsageFlags::TRANSFER_DST;
    let desc = ImageDesc { usage, ..ImageDesc::new_2d(WIDTH, HEIGHT, Format::R32G32B32A32_SFLOAT) };
    let image = context.create_image(Label::new("host", "sky"), &desc).unwrap();
    let rgba: Vec<[f32; 4]> = texels.iter().map(|[r, g, b]| [*r, *g, *b, 1.0]).collect();
    let desc = BufferDesc { size: 16 * rgba.len() as u64, usage: BufferUsageFlags::TRANSFER_SRC };
    let staging = context.create_buffer(Label::new("host", "texels"), &desc, Location::Upload).unwrap();
    staging.write(0, &rgba).unwrap();
    let record = |recorder: &mut airglow_gpu::Recorder<'_>| {
        recorder.transition(&image, airglow_graph::State::UNDEFINED, Access::TransferDestination)?;
        recorder.copy_buffer_to_image(&staging, &image.full_view()?)?;
        recorder.transition(&image, Access::TransferDestination, Access::ComputeSampled)
    };
    fixture.device().run(context, record).unwrap();
    image
}

fn texels(seed: u64) -> Vec<[f32; 3]> {
    Numbers::new(seed).rgb((WIDTH * HEIGHT) as usize).into_iter().map(|rgb| rgb.map(|c| c + 1.0)).collect()
}

/// A frame under the sky, as a graph: its plan, imports, and where the readback will be.
struct Built {
    plan: Plan<Record>,
    imports: Imports,
    readback: std::sync::Arc<std::sync::Mutex<Option<Readback>>>,
    rotations: Option<airglow_relight::Rotations>,
    ranges: Vec<airglow_relight::ResultRange>,
}

fn build(
    context: &Context,
    relight: &mut Relight,
    sky: &Image,
    revision: u64,
    instances: Vec<Instance<Buffer>>,
) -> Built {
    let (mut graph, mut imports) = (Graph::new(), Imports::new());
    let image = graph.import_image("sky", *sky.desc(), Access::ComputeSampled, Access::ComputeSampled);
    imports.image(&image, sky);
    let rotation = DQuat::from_rotation_y(0.7);
    let environment = Environment { image, width: WIDTH, height: HEIGHT, revision, rotation };
    let frame = GraphFrame { light: Light::Environment(environment), instances, target: None };
    let relit = relight.add(context, &mut graph, &mut imports, &frame).unwrap();
    let readback = std::sync::Arc::default();
    if let Some(results) = relit.results {
        let slot: std::sync::Arc<std::sync::Mutex<Option<Readback>>> = std::sync::Arc::clone(&readback);
        let mut pass = graph.pass("read back", airglow_graph::PassKind::Transfer);
        pass.read(&results, Access::TransferSource).side_effect();
        pass.record(Box::new(move |recorder, resources| {
            *slot.lock().unwrap() = Some(recorder.read_back_buffer(resources.buffer(&results)?)?);
            Ok(())
        }));
    }
    let plan = airglow_tests::plan::compile(graph, &Limits::default());
    Built { plan, imports, readback, rotations: relit.rotations, ranges: relit.ranges }
}

type Buffer = airglow_graph::Handle<airglow_graph::Buffer>;

/// Records a prepared frame once, waits, and reads its results.
fn run(
    fixture: &Fixture,
    execution: &mut Execution,
    built: (&Imports, &std::sync::Mutex<Option<Readback>>),
) -> Vec<f32> {
    let context = fixture.context();
    let mut frames = FrameLoop::new(fixture.device(), context).unwrap();
    let record = |commands| {
        // SAFETY: the loop's command buffer is recording and submitted once; imports are in their entry states.
        unsafe { execution.record(context, commands, built.0, None) }
    };
    frames.frame(FrameSemaphores::default(), record).unwrap();
    frames.finish().unwrap();
    built.1.lock().unwrap().take().unwrap().read().unwrap()
}

fn run_once(fixture: &Fixture, built: Built) -> Vec<f32> {
    let mut execution = Execution::prepare(fixture.context(), built.plan).unwrap();
    run(fixture, &mut execution, (&built.imports, &built.readback))
}

fn mesh(context: &Context, relight: &mut Relight, vertices: u32, seed: u64) -> (MeshId, Vec<f32>) {
    let vectors = Numbers::new(seed).values(vertices as usize * 16);
    (relight.add_mesh(context, "mesh", vertices, Some(&vectors)).unwrap(), vectors)
}

/// The bits of the same frame by the road without a graph.
fn without_graph(
    fixture: &Fixture,
    settings: Settings,
    vectors: &[f32],
    sky: &[[f32; 3]],
    turn: DQuat,
    rotation: DQuat,
) -> Vec<f32> {
    let context = fixture.context();
    let run: &airglow_relight::Run<'_> = &|record| fixture.device().run(context, |recorder| record(recorder));
    let bench = Bench { context, run };
    let mut relight = Relight::new(context, settings).unwrap();
    let mesh = relight.add_mesh(context, "mesh", vectors.len() as u32 / 16, Some(vectors)).unwrap();
    let light = CaseLight::Environment(Texels { width: WIDTH, height: HEIGHT, rgb: sky }, turn);
    bench.results(&mut relight, &Case { orientation: rotation.into(), ..Case::new(light, mesh) }).unwrap()
}

#[test]
fn both_roads_give_the_same_bits_and_rotations_follow() {
    let fixture = fixture();
    let (context, texels) = (fixture.context(), texels(1));
    let sky = sky(&fixture, &texels);
    for method in [Method::Compute, Method::Fragment] {
        let settings = Settings { method, ..Settings::default() };
        let mut relight = Relight::new(context, settings).unwrap();
        let (mesh, vectors) = mesh(context, &mut relight, 1500, 2);
        let (first, second) = (DQuat::from_rotation_x(0.3), DQuat::from_rotation_z(-2.0));
        let instance = Instance { orientation: first.into(), ..Instance::new(mesh) };
        let built = build(context, &mut relight, &sky, 1, vec![instance]);
        let rotations = built.rotations.clone().unwrap();
        let mut execution = Execution::prepare(context, built.plan).unwrap();
        let imports = (&built.imports, &*built.readback);
        let turn = DQuat::from_rotation_y(0.7);
        let expected = without_graph(&fixture, settings, &vectors, &texels, turn, first);
        assert_eq!(run(&fixture, &mut execution, imports), expected, "{method:?}");
        // The same plan again, turned: no new plan, and the environment is not projected again.
        rotations.set(turn * -2.0, &[second]).unwrap();
        let expected = without_graph(&fixture, settings, &vectors, &texels, turn, second);
        assert_eq!(run(&fixture, &mut execution, imports), expected, "{method:?}, turned");
        // A power of two as pre-exposure changes exponents only.
        rotations.set_pre_exposure(8.0).unwrap();
        let exposed = |rgba: &[f32]| [8.0 * rgba[0], 8.0 * rgba[1], 8.0 * rgba[2], 1.0];
        let expected: Vec<f32> = expected.chunks_exact(4).flat_map(exposed).collect();
        assert_eq!(run(&fixture, &mut execution, imports), expected, "{method:?}, pre-exposed");
        assert!(rotations.set(turn, &[first, second]).is_err(), "two rotations for one instance");
        assert!(rotations.set(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), &[first]).is_err(), "no rotation at all");
    }
}

#[test]
fn every_instance_has_its_own_rotation_and_range() {
    let fixture = fixture();
    let (context, texels) = (fixture.context(), texels(13));
    let sky = sky(&fixture, &texels);
    let turn = DQuat::from_rotation_y(0.7);
    for method in [Method::Compute, Method::Fragment] {
        let settings = Settings { method, ..Settings::default() };
        let mut relight = Relight::new(context, settings).unwrap();
        let meshes = [mesh(context, &mut relight, 1030, 14), mesh(context, &mut relight, 70, 15)];
        let which = [0, 1, 0];
        let rotations =
            [DQuat::from_rotation_x(1.0), DQuat::from_rotation_z(0.4), DQuat::from_rotation_y(3.0)];
        let instance =
            |i: usize| Instance { orientation: rotations[i].into(), ..Instance::new(meshes[which[i]].0) };
        let built = build(context, &mut relight, &sky, 1, (0..3).map(instance).collect());
        let ranges = built.ranges.clone();
        let results = run_once(&fixture, built);
        for (i, range) in ranges.iter().enumerate() {
            let vectors = &meshes[which[i]].1;
            let expected = without_graph(&fixture, settings, vectors, &texels, turn, rotations[i]);
            let first = range.offset as usize / 4;
            assert_eq!(range.vertices as usize, vectors.len() / 16);
            assert_eq!(results[first..first + range.size as usize / 4], expected, "{method:?} instance {i}");
        }
    }
}

#[test]
fn an_unchanged_environment_is_left_out_and_a_changed_one_comes_back() {
    let fixture = fixture();
    let context = fixture.context();
    let (first, second) = (sky(&fixture, &texels(3)), sky(&fixture, &texels(4)));
    let mut relight = Relight::new(context, Settings::default()).unwrap();
    let (mesh, _) = mesh(context, &mut relight, 100, 5);
    let instances = || vec![Instance::new(mesh)];
    let projects =
        |built: &Built| built.plan.steps().iter().any(|step| &*step.name == "relight environment rows");
    let built = build(context, &mut relight, &first, 1, instances());
    assert!(projects(&built));
    let before = run_once(&fixture, built);
    let built = build(context, &mut relight, &first, 1, instances());
    assert!(!projects(&built), "{}", built.plan.text());
    let left_out = built.plan.left_out().iter().any(|left_out| left_out.what == "relight environment");
    assert!(left_out, "{}", built.plan.text());
    assert_eq!(run_once(&fixture, built), before, "the same light, not projected again");
    let built = build(context, &mut relight, &second, 2, instances());
    assert!(projects(&built));
    assert_ne!(run_once(&fixture, built), before, "another light");
}

#[test]
fn meshes_come_and_go_between_frames() {
    let fixture = fixture();
    let (context, texels) = (fixture.context(), texels(6));
    let sky = sky(&fixture, &texels);
    let mut relight = Relight::new(context, Settings::default()).unwrap();
    let (old, _) = mesh(context, &mut relight, 300, 7);
    let built = build(context, &mut relight, &sky, 1, vec![Instance::new(old)]);
    run_once(&fixture, built);
    let vectors = Numbers::new(8).values(500 * 16);
    let new = relight.replace_mesh(context, old, "other mesh", 500, Some(&vectors)).unwrap();
    let built = build(context, &mut relight, &sky, 1, vec![Instance::new(new)]);
    let uploads = |built: &Built| built.plan.steps().iter().any(|step| &*step.name == "relight uploads");
    assert!(uploads(&built), "{}", built.plan.text());
    let turn = DQuat::from_rotation_y(0.7);
    let expected = without_graph(&fixture, Settings::default(), &vectors, &texels, turn, DQuat::IDENTITY);
    assert_eq!(run_once(&fixture, built), expected);
    let built = build(context, &mut relight, &sky, 1, vec![Instance::new(new)]);
    assert!(!uploads(&built), "uploaded once: {}", built.plan.text());
    let frame =
        |mesh| Frame::<(), ()> { light: Light::Vertices, instances: vec![Instance::new(mesh)], target: None };
    assert!(relight.prepare(context, &frame(old)).err().unwrap().to_string().contains("mesh 0"));
    relight.drop_mesh(new).unwrap();
    assert!(relight.drop_mesh(new).is_err(), "dropped twice");
}

#[test]
fn without_light_or_instances_the_pass_is_left_out() {
    let fixture = fixture();
    let context = fixture.context();
    let mut relight = Relight::new(context, Settings::default()).unwrap();
    let (mesh, _) = mesh(context, &mut relight, 100, 9);
    for (instances, why) in [(vec![Instance::new(mesh)], "no environment"), (Vec::new(), "no instance")] {
        let (mut graph, mut imports) = (Graph::new(), Imports::new());
        let frame = GraphFrame { light: Light::None, instances, target: None };
        let relit = relight.add(context, &mut graph, &mut imports, &frame).unwrap();
        assert!(relit.results.is_none() && relit.ranges.is_empty());
        let plan = airglow_tests::plan::compile(graph, &Limits::default());
        assert_eq!(plan.steps().len(), 0);
        assert!(plan.left_out()[0].why.contains(why), "{:?}", plan.left_out());
    }
}

#[test]
fn inputs_that_do_not_fit_the_settings_are_refused() {
    let fixture = fixture();
    let context = fixture.context();
    let mut relight = Relight::new(context, Settings::default()).unwrap();
    let (mesh, _) = mesh(context, &mut relight, 10, 10);
    let uniform = Light::Uniform { coefficients: (), rotation: DQuat::IDENTITY };
    let mut refusal = |light: Light<(), ()>, instance| {
        let frame = Frame { light, instances: vec![instance], target: None };
        relight.prepare(context, &frame).err().map(|error| error.to_string()).unwrap_or_default()
    };
    assert!(refusal(Light::Vertices, Instance::new(mesh)).contains("Settings::light"));
    let shadowed = Instance { visibility: Some(()), ..Instance::new(mesh) };
    assert!(refusal(uniform, shadowed).contains("Settings::visibility"));
    let still = Instance { orientation: DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0).into(), ..Instance::new(mesh) };
    assert!(refusal(uniform, still).contains("zero"));
    assert_eq!(refusal(uniform, Instance::new(mesh)), "");
    let nan = vec![f32::NAN; 32];
    assert!(relight.add_mesh(context, "bad", 2, Some(&nan)).unwrap_err().to_string().contains("32 of"));
    assert!(relight.add_mesh(context, "short", 3, Some(&[0.0; 32])).is_err());
    assert!(relight.add_mesh(context, "empty", 0, Some(&[])).is_err());
    assert!(Relight::new(context, Settings { order: 7, ..Settings::default() }).is_err());
}

#[test]
fn the_plan_is_as_written_down() {
    let fixture = fixture();
    let context = fixture.context();
    let sky = sky(&fixture, &texels(11));
    for (method, name) in [(Method::Compute, "compute"), (Method::Fragment, "fragment")] {
        let mut relight = Relight::new(context, Settings { method, ..Settings::default() }).unwrap();
        let (mesh, _) = mesh(context, &mut relight, 1000, 12);
        let built = build(context, &mut relight, &sky, 1, vec![Instance::new(mesh), Instance::new(mesh)]);
        let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/plans/{name}.txt"));
        assert_text(&golden, &built.plan.text());
    }
}

/// A live environment is not looked at by the CPU: what is not finite in it stays where it is.
#[test]
fn a_bad_texel_stays_local() {
    let fixture = fixture();
    let context = fixture.context();
    let colours = |texels: &[[f32; 3]]| {
        let mut relight = Relight::new(context, Settings::default()).unwrap();
        let (mesh, _) = mesh(context, &mut relight, 200, 2);
        let sky = sky(&fixture, texels);
        run_once(&fixture, build(context, &mut relight, &sky, 1, vec![Instance::new(mesh)]))
    };
    let good = texels(3);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let (mut broken, mut mended) = (good.clone(), good.clone());
        (broken[137][1], mended[137][1]) = (bad, 0.0);
        let (found, expected) = (colours(&broken), colours(&mended));
        assert!(found.iter().all(|value| value.is_finite()), "{bad} reached a vertex");
        assert_eq!(found, expected, "{bad} is not black");
        assert_ne!(found, colours(&good), "the texel is seen");
    }
}

#[test]
fn bad_texels_are_counted_where_that_is_asked_for_and_colours_keep_their_bits() {
    let fixture = fixture();
    let context = fixture.context();
    let device = fixture.device();
    let mut broken = texels(3);
    let mut mended = broken.clone();
    for (i, bad) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY].into_iter().cycle().take(7).enumerate() {
        let texel = 31 * i + 5;
        (broken[texel][i % 3], mended[texel][i % 3]) = (bad, 0.0);
    }
    // Two components of one texel are one texel, and what is negative is counted by itself and taken as it is.
    (broken[5][2], mended[5][2]) = (f32::NAN, 0.0);
    for texel in [40, 41] {
        (broken[texel][1], mended[texel][1]) = (-0.5, -0.5);
    }
    let run = |health: bool, texels: &[[f32; 3]]| {
        let made = context.pipelines_made();
        let mut relight = Relight::new(context, Settings { health, ..Settings::default() }).unwrap();
        let made = context.pipelines_made() - made;
        let (mesh, _) = mesh(context, &mut relight, 200, 2);
        let sky = sky(&fixture, texels);
        if let Some(health) = relight.health() {
            device.run(context, |recorder| health.clear(recorder)).unwrap();
        }
        let built = build(context, &mut relight, &sky, 1, vec![Instance::new(mesh)]);
        let colours = run_once(&fixture, built);
        let counts = relight.health().map(|health| {
            device.run(context, |recorder| health.collect(recorder)).unwrap();
            for _ in 0..context.frames_in_flight() {
                device.run(context, |_| Ok(())).unwrap();
            }
            health.latest(context).unwrap().unwrap().counts.into_iter().map(|(_, count)| count).collect()
        });
        (colours, counts, made)
    };
    let (colours, counts, made) = run(true, &broken);
    assert_eq!(counts, Some(vec![7, 2]));
    let (expected, none, made_without) = run(false, &mended);
    assert_eq!((colours, none), (expected.clone(), None::<Vec<u32>>));
    assert_eq!(made, made_without + 1, "counting takes a kernel of its own");
    assert_eq!(run(true, &mended), (expected, Some(vec![0, 2]), made));
}
