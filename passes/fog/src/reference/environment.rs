//! What an environment's light makes of the way to a surface, by adaptive quadrature.

use airglow_math::MathError;
use airglow_math::quadrature::adaptive;

use super::spread::legendre;

/// What the way to a surface multiplies the bands of an environment with, for `order` bands: `1/2 ∫ (1 - exp(-t u)) / u
/// P_l(1 - u) du` over u from 0 to 2, times exp(-T) and the albedo. `surface` is t, `environment` T: optical distances,
/// the environment far beyond the surface.
///
/// # Errors
/// Those of quadrature.
pub fn factors(order: usize, surface: f64, environment: f64) -> Result<Vec<f64>, MathError> {
    let factor = |l| {
        let integrand = |u: f64| {
            let kernel = if u * surface < 1e-9 { surface } else { -(-surface * u).exp_m1() / u };
            0.5 * kernel * legendre(l, 1.0 - u)
        };
        Ok((-environment).exp() * adaptive(integrand, 0.0, 2.0, 1e-13)?.value)
    };
    (0..order).map(factor).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::super::airlight::{Sight, airlight};
    use super::super::testing::assert_relative;
    use super::*;
    use crate::Phase;

    #[test]
    fn is_the_airlight_of_lamps_far_away() {
        // A patch of the environment's sphere is a lamp of L R² dω. What is left of it at the eye is divided out.
        let (beta, far) = (1e-3_f64, 1e5_f64);
        let left = (-beta * far).exp();
        for metres in [1.0, 100.0, 1000.0] {
            for l in 0..3 {
                let lamps = |cosine: f64| {
                    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
                    let sight = Sight { along: far * cosine, offset: far * sine };
                    let one = airlight(beta, sight, 0.0, metres, Phase::Isotropic).unwrap();
                    TAU * far * far * beta * one / left * legendre(l, cosine)
                };
                let expected = adaptive(lamps, -1.0, 1.0 - 1e-9, 1e-8).unwrap().value;
                let actual = factors(3, beta * metres, beta * far).unwrap()[l] / left;
                println!("{metres} m, band {l}: {actual:e} and {expected:e}");
                // The distance of the patches from the points of the way varies by 1 %.
                assert!((actual - expected).abs() < 0.02 * beta * metres, "{actual:e} and {expected:e}");
            }
        }
    }

    #[test]
    fn a_thin_medium_adds_the_mean_light_times_its_optical_distance() {
        let thin = factors(3, 1e-4, 0.5).unwrap();
        assert_relative("the mean", thin[0], 1e-4 * (-0.5_f64).exp(), 2e-4);
        assert!(thin[1].abs() < 1e-4 * thin[0] && thin[2].abs() < 1e-4 * thin[0], "{thin:?}");
    }
}
