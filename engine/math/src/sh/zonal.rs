//! Kernels symmetric about an axis, and convolution with them.
//!
//! Stands on Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps" (2001),
//! and the Funk-Hecke theorem. A kernel `k(cos angle)` is held as its **band factors**
//! `A_l = 2 pi ∫ k(t) P_l(t) dt` over t in [-1, 1], one per band: convolution multiplies `f_lm` by `A_l`, and
//! the kernel about direction d has the coefficients `A_l Y_lm(d)`. Its zonal coefficients about +Z are
//! `z_l = sqrt((2l+1) / 4pi) A_l`.

use std::f64::consts::PI;

use glam::DVec3;

use super::{check_order, coefficient_count, evaluate};
use crate::MathError;
use crate::error::check_length;

/// Band factors of the clamped cosine max(0, t): radiance convolved with it is irradiance, with no 1/pi.
///
/// Sun, thesis (2008), eq. 2.21-2.25, where A_4 = -0.130900 and A_6 = +0.049087 are the correct signs.
///
/// # Errors
/// [`MathError::Order`].
pub fn clamped_cosine(order: usize) -> Result<Vec<f64>, MathError> {
    check_order(order)?;
    Ok((0..order).map(clamped_cosine_band).collect())
}

fn clamped_cosine_band(l: usize) -> f64 {
    if l == 1 {
        return 2.0 * PI / 3.0;
    }
    if l % 2 == 1 {
        return 0.0;
    }
    let half = l / 2;
    // l! / (2^l (l/2)!²) as a product of (2k-1)/(2k).
    let binomial: f64 = (1..=half).map(|k| (2 * k - 1) as f64 / (2 * k) as f64).product();
    let sign = if half % 2 == 1 { 1.0 } else { -1.0 };
    let l = l as f64;
    2.0 * PI * sign / ((l + 2.0) * (l - 1.0)) * binomial
}

/// Band factors of the kernel whose zonal coefficients about +Z are given, one per band.
///
/// # Errors
/// [`MathError::Order`] unless there are 1 to [`super::MAX_ORDER`] of them.
pub fn factors_from_coefficients(zonal: &[f64]) -> Result<Vec<f64>, MathError> {
    check_order(zonal.len())?;
    Ok(zonal.iter().enumerate().map(|(l, z)| z / zonal_norm(l)).collect())
}

/// Zonal coefficients about +Z of the kernel whose band factors are given.
///
/// # Errors
/// As [`factors_from_coefficients`].
pub fn coefficients_from_factors(factors: &[f64]) -> Result<Vec<f64>, MathError> {
    check_order(factors.len())?;
    Ok(factors.iter().enumerate().map(|(l, a)| a * zonal_norm(l)).collect())
}

/// `Y_l0(+Z)`.
fn zonal_norm(l: usize) -> f64 {
    ((2 * l + 1) as f64 / (4.0 * PI)).sqrt()
}

/// Convolves `f` with a kernel given by its band factors: `out_lm = A_l f_lm`. The order is that of
/// `factors`.
///
/// # Errors
/// [`MathError::Order`]; [`MathError::Length`] unless `f` and `out` hold `factors.len()²` values.
pub fn convolve(factors: &[f64], f: &[f64], out: &mut [f64]) -> Result<(), MathError> {
    let order = factors.len();
    check_order(order)?;
    check_length("the convolved input", coefficient_count(order), f.len())?;
    check_length("the convolved output", coefficient_count(order), out.len())?;
    for (l, factor) in factors.iter().enumerate() {
        for i in l * l..(l + 1) * (l + 1) {
            out[i] = factor * f[i];
        }
    }
    Ok(())
}

/// Coefficients of a kernel, given by its band factors, turned from +Z about the unit `direction`:
/// `out_lm = A_l Y_lm(direction)`.
///
/// # Errors
/// [`MathError::Order`]; [`MathError::Length`] unless `out` holds `factors.len()²` values.
pub fn rotate_to_direction(factors: &[f64], direction: DVec3, out: &mut [f64]) -> Result<(), MathError> {
    let order = factors.len();
    evaluate(order, direction, out)?;
    for (l, factor) in factors.iter().enumerate() {
        for value in &mut out[l * l..(l + 1) * (l + 1)] {
            *value *= factor;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::adaptive;
    use crate::sh::rotation::Rotation;
    use crate::sh::{index, reconstruct};
    use crate::testing::{assert_all_close, assert_close, coefficients, direction};
    use glam::DQuat;
    use proptest::prelude::*;

    #[test]
    fn clamped_cosine_agrees_with_the_printed_values() {
        // Printed as 3.141593, 2.094395, 0.785398, 0, 0.130900 (less a sign), 0, 0.049087.
        let printed = [PI, PI / 1.5, PI / 4.0, 0.0, -PI / 24.0, 0.0, PI / 64.0, 0.0];
        assert_all_close("A", &clamped_cosine(8).unwrap(), &printed, 1e-15);
    }

    #[test]
    fn clamped_cosine_agrees_with_quadrature() {
        let factors = clamped_cosine(8).unwrap();
        let mut basis = [0.0; 64];
        for (l, factor) in factors.iter().enumerate() {
            let mut integrand = |t: f64| {
                evaluate(8, DVec3::new((1.0 - t * t).sqrt(), 0.0, t), &mut basis).unwrap();
                2.0 * PI * t * basis[index(l, 0)] / zonal_norm(l)
            };
            let integral = adaptive(&mut integrand, 0.0, 1.0, 1e-13).unwrap();
            assert_close(&format!("A_{l}"), *factor, integral.value, 1e-12);
        }
    }

    proptest! {
        /// Irradiance of a constant radiance 1 is pi, whatever the normal.
        #[test]
        fn irradiance_of_a_uniform_sky_is_pi(n in direction()) {
            let mut sky = vec![0.0; 25];
            sky[0] = (4.0 * PI).sqrt();
            let mut irradiance = vec![0.0; 25];
            convolve(&clamped_cosine(5).unwrap(), &sky, &mut irradiance).unwrap();
            assert_close("E", reconstruct(5, &irradiance, n).unwrap(), PI, 1e-13);
        }

        /// Convolution at a direction is the inner product with the kernel turned there.
        #[test]
        fn convolution_is_the_inner_product_with_the_turned_kernel(f in coefficients(6), n in direction()) {
            let factors = clamped_cosine(6).unwrap();
            let (mut convolved, mut lobe) = (vec![0.0; 36], vec![0.0; 36]);
            convolve(&factors, &f, &mut convolved).unwrap();
            rotate_to_direction(&factors, n, &mut lobe).unwrap();
            let inner: f64 = lobe.iter().zip(&f).map(|(a, b)| a * b).sum();
            assert_close("E", reconstruct(6, &convolved, n).unwrap(), inner, 1e-12);
        }

        #[test]
        fn turning_agrees_with_the_full_rotation(z in proptest::collection::vec(-1.0..1.0_f64, 8), d in direction()) {
            let mut about_z = vec![0.0; 64];
            for (l, value) in z.iter().enumerate() {
                about_z[index(l, 0)] = *value;
            }
            let (mut full, mut turned) = (vec![0.0; 64], vec![0.0; 64]);
            let q = DQuat::from_rotation_arc(DVec3::Z, d);
            Rotation::from_quaternion(8, q).unwrap().apply(&about_z, &mut full).unwrap();
            rotate_to_direction(&factors_from_coefficients(&z).unwrap(), d, &mut turned).unwrap();
            assert_all_close("coefficient", &turned, &full, 1e-12);
        }

        #[test]
        fn the_two_forms_invert_each_other(z in proptest::collection::vec(-1.0..1.0_f64, 8)) {
            let again = coefficients_from_factors(&factors_from_coefficients(&z).unwrap()).unwrap();
            assert_all_close("z", &again, &z, 1e-15);
        }
    }

    #[test]
    fn refuses_other_orders_and_lengths() {
        assert_eq!(clamped_cosine(0), Err(MathError::Order { order: 0 }));
        assert_eq!(clamped_cosine(9), Err(MathError::Order { order: 9 }));
        assert_eq!(convolve(&[], &[], &mut []), Err(MathError::Order { order: 0 }));
        assert!(matches!(convolve(&[1.0, 1.0], &[0.0; 4], &mut [0.0; 3]), Err(MathError::Length { .. })));
        assert!(matches!(rotate_to_direction(&[1.0], DVec3::Z, &mut []), Err(MathError::Length { .. })));
    }
}
