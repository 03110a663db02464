//! The distribution of von Mises and Fisher on the sphere, `g(n) = k / (4 pi sinh k) exp(k mu.n)`.
//!
//! Stands on Banerjee, Dhillon, Ghosh and Sra, "Clustering on the Unit Hypersphere using von Mises-Fisher
//! Distributions" (2005). What is filtered is never k and mu but the mean vector `r mu`, which is linear.

use std::f64::consts::PI;

use glam::DVec3;

/// The sharpest lobe: 1e-4 radians wide, beyond what any BRDF here can tell from a single normal.
pub const MAX_CONCENTRATION: f64 = 1e8;
/// Below this a lobe is the uniform distribution to 1e-6.
pub const MIN_CONCENTRATION: f64 = 1e-6;

/// A lobe by its axis and its concentration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobe {
    /// Unit axis.
    pub axis: DVec3,
    /// Concentration, [`MIN_CONCENTRATION`] to [`MAX_CONCENTRATION`].
    pub concentration: f64,
}

impl Lobe {
    /// The lobe whose mean vector is `mean`. A mean without direction gives the uniform lobe, about +Z.
    #[must_use]
    pub fn from_mean(mean: DVec3) -> Self {
        let axis = mean.try_normalize().unwrap_or(DVec3::Z);
        Self { axis, concentration: concentration(mean.length()) }
    }

    /// Density at a unit direction, 1/sr.
    #[must_use]
    pub fn density(&self, direction: DVec3) -> f64 {
        self.log_density(direction).exp()
    }

    /// Logarithm of the density; at the mean of a narrower lobe, the mean of the logarithm over that lobe.
    #[must_use]
    pub fn log_density(&self, direction: DVec3) -> f64 {
        self.log_height() + self.concentration * (self.axis.dot(direction) - 1.0)
    }

    /// Logarithm of the density on the axis.
    #[must_use]
    pub fn log_height(&self) -> f64 {
        let k = self.concentration;
        (k / (2.0 * PI * -(-2.0 * k).exp_m1())).ln()
    }

    /// Mean of the clamped cosine `(n.l)+` over the lobe.
    #[must_use]
    pub fn clamped_cosine(&self, light: DVec3) -> f64 {
        let (k, r) = (self.concentration, mean_length(self.concentration));
        clamped_cosine(r / k, r, self.axis.dot(light))
    }
}

/// Mean of the clamped cosine `(n.l)+` over normals about an axis at the cosine `cosine` to the light, with a mean vector of
/// length r and the variance `across`. n.l is taken as normally distributed with its exact mean and variance: exact where the
/// normals lie on one side of the horizon.
#[must_use]
pub fn clamped_cosine(across: f64, r: f64, cosine: f64) -> f64 {
    let along = (1.0 - r * r - 2.0 * across).max(0.0);
    let variance = along * cosine * cosine + across * (1.0 - cosine * cosine).max(0.0);
    rectified(r * cosine, variance.max(1e-30).sqrt())
}

/// Mean of `max(0, x)` for a normally distributed x.
#[must_use]
pub fn rectified(mean: f64, deviation: f64) -> f64 {
    let x = mean / deviation;
    let bell = (-0.5 * x * x).exp();
    // The cumulative normal distribution, Abramowitz and Stegun 26.2.17: within 7.5e-8.
    let t = 1.0 / (1.0 + 0.231_641_9 * x.abs());
    let series = t
        * (0.319_381_530
            + t * (-0.356_563_782 + t * (1.781_477_937 + t * (-1.821_255_978 + t * 1.330_274_429))));
    let tail = bell * series / (2.0 * PI).sqrt();
    let below = if x < 0.0 { tail } else { 1.0 - tail };
    (mean * below + deviation * bell / (2.0 * PI).sqrt()).max(0.0)
}

/// Length of the mean vector of a lobe, `coth k - 1/k`, 0 to 1.
#[must_use]
pub fn mean_length(concentration: f64) -> f64 {
    let k = concentration;
    if k < 1e-2 {
        // The series: the two terms cancel.
        return k / 3.0 * (1.0 - k * k / 15.0);
    }
    1.0 / k.tanh() - 1.0 / k
}

/// The concentration of the lobe whose mean vector has the length `r`: the inverse of [`mean_length`], to 1e-9.
///
/// Starts from Banerjee's `r (3 - r^2) / (1 - r^2)`, which is up to 4.9 % off, and goes on by Newton's method. Lengths
/// that no lobe has give the nearest that there is; NaN gives the uniform lobe.
#[must_use]
pub fn concentration(r: f64) -> f64 {
    let mut k = approximate_concentration(r);
    for _ in 0..4 {
        k = newton(k, r);
    }
    k
}

/// [`concentration`] as shaders have it, within 1.6e-3: `k (1 - r) / r` goes from 3 to 1 as r goes from 0 to 1, here by a
/// polynomial fitted to it.
#[must_use]
pub fn concentration_by_polynomial(r: f64) -> f64 {
    let r = if r.is_nan() { 0.0 } else { r.clamp(0.0, 1.0) };
    let bend = 1.995_253_7 + r * (-0.911_576_6 + r * (0.558_140_1 - 0.715_381_8 * r));
    (r * (1.0 + (1.0 - r) * bend) / (1.0 - r).max(1e-12)).clamp(MIN_CONCENTRATION, MAX_CONCENTRATION)
}

fn approximate_concentration(r: f64) -> f64 {
    let r = if r.is_nan() { 0.0 } else { r.clamp(0.0, 1.0) };
    (r * (3.0 - r * r) / (1.0 - r * r).max(1e-12)).clamp(MIN_CONCENTRATION, MAX_CONCENTRATION)
}

fn newton(k: f64, r: f64) -> f64 {
    let length = mean_length(k);
    // A' = 1 - A^2 - 2 A / k; past 1e3 it is k^-2 to 1e-6 and cancels, below 1e-2 it is 1/3.
    let slope = match k {
        _ if k > 1e3 => 1.0 / (k * k),
        _ if k < 1e-2 => 1.0 / 3.0,
        _ => 1.0 - length * length - 2.0 * length / k,
    };
    let r = if r.is_nan() { 0.0 } else { r.clamp(0.0, 1.0) };
    (k - (length - r) / slope).clamp(MIN_CONCENTRATION, MAX_CONCENTRATION)
}
