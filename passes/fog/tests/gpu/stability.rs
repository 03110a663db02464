//! Every extreme input and sweep passes.

use airglow_fog::stability::{cases, sweeps};
use airglow_fog::{Bench, Fog, Settings};
use airglow_gpu::{GpuError, Recorder};
use airglow_tests::device::fixture_with;

#[test]
fn extreme_inputs_and_limits_are_within_their_bounds() {
    let fixture = fixture_with(&Fog::requirements(&Settings::default()));
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    let bench = Bench { context: fixture.context(), run: &run };
    let outcomes = cases(&bench, None).unwrap();
    let failed: Vec<_> = outcomes.iter().filter(|outcome| !outcome.pass()).collect();
    let worst = outcomes.iter().map(|outcome| outcome.error).fold(0.0, f64::max);
    println!("{} inputs, worst error {worst:.1e}", outcomes.len());
    let sweeps = sweeps(&bench, None).unwrap();
    for sweep in &sweeps {
        let worst = sweep.points.iter().max_by(|a, b| a[3].total_cmp(&b[3])).unwrap();
        println!("{}: worst error {:.1e} at {:.1e}", sweep.name, worst[3], worst[0]);
    }
    assert!(failed.is_empty(), "{} fail: {failed:#?}", failed.len());
    assert!(sweeps.iter().all(|sweep| sweep.pass()));
}
