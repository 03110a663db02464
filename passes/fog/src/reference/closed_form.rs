//! Airlight in closed form: Sun, thesis (2008), eq. 3.16, with the exponential integral in place of its table.
//!
//! With `S(T, γ) = Im(exp(z) E1(z))` at `z = T (1 - exp(i γ))`, T the optical distance of the light and γ its angle from
//! the ray,
//!
//! ```text
//! ∫ exp(-β (x + d)) / d² dx = 2 / h ( exp(-β D) S(T, γ) - exp(-β (D_vp + D_sp)) S(T_sp, γ_p) )
//! ```
//!
//! over x from 0 to D_vp, the second term seen from the far end. Both exponentials are transmittances of real paths.

use airglow_math::MathError;
use airglow_math::special::scaled_exponential_integral;

use super::airlight::Sight;

/// `∫ exp(-β (x + d)) / d² dx` over an isotropic ray from the eye to `far` metres (which may be infinite), 1/m: the
/// [airlight](super::airlight::airlight) of an isotropic phase function times 4 pi.
///
/// Relative errors are near 1e-13 but for short stretches, whose two terms cancel: about 1e-14 times the ratio of the
/// endless ray's airlight to the stretch's.
///
/// # Errors
/// [`MathError::Range`] unless the extinction and the offset are above 0.
pub fn isotropic(extinction: f64, sight: Sight, far: f64) -> Result<f64, MathError> {
    let term = |x: f64| {
        let distance = sight.distance(x);
        let seen = endless(extinction, sight.offset, x - sight.along, distance)?;
        Ok::<_, MathError>((-extinction * (x + distance)).exp() * seen)
    };
    let near = term(0.0)?;
    let beyond = if far.is_finite() { term(far)? } else { 0.0 };
    Ok(2.0 * (near - beyond))
}

/// `S / h`, seen from a place `ahead` of the light's foot, in 1/m.
fn endless(extinction: f64, offset: f64, ahead: f64, distance: f64) -> Result<f64, MathError> {
    // z = β (m - i h) with m = ahead + d, before the foot without its cancellation.
    let m = if ahead >= 0.0 { ahead + distance } else { offset * offset / (distance - ahead) };
    Ok(extinction * scaled_exponential_integral(extinction * m, extinction * offset)?.imaginary_over_u)
}

/// `S(T, γ) / (T sin γ)`: the glow about a light of optical distance T at γ from it, smooth in γ but for its peak.
///
/// # Errors
/// [`MathError::Range`] unless T is above 0 and γ is above 0 and at most π.
pub fn glow(optical_distance: f64, gamma: f64) -> Result<f64, MathError> {
    let (sine, cosine) = (0.5 * gamma).sin_cos();
    // T (1 - cos γ) and T sin γ of the half angle.
    let z = [2.0 * optical_distance * sine * sine, 2.0 * optical_distance * sine * cosine.max(0.0)];
    Ok(scaled_exponential_integral(z[0], z[1])?.imaginary_over_u)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::airlight::airlight;
    use super::super::testing::assert_relative;
    use super::*;
    use crate::Phase;

    #[test]
    fn agrees_with_quadrature() {
        for optical in [1e-4, 0.03, 1.0, 7.0, 60.0, 300.0] {
            for gamma in [1e-7, 1e-3, 0.4, 1.5, 2.9, PI - 1e-7] {
                for far in [0.3, 0.999, 1.7, 30.0, f64::INFINITY] {
                    let sight = Sight::new(1.0, gamma);
                    let what = format!("T {optical}, gamma {gamma}, far {far}");
                    let actual = isotropic(optical, sight, far).unwrap() / (4.0 * PI);
                    let expected = airlight(optical, sight, 0.0, far, Phase::Isotropic).unwrap();
                    let whole = isotropic(optical, sight, f64::INFINITY).unwrap() / (4.0 * PI);
                    let cancelled = 1e-13 * whole / expected;
                    assert_relative(&what, actual, expected, 1e-11 + cancelled);
                }
            }
        }
    }

    #[test]
    fn the_glow_is_the_endless_airlight() {
        let (optical, gamma) = (2.5_f64, 0.7);
        let actual = 2.0 * optical * (-optical).exp() * glow(optical, gamma).unwrap();
        let expected = isotropic(optical, Sight::new(1.0, gamma), f64::INFINITY).unwrap();
        assert_relative("glow", actual, expected, 1e-13);
    }

    #[test]
    fn refuses_a_ray_through_the_light() {
        assert!(isotropic(1.0, Sight::new(1.0, 0.0), 0.5).is_err());
        assert!(isotropic(0.0, Sight::new(1.0, 0.5), 0.5).is_err());
    }
}
