//! On the device: exponentials, products and the pass over receivers, against f64.

#![expect(clippy::unwrap_used, reason = "helpers fail the test they are called from")]

mod budget;
mod conformance;
mod graph;
mod health;
mod layout;
mod pixels;
mod rows;
mod spheres;
mod world;

use airglow_gpu::{GpuError, Recorder};
use airglow_shadow::{Bench, Shadow};
use airglow_tests::device::fixture_with;

/// Runs a test with a bench on the test device.
fn with_bench<T>(test: impl FnOnce(&Bench<'_>) -> T) -> T {
    let fixture = fixture_with(&Shadow::requirements());
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    test(&Bench { context: fixture.context(), run: &run })
}

fn wide(values: &[f32]) -> Vec<f64> {
    values.iter().copied().map(f64::from).collect()
}
