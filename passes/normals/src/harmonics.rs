//! A distribution of normals in spherical harmonics: linear, and shading is a convolution (Sun 2008, eq. 5.7).

use std::f64::consts::{FRAC_1_PI, PI};

use airglow_math::quadrature::gauss_legendre;
use airglow_math::sh;
use airglow_math::sh::zonal::clamped_cosine;

use crate::NormalsError;
use crate::brdf::{Brdf, Directions};
use crate::map::Sample;

/// Coefficients of a distribution of normals, `gamma_lm = sum of w_q Y_lm(n_q)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Harmonics {
    order: usize,
    coefficients: Vec<f64>,
}

impl Harmonics {
    /// Of a footprint's unit normals, to `order` bands, 1 to [`sh::MAX_ORDER`].
    ///
    /// # Errors
    /// [`NormalsError::Math`] for another order.
    pub fn new(order: usize, footprint: &[Sample]) -> Result<Self, NormalsError> {
        let mut coefficients = vec![0.0; sh::coefficient_count(order)];
        let mut basis = coefficients.clone();
        sh::evaluate(order, glam::DVec3::Z, &mut basis)?; // refuses the order even of an empty footprint
        for sample in footprint {
            sh::evaluate(order, sample.mean, &mut basis)?;
            for (sum, value) in coefficients.iter_mut().zip(&basis) {
                *sum += sample.weight * value;
            }
        }
        Ok(Self { order, coefficients })
    }

    /// order^2 coefficients.
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// Radiance of the distribution. Other reflections than Lambert's are the convolved BRDF times the mean cosine, both at
    /// least 0: the product of the two is no convolution.
    ///
    /// # Errors
    /// [`NormalsError::Math`].
    pub fn radiance(&self, brdf: Brdf, directions: Directions) -> Result<f64, NormalsError> {
        let cosine = self.mean_cosine(directions.light)?;
        if brdf == Brdf::Lambert {
            return Ok(cosine * FRAC_1_PI);
        }
        if directions.half == glam::DVec3::ZERO {
            return Ok(0.0);
        }
        let reflected = self.convolved(&band_factors(self.order, brdf)?, directions.half)?;
        Ok(cosine * reflected.max(0.0))
    }

    /// The mean of (n.l)+. Five bands and more hold the clamped cosine to 2 %. Three and four cannot; but they hold mean and
    /// mean square of n.l exactly, and n.l is taken as spread evenly about its mean.
    fn mean_cosine(&self, light: glam::DVec3) -> Result<f64, NormalsError> {
        if !(3..=4).contains(&self.order) {
            return Ok(self.convolved(&clamped_cosine(self.order)?, light)?.max(0.0));
        }
        let mut factors = vec![0.0; self.order];
        factors[1] = 4.0 / 3.0 * PI;
        let mean = self.convolved(&factors, light)?;
        (factors[1], factors[2]) = (0.0, 8.0 / 15.0 * PI);
        let square = 1.0 / 3.0 + self.convolved(&factors, light)?;
        Ok(rectified_evenly(mean, square))
    }

    /// `sum of A_l gamma_lm Y_lm(direction)`.
    fn convolved(&self, factors: &[f64], direction: glam::DVec3) -> Result<f64, NormalsError> {
        let mut kernel = vec![0.0; self.coefficients.len()];
        sh::zonal::rotate_to_direction(factors, direction, &mut kernel)?;
        Ok(kernel.iter().zip(&self.coefficients).map(|(a, b)| a * b).sum())
    }
}

/// The mean of `max(0, x)` for an x of that mean and mean square, spread evenly about its mean.
fn rectified_evenly(mean: f64, square: f64) -> f64 {
    let reach = (3.0 * (square - mean * mean)).max(1e-12).sqrt();
    let above = (mean + reach).max(0.0);
    if mean > reach { mean } else { 0.25 * above * above / reach }
}

/// Band factors `A_l = 2 pi Int f(t) P_l(t) dt` of a BRDF about the half vector, by Gauss and Legendre's rule on pieces that
/// halve towards the peak at t = 1.
///
/// # Errors
/// [`NormalsError::Math`] for an order out of range.
pub fn band_factors(order: usize, brdf: Brdf) -> Result<Vec<f64>, NormalsError> {
    let rule = gauss_legendre(24)?;
    let mut basis = vec![0.0; sh::coefficient_count(order)];
    let mut factors = vec![0.0; order];
    let (mut begin, pieces) = (0.0, 44);
    for piece in 0..pieces {
        let end = if piece + 1 == pieces { 1.0 } else { begin + 0.5 * (1.0 - begin) };
        for (node, weight) in &rule {
            let t = begin + (end - begin) * 0.5 * (node + 1.0);
            let sine = (1.0 - t * t).max(0.0).sqrt();
            sh::evaluate(order, glam::DVec3::new(sine, 0.0, t), &mut basis)?;
            let value = PI * (end - begin) * weight * brdf.value(t);
            for (l, factor) in factors.iter_mut().enumerate() {
                *factor += value * basis[sh::index(l, 0)] / ((2 * l + 1) as f64 / (4.0 * PI)).sqrt();
            }
        }
        begin = end;
    }
    Ok(factors)
}
