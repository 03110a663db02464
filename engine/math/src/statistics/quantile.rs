//! Mean, median and percentiles: linear interpolation between order statistics (type 7 of Hyndman and Fan,
//! "Sample Quantiles in Statistical Packages", 1996). NaN samples make the result NaN.

use crate::MathError;

/// Arithmetic mean.
///
/// # Errors
/// [`MathError::NoSamples`].
pub fn mean(samples: &[f64]) -> Result<f64, MathError> {
    if samples.is_empty() {
        return Err(MathError::NoSamples { what: "a mean" });
    }
    Ok(samples.iter().sum::<f64>() / samples.len() as f64)
}

/// The median: the 50th percentile.
///
/// # Errors
/// [`MathError::NoSamples`].
pub fn median(samples: &[f64]) -> Result<f64, MathError> {
    percentile(samples, 50.0)
}

/// One percentile, `percent` in [0, 100].
///
/// # Errors
/// As [`percentiles`].
pub fn percentile(samples: &[f64], percent: f64) -> Result<f64, MathError> {
    Ok(percentiles(samples, &[percent])?[0])
}

/// Several percentiles, each in [0, 100], by sorting once.
///
/// # Errors
/// [`MathError::NoSamples`]; [`MathError::Range`] for a percentile outside [0, 100].
pub fn percentiles(samples: &[f64], percents: &[f64]) -> Result<Vec<f64>, MathError> {
    if samples.is_empty() {
        return Err(MathError::NoSamples { what: "a percentile" });
    }
    if let Some(&value) = percents.iter().find(|p| !(0.0..=100.0).contains(*p)) {
        return Err(MathError::Range { what: "a percentile", value, range: "0 to 100" });
    }
    if samples.iter().any(|s| s.is_nan()) {
        return Ok(vec![f64::NAN; percents.len()]);
    }
    let mut sorted = samples.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    Ok(percents.iter().map(|percent| of_sorted(&sorted, percent / 100.0)).collect())
}

/// The quantile, `fraction` in [0, 1], of sorted samples, of which there is at least one.
pub(super) fn of_sorted(sorted: &[f64], fraction: f64) -> f64 {
    let position = fraction * (sorted.len() - 1) as f64;
    let below = position as usize;
    let above = (below + 1).min(sorted.len() - 1);
    let weight = position - below as f64;
    if weight == 0.0 || sorted[below] == sorted[above] {
        return sorted[below]; // keeps infinities out of the arithmetic
    }
    (1.0 - weight) * sorted[below] + weight * sorted[above]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn agrees_with_hand_counts() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), Ok(2.0));
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), Ok(2.5));
        assert_eq!(median(&[7.0]), Ok(7.0));
        assert_eq!(mean(&[1.0, 2.0, 6.0]), Ok(3.0));
        let samples: Vec<f64> = (0..=20).map(f64::from).rev().collect();
        assert_eq!(percentiles(&samples, &[0.0, 5.0, 95.0, 100.0]), Ok(vec![0.0, 1.0, 19.0, 20.0]));
        assert_eq!(percentile(&[10.0, 20.0], 25.0), Ok(12.5));
    }

    #[test]
    fn extremes_do_not_break_it() {
        assert_eq!(percentile(&[1.0, f64::INFINITY], 100.0), Ok(f64::INFINITY));
        assert_eq!(median(&[f64::INFINITY, f64::INFINITY]), Ok(f64::INFINITY));
        assert!(median(&[1.0, f64::NAN]).unwrap().is_nan());
        assert_eq!(median(&[]), Err(MathError::NoSamples { what: "a percentile" }));
        assert_eq!(mean(&[]), Err(MathError::NoSamples { what: "a mean" }));
        assert!(matches!(percentile(&[1.0], 101.0), Err(MathError::Range { .. })));
        assert!(matches!(percentile(&[1.0], f64::NAN), Err(MathError::Range { .. })));
    }

    proptest! {
        #[test]
        fn grows_with_the_percentage(samples in proptest::collection::vec(-1e3..1e3_f64, 1..50), p in 0.0..100.0_f64) {
            let ascending = percentiles(&samples, &[0.0, p, 100.0]).unwrap();
            prop_assert!(ascending.is_sorted(), "{ascending:?}");
        }
    }
}
