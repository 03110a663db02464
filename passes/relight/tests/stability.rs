//! The extreme inputs and sweeps of `airglow stability`, all within their bounds.

mod host;

use airglow_relight::stability::{cases, sweeps};
use host::with_bench;

#[test]
fn every_extreme_input_is_within_its_bound() {
    with_bench(|bench| {
        let outcomes = cases(bench, true).unwrap();
        assert!(outcomes.len() > 30, "{} cases", outcomes.len());
        for outcome in &outcomes {
            println!("{:60} {:9.2e} {:8.0e} {}", outcome.name, outcome.error, outcome.bound, outcome.result);
            assert!(outcome.pass(), "{outcome:#?}");
        }
    });
}

#[test]
fn every_sweep_is_within_its_bound() {
    with_bench(|bench| {
        for sweep in sweeps(bench).unwrap() {
            for point in &sweep.points {
                println!(
                    "{:30} {:9.2e}: {:.8e} {:.8e} {:8.1e}",
                    sweep.name, point.at, point.value, point.truth, point.error
                );
            }
            assert!(sweep.pass(), "{sweep:#?}");
        }
    });
}
