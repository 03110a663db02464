//! Kernels on a device against the f64 reference.

#![expect(clippy::unwrap_used, reason = "helpers fail the test they are called from")]

mod conformance;
mod global;
mod health;
mod motion;
mod pass;
mod receivers;
mod scenes;
mod stability;
mod surfaces;
mod texels;
mod world;

use airglow_gpu::{GpuError, Recorder, Requirements};
use airglow_radiance::gpu::bench::Bench;
use airglow_tests::device::fixture_with;

/// Runs a test on a device of its own.
fn with_bench<T>(requirements: &Requirements, test: impl FnOnce(&Bench<'_>) -> T) -> T {
    let fixture = fixture_with(requirements);
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    test(&Bench { context: fixture.context(), run: &run })
}
