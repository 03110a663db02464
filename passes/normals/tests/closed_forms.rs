//! Lobes, harmonics and shading against closed forms and quadrature.

#![expect(clippy::unwrap_used, reason = "helpers fail the test they are called from")]

mod common;

use std::f64::consts::PI;

use airglow_math::quadrature::adaptive;
use airglow_math::sh::zonal::clamped_cosine;
use airglow_math::statistics::relative_l2;
use airglow_normals::vmf::{self, Lobe};
use airglow_normals::{Brdf, Directions, Mixture, Sample, WeightedLobe, band_factors, shade};
use common::Random;
use glam::DVec3;

fn assert_close(what: &str, actual: f64, expected: f64, relative: f64) {
    let error = (actual - expected).abs() / expected.abs().max(1e-300);
    assert!(error <= relative, "{what}: {actual:e} is not {expected:e}, off by {error:e}");
}

/// The lobe with the axis +Z as equally weighted normals, stratified in its cumulative distribution.
fn normals(concentration: f64, rings: usize) -> Vec<DVec3> {
    let ring = |i: usize| {
        let u = (i as f64 + 0.5) / rings as f64;
        let z = 1.0 + (u + (1.0 - u) * (-2.0 * concentration).exp()).ln() / concentration;
        let radius = (1.0 - z * z).max(0.0).sqrt();
        (0..rings).map(move |j| {
            let angle = 2.0 * PI * (j as f64 + 0.5) / rings as f64;
            DVec3::new(radius * angle.cos(), radius * angle.sin(), z)
        })
    };
    (0..rings).flat_map(ring).collect()
}

#[test]
fn concentration_inverts_the_mean_length() {
    let (mut exact, mut polynomial): (f64, f64) = (0.0, 0.0);
    for i in 0..=2000 {
        let k = 10_f64.powf(-1.5 + 6.5 * f64::from(i) / 2000.0);
        let r = vmf::mean_length(k);
        exact = exact.max((vmf::concentration(r) / k - 1.0).abs());
        if (0.01..=0.999).contains(&r) {
            polynomial = polynomial.max((vmf::concentration_by_polynomial(r) / k - 1.0).abs());
        }
    }
    println!("concentration from mean length: exact {exact:e}, by a polynomial {polynomial:e}");
    assert!(exact < 1e-6 && polynomial <= 2.5e-3, "{exact:e} {polynomial:e}");
}

#[test]
fn mean_length_is_the_mean_cosine() {
    for k in [1e-3, 0.0099, 0.0101, 0.3, 3.0, 30.0, 300.0] {
        let lobe = Lobe { axis: DVec3::Z, concentration: k };
        let density = |z: f64| 2.0 * PI * lobe.density(DVec3::new(0.0, (1.0 - z * z).max(0.0).sqrt(), z));
        let total = adaptive(density, -1.0, 1.0, 1e-12).unwrap().value;
        assert_close("the total", total, 1.0, 1e-10);
        let mean = adaptive(|z| z * density(z), -1.0, 1.0, 1e-12).unwrap().value;
        assert_close("the mean cosine", mean, vmf::mean_length(k), 1e-7);
    }
}

#[test]
fn the_clamped_cosine_is_exact_off_the_horizon() {
    for (k, elevation, tolerance) in [
        (1e8, 0.001_f64, 1e-4),
        (3000.0, 0.2, 1e-4),
        (300.0, 0.5, 1e-4),
        (50.0, 0.02, 0.05),
        (5.0, 0.3, 0.1),
        (1e-6, 1.0, 0.1),
    ] {
        let light = DVec3::new(elevation.cos(), 0.0, elevation.sin());
        let truth = normals(k, 400).iter().map(|n| n.dot(light).max(0.0)).sum::<f64>() / 160_000.0;
        let lobe = Lobe { axis: DVec3::Z, concentration: k };
        assert_close(&format!("concentration {k}"), lobe.clamped_cosine(light), truth, tolerance);
    }
}

/// One lobe under random lights and views, half of them near the highlight.
#[test]
fn shading_a_lobe_is_the_integral_over_it() {
    let cases = [
        (Brdf::Lambert, 0.04),
        (Brdf::BlinnPhong { exponent: 1.0 }, 0.06),
        (Brdf::BlinnPhong { exponent: 10.0 }, 0.03),
        (Brdf::BlinnPhong { exponent: 50.0 }, 0.01),
        (Brdf::BlinnPhong { exponent: 200.0 }, 0.01),
        (Brdf::Ggx { alpha: 0.1 }, 0.02),
        (Brdf::Ggx { alpha: 0.3 }, 0.04),
        (Brdf::Ggx { alpha: 0.5 }, 0.05),
        (Brdf::Ggx { alpha: 1.0 }, 0.05),
    ];
    for (brdf, tolerance) in cases {
        for k in [10.0, 50.0, 300.0, 3000.0] {
            let normals = normals(k, 200);
            let footprint: Vec<Sample> =
                normals.iter().map(|&mean| Sample { weight: 1.0 / 40_000.0, mean }).collect();
            let moment = vmf::mean_length(k) * DVec3::Z;
            let mixture = Mixture::new(vec![WeightedLobe { weight: 1.0, moment }]).unwrap();
            let mut random = Random(5);
            let (mut values, mut truths) = (Vec::new(), Vec::new());
            for row in 0..16 {
                let directions = common::directions(row, &footprint, 0.1, &mut random);
                values.push(shade::radiance(&mixture, brdf, directions));
                truths.push(airglow_normals::reference::radiance(&footprint, brdf, directions));
            }
            let error = relative_l2(&values, &truths).unwrap();
            println!("{brdf:?}, concentration {k}: {:.2}%", 100.0 * error);
            assert!(error < tolerance, "{brdf:?}, concentration {k}: {error}; {values:?} {truths:?}");
        }
    }
}

#[test]
fn a_sharp_lobe_is_its_normal() {
    let normal = DVec3::new(0.3, -0.2, 0.9).normalize();
    let mixture = Mixture::new(vec![WeightedLobe { weight: 1.0, moment: normal }]).unwrap();
    let directions = Directions::new(DVec3::new(0.5, 0.2, 0.8), DVec3::new(0.1, -0.6, 0.7)).unwrap();
    let one = [Sample { weight: 1.0, mean: normal }];
    for brdf in [Brdf::Lambert, Brdf::BlinnPhong { exponent: 77.0 }, Brdf::Ggx { alpha: 0.2 }] {
        let truth = airglow_normals::reference::radiance(&one, brdf, directions);
        assert_close(&format!("{brdf:?}"), shade::radiance(&mixture, brdf, directions), truth, 4e-3);
    }
}

#[test]
fn band_factors_are_those_of_closed_forms() {
    // 2 pi Int (t^s, t^(s+1)) dt.
    for exponent in [1.0, 7.0, 200.0, 1e4] {
        let factors = band_factors(2, Brdf::BlinnPhong { exponent }).unwrap();
        let height = (exponent + 8.0) / 4.0;
        assert_close("band 0", factors[0], height / (exponent + 1.0), 1e-10);
        assert_close("band 1", factors[1], height / (exponent + 2.0), 1e-10);
    }
    // The clamped cosine is (n.h)^1.
    let factors = band_factors(5, Brdf::BlinnPhong { exponent: 1.0 }).unwrap();
    for (factor, cosine) in factors.iter().zip(clamped_cosine(5).unwrap()) {
        assert!((factor - cosine * 9.0 / (8.0 * PI)).abs() < 1e-12, "{factor} {cosine}");
    }
    // D is normalised with the cosine: Int D cos = 1, of which a quarter is kept.
    for alpha in [0.001, 0.1, 0.5, 1.0] {
        let factors = band_factors(2, Brdf::Ggx { alpha }).unwrap();
        assert_close("GGX's band 1", factors[1], 0.25, 1e-8);
    }
}
