//! What sampling and shading lobes costs beside Toksvig's mean normal, on the test device:
//! `AIRGLOW_VALIDATION=off cargo run --release -p airglow-normals --example shading_cost`.

#![expect(clippy::unwrap_used, reason = "the maps are shared with the tests, whose helpers unwrap")]

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Instant;

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{Buffer, GpuError, Label, Location, Recorder, Requirements, Sampler, SamplerDesc};
use airglow_graph::BufferDesc;
use airglow_math::statistics::{median, paired_ratio_interval};
use airglow_normals::cost::{Shading, whole};
use airglow_normals::{Bench, Brdf, FitSettings, Method, NormalMap, Settings, Storage};
use airglow_tests::device::fixture_with;

/// Pixels of a side.
const SIDE: u32 = 512;
const ROUNDS: usize = 101;
/// The first is what all others are compared with.
const METHODS: [Method; 6] =
    [Method::Toksvig, Method::Lobes(1), Method::Lobes(2), Method::Lobes(4), Method::Lobes(6), Method::Taps];

/// Times every method in turn, so that what else the machine does falls on all of them, and prints their medians, the median
/// of the ratios to the first in the same round, and its 95 % interval; a round before compiles.
fn race(
    bench: &Bench<'_>,
    map: &NormalMap,
    (sampler, output): (&Sampler, &Buffer),
    (brdf, storage, level): (Brdf, Storage, f32),
) -> Result<(), Box<dyn std::error::Error>> {
    let fit = FitSettings { iterations: 8, ..Default::default() };
    let settings = Settings { fit, storage, budget: Some(u64::MAX) };
    let mut works = Vec::new();
    let mut add = |name: String, method, shading: Shading| -> Result<(), Box<dyn std::error::Error>> {
        let Some(image) = bench.kept(map, method, &settings)? else { return Ok(()) };
        works.push((name, shading, whole(&image)?, Vec::new()));
        Ok(())
    };
    let methods =
        if storage == Storage::Octahedral8 { &[Method::Toksvig, Method::Lobes(4)][..] } else { &METHODS };
    for &method in methods {
        add(method.to_string(), method, Shading::new(bench.context, method, storage, brdf)?)?;
    }
    for count in [1, 4] {
        add(format!("{count} lookups"), Method::Lobes(count), Shading::lookups(bench.context, count)?)?;
    }
    for round in 0..=ROUNDS {
        for (_, shading, view, times) in &mut works {
            let begin = Instant::now();
            (bench.run)(&mut |recorder| shading.record(recorder, (view, sampler), output, [SIDE; 2], level))?;
            if round > 0 {
                times.push(begin.elapsed().as_secs_f64());
            }
        }
    }
    let lookup = if level.fract() > 0.0 { "trilinear" } else { "bilinear, one level" };
    println!("{brdf:?}, {storage:?}, {lookup}");
    for (method, _, _, times) in &works {
        let ratio = paired_ratio_interval(times, &works[0].3, 0.95, 1000, 1)?;
        println!(
            "  {method:9} {:6.2} ms, {:.2} ({:.2} to {:.2}) times Toksvig",
            1e3 * median(times)?,
            ratio.estimate,
            ratio.low,
            ratio.high
        );
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let map = common::weave(512);
    let fixture = fixture_with(&Requirements::engine());
    let context = fixture.context();
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(context, |recorder| record(recorder))
    };
    let bench = Bench { context, run: &run };
    println!("{}, {SIDE} x {SIDE} pixels, medians of {ROUNDS}", fixture.device().line());
    let sampler = context.create_sampler(&SamplerDesc::linear("kept"))?;
    let desc = BufferDesc { size: 4 * u64::from(SIDE * SIDE), usage: BufferUsageFlags::STORAGE_BUFFER };
    let output = context.create_buffer(Label::new("example", "radiance"), &desc, Location::Device)?;
    for brdf in [Brdf::BlinnPhong { exponent: 50.0 }, Brdf::Ggx { alpha: 0.2 }] {
        for (storage, level) in [(Storage::F16, 0.0), (Storage::F16, 0.5), (Storage::Octahedral8, 0.0)] {
            race(&bench, &map, (&sampler, &output), (brdf, storage, level))?;
        }
    }
    Ok(())
}
