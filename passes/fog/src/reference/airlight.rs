//! The airlight integral by adaptive quadrature: Sun, thesis (2008), eq. 3.3 and 3.5, in lengths, with no formula of
//! the evaluators.

use airglow_math::MathError;
use airglow_math::quadrature::adaptive;

use crate::Phase;

/// Optical depth beyond which nothing is left in f64.
const SPENT: f64 = 60.0;

/// Tolerance of each panel.
const TOLERANCE: f64 = 1e-13;

/// Where a light lies as seen from a ray, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// Distance of the light's foot along the ray; negative behind the eye.
    pub along: f64,
    /// Distance of the light from the ray.
    pub offset: f64,
}

impl Sight {
    /// A point light at a distance from the eye and an angle gamma from the ray, radians.
    #[must_use]
    pub fn new(distance: f64, gamma: f64) -> Self {
        Self { along: distance * gamma.cos(), offset: distance * gamma.sin().max(0.0) }
    }

    /// The same for a lamp of that radius.
    ///
    /// The irradiance of a uniform disc of radius R that faces the point at distance d is I / (d² + R²), exactly; with
    /// the path taken to the disc's rim, attenuation too depends on √(d² + R²) alone, and the lamp is a point light
    /// moved off the ray by R. It is finite everywhere, the point light's where d is much above R, and errs by at most
    /// the extinction over R in the path.
    #[must_use]
    pub fn with_radius(self, radius: f64) -> Self {
        Self { offset: self.offset.hypot(radius), ..self }
    }

    /// Distance of the light from the point at `x` metres along the ray.
    #[must_use]
    pub fn distance(&self, x: f64) -> f64 {
        self.offset.hypot(x - self.along)
    }
}

/// A point of a ray at which light is scattered.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Its distance from the eye, in metres.
    pub from_eye: f64,
    /// Its distance from the light, in metres.
    pub from_light: f64,
    /// Cosine of the scattering angle, 1 forward.
    pub cosine: f64,
    /// Squared cosine and sine of half of it.
    pub halves: [f64; 2],
}

/// `∫ exp(-β (x + d)) phase / d² dx` for x from `near` to `far` metres (which may be infinite), d the distance of the
/// light: times scattering coefficient and intensity, radiance. 1/(m sr).
///
/// # Errors
/// [`MathError::Range`] where the ray meets a point light, so that the integral diverges, and for negative or
/// non-finite input.
pub fn airlight(extinction: f64, sight: Sight, near: f64, far: f64, phase: Phase) -> Result<f64, MathError> {
    let ahead = near - sight.along;
    // Beyond this distance from the foot the path is longer than the shortest by SPENT / β.
    let spent = sight.along + 0.5 * (SPENT / extinction + ahead + sight.distance(near)).max(0.0);
    integrate(sight, near, far.min(spent), &[extinction.recip()], |place| {
        (-extinction * (place.from_eye + place.from_light)).exp() * phase.at(place.halves)
    })
}

/// `∫ f / d² dx` for x from `near` to `far` metres (which may be infinite).
///
/// `scales` are lengths over which f falls or turns: there the interval is split beforehand, as it is at distances from
/// the light's foot, so that no feature of any size is missed.
///
/// # Errors
/// As [`airlight`].
pub fn integrate(
    sight: Sight,
    near: f64,
    far: f64,
    scales: &[f64],
    mut f: impl FnMut(Place) -> f64,
) -> Result<f64, MathError> {
    let check = |what, value: f64, sound, range| {
        if sound { Ok(()) } else { Err(MathError::Range { what, value, range }) }
    };
    check("the near end of a ray", near, (0.0..=1e300).contains(&near), "a finite length")?;
    check("the far end of a ray", far, far >= near, "a length from the near end on")?;
    let sound = sight.offset >= 0.0 && sight.offset.is_finite() && sight.along.is_finite();
    check("the light's offset from the ray", sight.offset, sound, "finite lengths")?;
    let met = sight.offset == 0.0 && (near..=far).contains(&sight.along);
    check("the light's offset from the ray", 0.0, !met, "more than 0 where the ray meets the light")?;

    // Measured from the foot, so that places beside a near light keep their precision.
    let (start, end) = (near - sight.along, far - sight.along);
    let size = sight.offset.max(start.abs());
    let end = end.min(1e16 * size);
    let mut total = 0.0;
    let breaks = breaks(start, end, sight.offset, scales);
    for pair in breaks.windows(2) {
        let integrand = |ahead: f64| {
            let from_light = sight.offset.hypot(ahead);
            // d + |ahead| and d - |ahead|, of which the product is offset².
            let sum = from_light + ahead.abs();
            let less = sight.offset / sum * sight.offset;
            let [forward, back] = if ahead < 0.0 { [sum, less] } else { [less, sum] };
            let halves = [0.5 * forward / from_light, 0.5 * back / from_light];
            let cosine = -ahead / from_light;
            let place = Place { from_eye: ahead + sight.along, from_light, cosine, halves };
            f(place) / from_light / from_light
        };
        total += adaptive(integrand, pair[0], pair[1], TOLERANCE)?.value;
    }
    Ok(total)
}

/// Ends of panels over which the integrand is smooth: geometric about the foot, and from the near end on the scales.
fn breaks(start: f64, end: f64, offset: f64, scales: &[f64]) -> Vec<f64> {
    const FACTOR: f64 = 4.0;
    let mut breaks = vec![start, end];
    let mut add = |at: f64| {
        if start < at && at < end {
            breaks.push(at);
        }
    };
    add(0.0);
    // On a ray through the light itself the distance to it is the only size.
    let largest = start.abs().max(end.abs());
    let smallest = if offset > 0.0 { 0.25 * offset } else { 0.25 * start.abs().min(end.abs()) };
    let mut distance = smallest.max(1e-40);
    while distance < largest {
        add(distance);
        add(-distance);
        distance *= FACTOR;
    }
    for scale in scales.iter().filter(|scale| scale.is_finite() && **scale > 0.0) {
        let mut distance = 0.01 * scale;
        while start + distance < end && distance < 1e4 * scale {
            add(start + distance);
            distance *= FACTOR;
        }
    }
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    breaks
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI, TAU};

    use super::super::testing::assert_relative;
    use super::*;

    #[test]
    fn without_extinction_it_is_the_angle_under_which_the_stretch_is_seen() {
        for (distance, gamma, far) in [(1.0, 0.3, 2.0), (5.0, 3.0, 0.1), (0.2, 1.5, 1e4), (1.0, 1e-7, 3.0)] {
            let sight = Sight::new(distance, gamma);
            let angle = f64::atan2(far - sight.along, sight.offset) + f64::atan2(sight.along, sight.offset);
            let actual = airlight(0.0, sight, 0.0, far, Phase::Isotropic).unwrap();
            let expected = angle / sight.offset / (4.0 * PI);
            assert_relative(&format!("{distance}, {gamma}, {far}"), actual, expected, 1e-11);
        }
    }

    #[test]
    fn towards_the_light_and_away_from_it_there_are_closed_forms() {
        // Towards it every path is as long as the direct one: exp(-β D) ∫ dx / (D - x)².
        let actual = airlight(2.0, Sight::new(3.0, 0.0), 0.0, 2.5, Phase::Isotropic).unwrap();
        let expected = (-6.0_f64).exp() * (1.0 / 0.5 - 1.0 / 3.0) / (4.0 * PI);
        assert_relative("gamma 0", actual, expected, 1e-12);
        // Away from it ∫ exp(-β (D + 2 x)) / (D + x)² dx, by parts an exponential integral.
        let (beta, distance) = (0.7, 1.5);
        let actual = airlight(beta, Sight::new(distance, PI), 0.0, f64::INFINITY, Phase::Isotropic).unwrap();
        let integral = airglow_math::special::exponential_integral(2.0 * beta * distance).unwrap();
        let direct = (-beta * distance).exp() / distance;
        let expected = (direct - 2.0 * beta * (beta * distance).exp() * integral) / (4.0 * PI);
        assert_relative("gamma pi", actual, expected, 1e-12);
    }

    #[test]
    fn phases_weigh_the_place_by_its_angle() {
        // Without extinction and with ahead = h tan η: ∫ cos^k dη / h with cos = -sin η, over a whole line.
        let sight = Sight { along: 1e9, offset: 1.0 };
        let expected = [PI, 0.0, FRAC_PI_2, 0.0];
        for (power, expected) in expected.into_iter().enumerate() {
            let mut weights = [0.0; 4];
            weights[power] = 1.0;
            let actual = airlight(0.0, sight, 0.0, 2e9, Phase::Polynomial(weights)).unwrap();
            assert!((actual - expected).abs() < 1e-8, "power {power}: {actual} is not {expected}");
        }
    }

    /// Irradiance of the uniform disc by quadrature over its rings, against the model of the lamp.
    #[test]
    fn a_lamp_is_a_disc_that_faces_the_point() {
        for (radius, distance) in [(0.1_f64, 0.05_f64), (0.1, 1.0), (2.0, 0.3)] {
            let radiance = 1.0 / (PI * radius * radius);
            let ring = |r: f64| {
                let square = distance * distance + r * r;
                // cos at the receiver times cos at the disc over the squared distance.
                TAU * r * radiance * distance * distance / (square * square)
            };
            let irradiance = adaptive(ring, 0.0, radius, 1e-13).unwrap().value;
            let model = Sight { along: 0.0, offset: distance }.with_radius(radius).distance(0.0).powi(-2);
            assert_relative(&format!("{radius} at {distance}"), model, irradiance, 1e-12);
        }
    }

    #[test]
    fn refuses_where_it_diverges() {
        let through = airlight(1.0, Sight::new(1.0, 0.0), 0.0, 2.0, Phase::Isotropic);
        assert!(matches!(through, Err(MathError::Range { .. })), "{through:?}");
        let lamp = Sight::new(1.0, 0.0).with_radius(0.01);
        assert!(airlight(1.0, lamp, 0.0, 2.0, Phase::Isotropic).unwrap() > 0.0);
        assert!(airlight(1.0, Sight::new(f64::NAN, 0.0), 0.0, 2.0, Phase::Isotropic).is_err());
    }
}
