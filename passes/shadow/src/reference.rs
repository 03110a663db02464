//! The truth: visibility of spheres, projected as it is, and the ways to it, one point at a time in f64.

use airglow_math::sh::coefficient_count;
use airglow_math::sh::zonal::{factors_from_coefficients, rotate_to_direction};
use airglow_math::sh::{evaluate, project};
use glam::DVec3;

use crate::circle::{self, Cap};
use crate::exponential::Evaluator;
use crate::logarithm::{CLIP, Logarithm};
use crate::mean::ONE;
use crate::order::check_order;
use crate::{Exponential, ShadowError, Sphere};

/// What spheres hide from points, by every way of this room; one order.
#[derive(Clone, Debug)]
pub struct Reference {
    order: usize,
    logarithm: Logarithm,
    evaluator: Evaluator,
}

impl Reference {
    /// With the thesis's clip of eigenvalues.
    ///
    /// # Errors
    /// [`ShadowError::Order`].
    pub fn new(order: usize) -> Result<Self, ShadowError> {
        Self::with_clip(order, CLIP)
    }

    /// With another clip; see [`Logarithm::new`].
    ///
    /// # Errors
    /// As [`Logarithm::new`].
    pub fn with_clip(order: usize, clip: f64) -> Result<Self, ShadowError> {
        Ok(Self { order, logarithm: Logarithm::new(order, clip)?, evaluator: Evaluator::new(order)? })
    }

    /// The exponentials of this order.
    #[must_use]
    pub fn evaluator(&self) -> &Evaluator {
        &self.evaluator
    }

    /// The sum of the logarithms of all caps (eq. 5.13).
    ///
    /// # Errors
    /// [`ShadowError::Range`] for caps higher than 2.
    pub fn log_visibility(&self, caps: &[Cap]) -> Result<Vec<f64>, ShadowError> {
        let mut sum = vec![0.0; coefficient_count(self.order)];
        for cap in caps {
            let turned = self.turned(&self.logarithm.of_cap(cap.height)?, cap.axis)?;
            sum.iter_mut().zip(turned).for_each(|(sum, value)| *sum += value);
        }
        Ok(sum)
    }

    /// The exponential of [`Self::log_visibility`].
    ///
    /// # Errors
    /// As that and [`Evaluator::exponential`].
    pub fn visibility(&self, method: Exponential, caps: &[Cap]) -> Result<Vec<f64>, ShadowError> {
        self.evaluator.exponential(method, &self.log_visibility(caps)?)
    }

    /// The product of the visibilities, one after the other (eq. 5.11): the rival.
    ///
    /// # Errors
    /// As [`Self::log_visibility`].
    pub fn chain(&self, caps: &[Cap]) -> Result<Vec<f64>, ShadowError> {
        let mut product = vec![0.0; coefficient_count(self.order)];
        product[0] = ONE;
        for cap in caps {
            let turned = self.turned(&circle::visibility(self.order, cap.height)?, cap.axis)?;
            product = self.evaluator.product(&product, &turned)?;
        }
        Ok(product)
    }

    /// Zonal coefficients about +Z, turned to an axis.
    fn turned(&self, zonal: &[f64], axis: DVec3) -> Result<Vec<f64>, ShadowError> {
        let mut out = vec![0.0; coefficient_count(self.order)];
        rotate_to_direction(&factors_from_coefficients(zonal)?, axis, &mut out)?;
        Ok(out)
    }
}

/// The projection of what all caps leave to be seen: 1 where no cap is, 0 elsewhere, by a rule of about
/// `degree^2 / 2` directions; its error falls with the degree as that of an area counted in cells.
///
/// # Errors
/// [`ShadowError::Order`], [`ShadowError::Math`] for a degree above 2000.
pub fn truth(order: usize, degree: usize, caps: &[Cap]) -> Result<Vec<f64>, ShadowError> {
    check_order(order)?;
    let open = |direction: DVec3| if caps.iter().any(|cap| cap.hides(direction)) { 0.0 } else { 1.0 };
    Ok(project(order, degree, open)?)
}

/// Root mean square over the sphere of the difference of two functions: the norm of the coefficients' difference over
/// `sqrt(4 pi)`.
#[must_use]
pub fn rms(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt() / ONE
}

/// What a white diffuse surface of a normal reflects of white light of radiance 1 with a visibility (eq. 5.14): the
/// share of the cosine-weighted sky it sees.
///
/// # Errors
/// [`ShadowError::Math`] for a length that is no order's.
pub fn ambient(order: usize, visibility: &[f64], normal: DVec3) -> Result<f64, ShadowError> {
    let factors = airglow_math::sh::zonal::clamped_cosine(order)?;
    let mut basis = vec![0.0; coefficient_count(order)];
    evaluate(order, normal, &mut basis)?;
    let band = |i: usize| factors[i.isqrt()] / std::f64::consts::PI;
    Ok(visibility.iter().zip(&basis).enumerate().map(|(i, (v, y))| band(i) * v * y).sum())
}

/// The caps of spheres in the sky of a point.
#[must_use]
pub fn caps(spheres: &[Sphere], point: DVec3) -> Vec<Cap> {
    spheres.iter().map(|sphere| sphere.cap(point)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cap(degrees: f64, axis: DVec3) -> Cap {
        Cap { axis: axis.normalize(), height: circle::height(degrees.to_radians()).unwrap() }
    }

    #[test]
    fn the_truth_of_one_circle_is_its_closed_form() {
        let reference = Reference::new(6).unwrap();
        let one = [cap(37.0, DVec3::new(1.0, -2.0, 0.5))];
        let (found, closed) = (truth(6, 400, &one).unwrap(), reference.chain(&one).unwrap());
        assert!(rms(&found, &closed) < 2e-3, "{found:?} and {closed:?}");
    }

    #[test]
    fn apart_circles_add_up_in_log_space_and_in_products() {
        let reference = Reference::new(4).unwrap();
        let two = [cap(15.0, DVec3::X), cap(15.0, -DVec3::X)];
        let truth = truth(4, 400, &two).unwrap();
        for found in
            [reference.chain(&two).unwrap(), reference.visibility(Exponential::Operator, &two).unwrap()]
        {
            assert!(rms(&found, &truth) < 0.02, "{found:?} and {truth:?}");
        }
    }

    #[test]
    fn half_a_sky_is_half_the_light_of_a_surface_that_faces_along() {
        let half = truth(6, 300, &[cap(90.0, DVec3::X)]).unwrap();
        let seen = ambient(6, &half, DVec3::Z).unwrap();
        assert!((seen - 0.5).abs() < 3e-3, "{seen}");
    }
}
