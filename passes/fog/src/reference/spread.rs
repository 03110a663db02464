//! The point spread function of fog: Sun, thesis (2008), section 3.6.

use std::f64::consts::{PI, TAU};

use airglow_math::MathError;
use airglow_math::quadrature::adaptive;
use airglow_math::sh::{coefficient_count, zonal};

use super::closed_form::glow;

/// Eq. 3.30 for an endless ray: the glow at `gamma` radians (0 excluded, to π) from a light at an optical distance, of
/// its irradiance without fog at the eye; 1/sr, albedo 1.
///
/// `PSF = T² exp(-T) S(T, γ) / (2 π T sin γ)`, with the scaled exponential integral of [`super::closed_form`].
///
/// # Errors
/// [`MathError::Range`] unless both are above 0.
pub fn exact(optical_distance: f64, gamma: f64) -> Result<f64, MathError> {
    let square = optical_distance * optical_distance;
    Ok(square * (-optical_distance).exp() * glow(optical_distance, gamma)? / TAU)
}

/// Eq. 3.31: the factor of the angle alone, the exact glow at an optical distance of 1 over exp(-1).
///
/// # Errors
/// As [`exact`].
pub fn normalised(gamma: f64) -> Result<f64, MathError> {
    Ok(glow(1.0, gamma)? / TAU)
}

/// Eq. 3.32: the amplitude `T exp(-T)` times [`normalised`].
///
/// # Errors
/// As [`exact`].
pub fn factored(optical_distance: f64, gamma: f64) -> Result<f64, MathError> {
    Ok(optical_distance * (-optical_distance).exp() * normalised(gamma)?)
}

/// Band factors of a spread function of the angle: `A_l = 2 π ∫ f(γ) P_l(cos γ) sin γ dγ`, by which convolution with it
/// multiplies band l. In the thesis's eq. 3.34 and 3.35 they are `√(4 π / (2 l + 1)) PSF_l`.
///
/// # Errors
/// [`MathError::Order`]; those of `f`.
pub fn band_factors(
    order: usize,
    mut f: impl FnMut(f64) -> Result<f64, MathError>,
) -> Result<Vec<f64>, MathError> {
    zonal::clamped_cosine(order)?; // refuses the order
    let mut refused = Ok(());
    let mut factors = Vec::with_capacity(order);
    for l in 0..order {
        // The glow grows as 1/γ towards its light: γ = t² is smooth there, and so is a narrow peak in log γ.
        let integrand = |t: f64| {
            let gamma = t * t;
            let value = f(gamma).unwrap_or_else(|error| {
                refused = Err(error);
                0.0
            });
            TAU * value * legendre(l, gamma.cos()) * gamma.sin() * 2.0 * t
        };
        let factor = adaptive(integrand, 0.0, PI.sqrt(), 1e-12)?.value;
        std::mem::replace(&mut refused, Ok(()))?;
        factors.push(factor);
    }
    Ok(factors)
}

/// `P_l(x)`.
pub(super) fn legendre(l: usize, x: f64) -> f64 {
    let (mut below, mut value) = (0.0, 1.0);
    for k in 1..=l {
        let k = k as f64;
        (below, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * below) / k);
    }
    value
}

/// Eq. 3.35 to 3.37: an environment at an optical distance, seen through the fog, `exp(-T) L + PSF * L`, as harmonics of
/// the order of `factors`; input to relighting as it stands.
///
/// # Errors
/// [`MathError::Order`]; [`MathError::Length`] unless there are order² coefficients.
pub fn fogged_environment(
    optical_distance: f64,
    factors: &[f64],
    environment: &[f64],
) -> Result<Vec<f64>, MathError> {
    let attenuated = (-optical_distance).exp();
    let both: Vec<f64> = factors.iter().map(|factor| attenuated + factor).collect();
    let mut fogged = vec![0.0; environment.len()];
    zonal::convolve(&both, environment, &mut fogged)?;
    Ok(fogged)
}

/// Eq. 3.34: for one outgoing direction, the BRDF that answers the light alone as `brdf` answers the light's glow.
/// Coefficients are over incident directions.
///
/// # Errors
/// As [`fogged_environment`].
pub fn effective_brdf(factors: &[f64], brdf: &[f64]) -> Result<Vec<f64>, MathError> {
    let mut effective = vec![0.0; coefficient_count(factors.len())];
    zonal::convolve(factors, brdf, &mut effective)?;
    Ok(effective)
}

#[cfg(test)]
mod tests {
    use airglow_math::sh;
    use glam::DVec3;

    use super::super::airlight::{Sight, airlight};
    use super::super::testing::assert_relative;
    use super::*;
    use crate::Phase;

    #[test]
    fn is_the_airlight_of_an_endless_ray() {
        for (distance, beta) in [(2.0, 0.05), (2.0, 1.5), (40.0, 0.1)] {
            for gamma in [1e-4, 0.5, 2.0, PI] {
                let sight = Sight::new(distance, gamma);
                let radiance = beta * airlight(beta, sight, 0.0, f64::INFINITY, Phase::Isotropic).unwrap();
                let expected = distance * distance * radiance;
                let what = format!("D {distance}, beta {beta}, gamma {gamma}");
                assert_relative(&what, exact(beta * distance, gamma).unwrap(), expected, 1e-11);
            }
        }
    }

    #[test]
    fn factorisation_is_exact_at_an_optical_distance_of_one() {
        assert_relative("T 1", factored(1.0, 0.8).unwrap(), exact(1.0, 0.8).unwrap(), 1e-14);
        // Figure 3.14: below 0.05 but close to the light, for T from 0.1 to 3.1.
        let worst = |gamma| {
            (1..=31)
                .map(|i| 0.1 * f64::from(i))
                .map(|t| (exact(t, gamma).unwrap() - factored(t, gamma).unwrap()).abs())
                .fold(0.0, f64::max)
        };
        assert!(worst(0.3) < 0.05 && worst(1.5) < 0.02, "{} {}", worst(0.3), worst(1.5));
    }

    #[test]
    fn factorisation_is_no_better_than_stated() {
        let (mut most, mut shares) = (0.0_f64, Vec::new());
        for t in (1..=30).map(|i| 0.1 * f64::from(i)) {
            let mut share = 0.0_f64;
            for gamma in (0..=30).map(|i| 0.1 * (10.0 * PI).powf(f64::from(i) / 30.0)) {
                let (exact, factored) = (exact(t, gamma).unwrap(), factored(t, gamma).unwrap());
                most = most.max((exact - factored).abs());
                share = share.max((factored / exact - 1.0).abs());
            }
            shares.push(share);
        }
        let largest = shares.iter().fold(0.0, |a: f64, &b| a.max(b));
        println!(
            "eq. 3.32 beside 3.30 from 0.1 rad on, T 0.1 to 3: {most:.3} 1/sr, worst {:.0} %",
            100.0 * largest
        );
        assert!(most < 0.1 && largest > 0.5, "{most} {largest}");
    }

    #[test]
    fn convolution_spreads_a_small_light_as_its_glow() {
        let (order, optical) = (5, 0.8);
        let factors = band_factors(order, |gamma| exact(optical, gamma)).unwrap();
        let mut light = vec![0.0; order * order];
        sh::evaluate(order, DVec3::Z, &mut light).unwrap();
        let fogged = fogged_environment(optical, &factors, &light).unwrap();
        for l in 0..order {
            let i = sh::index(l, 0);
            let projected = adaptive(
                |gamma: f64| {
                    let mut basis = vec![0.0; order * order];
                    let direction = DVec3::new(gamma.sin(), 0.0, gamma.cos());
                    sh::evaluate(order, direction, &mut basis).unwrap();
                    TAU * exact(optical, gamma).unwrap() * basis[i] * gamma.sin()
                },
                0.0,
                PI,
                1e-10,
            );
            let expected = (-optical).exp() * light[i] + projected.unwrap().value;
            assert_relative(&format!("band {l}"), fogged[i], expected, 1e-8);
        }
        let brdf = effective_brdf(&factors, &light).unwrap();
        assert_relative("effective BRDF", brdf[0], factors[0] * light[0], 1e-15);
    }

    #[test]
    fn refuses_an_order_or_length_that_does_not_fit() {
        assert!(band_factors(0, normalised).is_err());
        assert!(fogged_environment(1.0, &[1.0, 1.0], &[0.0; 3]).is_err());
        assert!(effective_brdf(&[1.0], &[0.0; 4]).is_err());
    }
}
