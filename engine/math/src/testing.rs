//! Helpers of this crate's tests: comparisons that print both values.

use glam::DVec3;
use proptest::prelude::*;

/// Asserts `|actual - expected| <= tolerance`, printing both.
#[track_caller]
pub fn assert_close(what: &str, actual: f64, expected: f64, tolerance: f64) {
    let difference = (actual - expected).abs();
    assert!(
        difference <= tolerance,
        "{what}: actual {actual:e}, expected {expected:e}, difference {difference:e} > {tolerance:e}"
    );
}

/// Asserts [`assert_close`] element by element.
#[track_caller]
pub fn assert_all_close(what: &str, actual: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(actual.len(), expected.len(), "{what}: lengths differ");
    for (i, (a, e)) in actual.iter().zip(expected).enumerate() {
        assert_close(&format!("{what}[{i}]"), *a, *e, tolerance);
    }
}

/// Random unit directions.
pub fn direction() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64)
        .prop_map(|(x, y, z)| DVec3::new(x, y, z))
        .prop_filter("too short to normalise", |v| v.length() > 1e-3)
        .prop_map(DVec3::normalize)
}

/// Random coefficient vectors of the given order, components in [-1, 1].
pub fn coefficients(order: usize) -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(-1.0..1.0_f64, order * order)
}
