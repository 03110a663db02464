//! Radiance of a mixture of lobes: each lobe with its own reflection and its own cosine.
//!
//! Near the half vector a BRDF is an exponential `exp(s (n.h - 1))`, whose product with a lobe is again a lobe
//! ([`Lobe::times`]). The cosine of the light is taken over that product: it is where the reflection comes from, and may
//! be far from the lobe's own axis.

use std::f64::consts::PI;

use glam::DVec3;

use crate::brdf::{Brdf, Directions};
use crate::mixture::{Mixture, WeightedLobe};
use crate::vmf::{Lobe, mean_length};

/// Distance in ln u of the Gaussians that make up the GGX distribution; the error is 0.4 % at 1.
const STEP: f64 = 1.0;
/// Of the cosine of normal and half vector where an exponential touches: behind the horizon there is nothing to touch.
const LEAST_TOUCH: f64 = 0.05;

/// Radiance of a mixture, as [`crate::reference::radiance`] of its normals.
#[must_use]
pub fn radiance(mixture: &Mixture, brdf: Brdf, directions: Directions) -> f64 {
    let lobes = mixture.lobes().iter().filter(|lobe| lobe.weight > 0.0);
    lobes.map(|lobe| lobe.weight * of_lobe(&Lobe::from_mean(lobe.mean()), brdf, directions)).sum()
}

fn of_lobe(lobe: &Lobe, brdf: Brdf, Directions { light, half }: Directions) -> f64 {
    match brdf {
        Brdf::Lambert => lobe.clamped_cosine(light) / PI,
        _ if half == DVec3::ZERO => 0.0,
        Brdf::BlinnPhong { exponent } => blinn_phong(lobe, exponent, light, half),
        Brdf::Ggx { alpha } => unmasked(reflecting_ggx(lobe, alpha, half), light),
    }
}

/// The power of the cosine as an exponential of sharpness s + 1, its height corrected at the axis of the product: exact
/// for narrow lobes, where all of the reflection is there, and for broad ones, where the exponential fits.
fn blinn_phong(lobe: &Lobe, exponent: f64, light: DVec3, half: DVec3) -> f64 {
    let sharpness = exponent + 1.0;
    let (integral, product) = lobe.times(sharpness, half);
    let cosine = product.axis.dot(half);
    if cosine <= 0.0 {
        return 0.0;
    }
    let height = (exponent * cosine.ln() + sharpness * (1.0 - cosine)).exp();
    (exponent + 8.0) / (8.0 * PI) * height * integral * product.clamped_cosine(light)
}

/// The normals of a lobe that reflect by GGX's `D(n.h)`: the integral, and its product with their mean.
///
/// GGX is a blend of Beckmann-like lobes of all widths: with `y = (1/alpha^2 - 1) (1 - (n.h)^2)`,
/// `1 / (1 + y)^2 = Int u e^(-u) e^(-u y) du`, here by the trapezoidal rule in ln u. One exponential alone would lose
/// the tails, which bring most of the reflection of broad lobes. `exp(-k (1 - (n.h)^2))` is taken as the exponential
/// that touches it where the narrower one before it lay.
fn reflecting_ggx(lobe: &Lobe, alpha: f64, half: DVec3) -> WeightedLobe {
    let narrowing = 1.0 / (alpha * alpha) - 1.0;
    let count = ((1.0 + narrowing).ln() / STEP).ceil() as usize + 5;
    let (mut sum, mut touch) = (WeightedLobe::default(), 1.0);
    for i in 0..count {
        let u = (1.5 - STEP * i as f64).exp();
        let k = u * narrowing;
        let sharpness = 2.0 * k * touch;
        let (logarithm, product) = lobe.log_times(sharpness, half);
        touch = product.axis.dot(half).max(LEAST_TOUCH);
        let height = -u - k * (1.0 - touch * touch) + sharpness * (1.0 - touch);
        let integral = u * u * (logarithm + height).exp();
        sum.weight += integral;
        sum.moment += integral * mean_length(product.concentration) * product.axis;
    }
    let scale = STEP / (PI * alpha * alpha);
    WeightedLobe { weight: scale * sum.weight, moment: scale * sum.moment }
}

/// A quarter of what reflects times its mean cosine.
fn unmasked(reflecting: WeightedLobe, light: DVec3) -> f64 {
    0.25 * reflecting.weight * Lobe::from_mean(reflecting.mean()).clamped_cosine(light)
}
