//! The stretches of a ray that lie inside the cone of a spot light.

use airglow_math::MathError;
use glam::DVec3;

use super::airlight::{Sight, integrate};
use crate::Phase;

/// Stretches, in metres from the eye, of the ray from the origin along the unit `direction` that lie within
/// `half_angle` radians (0 to π) of the unit `axis` of a cone whose apex is at `light`; at most two, the last of which
/// may be endless.
///
/// The ends are roots of `((x ω - p) · a)² = cos² |x ω - p|²`, of which both nappes have a part; what lies between them is
/// asked at a point inside.
#[must_use]
pub fn stretches(light: DVec3, axis: DVec3, half_angle: f64, direction: DVec3) -> Vec<(f64, f64)> {
    let cosine = half_angle.cos();
    let square = cosine * cosine;
    let (a, p) = (direction.dot(axis), light.dot(axis));
    let quadratic = a * a - square;
    let half = square * light.dot(direction) - p * a;
    let constant = p * p - square * light.length_squared();
    let mut ends: Vec<f64> = roots(quadratic, half, constant).into_iter().filter(|x| *x > 0.0).collect();
    ends.push(0.0);
    ends.push(f64::INFINITY);
    ends.sort_by(f64::total_cmp);
    let inside = |x: f64| {
        let from_light = direction * x - light;
        from_light.dot(axis) >= cosine * from_light.length()
    };
    let mut stretches: Vec<(f64, f64)> = Vec::new();
    for pair in ends.windows(2) {
        let middle = if pair[1].is_finite() { 0.5 * (pair[0] + pair[1]) } else { 2.0 * pair[0] + 1e6 };
        if pair[0] == pair[1] || !inside(middle) {
            continue;
        }
        match stretches.last_mut() {
            Some(last) if last.1 == pair[0] => last.1 = pair[1],
            _ => stretches.push((pair[0], pair[1])),
        }
    }
    stretches
}

/// Real roots of `a x² + 2 b x + c`.
fn roots(a: f64, b: f64, c: f64) -> Vec<f64> {
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return Vec::new();
    }
    let sum = -(b + discriminant.sqrt().copysign(b));
    [sum / a, c / sum].into_iter().filter(|root| root.is_finite()).collect()
}

/// [`airlight`](super::airlight::airlight) of a spot light whose intensity is `falloff` of the cosine from its axis
/// inside the cone, and 0 outside; `far` may be infinite.
///
/// # Errors
/// As there.
pub fn airlight(
    extinction: f64,
    [light, axis, direction]: [DVec3; 3],
    half_angle: f64,
    falloff: impl Fn(f64) -> f64,
    far: f64,
    phase: Phase,
) -> Result<f64, MathError> {
    let along = light.dot(direction);
    let sight = Sight { along, offset: light.cross(direction).length() };
    let spent = along.abs() + light.length() + 60.0 / extinction;
    let mut total = 0.0;
    for (near, end) in stretches(light, axis, half_angle, direction) {
        let end = end.min(far).min(spent);
        if near >= end {
            continue;
        }
        total += integrate(sight, near, end, &[extinction.recip()], |place| {
            let towards = (direction * place.from_eye - light) / place.from_light;
            let dimmed = (-extinction * (place.from_eye + place.from_light)).exp();
            dimmed * phase.value(place.cosine) * falloff(towards.dot(axis))
        })?;
    }
    Ok(total)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::{airlight as whole, testing::assert_relative};
    use super::*;

    #[test]
    fn a_lamp_overhead_lights_the_stretch_below_it() {
        // 2 m up, 10 m ahead, 45 degrees: 8 to 12 m.
        let found = stretches(DVec3::new(0.0, 2.0, -10.0), DVec3::NEG_Y, PI / 4.0, DVec3::NEG_Z);
        assert_eq!(found.len(), 1);
        assert!((found[0].0 - 8.0).abs() < 1e-12 && (found[0].1 - 12.0).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn every_position_of_eye_and_cone_is_told_apart() {
        let light = DVec3::new(0.0, 0.0, -5.0);
        // Looking into a cone that points at the eye: lit up to the light, and not beyond it.
        let facing = stretches(light, DVec3::Z, 0.3, DVec3::NEG_Z);
        assert_eq!(facing.len(), 1);
        assert!(facing[0].0 == 0.0 && (facing[0].1 - 5.0).abs() < 1e-6, "{facing:?}");
        // From behind: lit from the light on, without end.
        let behind = stretches(light, DVec3::NEG_Z, 0.3, DVec3::NEG_Z);
        assert_eq!(behind.len(), 1);
        assert!((behind[0].0 - 5.0).abs() < 1e-6 && behind[0].1.is_infinite(), "{behind:?}");
        // Past it.
        assert!(stretches(DVec3::new(3.0, 0.0, -5.0), DVec3::X, 0.3, DVec3::NEG_Z).is_empty());
        // Wider than a half space: all but the stretch of the dark cone, and so two.
        let wide = stretches(DVec3::new(0.0, 2.0, -10.0), DVec3::Y, 0.75 * PI, DVec3::NEG_Z);
        assert_eq!(wide.len(), 2, "{wide:?}");
        assert!((wide[0].1 - 8.0).abs() < 1e-12 && (wide[1].0 - 12.0).abs() < 1e-12, "{wide:?}");
    }

    #[test]
    fn a_cone_and_its_complement_make_the_point_light() {
        let (light, axis) = (DVec3::new(1.0, 0.5, -3.0), DVec3::new(-0.96, 0.28, 0.0));
        let direction = DVec3::new(0.1, 0.2, -1.0).normalize();
        let cone = |axis, angle| {
            airlight(0.4, [light, axis, direction], angle, |_| 1.0, 8.0, Phase::Isotropic).unwrap()
        };
        let along = light.dot(direction);
        let sight = Sight { along, offset: light.cross(direction).length() };
        let expected = whole::airlight(0.4, sight, 0.0, 8.0, Phase::Isotropic).unwrap();
        let lit = cone(axis, 0.7);
        assert!(lit > 0.0 && lit < expected, "{lit} of {expected}");
        assert_relative("the sum", lit + cone(-axis, PI - 0.7), expected, 1e-11);
        assert_relative("the whole sphere", cone(axis, PI), expected, 1e-12);
    }
}
