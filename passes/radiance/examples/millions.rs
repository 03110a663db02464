//! What a receiver of two million vertices takes: `cargo run --release -p airglow-radiance --example millions`.
//!
//! A ball before nine boxes, order 3 without gradients, bound 0.01. Prints the time of the tree, bytes on the device, and
//! of frames: first, emitters moved, and at rest. Wall and CPU time of the whole process, on the device of the tests.

#![expect(clippy::unwrap_used, reason = "an example that stops where it fails")]

use std::ops::ControlFlow;
use std::time::Instant;

use airglow_gpu::{GpuError, Recorder};
use airglow_radiance::gpu::RefineState;
use airglow_radiance::gpu::bench::Bench;
use airglow_radiance::{Hierarchy, Lights, Part, PassSettings, Radiance, Receiver, Triangle};
use airglow_tests::device::fixture_with;
use glam::{DVec3, Vec3};

#[path = "../tests/gpu/scenes.rs"]
#[expect(dead_code, reason = "tests use the rest")]
mod scenes;

const VERTICES: u32 = 2_000_000;

fn main() {
    let settings = PassSettings { order: 3, gradients: false, ..PassSettings::default() };
    let fixture = fixture_with(&Radiance::requirements(&settings));
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    let bench = Bench { context: fixture.context(), run: &run };
    let positions: Vec<[f32; 3]> = (0..VERTICES).map(on_ball).collect();
    let mut told = 0;
    let begin = Instant::now();
    let tree = Hierarchy::build(&positions, &[], &mut |placed, all| {
        if 10 * placed / all > told {
            told = 10 * placed / all;
            println!("tree: {placed} of {all} vertices placed");
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    println!("tree of {} nodes in {:.2} s", tree.nodes().len(), begin.elapsed().as_secs_f64());
    let begin = Instant::now();
    let part = Part { vertices: 0..VERTICES, turn: None };
    let receiver = Receiver::new(bench.context, settings, &tree, &positions, &[part]).unwrap();
    let mebibytes = receiver.bytes() as f64 / f64::from(1 << 20);
    println!("receiver of {mebibytes:.0} MiB in {:.2} s", begin.elapsed().as_secs_f64());
    let radiance = Radiance::new(bench.context, settings).unwrap();
    let blocks = scenes::blocks();
    let moved: Vec<Triangle> = blocks.iter().map(step).collect();
    let lights = Lights { emitters: &blocks, ..Lights::default() };
    let prepared = radiance.prepare(&receiver, &lights).unwrap();
    let light = bench.light_buffers(&prepared).unwrap();
    println!("light of vertices {:.0} MiB", light[0].size() as f64 / f64::from(1 << 20));
    let control = prepared.control.as_ref().unwrap();
    for (name, emitters) in
        [("first frame", &blocks), ("emitters moved 1 mm", &moved), ("emitters at rest", &moved)]
    {
        control.set(&Lights { emitters, ..Lights::default() }).unwrap();
        let begin = Instant::now();
        bench.frame(&prepared, &light).unwrap();
        let seconds = begin.elapsed().as_secs_f64();
        let states: Vec<RefineState> = bench.read(&receiver.samples().state).unwrap();
        let RefineState { taken, fresh, rounds, .. } = states[0];
        println!(
            "{name}: {seconds:.2} s, {taken} samples in {rounds} rounds, {fresh} of them taken when emitters moved last"
        );
    }
}

/// Points evenly on a ball of radius 0.6, along a spiral.
fn on_ball(i: u32) -> [f32; 3] {
    let height = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(VERTICES);
    let (sine, cosine) = (2.399_963_229_728_653 * f64::from(i)).sin_cos();
    let ring = (1.0 - height * height).sqrt();
    (0.6 * Vec3::new((ring * cosine) as f32, height as f32, (ring * sine) as f32)).to_array()
}

fn step(triangle: &Triangle) -> Triangle {
    Triangle { corners: triangle.corners.map(|corner| corner + 1e-3 * DVec3::X), ..*triangle }
}
