//! The reflection of a single normal: what is averaged over a footprint.

use std::f64::consts::{FRAC_1_PI, PI};

use glam::DVec3;

use crate::NormalsError;

/// A BRDF without Fresnel, shadowing and view foreshortening. All but the cosine of the incident light depends on the
/// angle of normal and half vector alone (Sun 2008, eq. 5.3), which is what makes filtering a convolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Brdf {
    /// `1 / pi`, albedo 1.
    Lambert,
    /// `(s + 8) / (8 pi) (n.h)^s`.
    BlinnPhong {
        /// The exponent s, 0 to 1e6.
        exponent: f64,
    },
    /// `D(n.h) / 4`, D the distribution of Walter, Marschner, Li and Torrance 2007, eq. 33.
    Ggx {
        /// The width alpha, 1e-3 to 1.
        alpha: f64,
    },
}

impl Brdf {
    /// Checks the parameter.
    ///
    /// # Errors
    /// [`NormalsError::Range`].
    pub fn check(self) -> Result<(), NormalsError> {
        let (what, value, accepted, range) = match self {
            Self::Lambert => return Ok(()),
            Self::BlinnPhong { exponent } => ("the exponent", exponent, 0.0..=1e6, "0 to 1e6"),
            Self::Ggx { alpha } => ("alpha", alpha, 1e-3..=1.0, "0.001 to 1"),
        };
        if accepted.contains(&value) { Ok(()) } else { Err(NormalsError::Range { what, value, range }) }
    }

    /// The value at the cosine of normal and half vector, 0 where that is not positive; 1/sr, without the cosine of
    /// the light. Lambert does not depend on it.
    #[must_use]
    pub fn value(self, cosine: f64) -> f64 {
        match self {
            Self::Lambert => FRAC_1_PI,
            _ if cosine <= 0.0 => 0.0,
            Self::BlinnPhong { exponent } => (exponent + 8.0) / (8.0 * PI) * cosine.powf(exponent),
            Self::Ggx { alpha } => {
                let squared = alpha * alpha;
                let sine = (1.0 - cosine * cosine).max(0.0);
                let denominator = squared * cosine * cosine + sine;
                squared / (4.0 * PI * denominator * denominator)
            }
        }
    }
}

/// A light and a view as a surface sees them, unit vectors in tangent space that point away from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Directions {
    /// Towards the light.
    pub light: DVec3,
    /// Between light and view. Zero where these are opposite: there is no half vector, and no reflection but Lambert's.
    pub half: DVec3,
}

impl Directions {
    /// Of a light and a view of any length.
    ///
    /// # Errors
    /// [`NormalsError::Range`] for a vector without direction.
    pub fn new(light: DVec3, view: DVec3) -> Result<Self, NormalsError> {
        let unit = |what, vector: DVec3| {
            let range = "a finite vector longer than 0";
            vector.try_normalize().ok_or(NormalsError::Range { what, value: vector.length(), range })
        };
        let (light, view) =
            (unit("the length of the light's direction", light)?, unit("the length of the view's", view)?);
        Ok(Self { light, half: (light + view).try_normalize().unwrap_or(DVec3::ZERO) })
    }
}
