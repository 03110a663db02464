//! The evaluators against quadrature: over random configurations, and at the edges of the domain.

use std::f64::consts::PI;

use airglow_math::quadrature::gauss_legendre;
use airglow_math::special::scaled_exponential_integral;

use super::*;
use crate::Phase;
use crate::reference::airlight::{Sight, airlight};

/// `∫ exp(-β (x + d)) / d² dx` in single precision, by both evaluators at both precisions.
fn all(light: Light, extinction: f32, far: f32) -> [(f32, f64, &'static str); 4] {
    let segment = Segment::new(light, 0.0, far);
    let dimmed = transmittance(extinction, segment.path);
    [
        (
            dimmed * taps::kernel(segment, extinction, taps::REFERENCE, 0.0, |_| 1.0),
            1.2e-5,
            "taps, reference",
        ),
        (dimmed * poles::kernel(segment, extinction, poles::REFERENCE), 1e-5, "poles, reference"),
        (dimmed * taps::kernel(segment, extinction, taps::DEFAULT, 0.0, |_| 1.0), 1e-3, "taps, default"),
        (dimmed * poles::kernel(segment, extinction, poles::DEFAULT), 2e-3, "poles, default"),
    ]
}

/// The light at a distance and an angle, as a shader has it, and as the reference has it.
fn light(distance: f64, gamma: f64) -> (Light, Sight) {
    let (along, offset) = ((distance * gamma.cos()) as f32, (distance * gamma.sin().max(0.0)) as f32);
    let sight = Sight { along: f64::from(along), offset: f64::from(offset) };
    (Light { distance: distance as f32, along, offset, radius: 0.0 }, sight)
}

#[track_caller]
fn check(what: &str, (actual, tolerance, name): (f32, f64, &str), truth: f64) {
    let actual = f64::from(actual);
    assert!(actual.is_finite() && actual >= 0.0, "{what}, {name}: {actual:e}");
    let error = (actual - truth).abs();
    // Below 1e-30 the precision is absolute.
    let allowed = if truth < 1e-30 { 1e-30 * tolerance } else { tolerance * truth };
    assert!(error <= allowed, "{what}, {name}: {actual:e} is not {truth:e}, {:e}", error / truth);
}

fn truth(extinction: f32, sight: Sight, far: f64) -> f64 {
    4.0 * PI * airlight(f64::from(extinction), sight, 0.0, far, Phase::Isotropic).unwrap()
}

/// One of a sequence that covers the domain evenly (Roberts 2018, the additive recurrence of three dimensions): extinction
/// from 1e-4 over so many decades, the ray's length, and a light of distance 1 at any angle.
fn configuration(i: u32, decades: f64) -> (f32, f32, Light, Sight) {
    let part = |alpha: f64| (0.5 + alpha * f64::from(i)).fract();
    let [a, b, c] = [0.819_172_513, 0.671_043_607, 0.549_700_478].map(part);
    let far = if b < 0.9 { 10_f64.powf(-4.0 + 8.0 * b / 0.9) as f32 } else { INFINITE };
    let (light, sight) = light(1.0, PI * c);
    (10_f64.powf(-4.0 + decades * a) as f32, far, light, sight)
}

#[test]
fn every_configuration_of_a_sweep_is_met() {
    for i in 0..3000_u32 {
        let (extinction, far, light, sight) = configuration(i, 6.0);
        let expected = truth(extinction, sight, if far == INFINITE { f64::INFINITY } else { far.into() });
        for result in all(light, extinction, far) {
            check(&format!("T {extinction:e}, far {far:e}, {light:?}"), result, expected);
        }
    }
}

#[test]
fn the_edges_of_the_domain_are_met() {
    for optical in [0.0, 1e-8, 1e-4, 1.0, 60.0, 1e3] {
        for gamma in [0.0, 1e-7, 1e-4, 1.0, PI - 1e-4, PI - 1e-7, PI] {
            for far in [1e-4, 0.5, 0.999_755_859_375, 2.0, 1e6, f64::INFINITY] {
                let (light, sight) = light(1.0, gamma);
                if sight.offset == 0.0 && far > 1.0 && gamma < 1.0 {
                    // Through the light the integral diverges: finite all the same.
                    for (value, _, name) in all(light, optical, (far as f32).min(INFINITE)) {
                        assert!(value.is_finite() && value >= 0.0, "{name} through the light: {value:e}");
                    }
                    continue;
                }
                let expected = truth(optical, sight, far);
                for result in all(light, optical, (far as f32).min(INFINITE)) {
                    check(&format!("T {optical:e}, far {far}, gamma {gamma}"), result, expected);
                }
            }
        }
    }
}

#[test]
fn a_light_at_the_eye_and_a_short_ray_far_away_are_finite() {
    let at_eye = Light { distance: 0.0, along: 0.0, offset: 0.0, radius: 0.0 };
    let lamp = Light { radius: 0.1, ..at_eye };
    for far in [1e-3, 1.0, INFINITE] {
        for (value, _, name) in all(at_eye, 0.5, far) {
            assert!(value.is_finite() && value >= 0.0, "{name} at the eye: {value:e}");
        }
        let sight = Sight { along: 0.0, offset: 0.0 }.with_radius(f64::from(lamp.radius));
        let expected = truth(0.5, sight, if far == INFINITE { f64::INFINITY } else { f64::from(far) });
        for result in all(lamp, 0.5, far) {
            check(&format!("lamp at the eye, {far}"), result, expected);
        }
    }
    for gamma in [0.0, 0.7, PI] {
        let (light, sight) = light(1000.0, gamma);
        for result in all(light, 0.01, 1e-3) {
            check(&format!("a millimetre, {gamma}"), result, truth(0.01, sight, f64::from(1e-3_f32)));
        }
    }
}

/// Three channels may share their taps: those of the smallest extinction serve one four times as large.
#[test]
fn taps_of_a_thinner_medium_serve_a_denser_one() {
    for (rule, tolerance) in [(taps::REFERENCE, 3e-5), (taps::DEFAULT, 3e-3)] {
        let mut worst = 0.0_f64;
        for i in 0..3000_u32 {
            let (extinction, far, light, sight) = configuration(i, 5.5);
            let segment = Segment::new(light, 0.0, far);
            let sum: f32 = taps::taps(segment, 0.25 * extinction, 1.0, rule)
                .map(|tap| tap.weight * (-extinction * tap.excess).exp())
                .sum();
            let actual = f64::from(transmittance(extinction, segment.path) * sum);
            let expected = truth(extinction, sight, if far == INFINITE { f64::INFINITY } else { far.into() });
            worst = worst.max((actual / expected - 1.0).abs());
        }
        assert!(worst < tolerance, "{worst:e} > {tolerance:e}");
    }
}

#[test]
fn a_stretch_in_two_parts_is_the_whole() {
    let (light, _) = light(3.0, 0.4);
    let part = |near, length| {
        let segment = Segment::new(light, near, length);
        transmittance(0.4, segment.path) * taps::kernel(segment, 0.4, taps::REFERENCE, 0.0, |_| 1.0)
    };
    let (whole, sum) = (part(0.0, 7.0), part(0.0, 2.5) + part(2.5, 4.5));
    assert!((whole - sum).abs() < 3e-6 * whole, "{sum} is not {whole}");
}

#[test]
fn taps_take_any_phase_function() {
    let phases = [
        (0.0, Phase::Polynomial([0.06, 0.05, 0.04, 0.03])),
        (0.8, Phase::HenyeyGreenstein { g: 0.8 }),
        (-0.5, Phase::HenyeyGreenstein { g: -0.5 }),
        (0.98, Phase::HenyeyGreenstein { g: 0.98 }),
        (0.6, Phase::Draine { g: 0.6, alpha: 1.0 }),
    ];
    for (optical, gamma, far) in [(0.5_f32, 0.3, 5.0), (5.0, 1.5, f64::INFINITY), (0.01, 2.5, 30.0)] {
        for (g, phase) in phases {
            let (light, sight) = light(1.0, gamma);
            let expected = airlight(f64::from(optical), sight, 0.0, far, phase).unwrap();
            for (rule, tolerance) in [(taps::REFERENCE, 2e-5), (taps::DEFAULT, 5e-3)] {
                let segment = Segment::new(light, 0.0, (far as f32).min(INFINITE));
                let value = |cosine: f32| phase.value(cosine.into()) as f32;
                let kernel = taps::kernel(segment, optical, rule, g, value);
                let actual = transmittance(optical, segment.path) * kernel;
                check(&format!("{phase:?}, T {optical}, {gamma}"), (actual, tolerance, "taps"), expected);
            }
        }
    }
}

#[test]
fn rules_are_the_ones_they_are_called() {
    for nodes in [taps::DEFAULT.nodes, taps::REFERENCE.nodes, poles::DEFAULT.short, poles::REFERENCE.short] {
        for ((node, weight), (x, w)) in nodes.iter().zip(gauss_legendre(nodes.len()).unwrap()) {
            let expected = ((0.5 + 0.5 * x) as f32, (0.5 * w) as f32);
            assert!(
                (node - expected.0).abs() < 1e-7 && (weight - expected.1).abs() < 1e-7,
                "{node} {weight}"
            );
        }
    }
}

#[test]
fn poles_stand_for_the_exponential_integral() {
    for (precision, tolerance) in [(poles::REFERENCE, 6e-7), (poles::DEFAULT, 9e-5)] {
        for exponent in 0..25 {
            for step in 0..=20 {
                let (modulus, angle) = (1.3_f64.powi(exponent), PI / 40.0 * f64::from(step));
                let (w, u) = (modulus * angle.cos().abs(), modulus * angle.sin());
                let expected = scaled_exponential_integral(w, u).unwrap().imaginary_over_u;
                let pole = |&(q, c): &(f32, f32)| f64::from(c) / (u * u + (w + f64::from(q)).powi(2));
                let actual: f64 = precision.poles.iter().map(pole).sum();
                let error = (actual / expected - 1.0).abs();
                assert!(error < tolerance, "at {w}, {u}: {actual:e} is not {expected:e}, {error:e}");
            }
        }
    }
}

#[test]
fn transmittance_keeps_its_precision() {
    for (extinction, length) in [(0.1_f32, 3.0_f32), (0.731, 93.7), (1.37, 50.0), (1e-3, 1.0), (2.0, 200.0)] {
        let expected = (-f64::from(extinction) * f64::from(length)).exp();
        let actual = f64::from(transmittance(extinction, length));
        let error = (actual - expected).abs();
        assert!(error <= 3e-7 * expected + 1e-45, "{extinction} {length}: {actual:e} is not {expected:e}");
    }
}
