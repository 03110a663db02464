//! The logarithm that inverts the exponential of products, by the eigenvalues of the product matrix.
//!
//! Sun 2008, section 5.2.3: `log g = R^T q'(D) R (g - 1)` with `M_g = R^T D R` (eq. 5.33) and
//! `q'(x) = ln x / (x - 1)` (eq. 5.34), after small and negative eigenvalues were raised (eq. 5.35).

use std::f64::consts::PI;

use airglow_math::sh::product::TripleProduct;
use airglow_math::sh::{coefficient_count, index};

use crate::ShadowError;
use crate::circle;
use crate::eigen;
use crate::order::check_order;

/// Smallest eigenvalue over the largest, below which one is raised: the thesis's value. Without it the matrix of a circle
/// turns indefinite, and its logarithm is not a number, from 67 degrees on at order 3 and from 34 degrees on at order 6.
pub const CLIP: f64 = 0.02;

/// The logarithm of one order.
#[derive(Clone, Debug)]
pub struct Logarithm {
    product: TripleProduct,
    clip: f64,
}

impl Logarithm {
    /// Eigenvalues below `clip` times the largest are raised to it; above 0, at most 0.5. [`CLIP`] by default.
    ///
    /// # Errors
    /// [`ShadowError::Order`], [`ShadowError::Range`].
    pub fn new(order: usize, clip: f64) -> Result<Self, ShadowError> {
        check_order(order)?;
        if clip > 0.0 && clip <= 0.5 {
            return Ok(Self { product: TripleProduct::new(order)?, clip });
        }
        Err(ShadowError::Range {
            what: "the clip of eigenvalues",
            value: clip,
            range: "above 0, at most 0.5",
        })
    }

    /// The logarithm of a function given by its coefficients.
    ///
    /// # Errors
    /// [`ShadowError::Math`] unless there are `order^2`, [`ShadowError::Range`] where no eigenvalue is above 0: the
    /// logarithm of a function that is nowhere positive.
    pub fn of(&self, function: &[f64]) -> Result<Vec<f64>, ShadowError> {
        let count = coefficient_count(self.product.order());
        let pairs = eigen::symmetric(count, &self.product.matrix(function)?);
        let largest = pairs.iter().fold(f64::NEG_INFINITY, |most, pair| most.max(pair.0));
        if !(largest > 0.0 && largest.is_finite()) {
            let what = "the largest eigenvalue of the function";
            return Err(ShadowError::Range {
                what,
                value: largest,
                range: "a function that is positive somewhere",
            });
        }
        let mut less_one = function.to_vec();
        less_one[0] -= (4.0 * PI).sqrt();
        let mut logarithm = vec![0.0; count];
        for (value, vector) in &pairs {
            let along: f64 = vector.iter().zip(&less_one).map(|(v, g)| v * g).sum();
            let factor = along * slope(value.max(self.clip * largest));
            logarithm.iter_mut().zip(vector).for_each(|(sum, v)| *sum += factor * v);
        }
        Ok(logarithm)
    }

    /// Zonal coefficients about the axis, one per band, of the logarithm of [`circle::visibility`].
    ///
    /// # Errors
    /// As [`circle::visibility`].
    pub fn of_cap(&self, height: f64) -> Result<Vec<f64>, ShadowError> {
        let order = self.product.order();
        let mut function = vec![0.0; coefficient_count(order)];
        for (l, value) in circle::visibility(order, height)?.into_iter().enumerate() {
            function[index(l, 0)] = value;
        }
        let logarithm = self.of(&function)?;
        Ok((0..order).map(|l| logarithm[index(l, 0)]).collect())
    }
}

/// `ln x / (x - 1)`, 1 at x = 1.
fn slope(x: f64) -> f64 {
    let less_one = x - 1.0;
    if less_one.abs() < 1e-8 { 1.0 - 0.5 * less_one } else { less_one.ln_1p() / less_one }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Exponential;
    use crate::exponential::Evaluator;

    #[test]
    fn the_exponential_of_the_logarithm_is_the_circle_below_the_clip() {
        for (order, degrees) in [(3, 60.0_f64), (4, 45.0), (5, 35.0), (6, 30.0)] {
            let height = circle::height(degrees.to_radians()).unwrap();
            let zonal = circle::visibility(order, height).unwrap();
            let mut function = vec![0.0; order * order];
            zonal.iter().enumerate().for_each(|(l, value)| function[index(l, 0)] = *value);
            let logarithm = Logarithm::new(order, CLIP).unwrap().of(&function).unwrap();
            let back = Evaluator::new(order).unwrap().exponential(Exponential::Operator, &logarithm).unwrap();
            for (back, value) in back.iter().zip(&function) {
                assert!((back - value).abs() < 0.03, "order {order}: {back:?} and {function:?}");
            }
        }
    }

    #[test]
    fn nothing_blocked_has_the_logarithm_zero_and_half_a_sky_a_finite_one() {
        for order in 3..=6 {
            let logarithm = Logarithm::new(order, CLIP).unwrap();
            let open = logarithm.of_cap(0.0).unwrap();
            assert!(open.iter().all(|value| value.abs() < 1e-14), "{open:?}");
            let half = logarithm.of_cap(1.0).unwrap();
            assert!(half.iter().all(|value| value.is_finite()) && half[0] < -1.0, "{half:?}");
        }
    }

    #[test]
    fn a_constant_has_the_logarithm_of_its_value() {
        let mut function = vec![0.0; 9];
        function[0] = 0.3 * (4.0 * PI).sqrt();
        let found = Logarithm::new(3, CLIP).unwrap().of(&function).unwrap()[0];
        let truth = 0.3_f64.ln() * (4.0 * PI).sqrt();
        assert!((found - truth).abs() < 1e-14, "{found} and {truth}");
    }

    #[test]
    fn what_has_no_logarithm_is_refused() {
        let logarithm = Logarithm::new(3, CLIP).unwrap();
        assert!(logarithm.of(&[0.0; 9]).unwrap_err().to_string().contains("positive somewhere"));
        assert!(logarithm.of(&[-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]).is_err());
        assert!(logarithm.of(&[1.0; 4]).is_err());
        assert!(Logarithm::new(3, 0.0).is_err() && Logarithm::new(3, f64::NAN).is_err());
    }
}
