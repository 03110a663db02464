//! Euclidean distances between vectors of numbers.

use crate::MathError;
use crate::error::check_length;

/// `|values - truth|`, the root of the summed squares.
///
/// # Errors
/// [`MathError::Length`] when the lengths differ.
pub fn l2(values: &[f64], truth: &[f64]) -> Result<f64, MathError> {
    check_length("the values to compare", truth.len(), values.len())?;
    Ok(values.iter().zip(truth).map(|(v, t)| (v - t) * (v - t)).sum::<f64>().sqrt())
}

/// `|values - truth| / |truth|`; where the truth is zero, 0 for equal vectors and infinity otherwise.
///
/// # Errors
/// As [`l2`].
pub fn relative_l2(values: &[f64], truth: &[f64]) -> Result<f64, MathError> {
    let norm = truth.iter().map(|t| t * t).sum::<f64>().sqrt();
    Ok(relative(l2(values, truth)?, norm))
}

/// `error / norm` with 0/0 = 0.
pub(super) fn relative(error: f64, norm: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error / norm }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_hand_counts() {
        assert_eq!(l2(&[4.0, 1.0], &[1.0, 5.0]), Ok(5.0));
        assert_eq!(relative_l2(&[0.0, 0.0], &[3.0, 4.0]), Ok(1.0));
        assert_eq!(l2(&[], &[]), Ok(0.0));
    }

    #[test]
    fn a_zero_truth_is_no_division_by_zero() {
        assert_eq!(relative_l2(&[0.0], &[0.0]), Ok(0.0));
        assert_eq!(relative_l2(&[1.0], &[0.0]), Ok(f64::INFINITY));
    }

    #[test]
    fn nan_is_not_hidden_and_lengths_must_fit() {
        assert!(relative_l2(&[f64::NAN], &[1.0]).unwrap().is_nan());
        assert!(matches!(l2(&[1.0], &[]), Err(MathError::Length { .. })));
    }
}
