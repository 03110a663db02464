//! Radiance of a mixture of lobes: each lobe with its own reflection and its own cosine.
//!
//! Near the half vector a BRDF is an exponential `exp(s (n.h - 1))`, whose product with a lobe is again a lobe
//! ([`Lobe::times`]). The cosine of the light is taken over that product: it is where the reflection comes from, and may
//! be far from the lobe's own axis.

use std::f64::consts::PI;

use glam::DVec3;

use crate::brdf::{Brdf, Directions};
use crate::mixture::Mixture;
use crate::vmf::Lobe;

/// Distance in ln u of the exponentials that make up the GGX distribution; the error is 0.3 % at 1.
const STEP: f64 = 1.0;

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
        Brdf::Ggx { alpha } => ggx(lobe, alpha, light, half),
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

/// GGX is a blend of Beckmann-like lobes of all widths: with `y = (1/alpha^2 - 1) (1 - (n.h)^2)`,
/// `1 / (1 + y)^2 = Int u e^(-u) e^(-u y) du`, here by the trapezoidal rule in ln u. One exponential alone would lose
/// the tails, which bring most of the reflection of broad lobes.
fn ggx(lobe: &Lobe, alpha: f64, light: DVec3, half: DVec3) -> f64 {
    let narrowing = 1.0 / (alpha * alpha) - 1.0;
    let count = ((1.0 + narrowing).ln() / STEP).ceil() as usize + 5;
    let one = |i: usize| {
        let u = (1.5 - STEP * i as f64).exp();
        STEP * u * u * (-u).exp() * gaussian(lobe, u * narrowing, light, half)
    };
    (0..count).map(one).sum::<f64>() / (4.0 * PI * alpha * alpha)
}

/// `exp(-k (1 - (n.h)^2))` over a lobe, by the exponential that touches it at the axis of the product.
fn gaussian(lobe: &Lobe, k: f64, light: DVec3, half: DVec3) -> f64 {
    const LEAST: f64 = 0.05; // of the cosine where it touches: behind the horizon there is nothing to touch
    let touch = |cosine: f64| 2.0 * k * cosine.max(LEAST);
    let (_, first) = lobe.times(touch(lobe.axis.dot(half)), half);
    let sharpness = touch(first.axis.dot(half));
    let (integral, product) = lobe.times(sharpness, half);
    let cosine = product.axis.dot(half).max(LEAST);
    let height = (-k * (1.0 - cosine * cosine) + sharpness * (1.0 - cosine)).exp();
    height * integral * product.clamped_cosine(light)
}
