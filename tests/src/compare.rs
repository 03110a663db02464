//! Comparisons that print the worst element with both of its values.

use std::fmt;

/// The element that differs most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// Its position.
    pub index: usize,
    /// The value under test.
    pub actual: f64,
    /// The truth.
    pub expected: f64,
    /// |actual - expected|, divided by the allowed error where one was given; infinite for a NaN.
    pub error: f64,
}

impl fmt::Display for Worst {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { index, actual, expected, .. } = self;
        write!(out, "element {index}: {actual:e}, expected {expected:e} (difference {:e})", actual - expected)
    }
}

/// The element with the largest |actual - expected| / allowed(expected). `None` for empty slices.
///
/// # Panics
/// If the lengths differ.
pub fn worst_against<A, E>(actual: &[A], expected: &[E], allowed: impl Fn(f64) -> f64) -> Option<Worst>
where
    A: Copy + Into<f64>,
    E: Copy + Into<f64>,
{
    assert_eq!(actual.len(), expected.len(), "lengths differ");
    let compare = |(index, (&actual, &expected)): (usize, (&A, &E))| {
        let (actual, expected): (f64, f64) = (actual.into(), expected.into());
        let error = (actual - expected).abs() / allowed(expected);
        // Equal values are right even where nothing is allowed; NaN is never right.
        let error = if actual == expected { 0.0 } else { error };
        Worst { index, actual, expected, error: if error.is_nan() { f64::INFINITY } else { error } }
    };
    actual.iter().zip(expected).enumerate().map(compare).max_by(|a, b| a.error.total_cmp(&b.error))
}

/// The element with the largest absolute error.
pub fn worst<A: Copy + Into<f64>, E: Copy + Into<f64>>(actual: &[A], expected: &[E]) -> Option<Worst> {
    worst_against(actual, expected, |_| 1.0)
}

/// Asserts |actual - expected| <= absolute + relative |expected| for every element.
///
/// # Panics
/// Naming the worst element with both values, if not.
#[track_caller]
pub fn assert_close<A, E>(what: &str, actual: &[A], expected: &[E], absolute: f64, relative: f64)
where
    A: Copy + Into<f64>,
    E: Copy + Into<f64>,
{
    let Some(worst) = worst_against(actual, expected, |expected| absolute + relative * expected.abs()) else {
        return;
    };
    assert!(worst.error <= 1.0, "{what}: {worst} is over {absolute:e} + {relative:e} of it");
}

/// Asserts that two slices have the same bits.
///
/// # Panics
/// Naming the first element that differs with both values, if not.
#[track_caller]
pub fn assert_same_bits(what: &str, actual: &[f32], expected: &[f32]) {
    assert_eq!(actual.len(), expected.len(), "{what}: lengths differ");
    let mut pairs = actual.iter().zip(expected).enumerate();
    if let Some((i, (a, e))) = pairs.find(|(_, (a, e))| a.to_bits() != e.to_bits()) {
        panic!(
            "{what}: element {i} is {a:e} ({:#010x}), expected {e:e} ({:#010x})",
            a.to_bits(),
            e.to_bits()
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_element_is_named_with_both_values() {
        let found = worst(&[1.0f32, 2.5, 3.0], &[1.0f64, 2.0, 3.25]).unwrap();
        assert_eq!((found.index, found.actual, found.expected, found.error), (1, 2.5, 2.0, 0.5));
        assert!(found.to_string().contains("2.5e0, expected 2e0"), "{found}");
        assert_eq!(worst(&[f32::NAN, 9.0], &[0.0f32, 0.0]).unwrap().index, 0);
        assert_close("within", &[1.01f64], &[1.0f64], 0.0, 0.011);
        assert_close("exact", &[0.0f64], &[0.0f64], 0.0, 0.0);
        assert!(std::panic::catch_unwind(|| assert_close("out", &[1.02f64], &[1.0f64], 0.0, 0.01)).is_err());
        assert!(std::panic::catch_unwind(|| assert_same_bits("zero", &[0.0], &[-0.0])).is_err());
    }
}
