//! Sweeps in logarithmic steps through the limits.

use std::f64::consts::PI;

use super::angles::row;
use super::{RELATIVE_BOUND, error};
use crate::FogError;
use crate::bench::Bench;
use crate::eval::{AirlightRow, airlight};

/// A limit approached in logarithmic steps.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// What is approached.
    pub name: &'static str,
    /// The parameter and its unit.
    pub parameter: &'static str,
    /// Parameter, the GPU's value, the truth, the error.
    pub points: Vec<[f64; 4]>,
    /// The rows of the points.
    pub rows: Vec<AirlightRow>,
    /// The largest error allowed.
    pub bound: f64,
}

impl Sweep {
    /// Whether every point is within the bound.
    #[must_use]
    pub fn pass(&self) -> bool {
        self.points.iter().all(|[.., error]| *error <= self.bound)
    }
}

/// A row for each value of a parameter.
type Approach = (&'static str, &'static str, [f64; 2], fn(f64) -> AirlightRow);

const APPROACHES: [Approach; 9] = [
    ("onto the light, surface beyond it", "angle, rad", [2e-8, 1.0], |at| row(0.1, 10.0, at, 20.0)),
    ("onto the light, surface before it", "angle, rad", [1e-9, 1.0], |at| row(0.1, 10.0, at, 9.0)),
    ("away from the light", "pi - angle, rad", [1e-9, 1.0], |at| row(0.1, 10.0, PI - at, f64::INFINITY)),
    ("optical distance of the light", "T", [1e-8, 1e3], |at| row(at / 10.0, 10.0, 0.5, 20.0)),
    ("optical distance, no surface", "T", [1e-8, 1e3], |at| row(at / 10.0, 10.0, 2.0, f64::INFINITY)),
    ("light at the eye", "distance, m", [1e-6, 1.0], |at| row(0.1, at, 0.5, 20.0)),
    ("light at the surface", "gap, m", [1e-5, 1.0], |at| row(0.1, 10.0, 1e-3, 10.0 - at)),
    ("short rays", "length, m", [1e-6, 1.0], |at| row(0.1, 10.0, 0.5, at)),
    ("long rays", "length, m", [1.0, 1e9], |at| row(0.1, 10.0, 0.5, at)),
];

/// Steps of a sweep.
const STEPS: usize = 60;

/// Runs the sweeps, or the one called `only`; none, if none has the name.
///
/// # Errors
/// [`FogError::Gpu`] when the device fails.
pub fn sweeps(bench: &Bench<'_>, only: Option<&str>) -> Result<Vec<Sweep>, FogError> {
    let chosen = |name: &str| only.is_none_or(|only| only == name);
    let mut sweeps = Vec::new();
    for (name, parameter, [low, high], at) in APPROACHES.into_iter().filter(|approach| chosen(approach.0)) {
        let place = |step: usize| low * (high / low).powf(step as f64 / (STEPS - 1) as f64);
        let rows: Vec<AirlightRow> = (0..STEPS).map(|step| at(place(step))).collect();
        let mut points = Vec::with_capacity(STEPS);
        for (step, found) in airlight(bench, &rows)?.into_iter().enumerate() {
            points.push(match found {
                Ok(found) => [place(step), found.value, found.reference, error(found.value, found.reference)],
                Err(_) => [place(step), f64::NAN, f64::NAN, f64::INFINITY],
            });
        }
        sweeps.push(Sweep { name, parameter, points, rows, bound: RELATIVE_BOUND });
    }
    Ok(sweeps)
}
