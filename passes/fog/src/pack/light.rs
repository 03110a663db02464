//! A light of the host's as the shader takes it, and where its airlight may be seen.

use std::f64::consts::FRAC_PI_4;

use glam::DVec3;

use super::{LightConstants, most, rgb, wide};
use crate::beam::{Ball, Region};
use crate::light::Light;
use crate::reach::{Reach, reach, reach_of_parallel};
use crate::settings::Settings;
use crate::view::View;

/// The constants of a light and its region, or `None` where it is too weak for any pixel. `extinction` is the least and
/// `scattering` the largest of the channels'.
pub(super) fn pack(
    settings: &Settings,
    view: &View,
    light: &Light,
    [extinction, scattering]: [f64; 2],
) -> Option<(LightConstants, Region)> {
    let View { world, camera, medium, .. } = view;
    let position = world.position(light.position) - world.position(camera.position);
    let (distance, radius) = (position.length(), world.distance(light.radius));
    let intensity = light.intensity.map(|value| value * light.scatter);
    let bound = settings.bound / world.pre_exposure;
    let strongest =
        |path: f64| scattering * medium.phase.most() * most(intensity) * (-extinction * path).exp();
    // Where the medium thins, neither its density nor what the path loses is bounded by that of the eye.
    let reached = if medium.thinning.is_some() {
        if most(intensity) > 0.0 { Reach::Everywhere } else { Reach::Nowhere }
    } else if world.depth.orthographic {
        let ahead = position.dot(world.direction(camera.forward).normalize()).abs();
        reach_of_parallel(strongest(ahead), radius, bound)
    } else {
        reach(strongest(distance), distance, radius, bound)
    };
    if reached == Reach::Nowhere {
        return None;
    }
    let least_along = match reached {
        // Rounded outwards by more than f32 loses.
        Reach::Within(angle) => distance * angle.cos() - 1e-6 * distance,
        _ => f64::from(f32::MIN),
    };
    let mut constants = LightConstants {
        position_radius: wide(position, radius),
        intensity_reach: rgb(seen(view, intensity, position, radius), least_along),
        axis_cosine: [0.0, 0.0, 0.0, -2.0],
        falloff_range: [0.0; 4],
        low: [0.0; 4],
        high: [0.0; 4],
    };
    let mut balls = [None; 3];
    let range = light.range.map(|range| world.distance(range));
    let mut spot = None;
    if let Some(cone) = light.cone {
        let axis = world.direction(cone.direction).normalize();
        constants.axis_cosine = wide(axis, cone.outer.cos());
        // KHR_lights_punctual: full at the inner angle, nothing at the outer.
        let scale = 1.0 / (cone.inner.cos() - cone.outer.cos()).max(1e-3);
        constants.falloff_range[..2].copy_from_slice(&[scale as f32, (-cone.outer.cos() * scale) as f32]);
        spot = Some((axis, cone.outer));
        balls[0] = range.map(|range| ball_of_cone(position, axis, cone.outer, range));
    }
    if let Some(range) = range {
        constants.falloff_range[2] = range as f32;
        balls[1] = Some(Ball { center: position, radius: range });
    }
    if let Some(bounds) = light.bounds {
        let ends = [bounds.low, bounds.high].map(|end| world.position(end) - world.position(camera.position));
        constants.falloff_range[3] = 1.0;
        constants.low = wide(ends[0].min(ends[1]), 0.0);
        constants.high = wide(ends[0].max(ends[1]), 0.0);
        balls[2] = Some(Ball { center: 0.5 * (ends[0] + ends[1]), radius: 0.5 * ends[0].distance(ends[1]) });
    }
    Some((constants, Region::new(position, reached, balls, spot)))
}

/// The smallest ball about a cone of half angle `outer` that ends at `range` from its apex.
fn ball_of_cone(apex: DVec3, axis: DVec3, outer: f64, range: f64) -> Ball {
    if outer < FRAC_PI_4 {
        let radius = 0.5 * range / outer.cos();
        return Ball { center: apex + radius * axis, radius };
    }
    Ball { center: apex + range * outer.cos() * axis, radius: range * outer.sin() }
}

/// `fog_seen` of `airlight.glsl`, in f64; left to the shader where each ray has an eye of its own.
fn seen(view: &View, intensity: [f64; 3], position: DVec3, radius: f64) -> [f64; 3] {
    if view.world.depth.orthographic || view.medium.thinning.is_some() {
        return intensity;
    }
    let path = position.length().hypot(radius);
    [0, 1, 2].map(|channel| intensity[channel] * (-view.medium.extinction[channel] * path).exp())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn the_ball_of_a_cone_holds_its_apex_and_its_rim() {
        let (apex, axis) = (DVec3::new(1.0, 2.0, -3.0), DVec3::X);
        for outer in [0.1, 0.7, FRAC_PI_4, 1.2, FRAC_PI_2] {
            let ball = ball_of_cone(apex, axis, outer, 5.0);
            let rim = apex + 5.0 * DVec3::new(outer.cos(), outer.sin(), 0.0);
            for point in [apex, rim, apex + 5.0 * axis] {
                let off = point.distance(ball.center);
                assert!(off <= ball.radius + 1e-12, "{outer}: {point} is {off} off, radius {}", ball.radius);
            }
        }
    }
}
