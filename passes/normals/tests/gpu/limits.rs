//! The extreme inputs and sweeps of the command, held here too.

use airglow_normals::stability;

use super::with_bench;

#[test]
fn extreme_inputs_are_near_the_truth_or_refused() {
    let (cases, sweeps) =
        with_bench(|bench| (stability::cases(bench, None).unwrap(), stability::sweeps(bench, None).unwrap()));
    for case in &cases {
        println!("{}: {:.1e} of {:.0e}, {}", case.name, case.error, case.bound, case.input);
    }
    for sweep in &sweeps {
        let errors = sweep.points.iter().map(|[.., error]| *error);
        println!("{}: {:.1e} of {:.0e}", sweep.name, errors.fold(0.0, f64::max), sweep.bound);
    }
    let failing: Vec<_> = cases.iter().filter(|case| !case.pass()).collect();
    assert!(failing.is_empty(), "{failing:#?}");
    let failing: Vec<_> = sweeps.iter().filter(|sweep| !sweep.pass()).collect();
    assert!(failing.is_empty(), "{failing:?}");
    assert_eq!((cases.len(), sweeps.len()), (15, 3));
    assert!(with_bench(|bench| stability::cases(bench, Some("nothing")).unwrap().is_empty()));
}
