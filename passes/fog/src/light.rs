//! The lights inside a medium.

use glam::DVec3;

use crate::FogError;
use crate::error::check;

/// The cone of a spot light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Axis, away from the light, in the host's axes; any length but zero.
    pub direction: DVec3,
    /// Half angle of full intensity, radians, from 0 on.
    pub inner: f64,
    /// Half angle from which on nothing arrives, radians, above `inner` and at most pi / 2.
    pub outer: f64,
}

/// A box along the host's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Its lowest coordinates, in the host's units.
    pub low: DVec3,
    /// Its highest.
    pub high: DVec3,
}

/// A point light, spot light or small sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// In the host's axes and units.
    pub position: DVec3,
    /// Radiant intensity, W/sr, from 0 on.
    pub intensity: [f64; 3],
    /// Factor on what the medium scatters of it, for artists; the world's is 1.
    pub scatter: f64,
    /// Radius in the host's units, from 0 on: a disc that faces each point of a view ray takes the place of the point
    /// whose airlight grows without end towards it.
    pub radius: f64,
    /// The cone of a spot light.
    pub cone: Option<Cone>,
    /// Distance in the host's units from which on nothing arrives, as glTF has it.
    pub range: Option<f64>,
    /// Where it shines: the medium outside is dark, so that it does not glow through walls.
    pub bounds: Option<Bounds>,
}

impl Light {
    /// A point light of that radiant intensity, W/sr.
    #[must_use]
    pub fn point(position: DVec3, intensity: [f64; 3]) -> Self {
        Self { position, intensity, scatter: 1.0, radius: 0.0, cone: None, range: None, bounds: None }
    }

    /// Refuses what is out of range; `index` is its place among the lights.
    pub(crate) fn check(&self, index: usize) -> Result<(), FogError> {
        let number = |name: &'static str, value: f64, allowed, range| {
            check(|| format!("lights[{index}].{name}"), value, allowed, range)
        };
        let positive = |value: f64| (0.0..=1e30).contains(&value);
        let vector = |name, vector: DVec3| {
            let worst = vector.to_array().into_iter().find(|x| !x.is_finite()).unwrap_or(0.0);
            number(name, worst, worst.is_finite(), "finite coordinates")
        };
        vector("position", self.position)?;
        for value in self.intensity {
            number("intensity", value, positive(value), "0 to 1e30 W/sr")?;
        }
        number("scatter", self.scatter, positive(self.scatter), "a factor from 0 on")?;
        number("radius", self.radius, positive(self.radius), "a length from 0 on")?;
        if let Some(Cone { direction, inner, outer }) = self.cone {
            vector("cone.direction", direction)?;
            let length = direction.length();
            number("cone.direction", length, length > 0.0, "a direction")?;
            let sound = outer > 0.0 && outer <= std::f64::consts::FRAC_PI_2;
            number("cone.outer", outer, sound, "a half angle above 0 and at most pi / 2")?;
            number(
                "cone.inner",
                inner,
                (0.0..outer).contains(&inner),
                "a half angle from 0 to below the outer one",
            )?;
        }
        if let Some(range) = self.range {
            number("range", range, range > 0.0 && range <= 1e30, "a length above 0, or none")?;
        }
        let Some(Bounds { low, high }) = self.bounds else { return Ok(()) };
        vector("bounds.low", low)?;
        vector("bounds.high", high)?;
        let least = (high - low).min_element();
        number("bounds.high", least, least >= 0.0, "coordinates not below those of bounds.low")
    }
}
