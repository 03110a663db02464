//! Lamps that come and go between frames cost nothing: no compile, no pipeline, no allocation, no new plan.

#![expect(clippy::unwrap_used, clippy::panic, reason = "helpers fail the test they are called from")]

use airglow_fog::{ACCESSES, Camera, Fog, Fogged, Frame, Light, Medium, Settings, View};
use airglow_gpu::ash::vk::{Format, ImageUsageFlags};
use airglow_gpu::open::{FrameLoop, FrameSemaphores};
use airglow_gpu::requirements::Limit;
use airglow_gpu::{Context, Execution, Image, Imports, Label, Missing, Offer, Record};
use airglow_graph::{Graph, Handle, ImageDesc, State, Topology};
use airglow_math::World;
use airglow_tests::device::fixture_with;
use airglow_tests::heap::{Counting, allocations};
use glam::DVec3;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const SIZE: [u32; 2] = [32, 18];
/// Frames before those that count.
const WARM_UP: usize = 20;

/// Lamps of a frame: none, one, all that a frame can have, none; and one that no pixel can see.
const LAMPS: [usize; 5] = [0, 1, 64, 0, 2];

fn view(lamps: usize) -> View {
    let camera = Camera {
        position: DVec3::new(0.0, 1.7, 8.0),
        right: DVec3::X,
        up: DVec3::Y,
        forward: DVec3::NEG_Z,
        edges: [-0.8, 0.8, -0.45, 0.45],
    };
    let lamp = |i: usize| {
        let position = DVec3::new(if lamps == 2 && i == 1 { 1e4 } else { 0.1 * i as f64 }, 3.0, 0.0);
        Light { radius: 0.1, ..Light::point(position, [40.0, 30.0, 15.0]) }
    };
    let lights = (0..lamps).map(lamp).collect();
    View { world: World::default(), camera, medium: Medium::with_visibility(60.0), lights, environment: None }
}

/// What a host gives: the surface, its depth, the picture.
fn images(context: &Context) -> [Image; 3] {
    let (hdr, sampled) = (Format::R32G32B32A32_SFLOAT, ImageUsageFlags::SAMPLED);
    let depth = sampled | ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
    let kinds = [(hdr, sampled), (Format::D32_SFLOAT, depth), (hdr, ImageUsageFlags::COLOR_ATTACHMENT)];
    kinds.map(|(format, usage)| {
        let desc = ImageDesc { usage, ..ImageDesc::new_2d(SIZE[0], SIZE[1], format) };
        context.create_image(Label::new("host", "image"), &desc).unwrap()
    })
}

/// The frame with so many lamps, declared.
fn declare(
    fog: &Fog,
    images: &[Image; 3],
    lamps: usize,
) -> (Graph<Record>, Imports, Fogged<Handle<airglow_graph::Image>>) {
    let (mut graph, mut imports) = (Graph::new(), Imports::new());
    let mut handles = Vec::new();
    for ((name, access), image) in ACCESSES.into_iter().zip(images) {
        let entry = if access.writes() { State::UNDEFINED } else { access.into() };
        let handle = graph.import_image(name, *image.desc(), entry, access);
        imports.image(&handle, image);
        handles.push(handle);
    }
    let [surface, depth, target] = handles[..] else { panic!("three images") };
    let frame = Frame { size: SIZE, surface, depth, target: Some(target), view: view(lamps) };
    let fogged = fog.add(&mut graph, &frame).unwrap();
    (graph, imports, fogged)
}

#[test]
fn a_lamp_that_enters_makes_no_plan_no_pipeline_and_no_allocation() {
    let fixture = fixture_with(&Fog::requirements(&Settings::default()));
    let context = fixture.context();
    let fog = Fog::new(context, Settings::default()).unwrap();
    let images = images(context);
    fixture
        .device()
        .run(context, |recorder| {
            let mut inputs = images.iter().zip(ACCESSES).take(2);
            inputs.try_for_each(|(image, (_, access))| recorder.transition(image, State::UNDEFINED, access))
        })
        .unwrap();
    let keys: Vec<Topology> = LAMPS.map(|lamps| declare(&fog, &images, lamps).0.topology()).to_vec();
    assert!(keys.iter().all(|key| *key == keys[0]), "{keys:?}");

    let (graph, imports, fogged) = declare(&fog, &images, 0);
    let plan = airglow_tests::plan::compile(graph, &context.graph_limits());
    assert!(plan.text().contains("fog") && plan.pipelines()[0].prepared == 3, "{}", plan.text());
    let mut execution = Execution::prepare(context, plan).unwrap();
    let control = fogged.control.unwrap();
    let views = LAMPS.map(view);
    let made = context.pipelines_made();
    let mut frames = FrameLoop::new(fixture.device(), context).unwrap();
    let mut counted = 0;
    for frame in 0..WARM_UP + 3 * LAMPS.len() {
        let recorded = frames.frame(FrameSemaphores::default(), |commands| {
            let before = allocations();
            let counts = control.set(&views[frame % LAMPS.len()]).unwrap();
            // SAFETY: the loop's command buffer is recording and submitted once; imports are in their entry states.
            let recorded = unsafe { execution.record(context, commands, &imports, None) };
            counted += if frame < WARM_UP { 0 } else { allocations() - before };
            let lamps = LAMPS[frame % LAMPS.len()] as u32;
            let away = u32::from(lamps == 2);
            assert_eq!((counts.evaluated, counts.left_out), (lamps - away, away));
            recorded
        });
        recorded.unwrap();
        // The picture is one tile, of one kind: the others draw nothing.
        let draws: u64 = execution.counts().iter().map(|counts| counts.draws).sum();
        assert_eq!(draws, 1, "{} lamps", LAMPS[frame % LAMPS.len()]);
    }
    frames.finish().unwrap();
    assert!(allocations() > 0, "nothing is counted");
    assert_eq!(counted, 0, "allocations after warm-up");
    assert_eq!(context.pipelines_made(), made, "a pipeline was made");
    assert!(control.left_out().unwrap().what.contains("1 of 2 lights"), "{:?}", control.left_out());
}

#[test]
fn a_device_with_too_few_descriptors_is_told_so() {
    let limits = Limit::ALL
        .iter()
        .map(|&limit| (limit, if limit == Limit::PerStageSampledImages { 1 } else { 1 << 30 }));
    let offer = Offer { limits: limits.collect(), ..Offer::default() };
    let missing = Fog::requirements(&Settings::default()).check(&offer);
    let needed = missing.into_iter().filter_map(|missing| match missing {
        Missing::Limit { need, .. } => Some((need.limit, need.at_least)),
        _ => None,
    });
    assert_eq!(needed.collect::<Vec<_>>(), [(Limit::PerStageSampledImages, 2)]);
}
