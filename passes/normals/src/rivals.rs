//! What others keep of a footprint: a mean normal, its length, or second moments of the slope.

use std::f64::consts::{FRAC_1_PI, PI};

use glam::{DMat2, DVec2, DVec3};

use crate::brdf::{Brdf, Directions};
use crate::map::Sample;

/// The steepest slope that second moments take in, 84 degrees: steeper normals would outweigh all others.
const STEEPEST: f64 = 10.0;

/// The mean normal of a footprint.
#[must_use]
pub fn mean(footprint: &[Sample]) -> DVec3 {
    footprint.iter().map(|sample| sample.weight * sample.mean).sum()
}

/// The mean normal, shaded as a normal: scaled to length 1 if `normalised`, or at the length it has.
#[must_use]
pub fn mip(mean: DVec3, normalised: bool, brdf: Brdf, directions: Directions) -> f64 {
    let normal = if normalised { mean.try_normalize().unwrap_or(DVec3::Z) } else { mean };
    normal.dot(directions.light).max(0.0) * brdf.value(normal.dot(directions.half))
}

/// Toksvig, "Mipmapping Normal Maps" (2005): the exponent falls with the length of the mean normal,
/// `s' = s r / (r + s (1 - r))`, and the height by `(1 + s') / (1 + s)`. GGX takes it by `s = 2 / alpha^2 - 2`, and its
/// own height, `1 / alpha'^2`, falls along.
#[must_use]
pub fn toksvig(mean: DVec3, brdf: Brdf, directions: Directions) -> f64 {
    let length = mean.length().clamp(0.0, 1.0);
    let lower = |s: f64| s * length / (length + s * (1.0 - length)).max(1e-12);
    match brdf {
        Brdf::Lambert => mip(mean, true, brdf, directions),
        Brdf::BlinnPhong { exponent } => {
            let lowered = lower(exponent);
            let height = (1.0 + lowered) / (1.0 + exponent) * (exponent + 8.0) / (lowered + 8.0);
            height * mip(mean, true, Brdf::BlinnPhong { exponent: lowered }, directions)
        }
        Brdf::Ggx { alpha } => {
            let exponent = lower(2.0 / (alpha * alpha) - 2.0);
            mip(mean, true, Brdf::Ggx { alpha: (2.0 / (exponent + 2.0)).sqrt() }, directions)
        }
    }
}

/// The variance that the length of the mean normal stands for, `(1 - r) / r`, added to the roughness of the material:
/// `alpha'^2 = alpha^2 + 2 variance`.
#[must_use]
pub fn roughened(mean: DVec3, brdf: Brdf, directions: Directions) -> f64 {
    let length = mean.length().clamp(1e-3, 1.0);
    widened(mean, 2.0 * (1.0 - length) / length, brdf, directions)
}

/// Tokuyoshi and Kaplanyan, "Improved Geometric Specular Antialiasing" (2019): the roughness grows by the squared
/// change of the mean normal from pixel to pixel, in x and y together, as far as 0.18.
#[must_use]
pub fn geometric(mean: DVec3, change: f64, brdf: Brdf, directions: Directions) -> f64 {
    const VARIANCE: f64 = 0.5 * FRAC_1_PI; // of the pixel's filter
    const MOST: f64 = 0.18;
    widened(mean, (2.0 * VARIANCE * change).min(MOST), brdf, directions)
}

/// The mean normal under a material whose `alpha^2` has grown; exponents are `2 / alpha^2 - 2`.
fn widened(mean: DVec3, growth: f64, brdf: Brdf, directions: Directions) -> f64 {
    let brdf = match brdf {
        Brdf::Lambert => Brdf::Lambert,
        Brdf::BlinnPhong { exponent } => {
            let squared = (2.0 / (exponent + 2.0) + growth).min(1.0);
            Brdf::BlinnPhong { exponent: 2.0 / squared - 2.0 }
        }
        Brdf::Ggx { alpha } => Brdf::Ggx { alpha: (alpha * alpha + growth).min(1.0).sqrt() },
    };
    mip(mean, true, brdf, directions)
}

/// Olano and Baker, "LEAN Mapping" (2010): mean and covariance of the slope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lean {
    /// Mean of `(n_x, n_y) / n_z`.
    pub mean: DVec2,
    /// Mean of the products of the slopes, row by row.
    pub moments: DMat2,
}

impl Lean {
    /// Of a footprint. Slopes are held to a steepness of 10, normals below the horizon to the same.
    #[must_use]
    pub fn new(footprint: &[Sample]) -> Self {
        let (mut mean, mut moments) = (DVec2::ZERO, DMat2::ZERO);
        for sample in footprint {
            let slope = slope(sample.mean);
            mean += sample.weight * slope;
            moments += sample.weight * DMat2::from_cols(slope * slope.x, slope * slope.y);
        }
        Self { mean, moments }
    }

    /// Radiance, with the cosine of the mean slope's normal. The reflection becomes a function of slope: for Blinn-Phong
    /// a Gaussian of variance `1 / s`, for GGX its own, `alpha^2 / 2` each way, both widened by the covariance, its measure taken at the mean slope.
    #[must_use]
    pub fn radiance(&self, brdf: Brdf, Directions { light, half }: Directions) -> f64 {
        let normal = self.mean.extend(1.0).normalize();
        let cosine = normal.dot(light).max(0.0);
        if brdf == Brdf::Lambert {
            return cosine * FRAC_1_PI;
        }
        if half.z <= 0.0 {
            return 0.0;
        }
        let offset = slope(half) - self.mean;
        let outer = DMat2::from_cols(self.mean * self.mean.x, self.mean * self.mean.y);
        let widened = |variance: f64| self.moments - outer + DMat2::from_diagonal(DVec2::splat(variance));
        let distance = |covariance: DMat2| offset.dot(covariance.inverse() * offset);
        match brdf {
            Brdf::Lambert => 0.0,
            Brdf::BlinnPhong { exponent } => {
                let variance = 1.0 / exponent.max(1e-3);
                let covariance = widened(variance);
                let height = (exponent + 8.0) / (8.0 * PI) * variance / covariance.determinant().sqrt();
                cosine * height * (-0.5 * distance(covariance)).exp()
            }
            Brdf::Ggx { alpha } => {
                let covariance = widened(0.5 * alpha * alpha);
                let tail = 1.0 + 0.5 * distance(covariance);
                let fourth = normal.dot(half).max(0.05).powi(4);
                cosine / (8.0 * PI * covariance.determinant().sqrt() * fourth * tail * tail)
            }
        }
    }
}

fn slope(normal: DVec3) -> DVec2 {
    let slope = normal.truncate() / normal.z.max(1e-6);
    slope.clamp_length_max(STEEPEST)
}
