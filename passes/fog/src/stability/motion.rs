//! Small steps of a lamp or of the eye: the largest change of what rays see, in what is allowed of it.

use glam::DVec3;

use super::{Outcome, RELATIVE_BOUND, number};
use crate::bench::{Bench, Ray, settings};
use crate::{FogError, Light, Medium, Phase, Preset};

const STEPS: usize = 150;
/// Metres.
const STEP: f64 = 0.01;
const RADIUS: f64 = 0.1;
const EXTINCTION: f64 = 0.4;
const G: f64 = 0.5;

/// Where the eye and the lamp are after so many metres.
type Way = (&'static str, fn(f64) -> [DVec3; 2]);

const WAYS: [Way; 4] = [
    ("a lamp across the view", |s| [DVec3::ZERO, DVec3::new(s - 0.75, 0.02, -3.0)]),
    ("a lamp through the eye", |s| [DVec3::ZERO, DVec3::new(0.0, 0.0, s - 0.75)]),
    ("a lamp through a surface", |s| [DVec3::ZERO, DVec3::new(0.1, 0.1, s - 5.75)]),
    ("the eye past a lamp", |s| [DVec3::new(0.0, 0.0, 0.75 - s), DVec3::new(0.05, 0.02, 0.0)]),
];

/// With R the radius and b the extinction, a step s changes the distance d of a point of a ray from the lamp by no more
/// than s: `1 / (d² + R²)` by a factor of at most exp(s / R), the exponential by exp(b s), and the angle of scattering by
/// s / R, so that the lobe, whose logarithm has a slope of at most 3 g / (1 - g²), changes by exp(3 g s / ((1 - g²) R)).
/// To that comes the error before and after it.
fn allowed() -> f64 {
    (STEP * ((1.0 + 3.0 * G / (1.0 - G * G)) / RADIUS + EXTINCTION)).exp() - 1.0 + 2.0 * RELATIVE_BOUND
}

pub(super) fn cases(bench: &Bench<'_>, chosen: impl Fn(&str) -> bool) -> Result<Vec<Outcome>, FogError> {
    let phase = Phase::HenyeyGreenstein { g: G };
    let medium = Medium { extinction: [EXTINCTION; 3], albedo: [0.9; 3], phase, thinning: None };
    let mut outcomes = Vec::new();
    for (name, way) in WAYS {
        let name = format!("motion: {name}");
        if !chosen(&name) {
            continue;
        }
        let mut rays = Vec::new();
        for step in 0..=STEPS {
            let [eye, lamp] = way(STEP * step as f64);
            let light = Light { radius: RADIUS, ..Light::point(lamp, [1.0; 3]) };
            for (direction, distance) in sights() {
                rays.push(Ray { eye, medium, light, direction, distance });
            }
        }
        let values = bench.airlight(&settings(&medium, Preset::Reference), &rays)?;
        let frames: Vec<&[[f32; 3]]> = values.chunks(sights().count()).collect();
        let mut worst = 0.0_f64;
        for pair in frames.windows(2) {
            for (before, after) in pair[0].iter().zip(pair[1]) {
                let [before, after] = [before[0], after[0]].map(f64::from);
                let share = (after - before).abs() / (allowed() * before.max(after)).max(1e-30);
                worst = if share.is_finite() { worst.max(share) } else { f64::INFINITY };
            }
        }
        let input =
            format!("{STEPS} steps of {STEP} m, radius {RADIUS} m, extinction {EXTINCTION} 1/m, g {G}");
        let (result, truth) = (format!("{} of what is allowed", number(worst)), "at most 1".to_owned());
        outcomes.push(Outcome { name, input, result, truth, error: worst, bound: 1.0, row: None });
    }
    Ok(outcomes)
}

/// Directions over the view, each with surfaces near and far and without.
fn sights() -> impl Iterator<Item = (DVec3, f64)> {
    (0..35).flat_map(|i| {
        let place = DVec3::new(f64::from(i % 7 - 3) * 0.2, f64::from(i / 7 - 2) * 0.2, -1.0);
        [0.5, 5.0, f64::INFINITY].map(|distance| (place.normalize(), distance))
    })
}
