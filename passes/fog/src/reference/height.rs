//! Airlight where the medium thins exponentially with height.

use airglow_math::MathError;

use super::airlight::{Sight, integrate};
use crate::Phase;

/// A medium that thins with height, and a ray and a light in it; heights are metres above the eye.
#[derive(Clone, Copy, Debug)]
pub struct Thinning {
    /// Extinction coefficient at the eye's height, 1/m.
    pub extinction: f64,
    /// Metres up in which the medium thins by a factor of e.
    pub scale_height: f64,
    /// Metres that the ray rises per metre: the up component of its direction.
    pub slope: f64,
    /// Height of the light.
    pub light_height: f64,
}

impl Thinning {
    /// Density at a height, of that at the eye.
    #[must_use]
    pub fn density(&self, height: f64) -> f64 {
        (-height / self.scale_height).exp()
    }

    /// Optical depth of a straight path of `length` metres between two heights, reckoned up from the lower.
    #[must_use]
    pub fn depth(&self, length: f64, from: f64, to: f64) -> f64 {
        let (from, rise) = (from.min(to), (to - from).abs() / self.scale_height);
        let mean = if rise == 0.0 { 1.0 } else { -(-rise).exp_m1() / rise };
        self.extinction * length * self.density(from) * mean
    }
}

/// `∫ density exp(-depth) phase / d² dx` for x from 0 to `far` metres (which may be infinite): times the scattering
/// coefficient at the eye's height and intensity, radiance.
///
/// # Errors
/// As [`super::airlight::airlight`].
pub fn airlight(medium: Thinning, sight: Sight, far: f64, phase: Phase) -> Result<f64, MathError> {
    let scales = [medium.extinction.recip(), (medium.scale_height / medium.slope).abs()];
    // Where the density would overflow, nothing has come through.
    let deepest = 500.0 * medium.scale_height / (-medium.slope).max(1e-300);
    integrate(sight, 0.0, far.min(deepest), &scales, |place| {
        let height = medium.slope * place.from_eye;
        let depth = medium.depth(place.from_eye, 0.0, height)
            + medium.depth(place.from_light, medium.light_height, height);
        medium.density(height) * (-depth).exp() * phase.value(place.cosine)
    })
}

#[cfg(test)]
mod tests {
    use airglow_math::quadrature::adaptive;

    use super::super::{airlight as homogeneous, testing::assert_relative};
    use super::*;

    #[test]
    fn the_depth_is_the_integral_of_the_density() {
        let medium = Thinning { extinction: 0.3, scale_height: 7.0, slope: 0.2, light_height: 4.0 };
        for (from, to) in [(0.0, 3.0), (12.0, -5.0), (2.0, 2.0), (2.0, 2.0 + 1e-9)] {
            let density = |t: f64| medium.extinction * medium.density(from + t * (to - from));
            let expected = 11.0 * adaptive(density, 0.0, 1.0, 1e-13).unwrap().value;
            assert_relative(&format!("{from} to {to}"), medium.depth(11.0, from, to), expected, 1e-12);
        }
    }

    #[test]
    fn a_medium_that_hardly_thins_is_homogeneous() {
        let medium = Thinning { extinction: 0.3, scale_height: 1e12, slope: 0.2, light_height: 1.0 };
        let sight = Sight { along: 4.0, offset: 1.5 };
        for far in [3.0, 40.0, f64::INFINITY] {
            let actual = airlight(medium, sight, far, Phase::Isotropic).unwrap();
            let expected = homogeneous::airlight(0.3, sight, 0.0, far, Phase::Isotropic).unwrap();
            assert_relative(&format!("to {far}"), actual, expected, 1e-10);
        }
    }

    /// The light at the eye's own ray, straight down: the depth is the path's, and the integral elementary.
    #[test]
    fn straight_down_with_no_distance_falloff_it_saturates() {
        let medium = Thinning { extinction: 0.5, scale_height: 3.0, slope: -1.0, light_height: 50.0 };
        // Far away above, d hardly changes: ∫ β ρ exp(-2 depth) dx -> (exp(-2·0)-exp(-2·∞))/2, times 1/d².
        let sight = Sight { along: -1e6, offset: 1.0 };
        let high = Thinning { light_height: 1e6, ..medium };
        let actual =
            0.5 * airlight(high, sight, f64::INFINITY, Phase::Polynomial([1.0, 0.0, 0.0, 0.0])).unwrap();
        let above = high.depth(1e6, 0.0, 1e6);
        let expected = 0.5 * (-above).exp() / 1e12;
        assert_relative("airlight", actual, expected, 1e-4);
    }
}
