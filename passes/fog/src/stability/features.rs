//! What a row of `fog-airlight` cannot say: channels, intensities, far places, cones, boxes, height.

use glam::DVec3;

use super::Outcome;
use crate::bench::{Bench, Ray, settings};
use crate::light::{Bounds, Cone};
use crate::medium::Thinning;
use crate::reference::airlight::{Sight, airlight};
use crate::reference::{cone, height};
use crate::{FogError, Light, Medium, Phase, Preset};

/// A ray and the truth of a channel of it.
struct Case {
    name: String,
    ray: Ray,
    channel: usize,
    truth: f64,
}

const LIGHT: DVec3 = DVec3::new(3.0, 4.0, -9.0);
const EXTINCTION: f64 = 0.1;

fn medium(extinction: [f64; 3]) -> Medium {
    Medium { extinction, albedo: [0.8; 3], phase: Phase::Isotropic, thinning: None }
}

fn ray(light: Light) -> Ray {
    let direction = DVec3::new(0.1, 0.2, -1.0).normalize();
    Ray { eye: DVec3::ZERO, medium: medium([EXTINCTION; 3]), light, direction, distance: 20.0 }
}

/// The sight of a point light from a ray.
fn sight(ray: &Ray) -> Sight {
    let light = ray.light.position - ray.eye;
    Sight { along: light.dot(ray.direction), offset: light.cross(ray.direction).length() }
}

/// Quadrature over part of a ray.
fn truth(ray: &Ray, extinction: f64, near: f64, far: f64) -> Result<f64, FogError> {
    if extinction == 0.0 || near >= far {
        return Ok(0.0);
    }
    Ok(0.8 * extinction * airlight(extinction, sight(ray), near, far, Phase::Isotropic)?)
}

pub(super) fn cases(bench: &Bench<'_>, chosen: impl Fn(&str) -> bool) -> Result<Vec<Outcome>, FogError> {
    let mut outcomes = Vec::new();
    for Case { name, ray, channel, truth } in all()?.into_iter().filter(|case| chosen(&case.name)) {
        let found = bench.airlight(&settings(&ray.medium, Preset::Reference), &[ray])?;
        let value = found.first().map_or(f64::NAN, |rgb| f64::from(rgb[channel]));
        outcomes.push(Outcome::of_value(name, format!("{ray:?}"), value, truth));
    }
    Ok(outcomes)
}

fn all() -> Result<Vec<Case>, FogError> {
    let white = Light::point(LIGHT, [1.0; 3]);
    let whole = |ray: &Ray, extinction| truth(ray, extinction, 0.0, ray.distance);
    let mut cases = Vec::new();
    let mut add = |name: &str, ray: Ray, channel: usize, truth: f64| {
        cases.push(Case { name: name.to_owned(), ray, channel, truth });
    };

    let channels = [0.0, 0.03, 2.0];
    for (channel, extinction) in channels.into_iter().enumerate() {
        let ray = Ray { medium: medium(channels), ..ray(white) };
        add(&format!("extinction 0, 0.03 and 2: channel {channel}"), ray, channel, whole(&ray, extinction)?);
    }
    for intensity in [1e6, 1e-6] {
        let ray = ray(Light { intensity: [intensity; 3], ..white });
        add(&format!("intensity {intensity:e}"), ray, 0, intensity * whole(&ray, EXTINCTION)?);
    }
    for far in [1e4, 1e7] {
        let eye = far * DVec3::new(1.0, -0.5, 0.7);
        let ray = Ray { eye, ..ray(Light { position: eye + LIGHT, ..white }) };
        add(&format!("camera {far:e} m from the origin"), ray, 0, whole(&ray, EXTINCTION)?);
    }

    // The wall is the plane z = -6: the lamp behind it shines within its own room.
    let room = |low: f64, high: f64| Bounds {
        low: DVec3::new(-50.0, -50.0, low),
        high: DVec3::new(50.0, 50.0, high),
    };
    let behind = ray(Light { bounds: Some(room(-30.0, -6.0)), ..white });
    let crossing = -6.0 / behind.direction.z;
    add(
        "a lamp behind a wall, its room seen from outside",
        behind,
        0,
        truth(&behind, EXTINCTION, crossing, 20.0)?,
    );
    for gap in [1e-4, 1e-3, 1e-2, 0.1, 1.0] {
        let position = DVec3::new(LIGHT.x, LIGHT.y, -6.0 - gap);
        let near = ray(Light { position, ..behind.light });
        let truth = truth(&near, EXTINCTION, crossing, 20.0)?;
        add(&format!("a lamp {gap} m behind a wall, its room seen from outside"), near, 0, truth);
        let before = Ray { distance: 0.999 * crossing, ..near };
        add(&format!("a lamp {gap} m behind a wall, the ray ends before it"), before, 0, 0.0);
    }
    let before = Ray { distance: 0.999 * crossing, ..behind };
    add("a lamp behind a wall, the ray ends before it", before, 0, 0.0);

    for (name, axis) in
        [("across", DVec3::X), ("towards the eye", DVec3::Z), ("away", DVec3::NEG_Z), ("down", DVec3::NEG_Y)]
    {
        for (inner, outer) in [(0.2, 0.6), (0.0, 0.05), (1.4, std::f64::consts::FRAC_PI_2)] {
            let ray = ray(Light { cone: Some(Cone { direction: axis, inner, outer }), ..white });
            let falloff = |cosine: f64| {
                let edge = (cosine - outer.cos()) / (inner.cos() - outer.cos()).max(1e-3);
                edge.clamp(0.0, 1.0).powi(2)
            };
            let vectors = [LIGHT, axis, ray.direction];
            let truth = cone::airlight(EXTINCTION, vectors, outer, falloff, ray.distance, Phase::Isotropic)?;
            add(&format!("spot {name}, half angle {outer:.2}"), ray, 0, 0.8 * EXTINCTION * truth);
        }
    }

    for (scale_height, slope) in [(5.0, 0.5), (50.0, -0.3), (1e6, 0.2), (2.0, 0.0)] {
        let direction = DVec3::new(0.1, slope, -1.0).normalize();
        let thinning = Some(Thinning { level: 0.0, scale_height });
        let ray = Ray { direction, medium: Medium { thinning, ..medium([EXTINCTION; 3]) }, ..ray(white) };
        let thin = height::Thinning {
            extinction: EXTINCTION,
            scale_height,
            slope: direction.y,
            light_height: LIGHT.y,
        };
        let truth = height::airlight(thin, sight(&ray), ray.distance, Phase::Isotropic)?;
        add(&format!("thinning in {scale_height} m, slope {slope}"), ray, 0, 0.8 * EXTINCTION * truth);
    }
    Ok(cases)
}
