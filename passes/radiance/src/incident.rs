//! Incident radiance at a point, as a light vector, with what the oracle needs to know of its emitters.

use glam::{DMat3, DVec3};

use crate::RadianceError;

/// Incident radiance at a point, projected on spherical harmonics, with the distance of its emitters.
#[derive(Clone, Debug, PartialEq)]
pub struct Incident {
    /// Light vector `l_i = Integral L(s) Y_i(s) ds`, linear RGB, order squared of them.
    pub coefficients: Vec<DVec3>,
    /// Solid angle under which emitters are seen, steradians.
    pub solid_angle: f64,
    /// `Integral ds / d(s)` over that solid angle, d the distance of the emitter in direction s; sr/m.
    pub nearness: f64,
    /// The same, weighted with radiance: `Integral L(s) / d(s) ds`. How fast the light changes with position:
    /// moving by a small h changes what each emitter sends by the order of h / d of itself.
    pub slope: DVec3,
    /// Derivatives of each coefficient by position, columns d/dx, d/dy and d/dz of RGB, 1/m; empty where none were asked
    /// for. What is seen is taken as unchanged: nothing appears from behind another.
    pub gradients: Vec<DMat3>,
}

impl Incident {
    /// No light.
    ///
    /// # Errors
    /// The order, unless it is 1 to [`airglow_math::sh::MAX_ORDER`].
    pub fn dark(order: usize) -> Result<Self, RadianceError> {
        airglow_math::sh::check_order(order)?;
        let coefficients = vec![DVec3::ZERO; airglow_math::sh::coefficient_count(order)];
        Ok(Self { coefficients, solid_angle: 0.0, nearness: 0.0, slope: DVec3::ZERO, gradients: Vec::new() })
    }

    /// Harmonic mean of the distances of emitters, weighted with solid angle (Sun 2005, section 3.3.2); infinite
    /// where none is seen.
    #[must_use]
    pub fn distance(&self) -> f64 {
        if self.nearness > 0.0 { self.solid_angle / self.nearness } else { f64::INFINITY }
    }

    /// Norm of the light vector: root of the summed squares, mean over red, green and blue.
    #[must_use]
    pub fn norm(&self) -> f64 {
        (self.coefficients.iter().map(|l| l.length_squared()).sum::<f64>() / 3.0).sqrt()
    }

    /// Adds the light of other emitters that neither cover these nor are covered by them. Gradients stay if both have
    /// them.
    ///
    /// # Errors
    /// [`RadianceError::Length`] when the orders differ.
    pub fn add(&mut self, other: &Self) -> Result<(), RadianceError> {
        let (expected, actual) = (self.coefficients.len(), other.coefficients.len());
        if expected != actual {
            return Err(RadianceError::Length { what: "the light vector to add", expected, actual });
        }
        self.coefficients.iter_mut().zip(&other.coefficients).for_each(|(sum, l)| *sum += *l);
        let gradients = self.gradients.iter().zip(&other.gradients);
        self.gradients = gradients.map(|(one, other)| *one + *other).collect();
        self.solid_angle += other.solid_angle;
        self.nearness += other.nearness;
        self.slope += other.slope;
        Ok(())
    }
}
