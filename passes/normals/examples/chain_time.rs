//! How long the chain of a large map takes on the test device, pipelines and reading back included:
//! `cargo run --release -p airglow-normals --example chain_time`.

#![expect(clippy::unwrap_used, reason = "the maps are shared with the tests, whose helpers unwrap")]

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Instant;

use airglow_gpu::{GpuError, Recorder, Requirements};
use airglow_normals::{Bench, FitSettings, NormalsError, Settings};
use airglow_tests::device::fixture_with;

const SIDE: usize = 1024;

fn main() -> Result<(), NormalsError> {
    let map = common::weave(SIDE);
    let fixture = fixture_with(&Requirements::engine());
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    let bench = Bench { context: fixture.context(), run: &run };
    println!("{}, {SIDE} x {SIDE}", fixture.device().line());
    for lobes in [1, 4] {
        // Steps cost alike: what two counts of them differ by is theirs, the rest is seeding, transfer and compilation.
        let mut seconds = [0.0; 2];
        for (iterations, seconds) in [8, 16].into_iter().zip(&mut seconds) {
            let fit = FitSettings { lobes, iterations, ..Default::default() };
            let begin = Instant::now();
            bench.texture(&map, &Settings { fit, ..Default::default() })?;
            *seconds = begin.elapsed().as_secs_f64();
            let texel = 1e9 * *seconds / (SIDE * SIDE) as f64;
            println!("{lobes} lobes, {iterations} steps: {seconds:.2} s, {texel:.0} ns a texel of the map");
        }
        let step = 1e9 * (seconds[1] - seconds[0]) / 8.0 / (SIDE * SIDE) as f64;
        println!("{lobes} lobes: {step:.0} ns a texel of the map and step");
    }
    Ok(())
}
