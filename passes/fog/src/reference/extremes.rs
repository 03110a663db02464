//! The edges of the domain: quadrature and closed form against each other and against limits in closed form.

use std::f64::consts::PI;

use super::airlight::{Sight, airlight};
use super::closed_form::isotropic;
use super::surface::{lobe_glow, scaled_lobe_glow};
use super::testing::assert_relative;
use crate::Phase;

/// Angles from the light, in radians: on it, beside it, and away from it.
pub const ANGLES: [f64; 7] = [0.0, 1e-7, 1e-4, 0.3, 2.0, PI - 1e-7, PI];

/// Optical distances of the light.
pub const OPTICAL_DISTANCES: [f64; 7] = [1e-8, 1e-4, 0.01, 1.0, 10.0, 100.0, 1e3];

fn truth(extinction: f64, sight: Sight, far: f64) -> f64 {
    4.0 * PI * airlight(extinction, sight, 0.0, far, Phase::Isotropic).unwrap()
}

#[test]
fn both_roads_agree_at_every_edge() {
    for optical in OPTICAL_DISTANCES {
        for gamma in ANGLES {
            for far in [1e-4, 0.999_9, 1.000_1, 1e4, f64::INFINITY] {
                let sight = Sight::new(1.0, gamma);
                if sight.offset == 0.0 {
                    continue; // the closed form is 0/0 there, and its limits are asked for below
                }
                let expected = truth(optical, sight, far);
                let actual = isotropic(optical, sight, far).unwrap();
                let whole = isotropic(optical, sight, f64::INFINITY).unwrap();
                let what = format!("T {optical:e}, gamma {gamma}, far {far}");
                if expected < 1e-300 {
                    assert!(actual.abs() < 1e-280, "{what}: {actual:e}");
                } else {
                    // Where the two terms of the closed form cancel, it is not the truth.
                    assert_relative(&what, actual, expected, 1e-10 + 1e-13 * whole / expected);
                }
            }
        }
    }
}

#[test]
fn towards_the_light_only_the_distance_to_it_counts() {
    for optical in OPTICAL_DISTANCES {
        for gap in [1e-4, 0.5, 0.999] {
            let far = 1.0 - gap;
            let expected = (-optical).exp() * far / gap;
            let actual = truth(optical, Sight::new(1.0, 0.0), far);
            if expected > 0.0 {
                assert_relative(&format!("T {optical:e}, gap {gap}"), actual, expected, 1e-11);
            }
        }
    }
}

#[test]
fn a_millimetre_a_kilometre_away_is_the_integrand_times_its_length() {
    for gamma in [0.0, 1e-4, 1.0, PI] {
        let expected = (-0.003_f64 * 1000.0).exp() / 1e6 * 1e-3;
        let actual = truth(0.003, Sight::new(1000.0, gamma), 1e-3);
        assert_relative(&format!("gamma {gamma}"), actual, expected, 1e-5);
    }
}

#[test]
fn the_light_may_be_next_to_the_eye() {
    // Within 1e-4 m the medium of 0.1 per metre is clear: what is seen is the angle of the ray.
    for gamma in [1e-4, 1.0, 3.0] {
        let actual = truth(0.1, Sight::new(1e-4, gamma), 1e3);
        assert_relative(&format!("gamma {gamma}"), actual, (PI - gamma) / (1e-4 * f64::sin(gamma)), 1e-3);
    }
}

#[test]
fn reflection_has_limits_at_both_ends() {
    // T -> 0: S -> (π - γ)/2, and the lobe of exponent 1 towards the light sees ∫ (π - γ)/2 2 π cos γ dγ to π/2.
    let expected = PI * (PI / 2.0 + 1.0);
    assert_relative("T 1e-8", scaled_lobe_glow(1e-8, 0.0, 1.0).unwrap(), expected, 1e-6);
    for exponent in [1.0, 20.0, 1000.0] {
        for theta in [0.0, 1e-7, 1.0, PI - 1e-7, PI] {
            for optical in OPTICAL_DISTANCES {
                let value = scaled_lobe_glow(optical, theta, exponent).unwrap();
                assert!(value.is_finite() && value > 0.0, "T {optical:e}, {theta}, {exponent}: {value:e}");
                assert!(lobe_glow(optical, theta, exponent).unwrap() <= value);
            }
        }
    }
}
