//! What a sample takes: `cargo run --release -p airglow-radiance --example sampling`.

#![expect(clippy::unwrap_used, reason = "an example that stops where it fails")]

use std::time::Instant;

use airglow_gpu::{GpuError, Recorder};
use airglow_radiance::gpu::bench::Bench;
use airglow_radiance::gpu::{LightShape, TexelSettings, Texels};
use airglow_tests::device::fixture_with;

#[path = "../tests/gpu/scenes.rs"]
mod scenes;

/// Samples of a dispatch.
const SAMPLES: u32 = 256;
/// Dispatches timed; the median is printed.
const RUNS: usize = 9;

fn main() {
    let fixture = fixture_with(&Texels::requirements());
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    let bench = Bench { context: fixture.context(), run: &run };
    let emitters = scenes::blocks();
    for gradients in [false, true] {
        for (size, rays) in [(16, 1), (8, 4), (16, 2), (16, 4), (32, 2), (64, 1)] {
            let shape = LightShape { order: 4, gradients };
            let texels = Texels::new(bench.context, TexelSettings { shape, size, rays }).unwrap();
            let points = scenes::points(SAMPLES);
            let buffers = bench.buffers(shape, &emitters, &points).unwrap();
            let mut times = Vec::new();
            let mut cpu = 0.0;
            for i in 0..=RUNS {
                if i == 1 {
                    cpu = -cpu_seconds();
                }
                let begin = Instant::now();
                run(&mut |recorder| texels.record(recorder, &buffers)).unwrap();
                times.push(1e3 * begin.elapsed().as_secs_f64() / f64::from(SAMPLES));
            }
            cpu = 1e3 * (cpu + cpu_seconds()) / (RUNS as f64 * f64::from(SAMPLES));
            times.remove(0);
            times.sort_by(f64::total_cmp);
            println!(
                "faces of {size}, {rays} rays, gradients {gradients}: median {:.4} ms, least {:.4} ms, CPU {cpu:.4} ms a sample",
                times[RUNS / 2],
                times[0]
            );
        }
    }
}

/// CPU time of the whole process so far, seconds, in steps of 10 ms; 0 where Linux does not say.
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
    fields.skip(11).take(2).filter_map(|ticks| ticks.parse::<f64>().ok()).sum::<f64>() / 100.0
}
