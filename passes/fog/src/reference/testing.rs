//! Comparisons that print both values.

/// Asserts `|actual - expected| <= tolerance |expected|`.
#[track_caller]
pub fn assert_relative(what: &str, actual: f64, expected: f64, tolerance: f64) {
    let error = (actual - expected).abs();
    assert!(
        error <= tolerance * expected.abs(),
        "{what}: actual {actual:e}, expected {expected:e}, relative error {:e} > {tolerance:e}",
        error / expected.abs()
    );
}
