//! What samples take and how much they err: `cargo run --release -p airglow-radiance --example sampling`.
//!
//! Nine boxes of 12 triangles, one of 1.2, and 768 and 3072 small ones; order 4. The error is the relative root mean square of
//! the light vectors of 48 samples from cube maps of 128 texels and 4 x 4 rays in f64. Times are of 128 samples in one
//! dispatch on the device of the tests, validation included, and CPU time of the whole process, which other work on the
//! machine leaves alone. A dispatch takes no draw call.

#![expect(clippy::unwrap_used, reason = "an example that stops where it fails")]

use std::time::Instant;

use airglow_gpu::{GpuError, Recorder};
use airglow_math::statistics::{Interval, bootstrap_interval, relative_l2};
use airglow_radiance::gpu::bench::Bench;
use airglow_radiance::gpu::{LightShape, TexelSettings, Texels};
use airglow_radiance::reference::Cube;
use airglow_radiance::{Incident, Triangle};
use airglow_tests::device::fixture_with;
use glam::DVec3;

#[path = "../tests/gpu/scenes.rs"]
mod scenes;

/// Samples of a dispatch.
const SAMPLES: u32 = 128;
/// Dispatches timed, after one that compiles.
const RUNS: usize = 41;

fn main() {
    let fixture = fixture_with(&Texels::requirements());
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    let bench = Bench { context: fixture.context(), run: &run };
    let blocks = scenes::blocks();
    let shape = LightShape { order: 4, gradients: false };

    println!("faces and rays, {} triangles", blocks.len());
    let points = scenes::points(48);
    let fine = Cube::new(4, 128).unwrap().with_rays(4).unwrap();
    let truth: Vec<Incident> = points.iter().map(|point| fine.sample(*point, &blocks).unwrap()).collect();
    for gradients in [false, true] {
        for (size, rays) in [(8, 2), (16, 1), (8, 4), (16, 2), (32, 1), (16, 4), (32, 2)] {
            let shape = LightShape { gradients, ..shape };
            let texels = Texels::new(bench.context, TexelSettings { shape, size, rays }).unwrap();
            let error = error(&bench.texels(&texels, &blocks, &points).unwrap(), &truth);
            let name = format!(
                "{size:3} texels, {rays} x {rays} rays{}",
                if gradients { ", gradients" } else { "" }
            );
            println!("{name:34} {}, error {error:.4}", time(&bench, &texels, &blocks));
        }
    }

    println!("triangles, 16 texels, one ray");
    let texels = Texels::new(bench.context, TexelSettings { shape, size: 16, rays: 1 }).unwrap();
    for (name, emitters) in [("12", block(1)), ("108", blocks), ("768", block(8)), ("3072", block(16))] {
        println!("{name:34} {}", time(&bench, &texels, &emitters));
    }

    println!("closed forms where exact, else 16 texels, one ray");
    let closed = texels.clone().with_closed_forms(bench.context).unwrap();
    for (name, emitters) in [("one square", block(1)[..2].to_vec()), ("a box of 12, never exact", block(1))] {
        println!("{:34} {}", format!("{name}: closed forms"), time(&bench, &closed, &emitters));
        println!("{:34} {}", format!("{name}: cube maps"), time(&bench, &texels, &emitters));
    }
}

/// A box whose sides are cut into so many strips each way.
fn block(strips: u32) -> Vec<Triangle> {
    let whole = scenes::block(DVec3::new(0.1, 0.2, -1.2), 0.4, DVec3::ONE);
    if strips == 1 {
        return whole;
    }
    whole.iter().flat_map(|triangle| split(triangle, strips.ilog2())).collect()
}

/// A triangle in four, so many times.
fn split(triangle: &Triangle, times: u32) -> Vec<Triangle> {
    if times == 0 {
        return vec![*triangle];
    }
    let [a, b, c] = triangle.corners;
    let [ab, bc, ca] = [a.midpoint(b), b.midpoint(c), c.midpoint(a)];
    let parts = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]];
    parts.iter().flat_map(|corners| split(&Triangle { corners: *corners, ..*triangle }, times - 1)).collect()
}

fn error(found: &[Incident], truth: &[Incident]) -> f64 {
    let all = |samples: &[Incident]| -> Vec<f64> {
        samples.iter().flat_map(|sample| &sample.coefficients).flat_map(|l| l.to_array()).collect()
    };
    relative_l2(&all(found), &all(truth)).unwrap()
}

/// Wall time of a sample, the median and its 95 % interval, CPU time, and its rays.
fn time(bench: &Bench<'_>, texels: &Texels, emitters: &[Triangle]) -> String {
    let buffers = bench.buffers(texels.settings().shape, emitters, &scenes::points(SAMPLES)).unwrap();
    let (mut times, mut cpu) = (Vec::new(), 0.0);
    for run in 0..=RUNS {
        if run == 1 {
            cpu = cpu_seconds();
        }
        let begin = Instant::now();
        (bench.run)(&mut |recorder| texels.record(recorder, &buffers)).unwrap();
        times.push(1e3 * begin.elapsed().as_secs_f64() / f64::from(SAMPLES));
    }
    let cpu = 1e3 * (cpu_seconds() - cpu) / (RUNS as f64 * f64::from(SAMPLES));
    let Interval { estimate, low, high } = bootstrap_interval(&times[1..], 0.95, 1000, 1).unwrap();
    let TexelSettings { size, rays, .. } = texels.settings();
    let rays = 6 * (size * rays).pow(2);
    format!("{estimate:.3} ms ({low:.3} to {high:.3}), CPU {cpu:.3} ms a sample, {rays} rays")
}

/// CPU time of the whole process so far, seconds, in steps of 10 ms; 0 where Linux does not say.
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
    fields.skip(11).take(2).filter_map(|ticks| ticks.parse::<f64>().ok()).sum::<f64>() / 100.0
}
