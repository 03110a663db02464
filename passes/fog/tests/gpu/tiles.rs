//! What tiles leave out of a picture is below the bound, and several views are one pass of the same bits.

use airglow_fog::bench::{Bench, Ray, settings};
use airglow_fog::{
    ACCESSES, Bounds, Camera, Cone, Counts, Fog, Frame, Light, Medium, Phase, Prepared, Preset, Settings,
    TILE, View,
};
use airglow_gpu::ash::vk::{Format, ImageUsageFlags};
use airglow_gpu::{GpuError, Record, Recorder};
use airglow_graph::{Graph, ImageDesc};
use airglow_math::World;
use airglow_tests::device::{Fixture, fixture_with};
use glam::DVec3;

use crate::images::Images;

const SIZE: [u32; 2] = [300, 170];
const LIGHTS: usize = 24;

/// Weak points, ranges, spots and boxes.
fn light(i: usize) -> Light {
    let part = |alpha: f64| (0.5 + alpha * i as f64).fract();
    let [a, b, c] = [0.819_172_513, 0.671_043_607, 0.549_700_478].map(part);
    let position = DVec3::new(16.0 * (a - 0.5), 9.0 * (b - 0.5), 2.0 - 16.0 * c);
    let point = Light { radius: 0.05, ..Light::point(position, [4.0, 3.0, 2.0]) };
    match i % 4 {
        0 => Light { intensity: [0.4, 0.3, 0.2], ..point },
        1 => Light { range: Some(1.0 + c), ..point },
        2 => {
            let outer = 0.2 + a;
            let cone = Cone { direction: DVec3::new(b - 0.5, -1.0, 0.3), inner: 0.5 * outer, outer };
            Light { cone: Some(cone), range: (i % 8 == 2).then_some(2.0), ..point }
        }
        _ => Light { bounds: Some(Bounds { low: position - 1.0, high: position + c }), ..point },
    }
}

fn view(orthographic: bool) -> View {
    let mut world = World::default();
    world.depth.orthographic = orthographic;
    let size = if orthographic { 8.0 } else { 0.8 };
    let camera = Camera {
        position: DVec3::new(0.3, 0.2, 4.0),
        right: DVec3::X,
        up: DVec3::Y,
        forward: DVec3::NEG_Z,
        edges: [-size, size, -0.5625 * size, 0.5625 * size],
    };
    let medium = Medium {
        extinction: [0.1, 0.12, 0.15],
        albedo: [0.9; 3],
        phase: Phase::HenyeyGreenstein { g: 0.5 },
        thinning: None,
    };
    View { world, camera, medium, lights: (0..LIGHTS).map(light).collect(), environment: None }
}

/// The ray of a pixel, to one of the lights.
fn ray(view: &View, pixel: usize, light: Light) -> Ray {
    let [width, height] = SIZE.map(|side| side as usize);
    let [x, y] =
        [(pixel % width, width), (pixel / width, height)].map(|(at, side)| (at as f64 + 0.5) / side as f64);
    let View { world, camera, medium, .. } = view;
    let [left, right, low, high] = camera.edges;
    let on_plane = (left + x * (right - left)) * camera.right + (high + y * (low - high)) * camera.up;
    let (eye, direction) = match world.depth.orthographic {
        true => (camera.position + on_plane, camera.forward),
        false => (camera.position, (on_plane + camera.forward).normalize()),
    };
    Ray { eye, medium: *medium, light, direction, distance: f64::INFINITY }
}

fn draw(fixture: &Fixture, images: &Images, view: &View, bound: f64) -> (Vec<[f32; 4]>, Counts) {
    let settings = Settings { bound, preset: Preset::Reference, ..Settings::default() };
    let fog = Fog::new(fixture.context(), settings).unwrap();
    let frame = Frame { size: SIZE, surface: (), depth: (), target: Some(()), view: view.clone() };
    let Prepared::Pass(pass) = fog.prepare(&frame).unwrap() else { panic!("there is a medium") };
    (images.draw(fixture, &pass), pass.control.counts())
}

#[test]
fn what_tiles_leave_out_is_below_the_bound() {
    let fixture = fixture_with(&Fog::requirements(&Settings::default()));
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    let bench = Bench { context: fixture.context(), run: &run };
    let farthest = World::default().depth.farthest() as f32;
    let images = Images::of(&fixture, SIZE, |_| 0.0, |_| farthest);
    for orthographic in [false, true] {
        let view = view(orthographic);
        let pixels: Vec<usize> = (0..(SIZE[0] * SIZE[1]) as usize).step_by(41).collect();
        // Every light at every pixel, by the pass's functions without its tiles.
        let rays: Vec<Ray> = pixels
            .iter()
            .flat_map(|&pixel| view.lights.iter().map(move |light| (pixel, *light)))
            .map(|(pixel, light)| ray(&view, pixel, light))
            .collect();
        let all = bench.airlight(&settings(&view.medium, Preset::Reference), &rays).unwrap();
        let mut left_out = Vec::new();
        for bound in [0.0, 1e-2, 0.1] {
            let (picture, counts) = draw(&fixture, &images, &view, bound);
            let tiles = SIZE.map(|side| side.div_ceil(TILE)).iter().product::<u32>();
            assert_eq!(counts.pairs + counts.pairs_left_out, tiles * LIGHTS as u32);
            assert_eq!(counts.evaluated + counts.left_out, LIGHTS as u32);
            left_out.push(counts.pairs_left_out);
            let mut worst = 0.0_f64;
            for (&pixel, lights) in pixels.iter().zip(all.chunks(LIGHTS)) {
                for channel in 0..3 {
                    let expected: f64 = lights.iter().map(|light| f64::from(light[channel])).sum();
                    let found = f64::from(picture[pixel][channel]);
                    // Positions rounded after other subtractions.
                    let allowed = LIGHTS as f64 * bound + 1e-4 * expected + 1e-9;
                    let error = (found - expected).abs();
                    assert!(error <= allowed, "{orthographic}, {bound}, {pixel}: {found}, {expected}");
                    worst = worst.max(error / allowed);
                }
            }
            println!("orthographic {orthographic}, bound {bound}: {worst:.2} of what is allowed, {counts:?}");
        }
        assert!(left_out[0] > 0 && left_out[0] < left_out[1] && left_out[1] < left_out[2], "{left_out:?}");
    }
}

#[test]
fn several_views_are_one_pass() {
    let fixture = fixture_with(&Fog::requirements(&Settings::default()));
    let fog = Fog::new(fixture.context(), Settings::default()).unwrap();
    let mut graph = Graph::<Record>::new();
    let usage = ImageUsageFlags::SAMPLED;
    let frames: Vec<_> = [false, true, false]
        .into_iter()
        .enumerate()
        .map(|(i, orthographic)| {
            let mut image = |(name, access), format| {
                let desc = ImageDesc { usage, ..ImageDesc::new_2d(SIZE[0], SIZE[1], format) };
                graph.import_image(name, desc, access, access)
            };
            let surface = image(ACCESSES[0], Format::R32G32B32A32_SFLOAT);
            let depth = image(ACCESSES[1], Format::D32_SFLOAT);
            let mut view = view(orthographic);
            if i == 2 {
                view.medium.extinction = [0.0; 3];
            }
            Frame { size: SIZE, surface, depth, target: None, view }
        })
        .collect();
    let fogged = fog.add_views(&mut graph, &frames).unwrap();
    assert_eq!(fogged[2].colour, frames[2].surface, "its medium is clear");
    assert!(fogged[0].control.is_some() && fogged[2].control.is_none());
    for seen in &fogged[..2] {
        let mut pass = graph.pass("host", airglow_graph::PassKind::Graphics);
        pass.side_effect().read(&seen.colour, ACCESSES[0].1).record(Box::new(|_, _| Ok(())));
    }
    let plan = graph.compile(&fixture.context().graph_limits()).unwrap();
    let passes = plan.steps().iter().filter(|step| step.name == "fog airlight").count();
    assert_eq!((passes, plan.left_out().len()), (1, 1), "{}", plan.text());
}
