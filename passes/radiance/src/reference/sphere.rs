//! Unoccluded spheres of uniform radiance projected on spherical harmonics in closed form.
//!
//! A sphere fills a cap of half-angle a, sin a = radius / distance. By Funk and Hecke its band factors are
//! `2 pi Integral P_l(t) dt` over t from cos a to 1, and Legendre's equation makes that
//! `2 pi sin2(a) P_l'(cos a) / (l (l + 1))`, which loses nothing for small spheres.

use std::f64::consts::PI;

use airglow_math::sh::check_order;
use airglow_math::sh::zonal::rotate_to_direction;
use glam::DVec3;

use crate::{Incident, RadianceError, Sphere};

/// Radiance that arrives at `point` from an unoccluded sphere; from inside, it comes from everywhere. The distance of
/// the sphere's nearness is that of its near surface in each direction; inside it is taken as the radius.
///
/// # Errors
/// The order, unless it is 1 to [`airglow_math::sh::MAX_ORDER`].
pub fn sphere(order: usize, point: DVec3, sphere: &Sphere) -> Result<Incident, RadianceError> {
    check_order(order)?;
    let mut incident = Incident::dark(order)?;
    let axis = sphere.centre - point;
    let distance = axis.length();
    let inside = distance <= sphere.radius;
    if sphere.radius == 0.0 {
        return Ok(incident);
    }
    let sine = if inside { 0.0 } else { sphere.radius / distance };
    let cosine = if inside { -1.0 } else { ((1.0 - sine) * (1.0 + sine)).sqrt() };
    let factors = cap_factors(order, sine * sine, cosine);
    let mut turned = vec![0.0; incident.coefficients.len()];
    rotate_to_direction(&factors, axis.normalize_or(DVec3::Z), &mut turned)?;
    incident.coefficients.iter_mut().zip(&turned).for_each(|(l, y)| *l = *y * sphere.radiance);
    incident.solid_angle = factors[0];
    incident.nearness = if inside { factors[0] / sphere.radius } else { nearness(distance, sphere.radius) };
    incident.slope = incident.nearness * sphere.radiance;
    Ok(incident)
}

/// Band factors of a cap, from the squared sine and the cosine of its half-angle.
fn cap_factors(order: usize, sine_squared: f64, cosine: f64) -> Vec<f64> {
    let whole = if cosine < 0.0 { 4.0 * PI } else { 2.0 * PI * sine_squared / (1.0 + cosine) };
    let mut factors = vec![whole];
    // P_l and P_l' upwards: P_l' = t P_(l-1)' + l P_(l-1).
    let (mut below, mut value, mut slope) = (0.0, 1.0, 0.0);
    for l in 1..order {
        let l_ = l as f64;
        slope = cosine * slope + l_ * value;
        (below, value) = (value, ((2.0 * l_ - 1.0) * cosine * value - (l_ - 1.0) * below) / l_);
        factors.push(2.0 * PI * sine_squared * slope / (l_ * (l_ + 1.0)));
    }
    factors
}

/// Integral of 1 / d(s) over the cap, d to the near surface: with D the distance of the centre, R the radius and
/// k2 = D2 - R2, 1/d = (D t + sqrt(D2 t2 - k2)) / k2, which is elementary.
fn nearness(distance: f64, radius: f64) -> f64 {
    let square = (distance - radius) * (distance + radius);
    let tangent = square.sqrt();
    let logarithm = ((distance + radius) / tangent).ln();
    PI / (distance * square) * (radius * radius + distance * radius - square * logarithm)
}
