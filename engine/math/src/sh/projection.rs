//! From functions to coefficients and back.

use glam::DVec3;

use super::{check_order, coefficient_count, evaluate};
use crate::MathError;
use crate::error::check_length;
use crate::quadrature::sphere;

/// Coefficients `∫ f Y_i` of a function of unit directions, by the product rule [`sphere`] of that degree.
///
/// Exact to rounding when `f` is a polynomial of degree at most `degree - (order - 1)`.
///
/// # Errors
/// [`MathError::Order`]; [`MathError::Range`] for a degree that [`sphere`] refuses.
pub fn project(order: usize, degree: usize, f: impl Fn(DVec3) -> f64) -> Result<Vec<f64>, MathError> {
    check_order(order)?;
    let samples = sphere(degree)?.into_iter().map(|(direction, weight)| (direction, weight * f(direction)));
    project_samples(order, samples)
}

/// Sum of `value Y_i(direction)` over weighted samples: each value carries its own weight in steradians (for
/// n uniform directions, `4 pi / n` times the function).
///
/// # Errors
/// [`MathError::Order`].
pub fn project_samples(
    order: usize,
    samples: impl IntoIterator<Item = (DVec3, f64)>,
) -> Result<Vec<f64>, MathError> {
    check_order(order)?;
    let mut sums = vec![0.0; coefficient_count(order)];
    let mut basis = vec![0.0; sums.len()];
    for (direction, value) in samples {
        evaluate(order, direction, &mut basis)?;
        for (sum, y) in sums.iter_mut().zip(&basis) {
            *sum += value * y;
        }
    }
    Ok(sums)
}

/// Value of the function with these coefficients in a unit direction.
///
/// # Errors
/// [`MathError::Order`]; [`MathError::Length`] unless there are `order²` coefficients.
pub fn reconstruct(order: usize, coefficients: &[f64], direction: DVec3) -> Result<f64, MathError> {
    check_order(order)?;
    check_length("the coefficients", coefficient_count(order), coefficients.len())?;
    let mut basis = vec![0.0; coefficients.len()];
    evaluate(order, direction, &mut basis)?;
    Ok(coefficients.iter().zip(&basis).map(|(c, y)| c * y).sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sequence::{sobol, uniform_sphere};
    use crate::testing::{assert_all_close, assert_close, coefficients, direction};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn projection_inverts_reconstruction(c in coefficients(5)) {
            let again = project(5, 8, |d| reconstruct(5, &c, d).unwrap()).unwrap();
            assert_all_close("coefficient", &again, &c, 1e-13);
        }

        #[test]
        fn polynomials_of_low_degree_are_reproduced(d in direction()) {
            let f = |d: DVec3| 1.0 + 2.0 * d.x - d.y * d.z + d.z.powi(3);
            let c = project(4, 6, f).unwrap();
            assert_close("f", reconstruct(4, &c, d).unwrap(), f(d), 1e-13);
        }
    }

    #[test]
    fn samples_converge_to_quadrature() {
        let f = |d: DVec3| d.z.max(0.0);
        let n = 1 << 14;
        let weight = 4.0 * std::f64::consts::PI / f64::from(n);
        let samples = (0..n).map(|i| uniform_sphere(sobol(i, 7))).map(|d| (d, weight * f(d)));
        let sampled = project_samples(3, samples).unwrap();
        assert_all_close("coefficient", &sampled, &project(3, 400, f).unwrap(), 2e-4);
    }

    #[test]
    fn refuses_other_orders() {
        assert_eq!(project(0, 4, |_| 1.0), Err(MathError::Order { order: 0 }));
        assert_eq!(project(9, 4, |_| 1.0), Err(MathError::Order { order: 9 }));
        assert!(matches!(reconstruct(2, &[1.0], DVec3::Z), Err(MathError::Length { .. })));
    }
}
