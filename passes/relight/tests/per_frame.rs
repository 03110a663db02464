//! What may come and go within a plan costs nothing when it is away: no pipeline, no allocation, no new plan.

#![expect(clippy::unwrap_used, reason = "helpers fail the test they are called from")]

#[path = "gpu/host/mod.rs"]
mod host;

use std::sync::{Arc, Mutex};

use airglow_gpu::ash::vk::{BufferUsageFlags, ImageUsageFlags};
use airglow_gpu::open::{FrameLoop, FrameSemaphores};
use airglow_gpu::{Buffer, Context, Counts, Execution, Imports, Label, Location, Readback, Recorder, Timing};
use airglow_graph::{Access, BufferDesc, Graph, ImageDesc, PassKind, ResourceDesc};
use airglow_relight::{
    Bindings, Frame, GraphFrame, Instance, Light, Method, Need, Prepared, Relight, Relit, Resource,
    ResultRange, Settings, Shown,
};
use airglow_tests::device::Fixture;
use airglow_tests::heap::{Counting, allocations};
use glam::DQuat;
use host::{Numbers, fixture};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// A large instance that comes and goes between two small ones.
const VERTICES: [u32; 3] = [500, 200_000, 300];

/// Frames before those that count.
const WARM_UP: usize = 20;
/// Newest frames whose times are kept; memory for them is made while warming up.
const KEPT: usize = 9;

/// A plan of three instances, and what reads their results back when asked.
struct Built {
    execution: Execution,
    imports: Imports,
    shown: Shown,
    ranges: Vec<ResultRange>,
    wanted: Arc<Mutex<bool>>,
    readback: Arc<Mutex<Option<Readback>>>,
}

/// A light of the host's.
fn light(context: &Context, numbers: &mut Numbers) -> Buffer {
    let light: Vec<[f32; 4]> = numbers.rgb(16).into_iter().map(|[r, g, b]| [r, g, b, 0.0]).collect();
    let desc = BufferDesc { size: 256, usage: BufferUsageFlags::STORAGE_BUFFER };
    let buffer = context.create_buffer(Label::new("host", "light"), &desc, Location::Upload).unwrap();
    buffer.write(0, &light).unwrap();
    buffer
}

/// Instances of a mesh each.
fn instances<B>(
    context: &Context,
    relight: &mut Relight,
    numbers: &mut Numbers,
    vertices: &[u32],
) -> Vec<Instance<B>> {
    let instance = |(i, &vertices): (usize, &u32)| {
        let vectors = numbers.values(16 * vertices as usize);
        let mesh = relight.add_mesh(context, &format!("mesh {i}"), vertices, Some(&vectors)).unwrap();
        Instance { orientation: DQuat::from_rotation_y(i as f64).into(), ..Instance::new(mesh) }
    };
    vertices.iter().enumerate().map(instance).collect()
}

/// With dynamic visibility where `shadowed` says so.
fn build(context: &Context, relight: &mut Relight, vertices: &[u32], shadowed: bool) -> Built {
    let mut numbers = Numbers::new(101);
    let buffer = light(context, &mut numbers);
    let (mut graph, mut imports) = (Graph::new(), Imports::new());
    let state = Access::ComputeStorageRead;
    let coefficients = graph.import_buffer("light", *buffer.desc(), state, state);
    imports.buffer(&coefficients, &buffer);
    let mut instances = instances(context, relight, &mut numbers, vertices);
    for (instance, vertices) in instances.iter_mut().zip(vertices).filter(|_| shadowed) {
        let values = numbers.values(16 * *vertices as usize);
        let desc = BufferDesc { size: 64 * u64::from(*vertices), usage: BufferUsageFlags::STORAGE_BUFFER };
        let label = Label::new("host", "visibility");
        let buffer = context.create_buffer(label, &desc, Location::Upload).unwrap();
        buffer.write(0, &values).unwrap();
        let visibility = graph.import_buffer("visibility", desc, state, state);
        imports.buffer(&visibility, &buffer);
        instance.visibility = Some(visibility);
    }
    let light = Light::Uniform { coefficients, rotation: DQuat::IDENTITY };
    let frame: GraphFrame = Frame { light, instances, target: None };
    let Relit { results, ranges, shown, .. } =
        relight.add(context, &mut graph, &mut imports, &frame).unwrap();
    let results = results.unwrap();
    let (wanted, readback) = (Arc::new(Mutex::new(false)), Arc::new(Mutex::new(None)));
    let mut pass = graph.pass("read back", PassKind::Transfer);
    pass.read(&results, Access::TransferSource).side_effect();
    let (asked, slot) = (Arc::clone(&wanted), Arc::clone(&readback));
    pass.record(Box::new(move |recorder, resources| {
        if *asked.lock().unwrap() {
            *slot.lock().unwrap() = Some(recorder.read_back_buffer(resources.buffer(&results)?)?);
        }
        Ok(())
    }));
    let plan = airglow_tests::plan::compile(graph, &context.graph_limits());
    let execution = Execution::prepare(context, plan).unwrap();
    Built { execution, imports, shown, ranges, wanted, readback }
}

/// Frames with the large instance shown where `shown` says so: allocations after warm-up, and the median device time of
/// a frame, seconds.
fn frames(fixture: &Fixture, built: &mut Built, shown: impl Fn(usize) -> bool) -> (u64, f64) {
    frames_with(fixture, built, |built, frame| built.shown.set(1, shown(frame)).unwrap())
}

/// Frames before each of which `change` is made.
fn frames_with(fixture: &Fixture, built: &mut Built, change: impl Fn(&Built, usize)) -> (u64, f64) {
    let context = fixture.context();
    let passes = built.execution.plan().steps().len() as u32;
    let mut timing = Timing::new(context, passes, 0, KEPT).unwrap();
    let mut frames = FrameLoop::new(fixture.device(), context).unwrap();
    let mut counted = 0;
    for frame in 0..WARM_UP + 30 {
        let recorded = frames.frame(FrameSemaphores::default(), |commands| {
            let before = allocations();
            change(built, frame);
            // SAFETY: the loop's command buffer is recording and submitted once; imports are in their entry states.
            let recorded =
                unsafe { built.execution.record(context, commands, &built.imports, Some(&mut timing)) };
            if frame >= WARM_UP {
                counted += allocations() - before;
            }
            recorded
        });
        recorded.unwrap();
    }
    frames.finish().unwrap();
    timing.collect().unwrap();
    let times: Vec<f64> = timing.frames().map(|times| times.sum).collect();
    (counted, airglow_math::statistics::median(&times).unwrap())
}

/// Dispatches and draws of the frame recorded last, and the bytes they bind.
fn work(built: &Built) -> (u64, u64) {
    let counts = built.execution.counts().iter().copied().reduce(Counts::and).unwrap();
    (counts.dispatches + counts.draws, counts.bound_bytes)
}

/// The results of the plan as it stands.
fn results(fixture: &Fixture, built: &mut Built) -> Vec<f32> {
    *built.wanted.lock().unwrap() = true;
    let mut frames = FrameLoop::new(fixture.device(), fixture.context()).unwrap();
    let record = |commands| {
        // SAFETY: the loop's command buffer is recording and submitted once; imports are in their entry states.
        unsafe { built.execution.record(fixture.context(), commands, &built.imports, None) }
    };
    frames.frame(FrameSemaphores::default(), record).unwrap();
    frames.finish().unwrap();
    *built.wanted.lock().unwrap() = false;
    built.readback.lock().unwrap().take().unwrap().read().unwrap()
}

#[test]
fn an_instance_that_comes_and_goes_costs_nothing_when_away() {
    let fixture = fixture();
    let context = fixture.context();
    for method in [Method::Compute, Method::Fragment] {
        let mut relight = Relight::new(context, Settings { method, ..Settings::default() }).unwrap();
        let mut built = build(context, &mut relight, &VERTICES, false);
        // The first frame copies the meshes to the device and gives their staging memory back.
        let whole = results(&fixture, &mut built);
        let made = context.pipelines_made();
        let (allocations, time) = frames(&fixture, &mut built, |_| true);
        let all = work(&built);
        let (allocations_away, time_away) = frames(&fixture, &mut built, |_| false);
        let away = work(&built);
        let (allocations_changing, _) = frames(&fixture, &mut built, |frame| frame % 3 == 0);
        println!(
            "{method:?}: {:.3} ms and {all:?} dispatches or draws and bytes with it, {:.3} ms and {away:?} without",
            1e3 * time,
            1e3 * time_away
        );
        assert_eq!([allocations, allocations_away, allocations_changing], [0; 3], "{method:?}");
        assert_eq!(context.pipelines_made(), made, "{method:?}: a pipeline was made");
        assert_eq!(all.0 - away.0, 1, "{method:?}: {all:?} {away:?}");
        assert!(all.1 - away.1 > 64 * u64::from(VERTICES[1]), "{method:?}: {all:?} {away:?}");

        // The others keep their bits, and it has its own again when it is back.
        built.shown.set(1, false).unwrap();
        let without = results(&fixture, &mut built);
        for range in [built.ranges[0], built.ranges[2]] {
            let values = range.offset as usize / 4..(range.offset + range.size) as usize / 4;
            assert!(without[values.clone()] == whole[values], "{method:?}: {range:?} changed");
        }
        built.shown.set(1, true).unwrap();
        assert!(results(&fixture, &mut built) == whole, "{method:?}: it came back otherwise");
        assert!(built.shown.set(3, true).unwrap_err().to_string().contains("below 3"));
    }
}

#[test]
fn shadows_and_light_that_are_away_cost_nothing() {
    const SMALL: [u32; 2] = [500, 300];
    let fixture = fixture();
    let context = fixture.context();
    for method in [Method::Compute, Method::Fragment] {
        let settings = Settings { method, visibility: true, ..Settings::default() };
        let mut relight = Relight::new(context, settings).unwrap();
        let plain = results(&fixture, &mut build(context, &mut relight, &SMALL, false));
        let mut built = build(context, &mut relight, &SMALL, true);
        let whole = results(&fixture, &mut built);
        let made = context.pipelines_made();
        let of = |values: &[f32], range: ResultRange| {
            values[range.offset as usize / 4..(range.offset + range.size) as usize / 4].to_vec()
        };
        let [first, second] = built.ranges[..] else { panic!("two instances") };

        // One instance leaves the shadow: it gets the bits of a plan without, the other keeps its own.
        built.shown.set_shadowed(0, false).unwrap();
        let half = results(&fixture, &mut built);
        assert!(
            of(&half, first) == of(&plain, first) && of(&whole, first) != of(&plain, first),
            "{method:?}"
        );
        assert!(of(&half, second) == of(&whole, second), "{method:?}");
        let all = work(&built);

        // The other, too: then there are no product matrices.
        built.shown.set_shadowed(1, false).unwrap();
        assert!(of(&results(&fixture, &mut built), second) == of(&plain, second), "{method:?}");
        let open = work(&built);
        assert_eq!(all.0 - open.0, 1, "{method:?}: {all:?} {open:?}");
        assert!(all.1 - open.1 > 64 * u64::from(SMALL[1]), "{method:?}: {all:?} {open:?}");
        let said = built.shown.left_out();
        assert!(said.len() == 1 && said[0].what.contains("visibility of 2 of 2 instances"), "{said:?}");

        // The light goes out: nothing is left to do, and it comes back as it was.
        built.shown.set_lit(false);
        let (allocations_out, _) = frames_with(&fixture, &mut built, |_, _| {});
        assert_eq!(work(&built).0, 0, "{method:?}");
        assert!(built.shown.left_out()[0].why.contains("the light is out"));
        built.shown.set_lit(true);
        [0, 1].iter().for_each(|instance| built.shown.set_shadowed(*instance, true).unwrap());
        assert!(built.shown.left_out().is_empty());
        assert!(results(&fixture, &mut built) == whole, "{method:?}: it came back otherwise");
        let (allocations_changing, _) = frames_with(&fixture, &mut built, |built, frame| {
            built.shown.set_lit(frame % 5 != 0);
            built.shown.set_shadowed(frame % 2, frame % 3 == 0).unwrap();
        });
        assert_eq!([allocations_out, allocations_changing], [0; 2], "{method:?}");
        assert_eq!(context.pipelines_made(), made, "{method:?}: a pipeline was made");
    }
}

/// What a host without a graph gives: its light, and the scratch that was asked for.
fn bindings(context: &Context, prepared: &Prepared, light: &Buffer) -> Bindings {
    let mut bindings = Bindings::default();
    bindings.buffers.insert(Resource::UniformLight, light.into());
    for (resource, need) in &prepared.needs {
        let label = Label::new("host", "scratch");
        match need {
            Need::Scratch(ResourceDesc::Buffer(desc)) => {
                let usage = BufferUsageFlags::STORAGE_BUFFER
                    | BufferUsageFlags::UNIFORM_BUFFER
                    | BufferUsageFlags::TRANSFER_DST;
                let desc = BufferDesc { usage, ..*desc };
                let buffer = context.create_buffer(label, &desc, Location::Device).unwrap();
                bindings.buffers.insert(*resource, (&buffer).into());
            }
            Need::Scratch(ResourceDesc::Image(desc)) => {
                let usage = ImageUsageFlags::COLOR_ATTACHMENT | ImageUsageFlags::TRANSFER_SRC;
                let image = context.create_image(label, &ImageDesc { usage, ..*desc }).unwrap();
                bindings.images.insert(*resource, image.full_view().unwrap());
            }
            Need::Ours { .. } | Need::Host => {}
        }
    }
    bindings
}

#[test]
fn a_frame_without_a_graph_allocates_nothing_after_warm_up() {
    let fixture = fixture();
    let context = fixture.context();
    for method in [Method::Compute, Method::Fragment] {
        let mut numbers = Numbers::new(103);
        let mut relight = Relight::new(context, Settings { method, ..Settings::default() }).unwrap();
        let host = light(context, &mut numbers);
        let instances = instances(context, &mut relight, &mut numbers, &VERTICES);
        let light = Light::Uniform { coefficients: (), rotation: DQuat::IDENTITY };
        let frame: Frame<(), ()> = Frame { light, instances, target: None };
        let prepared = relight.prepare(context, &frame).unwrap();
        let bindings = bindings(context, &prepared, &host);
        let mut frames = FrameLoop::new(fixture.device(), context).unwrap();
        let mut counted = 0;
        for frame in 0..WARM_UP + 10 {
            let recorded = frames.frame(FrameSemaphores::default(), |commands| {
                let before = allocations();
                prepared.shown.set(1, frame % 3 == 0).unwrap();
                // SAFETY: the loop's command buffer is recording, in this frame, and is submitted once.
                let mut recorder = unsafe { Recorder::new(context, commands) };
                // What the frame before wrote and read is written anew.
                for access in
                    [Access::ComputeStorageRead, Access::ComputeStorageWrite, Access::TransferDestination]
                {
                    recorder.memory_barrier(access, Access::ComputeStorageWrite)?;
                    recorder.memory_barrier(access, Access::TransferDestination)?;
                }
                let recorded = prepared.record(&mut recorder, &bindings);
                let allocated = allocations() - before;
                counted += if frame < WARM_UP { 0 } else { allocated };
                recorded
            });
            recorded.unwrap();
        }
        frames.finish().unwrap();
        assert!(allocations() > 0, "nothing is counted");
        assert_eq!(counted, 0, "{method:?}");
    }
}
