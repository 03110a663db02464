//! The extreme inputs and sweeps of `airglow stability`, all within their bounds.

use crate::host::with_bench;
use airglow_relight::stability::{Selection, cases, sweeps};

#[test]
fn every_extreme_input_is_within_its_bound() {
    with_bench(|bench| {
        let outcomes = cases(bench, &Selection { large: true, only: None }).unwrap();
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
        for sweep in sweeps(bench, &Selection::default()).unwrap() {
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

#[test]
fn a_name_selects_one_input_of_its_own() {
    with_bench(|bench| {
        let all = cases(bench, &Selection::default()).unwrap();
        for chosen in all.iter().step_by(5) {
            let only = cases(bench, &Selection { large: false, only: Some(&chosen.name) }).unwrap();
            let names: Vec<_> = only.iter().map(|outcome| &outcome.name).collect();
            assert_eq!(names, [&chosen.name]);
        }
        let selection = Selection { large: false, only: Some("a peak rises") };
        assert_eq!(sweeps(bench, &selection).unwrap().len(), 1);
        assert!(cases(bench, &selection).unwrap().is_empty());
    });
}
