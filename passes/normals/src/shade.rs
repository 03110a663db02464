//! Radiance of a mixture of lobes: each lobe with its own reflection and its own cosine.
//!
//! The cosine of the light is taken over the normals that reflect, which may lie far from the lobe's own axis. These are the
//! formulas of `shaders/glsl/normals`, with the length and concentration of a lobe exact.

use std::f64::consts::PI;

use glam::DVec3;

use crate::brdf::{Brdf, Directions};
use crate::ggx::Blurred;
use crate::mixture::Mixture;
use crate::vmf::{self, Lobe, mean_length};

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

/// The power of the cosine as an exponential of sharpness s + 1, whose product with the lobe is again a lobe, its height
/// corrected at the axis of the product: exact for narrow lobes, where all of the reflection is there, and for broad ones,
/// where the exponential fits. Roots are a few terms of their series.
fn blinn_phong(lobe: &Lobe, exponent: f64, light: DVec3, half: DVec3) -> f64 {
    let (k, sharpness) = (lobe.concentration, exponent + 1.0);
    let (own, other, inverse) = (k / (k + sharpness), sharpness / (k + sharpness), 1.0 / (k + sharpness));
    let apart = 1.0 - lobe.axis.dot(half);
    let bent = 2.0 * own * other * apart;
    let stretch = 1.0 + bent * (0.5 + 0.375 * bent);
    let x = own * own * apart * (1.0 + 0.5 * bent);
    let logarithm = exponent * (1.0 - x).max(1e-30).ln();
    let height = (logarithm + sharpness * (x - own * apart * (1.0 + 0.3 * bent))).exp();
    let integral = 0.5 * stretch * (inverse + own * (1.0 + mean_length(k))) * height;
    let width = (inverse * stretch).min(1.0);
    let cosine = stretch * (own * lobe.axis.dot(light) + other * half.dot(light));
    let cosine = vmf::clamped_cosine(width - width * width, 1.0 - width, cosine);
    (exponent + 8.0) / (8.0 * PI) * integral * cosine
}

/// A quarter of GGX's `D(n.h)` over the lobe times the mean cosine of the normals that reflect.
///
/// A reflection broader than the lobe sees of it its variance across, r / k, by squared sines; a narrower one its height on
/// the axis, which is `beyond` more than that variance says, and its own shape, by chords.
fn ggx(lobe: &Lobe, alpha: f64, light: DVec3, half: DVec3) -> f64 {
    let narrowing = 1.0 / (alpha * alpha) - 1.0;
    let (k, r) = (lobe.concentration, mean_length(lobe.concentration));
    let (variance, missing) = (r / k, 1.0 - r);
    let beyond = missing + missing.powi(2) * (1.1 + 3.0 * missing.powi(2));
    let apart = 1.0 - lobe.axis.dot(half);
    let sine = apart * (2.0 - apart);
    let broad = 2.0 * narrowing * variance;
    let narrow = broad / (1.0 + broad);
    let seen = 1.0 + beyond * narrow;
    let sharp = 1.0 / (1.0 + broad * seen);
    let distance = sine + narrow * (2.0 * apart * (1.0 - missing.powi(6)) - sine);
    let (value, own) = Blurred::of(sharp).at(narrowing * distance);
    let integral = value / (PI * alpha * alpha);
    let stretch = 1.0 + own * (1.0 - own) * apart; // on the sphere, not on the chord
    let cosine = stretch * (own * lobe.axis.dot(light) + (1.0 - own) * half.dot(light));
    0.25 * integral * vmf::clamped_cosine(own * variance * seen, 1.0 - missing * own, cosine)
}
