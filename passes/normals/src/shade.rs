//! Radiance of a mixture of lobes: each lobe with its own reflection and its own cosine.
//!
//! Near the half vector a BRDF is an exponential `exp(s (n.h - 1))`, whose product with a lobe is again a lobe
//! ([`Lobe::times`]). The cosine of the light is taken over that product: it is where the reflection comes from, and may
//! be far from the lobe's own axis.

use std::f64::consts::PI;

use glam::DVec3;

use crate::brdf::{Brdf, Directions};
use crate::ggx::{self, Gaussian};
use crate::mixture::{Mixture, WeightedLobe};
use crate::vmf::{Lobe, mean_length};

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
/// GGX is a blend of Gaussians `exp(-q (1 - (n.h)^2))` of all widths; one alone would lose the tails, which bring most of the
/// reflection of broad lobes. Each is multiplied with the lobe as if both were Gaussians about their axes: a broad one sees
/// of the lobe its variance across, `r / k`, by squared sines; a narrow one its height and its own shape, by chords. The mean of
/// the product lies between the axes by the share that the lobe keeps of its width.
fn reflecting_ggx(lobe: &Lobe, alpha: f64, half: DVec3) -> WeightedLobe {
    let narrowing = 1.0 / (alpha * alpha) - 1.0;
    let (k, r) = (lobe.concentration, mean_length(lobe.concentration));
    let apart = 1.0 - lobe.axis.dot(half);
    let sine = apart * (2.0 - apart);
    let (variance, opening) = (r / k, 2.0 / (1.0 + k + k * r));
    let mut sum = WeightedLobe::default();
    for Gaussian { rate, height } in ggx::gaussians(alpha) {
        let rate = rate * narrowing;
        let narrow = 1.0 - 1.0 / (1.0 + 2.0 * rate * variance);
        let kept = 1.0 / (1.0 + 2.0 * rate * (variance + (opening - variance) * narrow));
        let distance = sine + narrow * (2.0 * apart * k * opening - sine);
        let integral = height * kept * (-rate * distance * kept).exp();
        let length = (1.0 - (1.0 - r) * kept) * (1.0 + kept * (1.0 - kept) * apart);
        sum.weight += integral;
        sum.moment += integral * length * (kept * lobe.axis + (1.0 - kept) * half);
    }
    let peak = 1.0 / (PI * alpha * alpha);
    WeightedLobe { weight: peak * sum.weight, moment: peak * sum.moment }
}

/// A quarter of what reflects times its mean cosine.
fn unmasked(reflecting: WeightedLobe, light: DVec3) -> f64 {
    0.25 * reflecting.weight * Lobe::from_mean(reflecting.mean()).clamped_cosine(light)
}
