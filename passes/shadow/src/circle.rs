//! What a sphere leaves to be seen: the visibility of a circle of directions, in zonal coefficients about its axis.
//!
//! Sun 2008, eq. 5.36. With P_l the Legendre polynomials, `∫ P_l` over `[cos theta, 1]` is
//! `(P_{l-1}(cos theta) - P_{l+1}(cos theta)) / (2l + 1)`.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

use crate::ShadowError;
use crate::order::check_order;

/// A blocker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its centre, in the units of the receivers.
    pub center: DVec3,
    /// Its radius, 0 or more; a sphere of radius 0 blocks nothing.
    pub radius: f64,
}

/// Where a sphere stands in the sky of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cap {
    /// Unit vector towards the centre; +Z at the centre itself.
    pub axis: DVec3,
    /// `1 - cos` of the angular radius, 0 to 1: the solid angle over `2 pi`. 1, half of the sky, for a point inside.
    pub height: f64,
}

impl Sphere {
    /// What `point` sees of it. A point inside or on the sphere sees the half space towards its centre blocked.
    #[must_use]
    pub fn cap(&self, point: DVec3) -> Cap {
        let towards = self.center - point;
        let axis = towards.try_normalize().unwrap_or(DVec3::Z);
        let sine = self.radius / towards.length();
        if self.radius <= 0.0 {
            return Cap { axis, height: 0.0 };
        }
        if sine.is_nan() || sine >= 1.0 {
            return Cap { axis, height: 1.0 };
        }
        // 1 - cos without cancellation.
        Cap { axis, height: sine * sine / (1.0 + ((1.0 - sine) * (1.0 + sine)).sqrt()) }
    }
}

impl Cap {
    /// Whether it hides a direction.
    #[must_use]
    pub fn hides(&self, direction: DVec3) -> bool {
        self.height > 0.0 && direction.dot(self.axis) >= 1.0 - self.height
    }
}

/// The height of the cap of an angular radius in radians, 0 to pi / 2.
///
/// # Errors
/// [`ShadowError::Range`].
pub fn height(angular_radius: f64) -> Result<f64, ShadowError> {
    if (0.0..=FRAC_PI_2).contains(&angular_radius) {
        let half = (0.5 * angular_radius).sin();
        return Ok((2.0 * half * half).min(1.0));
    }
    Err(ShadowError::Range { what: "an angular radius", value: angular_radius, range: "0 to pi / 2" })
}

/// Zonal coefficients about the axis, one per band, of the visibility that is 0 within a cap and 1 outside.
///
/// # Errors
/// [`ShadowError::Order`]; [`ShadowError::Range`] unless `height` is 0 to 2.
pub fn visibility(order: usize, height: f64) -> Result<Vec<f64>, ShadowError> {
    check_order(order)?;
    if !(0.0..=2.0).contains(&height) {
        return Err(ShadowError::Range { what: "the height of a cap", value: height, range: "0 to 2" });
    }
    let cosine = 1.0 - height;
    let mut legendre = vec![1.0, cosine];
    for l in 1..=order {
        let k = l as f64;
        let next = ((2.0 * k + 1.0) * cosine * legendre[l] - k * legendre[l - 1]) / (k + 1.0);
        legendre.push(next);
    }
    let band = |l: usize| {
        let width = (2 * l + 1) as f64;
        let norm = (width / (4.0 * PI)).sqrt();
        let blocked = match l {
            0 => height,
            _ => (legendre[l - 1] - legendre[l + 1]) / width,
        };
        let all = if l == 0 { 2.0 } else { 0.0 };
        TAU * norm * (all - blocked)
    };
    Ok((0..order).map(band).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use airglow_math::quadrature::adaptive;
    use airglow_math::sh::{evaluate, index};

    #[test]
    fn coefficients_agree_with_quadrature() {
        for angle in [0.0, 0.01, 0.4, 1.1, FRAC_PI_2] {
            let height = height(angle).unwrap();
            let found = visibility(6, height).unwrap();
            for (l, found) in found.iter().enumerate() {
                let mut basis = [0.0; 36];
                let mut integrand = |z: f64| {
                    let direction = DVec3::new(((1.0 - z) * (1.0 + z)).sqrt(), 0.0, z);
                    evaluate(6, direction, &mut basis).unwrap();
                    TAU * basis[index(l, 0)]
                };
                let truth = adaptive(&mut integrand, -1.0, angle.cos(), 1e-13).unwrap().value;
                assert!((found - truth).abs() < 1e-12, "{angle}, band {l}: {found} and {truth}");
            }
        }
    }

    #[test]
    fn a_small_cap_takes_its_solid_angle() {
        let height = height(1e-6).unwrap();
        assert!((height / 0.5e-12 - 1.0).abs() < 1e-9, "{height}");
        let open = (4.0 * PI).sqrt();
        let blocked = open - visibility(4, 1e-9).unwrap()[0];
        assert!((blocked - TAU * 1e-9 / open).abs() < 1e-14, "{blocked}");
    }

    #[test]
    fn points_near_and_inside_a_sphere_see_half_of_the_sky_blocked() {
        let sphere = Sphere { center: DVec3::X, radius: 0.5 };
        for (point, height) in
            [(DVec3::X, 1.0), (DVec3::new(0.6, 0.0, 0.0), 1.0), (DVec3::new(0.5, 0.0, 0.0), 1.0)]
        {
            assert_eq!(sphere.cap(point).height, height, "{point}");
        }
        let hair = sphere.cap(DVec3::new(0.5 - 1e-12, 0.0, 0.0));
        assert!(hair.height < 1.0 && hair.height > 0.99999, "{hair:?}");
        assert_eq!(hair.axis, DVec3::X);
        let far = sphere.cap(DVec3::new(-1e6, 0.0, 0.0));
        assert!((far.height / (0.5 * 0.25e-12) - 1.0).abs() < 1e-5, "{far:?}");
        let nothing = Sphere { center: DVec3::X, radius: 0.0 };
        assert_eq!([nothing.cap(DVec3::X).height, nothing.cap(DVec3::ZERO).height], [0.0; 2]);
        assert!(!nothing.cap(DVec3::ZERO).hides(DVec3::X));
        let huge = Sphere { center: DVec3::X * 1.1e6, radius: 1e6 };
        assert!((huge.cap(DVec3::ZERO).height - (1.0 - (1.0 - 1.0 / 1.21_f64).sqrt())).abs() < 1e-12);
    }

    #[test]
    fn what_is_out_of_range_is_refused() {
        assert!(height(-0.1).is_err() && height(1.6).is_err() && height(f64::NAN).is_err());
        assert!(visibility(2, 0.1).unwrap_err().to_string().contains("give 3 to 6"));
        assert!(visibility(7, 0.1).is_err() && visibility(4, f64::NAN).is_err());
    }
}
