//! Isotropic BRDFs in half-angle form as zonal coefficients, as `shaders/glsl/normals/zonal.glsl` takes them.

use airglow_math::quadrature::gauss_legendre;

use crate::NormalsError;

/// A microfacet distribution as Low, Kronander, Ynnerman and Unger ("BRDF Models for Accurate and Efficient Rendering of
/// Glossy Surfaces", 2012) fit to measured materials: `height / (1 + rise (1 - n.h))^fall`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Abc {
    /// Where normal and half vector agree, 1/sr.
    pub height: f64,
    /// How fast it leaves that height: the larger the glossier.
    pub rise: f64,
    /// How fast it goes to 0 far away.
    pub fall: f64,
}

impl Abc {
    /// The value at the cosine of normal and half vector.
    #[must_use]
    pub fn value(&self, cosine: f64) -> f64 {
        self.height * (1.0 + self.rise * (1.0 - cosine)).powf(-self.fall)
    }
}

/// The coefficients `c_l = (2 l + 1) / 2 Int f(t) P_l(t) dt` of a BRDF f of the cosine t of normal and half vector, by Gauss
/// and Legendre's rule on pieces that halve towards the peak at t = 1. So many bands tell apart what is wider than about
/// `2 / bands` radians.
///
/// # Errors
/// [`NormalsError::Math`] of the rule, which has no cause in the arguments.
pub fn coefficients(bands: usize, brdf: impl Fn(f64) -> f64) -> Result<Vec<f64>, NormalsError> {
    let rule = gauss_legendre(64)?;
    let mut coefficients = vec![0.0; bands];
    let (mut begin, pieces) = (-1.0, 32);
    for piece in 0..pieces {
        let end = if piece + 1 == pieces { 1.0 } else { begin + 0.5 * (1.0 - begin) };
        for (node, weight) in &rule {
            let t = begin + (end - begin) * 0.5 * (node + 1.0);
            let value = 0.5 * (end - begin) * weight * brdf(t);
            let (mut before, mut legendre) = (0.0, 1.0);
            for (l, coefficient) in coefficients.iter_mut().enumerate() {
                let l = l as f64;
                *coefficient += (l + 0.5) * value * legendre;
                let next = ((2.0 * l + 1.0) * t * legendre - l * before) / (l + 1.0);
                (before, legendre) = (legendre, next);
            }
        }
        begin = end;
    }
    Ok(coefficients)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_come_back() {
        // t^3 = 3/5 P_1 + 2/5 P_3.
        let found = coefficients(6, |t| t * t * t).unwrap();
        for (l, (found, expected)) in found.iter().zip([0.0, 0.6, 0.0, 0.4, 0.0, 0.0]).enumerate() {
            assert!((found - expected).abs() < 1e-12, "band {l}: {found} instead of {expected}");
        }
    }

    #[test]
    fn a_fit_of_paint_is_the_sum_of_its_bands() {
        let paint = Abc { height: 0.47, rise: 48.57, fall: 1.7025 };
        let found = coefficients(64, |t| paint.value(t)).unwrap();
        for t in [1.0_f64, 0.99, 0.9, 0.5, 0.0] {
            let (mut before, mut legendre, mut sum) = (0.0, 1.0, 0.0);
            for (l, coefficient) in found.iter().enumerate() {
                let l = l as f64;
                sum += coefficient * legendre;
                (before, legendre) = (legendre, ((2.0 * l + 1.0) * t * legendre - l * before) / (l + 1.0));
            }
            let expected = paint.value(t);
            assert!((sum - expected).abs() < 2e-3 * paint.height, "{t}: {sum} instead of {expected}");
        }
    }
}
