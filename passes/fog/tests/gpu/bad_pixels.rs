//! A bad pixel of a live host stays where it is, and is counted if the host asks.

use airglow_fog::{
    Camera, Fog, Frame, HEALTH_BINDINGS, InputHealth, Light, Medium, Prepared, Settings, View,
};
use airglow_gpu::open::{FrameLoop, FrameSemaphores};
use airglow_gpu::{Execution, Image, Imports};
use airglow_graph::{Access, Graph};
use airglow_math::World;
use airglow_tests::device::{Fixture, fixture_with};
use airglow_tests::reflect::Module;
use glam::DVec3;

use crate::images::{Images, SIZE, view_distance};

/// Pixels whose surface is NaN, infinite, negative, and whose depth is NaN, infinite, above 1.
const BAD: [usize; 6] = [3, 411, 700, 500, 801, 1200];

fn radiance(pixel: usize) -> f32 {
    match BAD.iter().position(|bad| *bad == pixel) {
        Some(0) => f32::NAN,
        Some(1) => f32::INFINITY,
        Some(2) => -1.0,
        _ => 0.5,
    }
}

fn depth(pixel: usize) -> f32 {
    let world = World::default().depth;
    match BAD.iter().position(|bad| *bad == pixel) {
        Some(3) => f32::NAN,
        Some(4) => f32::INFINITY,
        Some(5) => 1.5,
        _ => view_distance(pixel).map_or(world.farthest(), |metres| world.value(metres)) as f32,
    }
}

fn view() -> View {
    let camera = Camera {
        position: DVec3::ZERO,
        right: DVec3::X,
        up: DVec3::Y,
        forward: DVec3::NEG_Z,
        edges: [-0.8, 0.8, -0.45, 0.45],
    };
    let lamp = Light { radius: 0.1, ..Light::point(DVec3::new(1.0, 1.0, -6.0), [40.0, 30.0, 15.0]) };
    let medium = Medium::with_visibility(60.0);
    View { world: World::default(), camera, medium, lights: vec![lamp], environment: None }
}

fn draw(fixture: &Fixture, images: &Images) -> Vec<[f32; 4]> {
    let fog = Fog::new(fixture.context(), Settings::default()).unwrap();
    let frame = Frame { size: SIZE, surface: (), depth: (), target: Some(()), view: view() };
    let Prepared::Pass(pass) = fog.prepare(&frame).unwrap() else { panic!("there is a medium") };
    images.draw(fixture, &pass)
}

#[test]
fn a_bad_pixel_stays_where_it_is() {
    let fixture = fixture_with(&Fog::requirements(&Settings::default()));
    let good = Images::new(&fixture, 0.5);
    let bad = Images::of(&fixture, SIZE, radiance, depth);
    let (good, bad) = (draw(&fixture, &good), draw(&fixture, &bad));
    for (pixel, (good, bad)) in good.iter().zip(&bad).enumerate() {
        if !BAD.contains(&pixel) {
            assert_eq!(good.map(f32::to_bits), bad.map(f32::to_bits), "pixel {pixel}: {good:?}, {bad:?}");
        }
    }
}

/// Counts of one frame of the graph's road.
fn counts(fixture: &Fixture, images: &Images, health: &mut InputHealth) -> Vec<u32> {
    let (device, context) = (fixture.device(), fixture.context());
    let (mut graph, mut imports) = (Graph::new(), Imports::new());
    let accesses = [Access::FragmentSampled, Access::FragmentSampledDepth];
    let mut import = |image: &Image, access: Access| {
        let handle = graph.import_image("given", *image.desc(), access, access);
        imports.image(&handle, image);
        handle
    };
    let [surface, depth] = [0, 1].map(|given| import(&images.0[given], accesses[given]));
    health.add(&mut graph, &mut imports, SIZE, vec![[surface, depth]]);
    let plan = airglow_tests::plan::compile(graph, &context.graph_limits());
    let mut execution = Execution::prepare(context, plan).unwrap();
    device.run(context, |recorder| health.counters().clear(recorder)).unwrap();
    let mut frames = FrameLoop::new(device, context).unwrap();
    let recorded = frames.frame(FrameSemaphores::default(), |commands| {
        // SAFETY: the loop's command buffer is recording and submitted once; imports are in their entry states.
        unsafe { execution.record(context, commands, &imports, None) }
    });
    recorded.unwrap();
    frames.finish().unwrap();
    device.run(context, |recorder| health.counters().collect(recorder)).unwrap();
    for _ in 0..context.frames_in_flight() {
        device.run(context, |_| Ok(())).unwrap();
    }
    let latest = health.counters().latest(context).unwrap().unwrap();
    latest.counts.into_iter().map(|(_, count)| count).collect()
}

#[test]
fn bad_pixels_are_counted() {
    Module::load("fog/health.spv").unwrap().assert_bindings(&HEALTH_BINDINGS);
    let fixture = fixture_with(&InputHealth::requirements());
    let mut health = InputHealth::new(fixture.context()).unwrap();
    assert_eq!(counts(&fixture, &Images::new(&fixture, 0.5), &mut health), [0, 0, 0]);
    assert_eq!(counts(&fixture, &Images::of(&fixture, SIZE, radiance, depth), &mut health), [2, 1, 3]);
}
