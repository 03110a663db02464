//! How far off a light's direction its airlight can be seen: a bound, not an estimate.

use std::f64::consts::PI;

/// How far a light reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reach {
    /// Below the bound everywhere.
    Nowhere,
    /// Below the bound at larger angles, radians, from the direction to the light.
    Within(f64),
    /// Below the bound at larger distances from the light, metres, where rays are parallel.
    Near(f64),
    /// Not bounded.
    Everywhere,
}

/// `most` bounds scattering times phase times radiant intensity times exp(-extinction distance), W/sr/m3 m2; `distance`
/// is that of the light, `radius` its own, in metres.
///
/// No path over a point of the ray is shorter than the distance of the light. So the airlight at an angle g off it is at
/// most `most` times the integral of 1 / d^2 over the whole ray, (pi - g) / (distance sin g), and with a radius at most
/// pi / radius; both fall with g.
pub(crate) fn reach(most: f64, distance: f64, radius: f64, bound: f64) -> Reach {
    if most <= 0.0 || (radius > 0.0 && most * PI / radius < bound) {
        return Reach::Nowhere;
    }
    let allowed = bound * distance / most;
    if allowed <= 1.0 || distance == 0.0 {
        return Reach::Everywhere;
    }
    let (mut inside, mut outside) = (0.0, PI);
    for _ in 0..50 {
        let angle: f64 = 0.5 * (inside + outside);
        if (PI - angle) / angle.sin() > allowed { inside = angle } else { outside = angle }
    }
    Reach::Within(outside)
}

/// The same for parallel rays, whose eyes may be anywhere: at a distance h off the light the airlight is at most `most`
/// times pi / h, `most` holding what is left after the least distance of the light from the plane of the eyes.
pub(crate) fn reach_of_parallel(most: f64, radius: f64, bound: f64) -> Reach {
    if most <= 0.0 || (radius > 0.0 && most * PI / radius < bound) {
        return Reach::Nowhere;
    }
    if bound > 0.0 { Reach::Near(most * PI / bound) } else { Reach::Everywhere }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bound_holds_beyond_the_reach_and_is_met_at_it() {
        let airlight = |most: f64, distance: f64, angle: f64| most * (PI - angle) / (distance * angle.sin());
        for (most, distance, bound) in [(1.0, 10.0, 0.2), (1e-3, 5.0, 1e-3), (50.0, 1e3, 1.0)] {
            let Reach::Within(angle) = reach(most, distance, 0.0, bound) else { panic!("{most} {distance}") };
            let at = airlight(most, distance, angle);
            assert!((at / bound - 1.0).abs() < 1e-6, "{at} instead of {bound} at {angle}");
            assert!(airlight(most, distance, angle + 0.1) < bound);
        }
        assert_eq!(reach(1.0, 10.0, 0.0, 0.0999), Reach::Everywhere, "1 / distance is left behind the eye");
        assert_eq!(reach(0.0, 10.0, 0.0, 0.1), Reach::Nowhere);
        assert_eq!(reach(1.0, 10.0, 100.0, 0.1), Reach::Nowhere);
        assert_eq!(reach(1.0, 0.0, 0.0, 0.1), Reach::Everywhere);
    }

    #[test]
    fn parallel_rays_see_a_light_as_far_off_as_the_bound_says() {
        let Reach::Near(radius) = reach_of_parallel(2.0, 0.0, 0.1) else { panic!("a bound") };
        assert!((2.0 * PI / radius / 0.1 - 1.0).abs() < 1e-12, "{radius}");
        assert_eq!(reach_of_parallel(2.0, 0.0, 0.0), Reach::Everywhere);
        assert_eq!(reach_of_parallel(0.0, 0.0, 0.1), Reach::Nowhere);
        assert_eq!(reach_of_parallel(2.0, 100.0, 0.1), Reach::Nowhere);
    }
}
