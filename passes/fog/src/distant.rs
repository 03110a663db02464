//! The medium before distant light: by bands as it lights (Sun, thesis (2008), section 3.6.5), and what it does to a BRDF
//! (section 3.6.4). The fog takes an environment for a sphere of small lights that are all at one distance.

use airglow_math::MathError;

use crate::FogError;
use crate::error::check;
use crate::medium::Medium;
use crate::reference::spread;

/// The medium between a scene and its environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distant {
    /// Optical distance of the environment, red, green and blue, from 0 on.
    pub optical_distance: [f64; 3],
    /// Scattering albedo, 0 to 1.
    pub albedo: [f64; 3],
}

impl Distant {
    /// An environment `metres` away in a homogeneous medium.
    ///
    /// # Errors
    /// [`FogError::Range`]; [`FogError::Kernel`] for a medium that thins with height.
    pub fn new(medium: &Medium, metres: f64) -> Result<Self, FogError> {
        medium.check()?;
        check(|| "metres".to_owned(), metres, (0.0..=1e30).contains(&metres), "a distance from 0 on")?;
        if medium.thinning.is_some() {
            let (what, mend) = ("thins with height", "give a homogeneous one for distant light");
            return Err(FogError::Kernel { what, mend });
        }
        let optical_distance = medium.extinction.map(|extinction| extinction * metres);
        Ok(Self { optical_distance, albedo: medium.albedo })
    }

    /// What each band of an environment's spherical harmonics is multiplied with, for `order` bands: the attenuation plus
    /// the point spread function's own factor (eq. 3.35 to 3.37). A zonal filter for relighting, which then costs no more
    /// than in clear air.
    ///
    /// # Errors
    /// [`FogError::Range`], [`FogError::Math`] for an order out of range.
    pub fn band_factors(&self, order: usize) -> Result<Vec<[f64; 3]>, FogError> {
        self.check()?;
        let mut factors = vec![[0.0; 3]; order];
        for channel in 0..3 {
            let (optical, albedo) = (self.optical_distance[channel], self.albedo[channel]);
            let same = (0..channel).find(|&other| self.optical_distance[other] == optical);
            let spread = match same {
                Some(other) if self.albedo[other] == albedo => {
                    factors.iter_mut().for_each(|band| band[channel] = band[other]);
                    continue;
                }
                _ => spread_factors(order, optical)?,
            };
            for (band, spread) in factors.iter_mut().zip(spread) {
                band[channel] = (-optical).exp() + albedo * spread;
            }
        }
        Ok(factors)
    }

    /// The effective BRDF of a tabulated one (eq. 3.34): what answers the light of a lamp, straight, as `table` answers
    /// its glow. `table` holds, for each outgoing direction, the order² coefficients of the BRDF over incident directions
    /// of one channel; the result is in its layout.
    ///
    /// # Errors
    /// [`FogError::Range`], [`FogError::Math`] for an order out of range or a table that is no whole number of
    /// directions.
    pub fn effective_brdf(&self, channel: usize, order: usize, table: &[f64]) -> Result<Vec<f64>, FogError> {
        self.check()?;
        let number = channel as f64;
        check(|| "channel".to_owned(), number, channel < 3, "0, 1 or 2")?;
        let factors = spread_factors(order, self.optical_distance[channel])?;
        let mut effective = Vec::with_capacity(table.len());
        for coefficients in table.chunks(order * order) {
            effective.extend(spread::effective_brdf(&factors, coefficients)?);
        }
        effective.iter_mut().for_each(|value| *value *= self.albedo[channel]);
        Ok(effective)
    }

    /// Refuses what is out of range.
    ///
    /// # Errors
    /// [`FogError::Range`] with the field.
    pub fn check(&self) -> Result<(), FogError> {
        for value in self.optical_distance {
            check(
                || "optical_distance".to_owned(),
                value,
                (0.0..=1e36).contains(&value),
                "a number from 0 on",
            )?;
        }
        for value in self.albedo {
            check(|| "albedo".to_owned(), value, (0.0..=1.0).contains(&value), "a number from 0 to 1")?;
        }
        Ok(())
    }
}

/// Factors of the point spread function alone; none is left of either where the light has no path or never arrives.
fn spread_factors(order: usize, optical_distance: f64) -> Result<Vec<f64>, MathError> {
    if optical_distance == 0.0 || optical_distance > 700.0 {
        return spread::band_factors(order, |_| Ok(0.0));
    }
    spread::band_factors(order, |gamma| spread::exact(optical_distance, gamma))
}
