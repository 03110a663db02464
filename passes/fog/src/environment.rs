//! An environment behind a scene in a medium: what of its light the medium scatters towards the eye before a surface.
//!
//! The environment is far away compared with the surface. A point x along the ray gets its light after a path of
//! `R - x cos γ`, so that what is scattered towards the eye is
//! ```text
//! exp(-T) / 4 π  ∫ L(ω) (1 - exp(-t u)) / u dω,   u = 1 - cos γ,  t: optical distance of the surface,  T: of the environment
//! ```
//! a convolution, smooth enough for three bands of spherical harmonics. It is the part of eq. 3.30 (Sun, thesis (2008))
//! that lies before the surface.

use crate::distant::Distant;
use crate::error::check;
use crate::{FogError, Medium};

/// Bands of an environment's radiance.
pub const ENVIRONMENT_ORDER: usize = 3;

/// An environment behind a scene in an isotropic, homogeneous medium.
///
/// Where no surface is, the picture shows it as it is seen through the medium ([`Background`](crate::Background)): the
/// pass leaves it as it is and adds the airlight of the lamps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Environment {
    /// How far its light comes through the medium, in the host's units, from 0 on.
    pub distance: f64,
    /// Its radiance without the medium, W/sr/m2: coefficients of real spherical harmonics in right-handed axes with +Y up
    /// (the host's world as `World::direction` turns it).
    pub radiance: [[f64; 3]; ENVIRONMENT_ORDER * ENVIRONMENT_ORDER],
}

impl Environment {
    /// The medium before it, `metres` the distance in metres.
    ///
    /// # Errors
    /// [`FogError::Range`]; [`FogError::Kernel`] for a medium that thins with height.
    pub(crate) fn distant(&self, medium: &Medium, metres: f64) -> Result<Distant, FogError> {
        let sound = self.radiance.as_flattened().iter().all(|value| value.is_finite());
        check(|| "radiance".to_owned(), f64::from(u8::from(sound)), sound, "finite coefficients")?;
        Distant::new(medium, metres)
    }
}
